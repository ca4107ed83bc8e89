//! Materials: networks whose surface is a `UsdPreviewSurface`, as principled surfaces (OpenPBR).
//! `docs/formats/usd.md` has the table of what becomes what.

use std::collections::HashMap;

use description::{
    AreaLightDesc, EdgeMode, FloatParameter, Handle, ImageChannel, ImageDesc, ImageTextureDesc, MappingDesc,
    MaterialDesc, MaterialKind, SceneDesc, SpectrumDesc, SpectrumParameter, TextureDesc, TextureKind,
    UvImageDesc, WrapMode,
};
use math::DAffine2;

use super::files::Files;
use super::pictures::{Edit, Pictures};
use super::stage::Prim;
use super::texture::{Source, Texture, end, source};
use crate::log::{Log, Result};
use crate::primitives::{Coordinates, Principled, Surface};

/// A material of the file as surfaces of the scene.
#[derive(Clone, Debug)]
pub(super) struct Material {
    /// The surface, and that where texture coordinates are mirrored.
    pub surfaces: [Surface; 2],
    /// The primvar of the coordinates that meshes have.
    pub set: String,
    pub has_normals: bool,
    /// The primvar that is the base colour.
    pub colors: Option<String>,
}

/// The materials of a scene, each made once.
pub(super) struct Materials<'a> {
    known: HashMap<(String, bool), Option<Material>>,
    plain: HashMap<[u32; 3], Surface>,
    pictures: Pictures,
    pub files: &'a Files<'a>,
}

/// Reflectance of surfaces that have neither a material nor a colour.
const GREY: f32 = 0.18;

/// The coordinates of meshes whose material says nothing of them.
const NO_MAP: Coordinates = Coordinates { set: 0, transform: DAffine2::IDENTITY };

impl<'a> Materials<'a> {
    pub fn new(files: &'a Files<'a>) -> Self {
        Self { known: HashMap::new(), plain: HashMap::new(), pictures: Pictures::default(), files }
    }

    /// The image of a light.
    pub fn light_image(
        &mut self,
        texture: &Texture,
        desc: &mut SceneDesc,
        log: &mut Log,
    ) -> Option<Handle<ImageDesc>> {
        self.pictures.add(texture, Edit::None, &mut desc.images, self.files, log)
    }

    /// A diffuse surface of a colour.
    pub fn plain(&mut self, color: Option<[f32; 3]>, desc: &mut SceneDesc) -> Surface {
        let color = color.unwrap_or([GREY; 3]);
        let surface = self.plain.entry(color.map(f32::to_bits)).or_insert_with(|| {
            let [r, g, b] = color.map(|v| v.clamp(0.0, 1.0));
            diffuse(SpectrumDesc::rgb(r, g, b).into(), desc)
        });
        surface.clone()
    }

    /// A material; `None` if nothing of it is drawn.
    pub fn get(
        &mut self,
        prim: &Prim,
        is_two_sided: bool,
        desc: &mut SceneDesc,
        log: &mut Log,
    ) -> Option<Material> {
        let key = (prim.path().to_owned(), is_two_sided);
        if let Some(known) = self.known.get(&key) {
            return known.clone();
        }
        let made = self.make(prim, is_two_sided, desc, log);
        let made = log.keep(made).flatten();
        self.known.insert(key, made.clone());
        made
    }

    fn make(
        &mut self,
        prim: &Prim,
        is_two_sided: bool,
        desc: &mut SceneDesc,
        log: &mut Log,
    ) -> Result<Option<Material>> {
        if !prim.is_there() {
            return Err(prim.fault("", "there is no such material"));
        }
        let (shader, _) = end(prim, "outputs:surface")?;
        let kind = shader.word("info:id")?.unwrap_or_default();
        if kind != "UsdPreviewSurface" {
            let message = match kind.is_empty() {
                true => "materials without a `UsdPreviewSurface` are not drawn".to_owned(),
                false => format!("shaders of the kind `{kind}` are not drawn"),
            };
            log.warn("not-drawn", prim.path(), message);
            return Ok(None);
        }
        let mut builder = Builder {
            shader,
            desc,
            pictures: &mut self.pictures,
            files: self.files,
            log,
            coordinates: NO_MAP,
            set: None,
        };
        builder.material(prim, is_two_sided).map(Some)
    }
}

/// A diffuse surface.
pub(super) fn diffuse(reflectance: SpectrumParameter, desc: &mut SceneDesc) -> Surface {
    let material = desc.materials.push(MaterialKind::Diffuse { reflectance }.into());
    Surface {
        material,
        area_light: None,
        alpha: None,
        media: None,
        single_sided: false,
        coordinates: NO_MAP,
        tangent_rotation: 0.0,
    }
}

/// A number or a colour with what is known of it.
enum Input {
    Constant([f64; 3]),
    Texture(Box<Texture>),
    Primvar(String),
}

/// Makes the surfaces of one material.
struct Builder<'b, 's> {
    shader: Prim<'s>,
    desc: &'b mut SceneDesc,
    pictures: &'b mut Pictures,
    files: &'b Files<'b>,
    log: &'b mut Log,
    coordinates: Coordinates,
    /// The primvar of the coordinates of the first texture.
    set: Option<String>,
}

impl Builder<'_, '_> {
    fn material(&mut self, prim: &Prim, is_two_sided: bool) -> Result<Material> {
        let normal = match self.input::<3>("normal", [0.0, 0.0, 1.0])? {
            Input::Texture(texture) if self.image(&texture).is_some() => Some(texture),
            _ => None,
        };
        let emission = self.input::<3>("emissiveColor", [0.0; 3])?;
        // Normal maps and emission are looked up at the coordinates of the mesh itself.
        let placed = match (&normal, &emission) {
            (Some(texture), _) => Some(texture),
            (None, Input::Texture(texture)) => Some(texture),
            _ => None,
        };
        if let Some(texture) = placed.filter(|texture| texture.transform.inverse().is_finite()) {
            self.coordinates.transform = texture.transform;
            self.set = Some(texture.set.clone());
        }
        let (kind, colors) = self.kind()?;
        let alpha = self.alpha()?;
        let name = prim.name().to_owned();
        let area_light = self.area_light(&emission, &name, is_two_sided);
        let normal_maps = [false, true].map(|is_mirrored| {
            let texture = normal.as_ref()?;
            let [scale, bias] = [texture.scale, texture.bias].map(|[x, y, z, _]| [x, y, z]);
            let is_usual = scale == [2.0; 3] && bias == [-1.0; 3] || scale == [1.0; 3] && bias == [0.0; 3];
            let edit = match is_usual {
                true if !is_mirrored => Edit::None,
                true => Edit::Normals([2.0; 3], [-1.0; 3], true),
                false => Edit::Normals(scale, bias, is_mirrored),
            };
            let map = self.uv_image(texture, edit)?;
            // Black is no normal.
            let is_black = match map.wrap {
                WrapMode::Axes(axes) => axes.contains(&EdgeMode::Black),
                wrap => wrap == WrapMode::Black,
            };
            Some(UvImageDesc { wrap: if is_black { WrapMode::Repeat } else { map.wrap }, ..map })
        });
        let coordinates = self.coordinates;
        let surfaces = normal_maps.map(|normal_map| {
            let material =
                MaterialDesc { name: name.clone(), normal_map, ..MaterialDesc::from(kind.clone()) };
            Surface {
                material: self.desc.materials.push(material),
                area_light,
                alpha: alpha.clone(),
                media: None,
                single_sided: false,
                coordinates,
                tangent_rotation: 0.0,
            }
        });
        let [surface, mirrored] = surfaces;
        let has_normals = normal_maps[0].is_some();
        let surfaces = if has_normals { [surface, mirrored] } else { [surface.clone(), surface] };
        Ok(Material {
            surfaces,
            set: self.set.clone().unwrap_or_else(|| "st".to_owned()),
            has_normals,
            colors,
        })
    }

    fn warn(&mut self, message: impl Into<String>) {
        self.log.warn("not-drawn", self.shader.path(), message);
    }

    /// An input of `N` numbers, of which a single one is three times the same.
    fn input<const N: usize>(&mut self, name: &str, otherwise: [f64; 3]) -> Result<Input> {
        Ok(match source(&self.shader, name)? {
            None => Input::Constant(otherwise),
            Some(Source::Value(prim, property)) => match prim.numbers::<N>(&property)? {
                Some(value) => Input::Constant(std::array::from_fn(|i| value[i.min(N - 1)])),
                None => Input::Constant(otherwise),
            },
            Some(Source::Texture(texture)) => {
                match &self.set {
                    None => self.set = Some(texture.set.clone()),
                    Some(set) if *set != texture.set => {
                        self.warn("textures of a material at several sets of coordinates are drawn at one")
                    }
                    Some(_) => {}
                }
                Input::Texture(texture)
            }
            Some(Source::Primvar(name)) => Input::Primvar(name),
            Some(Source::Unknown(kind)) => {
                self.warn(format!("nodes of the kind `{kind}` are not drawn"));
                Input::Constant(otherwise)
            }
        })
    }

    fn image(&mut self, texture: &Texture) -> Option<std::sync::Arc<image::Image>> {
        self.pictures.image(texture, self.files, self.log)
    }

    /// From the coordinates of meshes to those of a texture.
    fn texture_from_mesh(&self, texture: &Texture) -> DAffine2 {
        match texture.transform == self.coordinates.transform {
            true => DAffine2::IDENTITY,
            false => texture.transform * self.coordinates.transform.inverse(),
        }
    }

    /// An image over (u, v).
    fn uv_image(&mut self, texture: &Texture, edit: Edit) -> Option<UvImageDesc> {
        let image = self.pictures.add(texture, edit, &mut self.desc.images, self.files, self.log)?;
        let columns =
            self.texture_from_mesh(texture).to_cols_array_2d().map(|column| column.map(|v| v as f32));
        Some(UvImageDesc { image, columns, wrap: texture.wrap, is_nearest: false })
    }

    /// An image as a texture.
    fn texture(&mut self, texture: &Texture, edit: Edit) -> Option<ImageTextureDesc> {
        let image = self.pictures.add(texture, edit, &mut self.desc.images, self.files, self.log)?;
        let from_mesh = self.texture_from_mesh(texture);
        let [x, y, delta] = [from_mesh.matrix2.x_axis, from_mesh.matrix2.y_axis, from_mesh.translation];
        let mapping = if x.y == 0.0 && y.x == 0.0 {
            MappingDesc::Uv { scale: [x.x as f32, y.y as f32], delta: delta.as_vec2().to_array() }
        } else {
            MappingDesc::Affine { columns: [x, y, delta].map(|v| v.as_vec2().to_array()) }
        };
        Some(ImageTextureDesc { mapping, wrap: texture.wrap, ..ImageTextureDesc::new(image) })
    }

    fn number(&mut self, name: &str, otherwise: f64) -> Result<FloatParameter> {
        let input = self.input::<1>(name, [otherwise; 3])?;
        Ok(match input {
            Input::Constant([value, ..]) => (value as f32).into(),
            Input::Texture(texture) => self.channel(&texture),
            Input::Primvar(_) => {
                self.warn(format!("`inputs:{name}` that varies by a primvar is drawn as {otherwise}"));
                (otherwise as f32).into()
            }
        })
    }

    /// The channel of a texture that is meant.
    fn channel(&mut self, texture: &Texture) -> FloatParameter {
        let channel = texture.channel.unwrap_or(0);
        let (scale, bias) = (texture.scale[channel], texture.bias[channel]);
        let has_alpha = self.image(texture).map(|image| image.alpha_index().is_some());
        let constant = match has_alpha {
            None => Some(texture.constant()[channel]),
            Some(false) if channel == 3 => Some(scale + bias),
            Some(_) => None,
        };
        if let Some(value) = constant {
            return (value as f32).into();
        }
        const CHANNELS: [ImageChannel; 4] =
            [ImageChannel::Red, ImageChannel::Green, ImageChannel::Blue, ImageChannel::Alpha];
        let is_scaled = bias == 0.0 && scale >= 0.0;
        let edit = if is_scaled { Edit::None } else { Edit::Number(channel, scale, bias) };
        let Some(image) = self.texture(texture, edit) else {
            return (texture.constant()[channel] as f32).into();
        };
        let (channel, scale) =
            if is_scaled { (CHANNELS[channel], scale as f32) } else { (ImageChannel::Red, 1.0) };
        let image = ImageTextureDesc { channel: Some(channel), scale, ..image };
        self.desc.float_textures.push(TextureDesc::new(TextureKind::Image(image))).into()
    }

    /// A colour divided by a unit.
    fn color(&mut self, input: &Input, unit: f64) -> SpectrumParameter {
        let constant = |[r, g, b]: [f64; 3]| {
            let [r, g, b] = [r, g, b].map(|v| (v / unit) as f32);
            SpectrumParameter::from(SpectrumDesc::rgb(r, g, b))
        };
        let texture = match input {
            Input::Constant(value) => return constant(*value),
            Input::Primvar(_) => return constant([f64::from(GREY); 3]),
            Input::Texture(texture) => texture,
        };
        let [scale, bias] = [texture.scale, texture.bias].map(|[x, y, z, _]| [x, y, z].map(|v| v / unit));
        let is_even = bias == [0.0; 3] && scale == [scale[0]; 3] && scale[0] >= 0.0;
        let edit = if is_even { Edit::None } else { Edit::Color(scale, bias) };
        match self.texture(texture, edit) {
            Some(image) => {
                let image = ImageTextureDesc { scale: if is_even { scale[0] as f32 } else { 1.0 }, ..image };
                self.desc.spectrum_textures.push(TextureDesc::new(TextureKind::Image(image))).into()
            }
            None => {
                let [r, g, b, _] = texture.constant();
                constant([r, g, b])
            }
        }
    }

    /// The material without what shapes have, and the primvar that is its base colour.
    fn kind(&mut self) -> Result<(MaterialKind, Option<String>)> {
        /// Reflectance of an index of 1.5.
        const UNIT: f64 = 0.04;
        let mut surface = Principled::default();
        let base = self.input::<3>("diffuseColor", [f64::from(GREY); 3])?;
        let color = self.color(&base, 1.0);
        surface.color("base_color", color);
        surface.number("specular_roughness", self.number("roughness", 0.5)?);
        let is_specular = match source(&self.shader, "useSpecularWorkflow")? {
            Some(Source::Value(prim, property)) => prim.flag(&property)?,
            _ => false,
        };
        if is_specular {
            let specular = self.input::<3>("specularColor", [0.0; 3])?;
            let most = match &specular {
                Input::Constant(value) => value.iter().fold(0.0, |a: f64, &b| a.max(b)),
                _ => 1.0,
            };
            surface.number("specular_weight", ((most / UNIT) as f32).into());
            if most > 0.0 {
                let color = self.color(&specular, most);
                surface.color("specular_color", color);
            }
        } else {
            surface.number("base_metalness", self.number("metallic", 0.0)?);
            let ior = match self.input::<1>("ior", [1.5; 3])? {
                Input::Constant([ior, ..]) => ior,
                _ => 1.5,
            };
            let known = ior.clamp(1.0, 3.0);
            if known != ior {
                self.warn(format!("the index of refraction {ior} is drawn as {known}"));
            }
            surface.number("specular_ior", (known as f32).into());
        }
        let coat = self.number("clearcoat", 0.0)?;
        if coat.value() != Some(&0.0) {
            surface.number("coat_weight", coat);
            surface.number("coat_roughness", self.number("clearcoatRoughness", 0.01)?);
            surface.number("coat_ior", 1.5.into());
            // The coat of the format does not darken what is under it.
            surface.number("coat_darkening", 0.0.into());
        }
        if !matches!(self.input::<1>("displacement", [0.0; 3])?, Input::Constant([0.0, ..])) {
            self.warn("displacement is not drawn");
        }
        let colors = match base {
            Input::Primvar(name) => Some(name),
            _ => None,
        };
        Ok((MaterialKind::OpenPbr(surface.desc), colors))
    }

    fn alpha(&mut self) -> Result<Option<FloatParameter>> {
        let opacity = self.number("opacity", 1.0)?;
        let threshold = match self.input::<1>("opacityThreshold", [0.0; 3])? {
            Input::Constant([value, ..]) => value as f32,
            _ => 0.0,
        };
        Ok(match opacity {
            FloatParameter::Value(opacity) if opacity >= 1.0 => None,
            FloatParameter::Value(opacity) if threshold > 0.0 => {
                Some(FloatParameter::Value(if opacity >= threshold { 1.0 } else { 0.0 }))
            }
            texture if threshold > 0.0 => {
                let step = TextureKind::Step { texture, edge: threshold };
                Some(self.desc.float_textures.push(TextureDesc::new(step)).into())
            }
            opacity => Some(opacity),
        })
    }

    fn area_light(
        &mut self,
        emission: &Input,
        name: &str,
        is_two_sided: bool,
    ) -> Option<Handle<AreaLightDesc>> {
        let (color, texture) = match emission {
            Input::Constant(color) => (*color, None),
            Input::Primvar(_) => {
                self.warn("emission that varies by a primvar is not drawn");
                return None;
            }
            Input::Texture(texture) => match self.image(texture) {
                Some(_) => ([1.0; 3], Some(texture)),
                None => ([0, 1, 2].map(|i| texture.constant()[i]), None),
            },
        };
        let scale = color.into_iter().fold(0.0, f64::max);
        if scale <= 0.0 {
            return None;
        }
        let [r, g, b] = color.map(|v| (v / scale) as f32);
        let mut light = AreaLightDesc::new(SpectrumDesc::rgb(r, g, b));
        (light.scale, light.two_sided) = (scale as f32, is_two_sided);
        light.group = Some(name.to_owned());
        if let Some(texture) = texture {
            let [scale, bias] = [texture.scale, texture.bias].map(|[x, y, z, _]| [x, y, z]);
            let is_even = bias == [0.0; 3] && scale == [scale[0]; 3] && scale[0] >= 0.0;
            let edit = if is_even { Edit::None } else { Edit::Color(scale, bias) };
            light.scale = if is_even { scale[0] as f32 } else { 1.0 };
            light.image = self.uv_image(texture, edit);
        }
        (light.scale > 0.0).then(|| self.desc.area_lights.push(light))
    }
}
