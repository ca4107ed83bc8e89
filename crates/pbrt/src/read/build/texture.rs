//! Textures of numbers and of spectra, read by one generic reader.

use description::{
    Arena, EncodingDesc, Handle, SceneDesc, Stated, TextureDesc, TextureKind, TextureType, TextureValue,
    UvImageDesc, UvImageNames, WrapMode,
};

use super::Builder;
use super::reader::Reader;
use crate::read::statement::{Statements, TextureStatement};

impl Builder<'_> {
    /// Builds all textures in the order of the file, so that each can refer to those before it.
    pub(super) fn textures(&mut self, statements: &mut Statements, desc: &mut SceneDesc) {
        let mut floats = statements.float_textures.drain(..);
        let mut spectra = statements.spectrum_textures.drain(..);
        for &is_spectrum in &statements.texture_order {
            if is_spectrum {
                let Some(statement) = spectra.next() else { continue };
                let (name, handle) = self.texture(statement, &mut desc.spectrum_textures);
                self.spectrum_textures.insert(name, handle);
            } else {
                let Some(statement) = floats.next() else { continue };
                let (name, handle) = self.texture(statement, &mut desc.float_textures);
                self.float_textures.insert(name, handle);
            }
        }
    }

    /// Builds a texture. One that has errors becomes the constant 1.
    fn texture<V: TextureValue>(
        &mut self,
        texture: TextureStatement,
        textures: &mut Arena<TextureDesc<V>>,
    ) -> (String, Handle<TextureDesc<V>>) {
        let (kind, origin) = self.read(texture.statement, kind::<V>);
        let kind = kind.unwrap_or_default();
        let name = texture.name.value.clone();
        let desc = TextureDesc { name: name.clone(), kind, world_from_texture: texture.world_from_texture };
        (name, textures.push_stated(Stated::new(desc, origin)))
    }
}

/// The kinds of textures of numbers or of spectra.
pub(super) fn names<V: TextureValue>() -> Vec<&'static str> {
    let is_known = |name: &&&str| TextureType::named(name).is_some_and(V::are_of);
    TextureType::NAMES.iter().filter(is_known).copied().collect()
}

fn kind<V: TextureValue>(reader: &mut Reader) -> Option<TextureKind<V>> {
    let kind = TextureType::named(&reader.kind.value).filter(|kind| V::are_of(*kind));
    let Some(mut kind) = kind.and_then(TextureKind::<V>::new) else {
        reader.unknown_type("texture", "texture", &names::<V>());
        return None;
    };
    reader.settings(&mut kind);
    match &mut kind {
        TextureKind::Bilerp { mapping, .. } | TextureKind::Dots { mapping, .. } => {
            *mapping = reader.part("mapping");
        }
        TextureKind::Checkerboard { mapping, .. } => {
            let squares = reader.part("mapping");
            *mapping = (reader.integer("dimension", 2, 2..=3) == 2).then_some(squares);
        }
        TextureKind::Image(image) => {
            let encoding = encoding(reader);
            image.mapping = reader.part("mapping");
            image.wrap = reader.choice("wrap", WrapMode::Repeat, WrapMode::NAMES);
            if V::NAME == f32::NAME {
                image.channel = reader.named("channel");
            }
            let file = reader.needed("filename", Reader::string)?;
            image.image = reader.builder.image(&file, encoding);
        }
        TextureKind::Ptex { filename, encoding: stored, .. } => {
            let file = reader.needed("filename", Reader::string)?;
            *filename = reader.builder.path(&file).to_string_lossy().into_owned();
            *stored = encoding(reader).unwrap_or(*stored);
        }
        TextureKind::Constant { .. }
        | TextureKind::Scale { .. }
        | TextureKind::Mix { .. }
        | TextureKind::DirectionMix { .. }
        | TextureKind::Fbm { .. }
        | TextureKind::Wrinkled { .. }
        | TextureKind::Windy
        | TextureKind::Step { .. }
        | TextureKind::Marble { .. } => (),
    }
    Some(kind)
}

fn encoding(reader: &mut Reader) -> Option<EncodingDesc> {
    let name = reader.string("encoding")?;
    let mut words = name.value.split_whitespace();
    match (words.next(), words.next(), words.next()) {
        (Some("sRGB"), None, _) => Some(EncodingDesc::Srgb),
        (Some("linear"), None, _) => Some(EncodingDesc::Linear),
        (Some("gamma"), Some(exponent), None)
            if exponent.parse().is_ok_and(|exponent: f32| exponent.is_finite() && exponent > 0.0) =>
        {
            exponent.parse().ok().map(EncodingDesc::Gamma)
        }
        _ => {
            let message = format!(
                "`encoding` cannot be `{}`: it is `sRGB`, `linear` or `gamma` and a number",
                name.value
            );
            reader.builder.report.error("unknown-choice", message, name.span);
            None
        }
    }
}

impl Reader<'_, '_> {
    /// A map of normals.
    pub(super) fn normal_map(&mut self, names: &UvImageNames) -> Option<UvImageDesc> {
        self.uv_image(names, Some(EncodingDesc::Linear), WrapMode::Repeat)
    }

    /// An image over (u, v), with its wrap mode if none is given.
    pub(super) fn uv_image(
        &mut self,
        names: &UvImageNames,
        encoding: Option<EncodingDesc>,
        otherwise: WrapMode,
    ) -> Option<UvImageDesc> {
        let image = self.image(names.file, encoding)?;
        let wrap = self.choice(names.wrap, otherwise, WrapMode::NAMES);
        let is_nearest = self.choice(names.filter, false, &[("bilinear", false), ("point", true)]);
        let columns = self
            .float_array(names.columns)
            .map_or(UvImageDesc::IDENTITY, |[a, b, c, d, e, f]| [[a, b], [c, d], [e, f]]);
        Some(UvImageDesc { image, columns, wrap, is_nearest })
    }
}
