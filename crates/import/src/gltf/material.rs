//! Materials as the file has them, with their extensions.

use super::document::Document;
use super::json::{Place, Result};
use super::pictures::Encoding;
use super::texture::TextureRef;

/// What opacity means.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum AlphaMode {
    /// Nothing.
    Opaque,
    /// What is less opaque than this is cut out.
    Mask(f32),
    /// It is opacity.
    Blend,
}

/// A number, and an image of factors on it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Number {
    pub factor: f32,
    pub texture: Option<TextureRef>,
}

/// A linear colour, and an image of factors on it.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Color {
    pub factor: [f32; 3],
    pub texture: Option<TextureRef>,
}

/// A clear coat.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Clearcoat {
    /// Its weight, of which the texture is red.
    pub weight: Number,
    /// Its roughness, of which the texture is green.
    pub roughness: Number,
    /// The normal map of the coat and its scale.
    pub normals: Option<(TextureRef, f32)>,
}

/// A medium inside.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Volume {
    /// Whether the surface bounds a body.
    pub is_thick: bool,
    /// What is left of white light after the distance.
    pub color: [f32; 3],
    /// In units of the world.
    pub distance: f32,
}

/// A thin film.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Iridescence {
    /// Its weight, of which the texture is red.
    pub weight: Number,
    pub ior: f32,
    /// In nanometres, where the texture is 0 and 1.
    pub thickness: [f32; 2],
    /// Its green.
    pub thickness_texture: Option<TextureRef>,
}

/// Stretched highlights.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Anisotropy {
    pub strength: f32,
    /// Counter-clockwise from the tangent.
    pub rotation: f32,
    /// Red and green are a direction, blue factors on the strength.
    pub texture: Option<TextureRef>,
}

/// A surface by its diffuse and specular colours.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct SpecularGlossiness {
    pub specular: [f32; 3],
    pub glossiness: f32,
    /// Specular colours, and glossiness as opacity.
    pub texture: Option<TextureRef>,
}

/// A material.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Material {
    pub pointer: String,
    pub name: String,
    pub base: Color,
    /// Opacity, of which the base colour's texture has factors.
    pub opacity: f32,
    pub alpha_mode: AlphaMode,
    pub is_two_sided: bool,
    pub is_unlit: bool,
    /// Of which the texture is blue.
    pub metallic: f32,
    /// Of which the texture is green.
    pub roughness: f32,
    pub metallic_roughness: Option<TextureRef>,
    pub normals: Option<(TextureRef, f32)>,
    /// In cd/m².
    pub emissive: Color,
    pub ior: f32,
    pub dispersion: f32,
    /// Of which the texture is opacity.
    pub specular: Number,
    pub specular_color: Color,
    /// Of which the texture is red.
    pub transmission: Number,
    pub volume: Option<Volume>,
    pub clearcoat: Option<Clearcoat>,
    pub sheen: Color,
    /// Of which the texture is opacity.
    pub sheen_roughness: Number,
    pub iridescence: Option<Iridescence>,
    pub anisotropy: Option<Anisotropy>,
    /// The share of light that passes diffusely, of which the texture is opacity, and its colour.
    pub diffuse_transmission: Option<(Number, Color)>,
    pub specular_glossiness: Option<SpecularGlossiness>,
}

const SHARE: [f64; 2] = [0.0, 1.0];
const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];

/// Reads parts of materials.
struct Reader<'d, 'a> {
    document: &'d Document<'a>,
}

impl Reader<'_, '_> {
    fn texture(&self, place: &Place, key: &str) -> Result<Option<TextureRef>> {
        TextureRef::parse(self.document, place, key)
    }

    fn number(&self, place: &Place, [factor, texture]: [&str; 2], default: f64) -> Result<Number> {
        Ok(Number {
            factor: place.number_in(factor, default, SHARE)?,
            texture: self.texture(place, texture)?,
        })
    }

    /// A normal map and its scale.
    fn normals(&self, place: &Place, key: &str) -> Result<Option<(TextureRef, f32)>> {
        let (Some(texture), Some(info)) = (self.texture(place, key)?, place.get(key)) else {
            return Ok(None);
        };
        Ok(Some((texture, info.number("scale")?.unwrap_or(1.0) as f32)))
    }

    fn color(&self, place: &Place, [factor, texture]: [&str; 2], default: f32, most: f64) -> Result<Color> {
        Ok(Color { factor: place.color(factor, [default; 3], most)?, texture: self.texture(place, texture)? })
    }
}

impl Material {
    /// The material of surfaces that have none: white, rough metal.
    pub fn unnamed(document: &Document) -> Self {
        Self::parse(document, &Place::empty("")).expect("invariant: an empty object has no faults")
    }

    /// Reads a material.
    pub fn parse(document: &Document, place: &Place) -> Result<Self> {
        let reader = Reader { document };
        let empty = || Place::empty(&place.pointer);
        let pbr = place.object("pbrMetallicRoughness")?.unwrap_or_else(empty);
        let [r, g, b, mut opacity] = pbr.color("baseColorFactor", [1.0; 4], 1.0)?;
        let mut base = Color { factor: [r, g, b], texture: reader.texture(&pbr, "baseColorTexture")? };
        let alpha_mode = match place.string("alphaMode")? {
            None | Some("OPAQUE") => AlphaMode::Opaque,
            Some("MASK") => AlphaMode::Mask(place.number_in("alphaCutoff", 0.5, POSITIVE)?),
            Some("BLEND") => AlphaMode::Blend,
            Some(mode) => return Err(place.invalid_member("alphaMode", format!("`{mode}` is not a mode"))),
        };
        let normals = reader.normals(place, "normalTexture")?;
        // Its light is traced, but a damaged reference is reported.
        reader.texture(place, "occlusionTexture")?;
        let mut emissive = reader.color(place, ["emissiveFactor", "emissiveTexture"], 0.0, 1.0)?;
        if let Some(extension) = place.extension("KHR_materials_emissive_strength")? {
            let strength = extension.number_in("emissiveStrength", 1.0, POSITIVE)?;
            emissive.factor = emissive.factor.map(|v| v * strength);
        }
        let or_empty = |name: &str| Ok(place.extension(name)?.unwrap_or_else(empty));
        let ior = or_empty("KHR_materials_ior")?;
        let ior = match ior.number("ior")? {
            Some(0.0) => 0.0,
            _ => ior.number_in("ior", 1.5, [1.0, f64::INFINITY])?,
        };
        let dispersion = or_empty("KHR_materials_dispersion")?.number_in("dispersion", 0.0, POSITIVE)?;
        let specular = or_empty("KHR_materials_specular")?;
        let sheen = or_empty("KHR_materials_sheen")?;
        let transmission = or_empty("KHR_materials_transmission")?;
        let specular_glossiness = match place.extension("KHR_materials_pbrSpecularGlossiness")? {
            Some(extension) => {
                let [r, g, b, a] = extension.color("diffuseFactor", [1.0; 4], 1.0)?;
                base = Color { factor: [r, g, b], texture: reader.texture(&extension, "diffuseTexture")? };
                opacity = a;
                Some(SpecularGlossiness {
                    specular: extension.color("specularFactor", [1.0; 3], 1.0)?,
                    glossiness: extension.number_in("glossinessFactor", 1.0, SHARE)?,
                    texture: reader.texture(&extension, "specularGlossinessTexture")?,
                })
            }
            None => None,
        };
        let diffuse_transmission = match place.extension("KHR_materials_diffuse_transmission")? {
            Some(extension) => Some((
                reader.number(
                    &extension,
                    ["diffuseTransmissionFactor", "diffuseTransmissionTexture"],
                    0.0,
                )?,
                reader.color(
                    &extension,
                    ["diffuseTransmissionColorFactor", "diffuseTransmissionColorTexture"],
                    1.0,
                    1.0,
                )?,
            )),
            None => None,
        };
        Ok(Self {
            pointer: place.pointer.clone(),
            name: place.string("name")?.unwrap_or("").to_owned(),
            base,
            opacity,
            alpha_mode,
            is_two_sided: place.boolean("doubleSided", false)?,
            is_unlit: place.extension("KHR_materials_unlit")?.is_some(),
            metallic: pbr.number_in("metallicFactor", 1.0, SHARE)?,
            roughness: pbr.number_in("roughnessFactor", 1.0, SHARE)?,
            metallic_roughness: reader.texture(&pbr, "metallicRoughnessTexture")?,
            normals,
            emissive,
            ior,
            dispersion,
            specular: reader.number(&specular, ["specularFactor", "specularTexture"], 1.0)?,
            specular_color: reader.color(
                &specular,
                ["specularColorFactor", "specularColorTexture"],
                1.0,
                f64::INFINITY,
            )?,
            transmission: reader.number(&transmission, ["transmissionFactor", "transmissionTexture"], 0.0)?,
            volume: volume(&reader, place)?,
            clearcoat: clearcoat(&reader, place)?,
            sheen: reader.color(&sheen, ["sheenColorFactor", "sheenColorTexture"], 0.0, 1.0)?,
            sheen_roughness: reader.number(&sheen, ["sheenRoughnessFactor", "sheenRoughnessTexture"], 0.0)?,
            iridescence: iridescence(&reader, place)?,
            anisotropy: anisotropy(&reader, place)?,
            diffuse_transmission,
            specular_glossiness,
        })
    }

    /// Whether its base or its coat has a normal map.
    pub fn has_normal_map(&self) -> bool {
        self.normals.is_some() || self.coat_normals().is_some()
    }

    /// The normal map of its coat.
    pub fn coat_normals(&self) -> Option<&(TextureRef, f32)> {
        self.clearcoat.as_ref()?.normals.as_ref()
    }

    /// Its textures, with how they are decoded.
    pub fn textures(&self) -> Vec<(&TextureRef, Encoding)> {
        use Encoding::{Color, Data};
        let clearcoat = self.clearcoat.as_ref();
        let iridescence = self.iridescence.as_ref();
        let (diffuse, diffuse_color) = match &self.diffuse_transmission {
            Some((number, color)) => (number.texture.as_ref(), color.texture.as_ref()),
            None => (None, None),
        };
        [
            (self.normals.as_ref().map(|(texture, _)| texture), Data),
            (self.coat_normals().map(|(texture, _)| texture), Data),
            (self.emissive.texture.as_ref(), Color),
            (self.base.texture.as_ref(), Color),
            (self.metallic_roughness.as_ref(), Data),
            (self.specular.texture.as_ref(), Data),
            (self.specular_color.texture.as_ref(), Color),
            (self.transmission.texture.as_ref(), Data),
            (clearcoat.and_then(|coat| coat.weight.texture.as_ref()), Data),
            (clearcoat.and_then(|coat| coat.roughness.texture.as_ref()), Data),
            (self.sheen.texture.as_ref(), Color),
            (self.sheen_roughness.texture.as_ref(), Data),
            (iridescence.and_then(|film| film.weight.texture.as_ref()), Data),
            (iridescence.and_then(|film| film.thickness_texture.as_ref()), Data),
            (self.anisotropy.as_ref().and_then(|anisotropy| anisotropy.texture.as_ref()), Data),
            (diffuse, Data),
            (diffuse_color, Color),
            (self.specular_glossiness.as_ref().and_then(|surface| surface.texture.as_ref()), Color),
        ]
        .into_iter()
        .filter_map(|(texture, encoding)| Some((texture?, encoding)))
        .collect()
    }
}

fn volume(reader: &Reader, place: &Place) -> Result<Option<Volume>> {
    let Some(extension) = place.extension("KHR_materials_volume")? else { return Ok(None) };
    reader.texture(&extension, "thicknessTexture")?;
    let distance = extension.number("attenuationDistance")?.unwrap_or(f64::INFINITY);
    if distance <= 0.0 {
        return Err(extension.invalid_member("attenuationDistance", "this must be above 0"));
    }
    Ok(Some(Volume {
        is_thick: extension.number_in("thicknessFactor", 0.0, POSITIVE)? > 0.0,
        color: extension.color("attenuationColor", [1.0; 3], 1.0)?,
        distance: distance as f32,
    }))
}

fn clearcoat(reader: &Reader, place: &Place) -> Result<Option<Clearcoat>> {
    let Some(extension) = place.extension("KHR_materials_clearcoat")? else { return Ok(None) };
    Ok(Some(Clearcoat {
        weight: reader.number(&extension, ["clearcoatFactor", "clearcoatTexture"], 0.0)?,
        roughness: reader.number(
            &extension,
            ["clearcoatRoughnessFactor", "clearcoatRoughnessTexture"],
            0.0,
        )?,
        normals: reader.normals(&extension, "clearcoatNormalTexture")?,
    }))
}

fn iridescence(reader: &Reader, place: &Place) -> Result<Option<Iridescence>> {
    let Some(extension) = place.extension("KHR_materials_iridescence")? else { return Ok(None) };
    Ok(Some(Iridescence {
        weight: reader.number(&extension, ["iridescenceFactor", "iridescenceTexture"], 0.0)?,
        ior: extension.number_in("iridescenceIor", 1.3, [1.0, f64::INFINITY])?,
        thickness: [
            extension.number_in("iridescenceThicknessMinimum", 100.0, POSITIVE)?,
            extension.number_in("iridescenceThicknessMaximum", 400.0, POSITIVE)?,
        ],
        thickness_texture: reader.texture(&extension, "iridescenceThicknessTexture")?,
    }))
}

fn anisotropy(reader: &Reader, place: &Place) -> Result<Option<Anisotropy>> {
    let Some(extension) = place.extension("KHR_materials_anisotropy")? else { return Ok(None) };
    Ok(Some(Anisotropy {
        strength: extension.number_in("anisotropyStrength", 0.0, SHARE)?,
        rotation: extension.number("anisotropyRotation")?.unwrap_or(0.0) as f32,
        texture: reader.texture(&extension, "anisotropyTexture")?,
    }))
}
