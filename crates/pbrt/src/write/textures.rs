//! Textures of numbers and of spectra.

use std::collections::BTreeSet;

use description::{
    EncodingDesc, ImageTextureDesc, MappingDesc, SceneDesc, TextureDesc, TextureKind, TextureValue,
    UvImageDesc, UvImageNames, WrapMode,
};
use image::{ColorEncoding, Pixels};
use math::DMat4;

use crate::write::files::Files;
use crate::write::names::Names;
use crate::write::number::decimal;
use crate::write::settings::{note_extension, parameters, part};
use crate::write::statement::{Statement, quoted};
use crate::write::text::Text;

/// All textures. Those of spectra may refer to those of numbers, so that they are later.
pub(crate) fn textures(
    desc: &SceneDesc,
    names: &Names,
    files: &mut Files,
    text: &mut Text,
    extensions: &mut BTreeSet<String>,
) {
    let mut context = Context { desc, names, files, extensions };
    for (handle, texture) in desc.float_textures.iter() {
        context.texture(names.float_texture(handle), texture, text);
    }
    for (handle, texture) in desc.spectrum_textures.iter() {
        context.texture(names.spectrum_texture(handle), texture, text);
    }
}

struct Context<'a, 'f> {
    desc: &'a SceneDesc,
    names: &'a Names,
    files: &'a mut Files<'f>,
    extensions: &'a mut BTreeSet<String>,
}

impl Context<'_, '_> {
    fn texture<V: TextureValue>(&mut self, name: &str, texture: &TextureDesc<V>, text: &mut Text) {
        let TextureDesc { name: _, kind, world_from_texture } = texture;
        let mut statement = Statement::new("Texture", name).target("texture");
        statement.head += &format!(" {} {}", quoted(V::NAME), quoted(kind.name()));
        note_extension("texture", kind, self.extensions);
        parameters(&mut statement, kind, self.names);
        self.kind(&mut statement, kind);
        text.block(*world_from_texture != DMat4::IDENTITY, |text| {
            text.matrix(world_from_texture);
            text.statement(statement);
        });
    }

    /// The fields that are not declared as parameters.
    fn kind<V: TextureValue>(&mut self, to: &mut Statement, kind: &TextureKind<V>) {
        match kind {
            TextureKind::Bilerp { mapping, .. } | TextureKind::Dots { mapping, .. } => {
                part(to, "mapping", mapping, self.names);
            }
            TextureKind::Image(image) => self.image(to, image),
            TextureKind::Checkerboard { mapping, .. } => match mapping {
                Some(mapping) => part(to, "mapping", mapping, self.names),
                None => to.integer("dimension", 3, 2),
            },
            TextureKind::Ptex { filename, encoding: stored, .. } => {
                let stored = match stored {
                    EncodingDesc::Linear => ColorEncoding::Linear,
                    EncodingDesc::Srgb => ColorEncoding::Srgb,
                    EncodingDesc::Gamma(exponent) => ColorEncoding::Gamma(*exponent),
                };
                to.text("filename", filename);
                encoding(to, stored, ColorEncoding::Gamma(2.2));
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
    }

    fn image(&mut self, to: &mut Statement, texture: &ImageTextureDesc) {
        let image = &self.desc.images[texture.image].image;
        // Codes keep their encoding, which the statement tells.
        let stored = match image.pixels() {
            Pixels::U8(_, encoding) => *encoding,
            Pixels::F16(_) | Pixels::F32(_) => ColorEncoding::Srgb,
        };
        to.text("filename", &self.files.image(image, stored));
        encoding(to, stored, ColorEncoding::Srgb);
        part(to, "mapping", &texture.mapping, self.names);
        if matches!(texture.mapping, MappingDesc::Affine { .. }) {
            self.extensions.insert("texture mapping affine".into());
        }
        if let Some(channel) = texture.channel {
            self.extensions.insert("texture channel".into());
            to.text("channel", channel.name());
        }
        if matches!(texture.wrap, WrapMode::Axes(_)) {
            self.extensions.insert("texture wrap by axis".into());
        }
        to.choice("wrap", texture.wrap.name(), "repeat");
    }
}

/// How an image over (u, v) is looked up, and the wrap mode that is the default.
pub(crate) fn uv_lookup(
    to: &mut Statement,
    image: &UvImageDesc,
    names: &UvImageNames,
    default: WrapMode,
    extensions: &mut BTreeSet<String>,
) {
    let UvImageDesc { image: _, columns: matrix, wrap: mode, is_nearest } = image;
    if *image == UvImageDesc::new(image.image, default) {
        return;
    }
    extensions.insert("lookups of images of emission and normals".into());
    to.choice(names.wrap, mode.name(), default.name());
    to.choice(names.filter, if *is_nearest { "point" } else { "bilinear" }, "bilinear");
    if *matrix != UvImageDesc::IDENTITY {
        to.floats(names.columns, matrix.as_flattened().iter().copied());
    }
}

fn encoding(to: &mut Statement, encoding: ColorEncoding, default: ColorEncoding) {
    if encoding == default {
        return;
    }
    match encoding {
        ColorEncoding::Linear => to.text("encoding", "linear"),
        ColorEncoding::Srgb => to.text("encoding", "sRGB"),
        ColorEncoding::Gamma(exponent) => to.text("encoding", &format!("gamma {}", decimal(exponent))),
    }
}
