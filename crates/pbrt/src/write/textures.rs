//! Textures of numbers and of spectra.

use std::collections::BTreeSet;

use description::{
    EncodingDesc, ImageChannel, ImageTextureDesc, MappingDesc, Parameter, SceneDesc, SpectrumDesc,
    TextureDesc, TextureFilter, TextureKind, UvImageDesc, WrapMode,
};
use image::{ColorEncoding, Pixels};
use math::{DMat4, Vec3};

use crate::write::files::Files;
use crate::write::names::Names;
use crate::write::number::decimal;
use crate::write::statement::{Statement, quoted};
use crate::write::text::Text;

/// The differences between textures of numbers and of spectra.
trait TextureValue: Sized {
    const TYPE: &'static str;

    fn value(statement: &mut Statement, name: &str, value: &Self, default: f32);
    fn parameter(statement: &mut Statement, name: &str, value: &Parameter<Self>, default: f32, names: &Names);
}

impl TextureValue for f32 {
    const TYPE: &'static str = "float";

    fn value(statement: &mut Statement, name: &str, value: &Self, default: f32) {
        statement.float(name, *value, default);
    }

    fn parameter(statement: &mut Statement, name: &str, value: &Parameter<f32>, default: f32, names: &Names) {
        statement.float_parameter(name, value, default, names);
    }
}

impl TextureValue for SpectrumDesc {
    const TYPE: &'static str = "spectrum";

    fn value(statement: &mut Statement, name: &str, value: &Self, default: f32) {
        statement.spectrum_or(name, value, default);
    }

    fn parameter(
        statement: &mut Statement,
        name: &str,
        value: &Parameter<Self>,
        default: f32,
        names: &Names,
    ) {
        statement.spectrum_parameter(name, value, Some(default), names);
    }
}

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
        statement.head += &format!(" {} {}", quoted(V::TYPE), quoted(type_name(kind)));
        self.kind(&mut statement, kind);
        text.block(*world_from_texture != DMat4::IDENTITY, |text| {
            text.matrix(world_from_texture);
            text.statement(statement);
        });
    }

    fn kind<V: TextureValue>(&mut self, to: &mut Statement, kind: &TextureKind<V>) {
        let names = self.names;
        match kind {
            TextureKind::Constant(value) => V::value(to, "value", value, 1.0),
            TextureKind::Scale { texture, scale } => {
                V::parameter(to, "tex", texture, 1.0, names);
                to.float_parameter("scale", scale, 1.0, names);
            }
            TextureKind::Mix { textures, amount } => {
                pair(to, textures, ["tex1", "tex2"], [0.0, 1.0], names);
                to.float_parameter("amount", amount, 0.5, names);
            }
            TextureKind::DirectionMix { textures, direction } => {
                pair(to, textures, ["tex1", "tex2"], [0.0, 1.0], names);
                to.triple("vector3", "dir", *direction, Vec3::Y);
            }
            TextureKind::Bilerp { corners, mapping: place } => {
                let names = [("v00", 0.0), ("v01", 1.0), ("v10", 0.0), ("v11", 1.0)];
                for (corner, (name, default)) in corners.iter().zip(names) {
                    V::value(to, name, corner, default);
                }
                mapping(to, place);
            }
            TextureKind::Image(image) => self.image(to, image),
            TextureKind::Checkerboard { textures, mapping: place } => {
                pair(to, textures, ["tex1", "tex2"], [1.0, 0.0], names);
                match place {
                    Some(place) => mapping(to, place),
                    None => to.integer("dimension", 3, 2),
                }
            }
            TextureKind::Dots { inside, outside, mapping: place } => {
                V::parameter(to, "inside", inside, 1.0, names);
                V::parameter(to, "outside", outside, 0.0, names);
                mapping(to, place);
            }
            TextureKind::Fbm { octaves, roughness } | TextureKind::Wrinkled { octaves, roughness } => {
                to.integer("octaves", *octaves, 8);
                to.float("roughness", *roughness, 0.5);
            }
            TextureKind::Windy => (),
            TextureKind::Step { texture, edge } => {
                self.extensions.insert("texture step".into());
                to.float_parameter("tex", texture, 1.0, names);
                to.float("edge", *edge, 0.5);
            }
            TextureKind::Marble { octaves, roughness, scale, variation } => {
                to.integer("octaves", *octaves, 8);
                to.float("roughness", *roughness, 0.5);
                to.float("scale", *scale, 1.0);
                to.float("variation", *variation, 0.2);
            }
            TextureKind::Ptex { filename, encoding: stored, scale } => {
                let stored = match stored {
                    EncodingDesc::Linear => ColorEncoding::Linear,
                    EncodingDesc::Srgb => ColorEncoding::Srgb,
                    EncodingDesc::Gamma(exponent) => ColorEncoding::Gamma(*exponent),
                };
                to.text("filename", filename);
                encoding(to, stored, ColorEncoding::Gamma(2.2));
                to.float("scale", *scale, 1.0);
            }
        }
    }

    fn image(&mut self, to: &mut Statement, texture: &ImageTextureDesc) {
        let ImageTextureDesc { image, mapping: place, channel, filter, max_anisotropy, wrap, scale, invert } =
            texture;
        let image = &self.desc.images[*image].image;
        // Codes keep their encoding, which the statement tells.
        let stored = match image.pixels() {
            Pixels::U8(_, encoding) => *encoding,
            Pixels::F16(_) | Pixels::F32(_) => ColorEncoding::Srgb,
        };
        to.text("filename", &self.files.image(image, stored));
        encoding(to, stored, ColorEncoding::Srgb);
        mapping(to, place);
        if matches!(place, MappingDesc::Affine { .. }) {
            self.extensions.insert("texture mapping affine".into());
        }
        let channel = channel.map(|channel| match channel {
            ImageChannel::Red => "r",
            ImageChannel::Green => "g",
            ImageChannel::Blue => "b",
            ImageChannel::Alpha => "a",
        });
        if let Some(channel) = channel {
            self.extensions.insert("texture channel".into());
            to.text("channel", channel);
        }
        let filter = match filter {
            TextureFilter::Point => "point",
            TextureFilter::Bilinear => "bilinear",
            TextureFilter::Trilinear => "trilinear",
            TextureFilter::Ewa => "ewa",
        };
        to.choice("filter", filter, "bilinear");
        if matches!(wrap, WrapMode::Axes(_)) {
            self.extensions.insert("texture wrap by axis".into());
        }
        to.choice("wrap", wrap.name(), "repeat");
        to.float("maxanisotropy", *max_anisotropy, 8.0);
        to.float("scale", *scale, 1.0);
        to.flag("invert", *invert, false);
    }
}

/// How an image over (u, v) is looked up, by the names of its wrap mode, filter and columns, and
/// the wrap mode that is the default.
pub(crate) fn uv_lookup(
    to: &mut Statement,
    image: &UvImageDesc,
    [wrap, filter, columns]: [&str; 3],
    default: WrapMode,
    extensions: &mut BTreeSet<String>,
) {
    let UvImageDesc { image: _, columns: matrix, wrap: mode, is_nearest } = image;
    if *image == UvImageDesc::new(image.image, default) {
        return;
    }
    extensions.insert("lookups of images of emission and normals".into());
    to.choice(wrap, mode.name(), default.name());
    to.choice(filter, if *is_nearest { "point" } else { "bilinear" }, "bilinear");
    if *matrix != UvImageDesc::IDENTITY {
        to.floats(columns, matrix.as_flattened().iter().copied());
    }
}

/// The format's name of a type of texture.
fn type_name<V>(kind: &TextureKind<V>) -> &'static str {
    match kind {
        TextureKind::Constant(_) => "constant",
        TextureKind::Scale { .. } => "scale",
        TextureKind::Mix { .. } => "mix",
        TextureKind::DirectionMix { .. } => "directionmix",
        TextureKind::Bilerp { .. } => "bilerp",
        TextureKind::Image(_) => "imagemap",
        TextureKind::Checkerboard { .. } => "checkerboard",
        TextureKind::Dots { .. } => "dots",
        TextureKind::Fbm { .. } => "fbm",
        TextureKind::Wrinkled { .. } => "wrinkled",
        TextureKind::Windy => "windy",
        TextureKind::Step { .. } => "step",
        TextureKind::Marble { .. } => "marble",
        TextureKind::Ptex { .. } => "ptex",
    }
}

fn pair<V: TextureValue>(
    to: &mut Statement,
    textures: &[Parameter<V>; 2],
    parameters: [&str; 2],
    defaults: [f32; 2],
    names: &Names,
) {
    for ((texture, name), default) in textures.iter().zip(parameters).zip(defaults) {
        V::parameter(to, name, texture, default, names);
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

fn mapping(to: &mut Statement, mapping: &MappingDesc) {
    let (name, delta) = match mapping {
        MappingDesc::Uv { delta, .. } => ("uv", *delta),
        MappingDesc::Spherical => ("spherical", [0.0; 2]),
        MappingDesc::Cylindrical => ("cylindrical", [0.0; 2]),
        MappingDesc::Planar { delta, .. } => ("planar", *delta),
        MappingDesc::Affine { .. } => ("affine", [0.0; 2]),
    };
    to.choice("mapping", name, "uv");
    match mapping {
        MappingDesc::Uv { scale: [u, v], .. } => {
            to.float("uscale", *u, 1.0);
            to.float("vscale", *v, 1.0);
        }
        MappingDesc::Planar { axes: [v1, v2], .. } => {
            to.triple("vector3", "v1", *v1, Vec3::X);
            to.triple("vector3", "v2", *v2, Vec3::Y);
        }
        MappingDesc::Affine { columns } => to.floats("columns", columns.as_flattened().iter().copied()),
        MappingDesc::Spherical | MappingDesc::Cylindrical => (),
    }
    to.float("udelta", delta[0], 0.0);
    to.float("vdelta", delta[1], 0.0);
}
