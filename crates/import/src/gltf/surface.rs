//! Materials of the file as principled surfaces of a scene: OpenPBR, with opacity, emission and the
//! medium inside. `docs/formats/gltf.md` has the table of what becomes what.

use std::collections::BTreeMap;

use description::{
    AreaLightDesc, CoefficientsDesc, FloatParameter, Handle, ImageChannel, ImageDesc, ImageTextureDesc,
    MappingDesc, MaterialDesc, MaterialKind, MediumDesc, MediumInterface, MediumKind, SceneDesc,
    SpectrumDesc, SpectrumParameter, TextureDesc, TextureFilter, TextureKind, TransformDesc, UvImageDesc,
    WrapMode,
};
use math::{DAffine2, DVec2};
use spectrum::{LAMBDA_MAX, LAMBDA_MIN, RgbAlbedoSpectrum, RgbColorSpace};

use super::material::{AlphaMode, Color, Material, Number};
use super::pictures::{Edit, Encoding, Pictures, stretched};
use super::texture::TextureRef;
use crate::log::Log;
use crate::primitives::{Coordinates, Principled, Surface};

/// The texture coordinates of a file that the meshes of a material have: those of normal maps,
/// whose directions they are, or of emission. Other textures have mappings from there.
pub(super) fn coordinates(material: &Material) -> Coordinates {
    let normals = material.normals.as_ref().or(material.coat_normals()).map(|(texture, _)| texture);
    let emission = if material.is_unlit { &material.base } else { &material.emissive };
    let placed = normals.or(emission.texture.as_ref()).filter(|texture| is_regular(texture));
    if let Some(texture) = placed {
        return Coordinates { set: texture.set, transform: texture.transform };
    }
    let set = material.base.texture.as_ref().or(material.textures().first().map(|&(texture, _)| texture));
    Coordinates { set: set.map_or(0, |texture| texture.set), transform: DAffine2::IDENTITY }
}

fn is_regular(texture: &TextureRef) -> bool {
    texture.transform.inverse().is_finite()
}

/// Images of colours of vertices, to which meshes are mapped.
#[derive(Clone, Copy, Debug)]
pub(super) struct Painted {
    /// In place of the base colour.
    pub color: Handle<ImageDesc>,
    /// In place of opacity.
    pub opacity: Option<Handle<ImageDesc>>,
}

/// Makes surfaces of materials.
pub(super) struct Builder<'a> {
    pub desc: &'a mut SceneDesc,
    pub pictures: &'a mut Pictures,
    pub log: &'a mut Log,
    /// From the texture coordinates of meshes to those of other sets; v is up in both.
    pub maps: &'a BTreeMap<usize, DAffine2>,
}

impl Builder<'_> {
    /// The surface of a material, and that where texture coordinates are mirrored, which is the
    /// same unless it has a normal map.
    pub fn both(&mut self, material: &Material, colors: Option<Painted>) -> [Surface; 2] {
        let surface = self.surface(material, false, colors);
        let mirrored = match material.has_normal_map() {
            true => Surface { area_light: surface.area_light, ..self.surface(material, true, colors) },
            false => surface.clone(),
        };
        [surface, mirrored]
    }

    /// A surface. Where texture coordinates are mirrored, so is green of normal maps.
    fn surface(&mut self, material: &Material, is_mirrored: bool, colors: Option<Painted>) -> Surface {
        let coordinates = coordinates(material);
        let mut part = Part { builder: self, material, coordinates, colors };
        let alpha = part.alpha();
        // A surface that is cut out everywhere is not seen, and shines no light.
        let is_seen = alpha.as_ref().and_then(FloatParameter::value).is_none_or(|&alpha| alpha > 0.0);
        let area_light = if is_seen { part.area_light() } else { None };
        let (kind, tangent_rotation) = part.kind(is_mirrored);
        let media = part.media();
        let normal_map = part.normal_map(material.normals.as_ref(), is_mirrored);
        let mut placed = MaterialDesc { name: material.name.clone(), normal_map, ..MaterialDesc::from(kind) };
        if let Some((share, color)) = &material.diffuse_transmission
            && share.factor > 0.0
        {
            let amount = part.number(share, ImageChannel::Alpha);
            let transmittance = part.color(color, [1.0; 3]);
            let through =
                MaterialKind::DiffuseTransmission { reflectance: 0.0.into(), transmittance, scale: 1.0 };
            let through = MaterialDesc { normal_map, ..MaterialDesc::from(through) };
            let materials = [self.desc.materials.push(placed), self.desc.materials.push(through)];
            placed = MaterialDesc::from(MaterialKind::Mix { materials, amount });
            placed.name.clone_from(&material.name);
        }
        let (single_sided, material) = (!material.is_two_sided, self.desc.materials.push(placed));
        Surface { material, area_light, alpha, media, single_sided, coordinates, tangent_rotation }
    }
}

/// The parts of one surface.
struct Part<'b, 'a, 'm> {
    builder: &'b mut Builder<'a>,
    material: &'m Material,
    coordinates: Coordinates,
    colors: Option<Painted>,
}

impl Part<'_, '_, '_> {
    fn warn(&mut self, pointer: &str, message: impl Into<String>) {
        self.builder.log.warn("not-drawn", pointer, message);
    }

    /// The coordinates of a texture, by the set that meshes have.
    fn placed(&self, texture: &TextureRef) -> Coordinates {
        let set = self.coordinates.set;
        let map = self.builder.maps.get(&texture.set).filter(|_| texture.set != set);
        Coordinates { set, transform: map.map_or(texture.transform, |map| texture.transform * *map) }
    }

    /// From the coordinates of meshes to those of a texture.
    fn texture_from_mesh(&self, texture: &TextureRef) -> DAffine2 {
        let placed = self.placed(texture);
        match placed == self.coordinates {
            true => DAffine2::IDENTITY,
            false => placed.transform * self.coordinates.transform.inverse(),
        }
    }

    /// An image over (u, v); `None` if it cannot be decoded.
    fn uv_image(&mut self, texture: &TextureRef, encoding: Encoding, edit: Edit) -> Option<UvImageDesc> {
        let image = self.builder.pictures.add(texture, encoding, edit, &mut self.builder.desc.images)?;
        let columns =
            self.texture_from_mesh(texture).to_cols_array_2d().map(|column| column.map(|v| v as f32));
        let is_nearest = texture.filter == TextureFilter::Point;
        Some(UvImageDesc { image, columns, wrap: texture.wrap, is_nearest })
    }

    /// An image as a texture; `None` if it cannot be decoded.
    fn image(&mut self, texture: &TextureRef, encoding: Encoding, edit: Edit) -> Option<ImageTextureDesc> {
        let image = self.builder.pictures.add(texture, encoding, edit, &mut self.builder.desc.images)?;
        let from_mesh = self.texture_from_mesh(texture);
        let [x, y, delta] = [from_mesh.matrix2.x_axis, from_mesh.matrix2.y_axis, from_mesh.translation];
        let mapping = if x.y == 0.0 && y.x == 0.0 {
            MappingDesc::Uv { scale: [x.x as f32, y.y as f32], delta: delta.as_vec2().to_array() }
        } else {
            MappingDesc::Affine { columns: [x, y, delta].map(|v| v.as_vec2().to_array()) }
        };
        let desc = ImageTextureDesc::new(image);
        Some(ImageTextureDesc { mapping, filter: texture.filter, wrap: texture.wrap, ..desc })
    }

    /// A texture of numbers of a channel times a factor.
    fn channel(
        &mut self,
        texture: &TextureRef,
        encoding: Encoding,
        edit: Edit,
        channel: ImageChannel,
        factor: f32,
    ) -> Option<ImageTextureDesc> {
        let image = self.builder.pictures.image(texture, encoding)?;
        if channel == ImageChannel::Alpha && image.alpha_index().is_none() {
            return None;
        }
        let desc = self.image(texture, encoding, edit)?;
        Some(ImageTextureDesc { channel: Some(channel), scale: factor, ..desc })
    }

    fn float(&mut self, image: Option<ImageTextureDesc>, otherwise: f32) -> FloatParameter {
        match image {
            Some(image) => {
                self.builder.desc.float_textures.push(TextureDesc::new(TextureKind::Image(image))).into()
            }
            None => otherwise.into(),
        }
    }

    fn number(&mut self, number: &Number, channel: ImageChannel) -> FloatParameter {
        let image = number.texture.as_ref().filter(|_| number.factor > 0.0);
        let image = image
            .and_then(|texture| self.channel(texture, Encoding::Data, Edit::None, channel, number.factor));
        self.float(image, number.factor)
    }

    /// A colour that is divided by `unit`.
    fn color(&mut self, color: &Color, unit: [f32; 3]) -> SpectrumParameter {
        let factor: [f32; 3] = std::array::from_fn(|c| color.factor[c] / unit[c]);
        let [r, g, b] = factor;
        let texture = color.texture.as_ref().filter(|_| factor != [0.0; 3]);
        let is_grey = r == g && g == b;
        let edit = if is_grey { Edit::None } else { Edit::Tint(factor) };
        match texture.and_then(|texture| self.image(texture, Encoding::Color, edit)) {
            Some(image) => self.spectrum(ImageTextureDesc { scale: if is_grey { r } else { 1.0 }, ..image }),
            None => SpectrumDesc::rgb(r, g, b).into(),
        }
    }

    fn base(&mut self) -> SpectrumParameter {
        match self.colors {
            Some(painted) => self.spectrum(ImageTextureDesc::new(painted.color)),
            None => self.color(&self.material.base, [1.0; 3]),
        }
    }

    fn spectrum(&mut self, image: ImageTextureDesc) -> SpectrumParameter {
        self.builder.desc.spectrum_textures.push(TextureDesc::new(TextureKind::Image(image))).into()
    }

    fn alpha(&mut self) -> Option<FloatParameter> {
        let material = self.material;
        if material.alpha_mode == AlphaMode::Opaque {
            return None;
        }
        let painted = self.colors.and_then(|painted| painted.opacity);
        let image = match painted {
            Some(image) => {
                Some(ImageTextureDesc { channel: Some(ImageChannel::Red), ..ImageTextureDesc::new(image) })
            }
            None => material.base.texture.as_ref().and_then(|texture| {
                self.channel(texture, Encoding::Color, Edit::None, ImageChannel::Alpha, material.opacity)
            }),
        };
        let opacity = self.float(image, material.opacity);
        Some(match (material.alpha_mode, opacity) {
            (AlphaMode::Mask(cutoff), FloatParameter::Value(opacity)) => {
                FloatParameter::Value(if opacity >= cutoff { 1.0 } else { 0.0 })
            }
            (AlphaMode::Mask(edge), texture) => {
                let step = TextureKind::Step { texture, edge };
                self.builder.desc.float_textures.push(TextureDesc::new(step)).into()
            }
            (_, opacity) => opacity,
        })
    }

    fn normal_map(&mut self, normals: Option<&(TextureRef, f32)>, is_mirrored: bool) -> Option<UvImageDesc> {
        let (texture, scale) = normals?;
        let [x, y] = [DVec2::X, DVec2::Y].map(|axis| self.texture_from_mesh(texture).transform_vector2(axis));
        if !(x.x > 0.0 && y.y > 0.0 && x.y == 0.0 && y.x == 0.0) {
            let message = "a normal map that is turned against another one bends surfaces in its directions";
            self.warn(&texture.pointer, message);
        }
        let is_color = self.builder.pictures.image(texture, Encoding::Data)?.is_color();
        let edit = match (*scale, is_mirrored) {
            (1.0, false) if is_color => Edit::None,
            (scale, is_mirrored) => Edit::Normals([scale, if is_mirrored { -scale } else { scale }]),
        };
        self.uv_image(texture, Encoding::Data, edit)
    }

    /// What the surface emits, in cd/m²; an unlit one emits its colour.
    fn area_light(&mut self) -> Option<Handle<AreaLightDesc>> {
        let material = self.material;
        let color = if material.is_unlit { &material.base } else { &material.emissive };
        let group = (!material.name.is_empty()).then(|| material.name.clone());
        if let Some(painted) = self.colors.filter(|_| material.is_unlit) {
            let mut light = AreaLightDesc::new(SpectrumDesc::rgb(1.0, 1.0, 1.0));
            light.image = Some(UvImageDesc::new(painted.color, WrapMode::Clamp));
            (light.two_sided, light.group) = (material.is_two_sided, group);
            return Some(self.builder.desc.area_lights.push(light));
        }
        let scale = color.factor.into_iter().fold(0.0, f32::max);
        if scale <= 0.0 {
            return None;
        }
        let tint = color.factor.map(|v| v / scale);
        let mut light = AreaLightDesc::new(SpectrumDesc::rgb(tint[0], tint[1], tint[2]));
        (light.scale, light.two_sided, light.group) = (scale, material.is_two_sided, group);
        if let Some(texture) = &color.texture {
            let image = self.builder.pictures.image(texture, Encoding::Color)?;
            let edit = if tint == [1.0; 3] && image.is_color() { Edit::None } else { Edit::Tint(tint) };
            light.image = self.uv_image(texture, Encoding::Color, edit);
        }
        Some(self.builder.desc.area_lights.push(light))
    }

    /// Whether light passes, and whether it passes through a body.
    fn is_transparent(&self) -> bool {
        self.material.transmission.factor > 0.0
    }

    fn is_thick(&self) -> bool {
        self.material.volume.as_ref().is_some_and(|volume| volume.is_thick)
    }

    fn media(&mut self) -> Option<MediumInterface> {
        let material = self.material;
        let volume = material.volume.as_ref().filter(|_| self.is_thick() && self.is_transparent())?;
        if volume.color == [1.0; 3] || volume.distance.is_infinite() {
            return None;
        }
        // What is left after the distance d is exp(−σ d), the spectrum of the colour.
        let left = RgbAlbedoSpectrum::new(RgbColorSpace::srgb(), volume.color);
        let (first, last) = (LAMBDA_MIN as u16, LAMBDA_MAX as u16);
        let sigma_a = (first..=last).step_by(5).map(f32::from).map(|lambda| {
            let left: f32 = left.at(lambda);
            (lambda, -libm::logf(left.max(1e-4)) / volume.distance)
        });
        let sigma_a = SpectrumDesc::Samples(sigma_a.collect());
        let coefficients = CoefficientsDesc::Given { sigma_a, sigma_s: 0.0.into(), scale: 1.0 };
        let medium = MediumDesc {
            name: material.name.clone(),
            kind: MediumKind::Homogeneous { coefficients, le: None, le_scale: 1.0 },
            world_from_medium: TransformDesc::default(),
            g: 0.0,
        };
        let inside = Some(self.builder.desc.media.push(medium));
        Some(MediumInterface { inside, outside: None })
    }

    /// The material without what shapes have, and the rotation of its tangents.
    fn kind(&mut self, is_mirrored: bool) -> (MaterialKind, f32) {
        let material = self.material;
        if material.is_unlit {
            return (MaterialKind::Diffuse { reflectance: 0.0.into() }, 0.0);
        }
        let mut surface = Principled::default();
        let base = self.base();
        surface.color("base_color", base);
        surface.number("specular_ior", self.ior(material.ior));
        let mut rotation = 0.0;
        match &material.specular_glossiness {
            Some(_) => self.specular_glossiness(&mut surface),
            None => {
                rotation = self.metallic_roughness(&mut surface);
                self.specular(&mut surface);
            }
        }
        self.clearcoat(&mut surface, is_mirrored);
        self.sheen(&mut surface);
        self.iridescence(&mut surface);
        self.transmission(&mut surface);
        (MaterialKind::OpenPbr(surface.desc), rotation)
    }

    fn ior(&mut self, ior: f32) -> FloatParameter {
        // 0 stands for a surface that reflects all light; 3 reflects a quarter.
        let known = if ior == 0.0 { 3.0 } else { ior.clamp(1.0, 3.0) };
        if known != ior {
            let pointer = self.material.pointer.clone();
            self.warn(&pointer, format!("the index of refraction {ior} is drawn as {known}"));
        }
        known.into()
    }

    /// Roughness and metalness; the rotation of anisotropic highlights.
    fn metallic_roughness(&mut self, surface: &mut Principled) -> f32 {
        use ImageChannel::{Blue, Green};
        let material = self.material;
        let texture = material.metallic_roughness.clone();
        let metalness = self.number(&Number { factor: material.metallic, texture: texture.clone() }, Blue);
        surface.number("base_metalness", metalness);
        let Some(anisotropy) = material.anisotropy.as_ref().filter(|anisotropy| anisotropy.strength > 0.0)
        else {
            let roughness = self.number(&Number { factor: material.roughness, texture }, Green);
            surface.number("specular_roughness", roughness);
            return 0.0;
        };
        let (strength, roughness) = (anisotropy.strength, material.roughness);
        let constant = stretched(strength, roughness);
        for (result, name) in ["specular_roughness", "specular_roughness_anisotropy"].into_iter().enumerate()
        {
            // Where both vary, roughness follows its own image, anisotropy that of the strength.
            let (texture, edit) = match (&texture, &anisotropy.texture) {
                (Some(texture), None) => (Some(texture), Edit::ByRoughness(result, roughness, strength)),
                (Some(texture), Some(_)) if result == 0 => {
                    (Some(texture), Edit::ByRoughness(result, roughness, strength))
                }
                (_, Some(texture)) => (Some(texture), Edit::ByStrength(result, strength, roughness)),
                (None, None) => (None, Edit::None),
            };
            let image = texture
                .and_then(|texture| self.channel(texture, Encoding::Data, edit, ImageChannel::Red, 1.0));
            let number = self.float(image, constant[result]);
            surface.number(name, number);
        }
        let direction = anisotropy.texture.as_ref().map_or(Some(0.0), |texture| self.direction(texture));
        if direction.is_none() {
            let pointer = anisotropy.texture.as_ref().map_or("", |texture| &texture.pointer).to_owned();
            self.warn(&pointer, "directions of anisotropy that vary over a surface are drawn as one");
        }
        let rotation = anisotropy.rotation + direction.unwrap_or(0.0);
        if rotation.abs() > 1e-3 && material.has_normal_map() {
            self.warn(&material.pointer, "anisotropy is not rotated on surfaces with a normal map");
            return 0.0;
        }
        rotation
    }

    /// The angle of the directions of an image, if they are all about the same.
    fn direction(&self, texture: &TextureRef) -> Option<f32> {
        let image = self.builder.pictures.image(texture, Encoding::Data)?;
        let (mut sum, count) = ([0.0; 2], f64::from(image.width()) * f64::from(image.height()));
        for (x, y) in (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y))) {
            let [r, g, _] = image.rgb(x, y);
            let (dx, dy) = (f64::from(2.0 * r - 1.0), f64::from(2.0 * g - 1.0));
            let length = libm::hypot(dx, dy).max(1e-6);
            sum = [sum[0] + dx / length, sum[1] + dy / length];
        }
        (libm::hypot(sum[0], sum[1]) > 0.99 * count).then(|| libm::atan2(sum[1], sum[0]) as f32)
    }

    fn specular(&mut self, surface: &mut Principled) {
        let material = self.material;
        let (weight, color) = (&material.specular, &material.specular_color);
        let most = color.factor.into_iter().fold(1.0, f32::max);
        let weight = Number { factor: weight.factor * most, texture: weight.texture.clone() };
        // Both are of the dielectric part only; a whole metal has neither.
        if material.metallic < 1.0 || material.metallic_roughness.is_some() {
            let number = self.number(&weight, ImageChannel::Alpha);
            surface.number("specular_weight", number);
            let color = self.color(color, [most; 3]);
            surface.color("specular_color", color);
        }
    }

    fn specular_glossiness(&mut self, surface: &mut Principled) {
        let Some(described) = self.material.specular_glossiness.clone() else { return };
        /// Reflectance of an index of 1.5.
        const UNIT: f32 = 0.04;
        surface.number("base_metalness", 0.0.into());
        let most = described.specular.into_iter().fold(0.0, f32::max);
        let [r, g, b] = described.specular.map(|v| if most > 0.0 { v / most } else { 1.0 });
        let rough = 1.0 - described.glossiness;
        let Some(texture) = described.texture.as_ref() else {
            surface.number("specular_weight", (most / UNIT).into());
            surface.color("specular_color", SpectrumDesc::rgb(r, g, b).into());
            surface.number("specular_roughness", rough.into());
            return;
        };
        let tint = described.specular;
        let weight =
            self.channel(texture, Encoding::Color, Edit::Largest(tint), ImageChannel::Red, 1.0 / UNIT);
        let weight = self.float(weight, most / UNIT);
        surface.number("specular_weight", weight);
        let color = match self.image(texture, Encoding::Color, Edit::Hue(tint)) {
            Some(image) => self.spectrum(image),
            None => SpectrumDesc::rgb(r, g, b).into(),
        };
        surface.color("specular_color", color);
        let (channel, glossiness) = (ImageChannel::Alpha, described.glossiness);
        let image = self.channel(texture, Encoding::Color, Edit::None, channel, glossiness);
        let image = image.map(|image| ImageTextureDesc { invert: true, ..image });
        let roughness = self.float(image, rough);
        surface.number("specular_roughness", roughness);
    }

    fn clearcoat(&mut self, surface: &mut Principled, is_mirrored: bool) {
        let Some(coat) = self.material.clearcoat.clone().filter(|coat| coat.weight.factor > 0.0) else {
            return;
        };
        let weight = self.number(&coat.weight, ImageChannel::Red);
        let roughness = self.number(&coat.roughness, ImageChannel::Green);
        surface.number("coat_weight", weight);
        surface.number("coat_roughness", roughness);
        surface.number("coat_ior", 1.5.into());
        // The extension's coat does not darken what is under it.
        surface.number("coat_darkening", 0.0.into());
        surface.desc.geometry_coat_normal = self.normal_map(coat.normals.as_ref(), is_mirrored);
    }

    fn sheen(&mut self, surface: &mut Principled) {
        let sheen = &self.material.sheen;
        let most = sheen.factor.into_iter().fold(0.0, f32::max);
        if most <= 0.0 {
            return;
        }
        let (weight, color) = match &sheen.texture {
            Some(texture) => {
                let largest = Edit::Largest(sheen.factor);
                let weight = self.channel(texture, Encoding::Color, largest, ImageChannel::Red, 1.0);
                (weight, self.image(texture, Encoding::Color, Edit::Hue(sheen.factor)))
            }
            None => (None, None),
        };
        let weight = self.float(weight, most);
        surface.number("fuzz_weight", weight);
        let [r, g, b] = sheen.factor.map(|v| v / most);
        let color = color.map_or(SpectrumDesc::rgb(r, g, b).into(), |image| self.spectrum(image));
        surface.color("fuzz_color", color);
        let roughness = self.number(&self.material.sheen_roughness, ImageChannel::Alpha);
        surface.number("fuzz_roughness", roughness);
    }

    fn iridescence(&mut self, surface: &mut Principled) {
        let Some(film) = self.material.iridescence.as_ref().filter(|film| film.weight.factor > 0.0) else {
            return;
        };
        let weight = self.number(&film.weight, ImageChannel::Red);
        surface.number("thin_film_weight", weight);
        let ior = self.ior(film.ior);
        surface.number("thin_film_ior", ior);
        // Nanometres in the file, micrometres here.
        let [thinnest, thickest] = film.thickness.map(|thickness| thickness / 1000.0);
        let image = film.thickness_texture.as_ref();
        let image = image
            .and_then(|texture| self.channel(texture, Encoding::Data, Edit::None, ImageChannel::Green, 1.0));
        let thickness = match image {
            Some(image) => {
                let amount = self.float(Some(image), 1.0);
                let mix = TextureKind::Mix { textures: [thinnest.into(), thickest.into()], amount };
                self.builder.desc.float_textures.push(TextureDesc::new(mix)).into()
            }
            None => thickest.into(),
        };
        surface.number("thin_film_thickness", thickness);
    }

    fn transmission(&mut self, surface: &mut Principled) {
        if !self.is_transparent() {
            return;
        }
        let material = self.material;
        let weight = self.number(&material.transmission, ImageChannel::Red);
        surface.number("transmission_weight", weight);
        let tint = self.base();
        surface.color("transmission_color", tint);
        if material.dispersion > 0.0 {
            // An Abbe number of 20/dispersion, as the scale of one of 20 where that is a share.
            surface.number("transmission_dispersion_scale", material.dispersion.min(1.0).into());
            surface.number(
                "transmission_dispersion_abbe_number",
                (20.0 / material.dispersion.max(1.0)).max(1.0).into(),
            );
        }
        surface.desc.thin_walled = !self.is_thick();
    }
}
