//! Materials of mesh files as surfaces of a scene. `docs/formats/meshes.md` has the table of what
//! becomes what.

use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use description::{
    AreaLightDesc, CoatedDiffuseDesc, ConductorDesc, ConductorReflectance, EncodingDesc, FloatParameter,
    Handle, ImageChannel, ImageDesc, ImageTextureDesc, MappingDesc, MaterialDesc, MaterialKind,
    RoughnessDesc, SceneDesc, SpectrumDesc, SpectrumParameter, TextureDesc, TextureKind, UvImageDesc,
    WrapMode,
};
use image::Image;

use assets::mesh::{Channel, Map, ObjMaterial, PRINCIPLED};
use assets::{AssetSource, resolve};

use crate::log::Log;
use crate::primitives::{Coordinates, Principled, Surface};

/// The paint of vertices on a material: nothing, a factor, or an image that has the factor of the
/// material in it.
#[derive(Clone, Copy)]
pub(super) enum Paint {
    None,
    Even([f32; 3]),
    Image(Handle<ImageDesc>),
}

/// Makes surfaces of materials.
pub(super) struct Surfaces<'a> {
    pub desc: &'a mut SceneDesc,
    pub log: &'a mut Log,
    pub assets: &'a dyn AssetSource,
    /// The mesh file, beside which pictures may be.
    pub file: &'a Path,
    images: HashMap<(PathBuf, String), Option<Handle<ImageDesc>>>,
}

/// A picture as it is looked up.
struct Lookup<'m> {
    map: &'m Map,
    /// The file that names it.
    library: &'m Path,
    /// Whether its codes are numbers, not colours.
    is_data: bool,
}

impl<'a> Surfaces<'a> {
    pub fn new(
        desc: &'a mut SceneDesc,
        log: &'a mut Log,
        assets: &'a dyn AssetSource,
        file: &'a Path,
    ) -> Self {
        Self { desc, log, assets, file, images: HashMap::new() }
    }

    /// The surface of a material of a library, and that where texture coordinates are mirrored,
    /// which is the same unless it has a normal map.
    pub fn both(&mut self, material: &ObjMaterial, library: &Path, paint: Paint) -> [Surface; 2] {
        let opacity = material.opacity.unwrap_or(1.0).clamp(0.0, 1.0);
        let alpha = match &material.opacity_map {
            Some(map) => Some(self.number(&Lookup { map, library, is_data: true }, opacity)),
            None => (opacity < 1.0).then(|| opacity.into()),
        };
        let area_light = self.area_light(material, library);
        let kind = self.kind(material, library, paint);
        let (normals, displacement) = self.relief(material, library);
        let mut place = |normal_map| {
            let desc = MaterialDesc { normal_map, displacement: displacement.clone(), ..kind.clone().into() };
            self.desc.materials.push(MaterialDesc { name: material.name.clone(), ..desc })
        };
        let handles = match normals {
            Some(normals) => normals.map(|normals| place(Some(normals))),
            None => [place(None); 2],
        };
        handles.map(|handle| Surface { area_light, alpha: alpha.clone(), ..plain(handle) })
    }

    fn kind(&mut self, material: &ObjMaterial, library: &Path, paint: Paint) -> MaterialKind {
        let color = |rgb: Option<[f32; 3]>| rgb.map(|[r, g, b]| SpectrumDesc::rgb(r, g, b));
        let reflectance = self.reflectance(material, library, paint);
        let is_glass = matches!(material.illumination, Some(4 | 6 | 7 | 9));
        let filter = material.filter.filter(|&filter| is_glass && filter != [1.0; 3]);
        if material.is_principled() || filter.is_some() {
            return self.principled(material, library, reflectance, is_glass);
        }
        let dark = material.diffuse.is_some_and(|rgb| rgb.iter().all(|&value| value < 1e-3));
        let shines = material.specular.is_some_and(|rgb| rgb.iter().any(|&value| value > 0.0));
        let alpha = phong_alpha(material.shininess.unwrap_or(0.0));
        let roughness = RoughnessDesc { u: alpha.into(), v: alpha.into(), remap: false };
        if is_glass {
            let eta = material.index_of_refraction.filter(|&eta| eta > 1.0).unwrap_or(1.5);
            MaterialKind::Dielectric { eta: eta.into(), roughness: RoughnessDesc::default() }
        } else if dark && shines && material.diffuse_map.is_none() {
            let reflectance =
                ConductorReflectance::Reflectance(color(material.specular).unwrap_or(0.5.into()).into());
            MaterialKind::Conductor(ConductorDesc { reflectance, roughness })
        } else if shines {
            MaterialKind::CoatedDiffuse(CoatedDiffuseDesc {
                reflectance,
                roughness,
                ..CoatedDiffuseDesc::default()
            })
        } else {
            MaterialKind::Diffuse { reflectance }
        }
    }

    fn principled(
        &mut self,
        material: &ObjMaterial,
        library: &Path,
        base: SpectrumParameter,
        is_glass: bool,
    ) -> MaterialKind {
        let mut surface = Principled::default();
        surface.color("base_color", base);
        if let Some(shininess) = material.shininess {
            // The roughness is the square root of α.
            surface.number("specular_roughness", phong_alpha(shininess).sqrt().into());
        }
        if let Some(eta) = material.index_of_refraction.filter(|&eta| eta >= 1.0) {
            surface.number("specular_ior", eta.min(3.0).into());
        }
        if is_glass {
            let [r, g, b] = material.filter.unwrap_or([1.0; 3]).map(|value| value.clamp(0.0, 1.0));
            surface.number("transmission_weight", 1.0.into());
            surface.color("transmission_color", SpectrumDesc::rgb(r, g, b).into());
        }
        for (index, (_, name)) in PRINCIPLED.into_iter().enumerate() {
            let factor = material.principled[index].map(|value| value.clamp(0.0, 1.0));
            let value = match &material.principled_maps[index] {
                Some(map) => {
                    // Opacity of the picture is not what is meant.
                    let map = &Map { channel: map.channel.or(Some(Channel::Red)), ..map.clone() };
                    Some(self.number(&Lookup { map, library, is_data: true }, factor.unwrap_or(1.0)))
                }
                None => factor.map(Into::into),
            };
            if let Some(value) = value {
                surface.number(name, value);
            }
        }
        MaterialKind::OpenPbr(surface.desc)
    }

    /// The product of what the material, its picture and its vertices say.
    fn reflectance(&mut self, material: &ObjMaterial, library: &Path, paint: Paint) -> SpectrumParameter {
        let (diffuse, map) = (material.diffuse, material.diffuse_map.as_ref());
        let factor = match (paint, diffuse) {
            (Paint::Image(image), _) => return self.spectrum(ImageTextureDesc::new(image)),
            (Paint::Even(paint), _) => {
                let diffuse = diffuse.unwrap_or([1.0; 3]);
                std::array::from_fn(|i| diffuse[i] * paint[i])
            }
            (Paint::None, Some(diffuse)) => diffuse,
            (Paint::None, None) if map.is_some() => [1.0; 3],
            (Paint::None, None) => return 0.5.into(),
        };
        let [r, g, b] = factor;
        let Some(map) = map else { return SpectrumDesc::rgb(r, g, b).into() };
        let lookup = Lookup { map, library, is_data: false };
        let scale = (r == g && g == b && map.base == 0.0 && map.channel.is_none()).then_some(r * map.gain);
        let edit = move |rgb: [f32; 3]| -> [f32; 3] {
            std::array::from_fn(|i| ((map.base + map.gain * rgb[i]) * factor[i]).clamp(0.0, 1.0))
        };
        let image = match scale.filter(|scale| (0.0..=1.0).contains(scale)) {
            Some(scale) => self.texture(&lookup, None).map(|image| ImageTextureDesc { scale, ..image }),
            None => {
                let key = format!("{:?} {} {} {factor:?}", map.channel, map.base, map.gain);
                self.texture(&lookup, Some((key, &edit)))
            }
        };
        image.map_or(SpectrumDesc::rgb(r, g, b).into(), |image| self.spectrum(image))
    }

    fn spectrum(&mut self, image: ImageTextureDesc) -> SpectrumParameter {
        self.desc.spectrum_textures.push(TextureDesc::new(TextureKind::Image(image))).into()
    }

    /// A number of a picture times a factor; the factor if the picture cannot be read. Opacity is
    /// the number of a picture that has any.
    fn number(&mut self, lookup: &Lookup, factor: f32) -> FloatParameter {
        let Map { base, gain, channel, .. } = *lookup.map;
        let image = if base == 0.0 && channel != Some(Channel::Mean) {
            let channel = channel.and_then(|channel| match channel {
                Channel::Red => Some(ImageChannel::Red),
                Channel::Green => Some(ImageChannel::Green),
                Channel::Blue => Some(ImageChannel::Blue),
                Channel::Alpha => Some(ImageChannel::Alpha),
                Channel::Mean => None,
            });
            let image = self.texture(lookup, None);
            image.map(|image| ImageTextureDesc { channel, scale: factor * gain, ..image })
        } else {
            let edit = move |rgb: [f32; 3]| rgb.map(|value| base + gain * value);
            let image = self.texture(lookup, Some((format!("{channel:?} {base} {gain}"), &edit)));
            image.map(|image| ImageTextureDesc { scale: factor, ..image })
        };
        match image {
            Some(image) => self.desc.float_textures.push(TextureDesc::new(TextureKind::Image(image))).into(),
            None => factor.into(),
        }
    }

    /// Normal maps, the second one for mirrored texture coordinates, and a bump map. A picture of
    /// bumps that is coloured has normals, as programs write them.
    fn relief(
        &mut self,
        material: &ObjMaterial,
        library: &Path,
    ) -> (Option<[UvImageDesc; 2]>, Option<FloatParameter>) {
        let bump = material.bump_map.as_ref().map(|map| Lookup { map, library, is_data: true });
        let is_colored = bump.as_ref().is_some_and(|bump| {
            let image = self.image(bump, None);
            image.is_some_and(|image| is_colored(&self.desc.images[image].image))
        });
        let normals = material.normal_map.as_ref().map(|map| Lookup { map, library, is_data: true });
        let normals = match (normals, bump) {
            (Some(normals), bump) => {
                if bump.is_some() {
                    self.log.warn("not-drawn", &material.name, "bumps are not drawn beside a normal map");
                }
                normals
            }
            (None, Some(bump)) if is_colored => bump,
            (None, Some(bump)) => {
                let height = bump.map.bump;
                return (None, self.image(&bump, None).map(|_| self.number(&bump, height)));
            }
            (None, None) => return (None, None),
        };
        let strength = normals.map.bump;
        let mut turned = |up: f32| {
            let code = |value: f32, scale: f32| 0.5 + (value - 0.5) * scale;
            let edit = move |[r, g, b]: [f32; 3]| [code(r, strength), code(g, strength * up), b];
            match (strength, up) {
                (1.0, 1.0) => self.image(&normals, None),
                _ => self.image(&normals, Some((format!("normals {strength} {up}"), &edit))),
            }
        };
        let maps = turned(1.0).zip(turned(-1.0));
        (maps.map(|(upright, mirrored)| [upright, mirrored].map(|image| placed(image, normals.map))), None)
    }

    fn area_light(&mut self, material: &ObjMaterial, library: &Path) -> Option<Handle<AreaLightDesc>> {
        let emission = material.emission.or(material.emission_map.as_ref().map(|_| [1.0; 3]));
        let [r, g, b] = emission.filter(|rgb| rgb.iter().any(|&value| value > 0.0))?;
        let mut light = AreaLightDesc::new(SpectrumDesc::rgb(r, g, b));
        if let Some(map) = &material.emission_map {
            let edit = move |rgb: [f32; 3]| {
                let [x, y, z] = rgb.map(|value| (map.base + map.gain * value).max(0.0));
                [r * x, g * y, b * z]
            };
            let key = format!("emission {r} {g} {b} {} {}", map.base, map.gain);
            let image = self.image(&Lookup { map, library, is_data: false }, Some((key, &edit)));
            light.image = image.map(|image| placed(image, map));
        }
        Some(self.desc.area_lights.push(light))
    }

    /// A picture as a texture; `None` if it cannot be read.
    fn texture(&mut self, lookup: &Lookup, edit: Option<Edit>) -> Option<ImageTextureDesc> {
        let image = self.image(lookup, edit)?;
        let Map { scale, offset, clamps, .. } = *lookup.map;
        Some(ImageTextureDesc {
            mapping: MappingDesc::Uv { scale, delta: offset },
            wrap: if clamps { WrapMode::Clamp } else { WrapMode::Repeat },
            ..ImageTextureDesc::new(image)
        })
    }

    /// A picture, each read once for each edit; `None` if it cannot be read, which is reported.
    fn image(&mut self, lookup: &Lookup, edit: Option<Edit>) -> Option<Handle<ImageDesc>> {
        let path = self.path(lookup);
        let (name, change) = edit.unzip();
        let key = (path.clone(), format!("{} {}", lookup.is_data, name.unwrap_or_default()));
        if let Some(known) = self.images.get(&key) {
            return *known;
        }
        let handle = match change {
            None => {
                let encoding = lookup.is_data.then_some(EncodingDesc::Linear);
                match assets::decode_image(self.assets, &path, encoding) {
                    Ok(image) => Some(Arc::new(image)),
                    Err(message) => {
                        let message = format!("cannot read the image `{}`: {message}", path.display());
                        self.log.warn("unreadable-image", "", message);
                        None
                    }
                }
            }
            Some(change) => {
                let original = self.image(lookup, None)?;
                let image = self.desc.images[original].image.clone();
                let value = |x, y| {
                    let rgb = image.rgb(x, y);
                    let channel = match lookup.map.channel {
                        None => return change(rgb),
                        Some(Channel::Red) => rgb[0],
                        Some(Channel::Green) => rgb[1],
                        Some(Channel::Blue) => rgb[2],
                        Some(Channel::Alpha) => image.alpha_index().map_or(1.0, |a| image.channel(x, y, a)),
                        Some(Channel::Mean) => rgb.iter().sum::<f32>() / 3.0,
                    };
                    change([channel; 3])
                };
                Some(Arc::new(Image::from_fn(image.width(), image.height(), ["R", "G", "B"], value).to_f16()))
            }
        };
        let name = lookup.map.file.clone();
        let handle = handle.map(|image| self.desc.images.push(ImageDesc { name, image }));
        self.images.insert(key, handle);
        handle
    }

    /// Where a picture is: beside the library or the mesh, with or without the folders of its name.
    fn path(&self, lookup: &Lookup) -> PathBuf {
        let file = &lookup.map.file;
        let beside = |name: &str| {
            resolve(self.assets, name, &lookup.library.to_string_lossy(), &self.file.to_string_lossy())
        };
        let path = beside(file);
        let alone = file.rsplit('/').next().map(beside);
        match alone {
            Some(alone) if !self.assets.exists(&path) && self.assets.exists(&alone) => alone,
            _ => path,
        }
    }
}

/// A change of colours, with a name that tells it from others.
type Edit<'e> = (String, &'e dyn Fn([f32; 3]) -> [f32; 3]);

/// α of a microfacet distribution as wide as a lobe of a Phong exponent, which is 2/α² − 2.
fn phong_alpha(exponent: f32) -> f32 {
    (2.0 / (exponent.max(0.0) + 2.0)).sqrt()
}

/// A picture over the texture coordinates of a mesh, as the options of its statement say.
fn placed(image: Handle<ImageDesc>, &Map { scale, offset, clamps, .. }: &Map) -> UvImageDesc {
    let columns = [[scale[0], 0.0], [0.0, scale[1]], offset];
    UvImageDesc {
        columns,
        ..UvImageDesc::new(image, if clamps { WrapMode::Clamp } else { WrapMode::Repeat })
    }
}

/// A surface of a material alone.
pub(super) fn plain(material: Handle<MaterialDesc>) -> Surface {
    Surface {
        material,
        area_light: None,
        alpha: None,
        media: None,
        coordinates: Coordinates { set: 0, transform: math::DAffine2::IDENTITY },
        tangent_rotation: 0.0,
        single_sided: false,
    }
}

fn is_colored(image: &Image) -> bool {
    let is_grey = |x, y| {
        let [r, g, b] = image.rgb(x, y);
        (r - g).abs() < 0.02 && (g - b).abs() < 0.02
    };
    (0..image.height()).any(|y| (0..image.width()).any(|x| !is_grey(x, y)))
}
