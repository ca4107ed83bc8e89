//! Textures of numbers and of spectra, read by one generic reader.

use description::{
    Arena, EncodingDesc, Handle, ImageChannel, ImageTextureDesc, MappingDesc, Parameter, SceneDesc,
    SpectrumDesc, Stated, TextureDesc, TextureFilter, TextureKind, UvImageDesc, WrapMode,
};
use math::Vec3;

use super::Builder;
use super::reader::Reader;
use crate::read::statement::{Statements, TextureStatement};

/// The differences between textures of numbers and of spectra.
pub(super) trait TextureValue: Clone {
    /// The types of texture that give such values.
    const TYPES: &'static [&'static str];

    fn constant(value: f32) -> Self;
    fn value(reader: &mut Reader, name: &'static str, default: f32) -> Self;
    fn parameter(reader: &mut Reader, name: &'static str, default: f32) -> Parameter<Self>;
    /// The channel of an image that is read; numbers only.
    fn channel(reader: &mut Reader) -> Option<ImageChannel>;
    /// The types that only this kind of value has.
    fn own_kind(reader: &mut Reader) -> Option<TextureKind<Self>>;
}

impl TextureValue for f32 {
    const TYPES: &'static [&'static str] = &[
        "constant",
        "scale",
        "mix",
        "directionmix",
        "bilerp",
        "imagemap",
        "checkerboard",
        "dots",
        "ptex",
        "fbm",
        "wrinkled",
        "windy",
        "step",
    ];

    fn constant(value: f32) -> Self {
        value
    }

    fn value(reader: &mut Reader, name: &'static str, default: f32) -> Self {
        reader.float(name, default)
    }

    fn parameter(reader: &mut Reader, name: &'static str, default: f32) -> Parameter<Self> {
        reader.float_parameter(name, default)
    }

    fn channel(reader: &mut Reader) -> Option<ImageChannel> {
        let channels = [
            ("r", Some(ImageChannel::Red)),
            ("g", Some(ImageChannel::Green)),
            ("b", Some(ImageChannel::Blue)),
            ("a", Some(ImageChannel::Alpha)),
        ];
        reader.choice("channel", None, &channels)
    }

    fn own_kind(reader: &mut Reader) -> Option<TextureKind<Self>> {
        Some(match reader.kind.value.as_str() {
            "fbm" => {
                let (octaves, roughness) = octaves(reader);
                TextureKind::Fbm { octaves, roughness }
            }
            "wrinkled" => {
                let (octaves, roughness) = octaves(reader);
                TextureKind::Wrinkled { octaves, roughness }
            }
            "windy" => TextureKind::Windy,
            "step" => TextureKind::Step {
                texture: reader.float_parameter("tex", 1.0),
                edge: reader.float("edge", 0.5),
            },
            _ => return None,
        })
    }
}

impl TextureValue for SpectrumDesc {
    const TYPES: &'static [&'static str] = &[
        "constant",
        "scale",
        "mix",
        "directionmix",
        "bilerp",
        "imagemap",
        "checkerboard",
        "dots",
        "ptex",
        "marble",
    ];

    fn constant(value: f32) -> Self {
        value.into()
    }

    fn value(reader: &mut Reader, name: &'static str, default: f32) -> Self {
        let value = reader.spectrum(name);
        reader.note(default, "");
        value.unwrap_or(default.into())
    }

    fn parameter(reader: &mut Reader, name: &'static str, default: f32) -> Parameter<Self> {
        reader.spectrum_parameter(name, default)
    }

    fn channel(_: &mut Reader) -> Option<ImageChannel> {
        None
    }

    fn own_kind(reader: &mut Reader) -> Option<TextureKind<Self>> {
        if reader.kind.value != "marble" {
            return None;
        }
        let (octaves, roughness) = octaves(reader);
        let (scale, variation) = (reader.float("scale", 1.0), reader.float("variation", 0.2));
        Some(TextureKind::Marble { octaves, roughness, scale, variation })
    }
}

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
        let kind = kind.unwrap_or(TextureKind::Constant(V::constant(1.0)));
        let name = texture.name.value.clone();
        let desc = TextureDesc { name: name.clone(), kind, world_from_texture: texture.world_from_texture };
        (name, textures.push_stated(Stated::new(desc, origin)))
    }
}

fn kind<V: TextureValue>(reader: &mut Reader) -> Option<TextureKind<V>> {
    let pair = |reader: &mut Reader| [V::parameter(reader, "tex1", 0.0), V::parameter(reader, "tex2", 1.0)];
    Some(match reader.kind.value.as_str() {
        "constant" => TextureKind::Constant(V::value(reader, "value", 1.0)),
        "scale" => TextureKind::Scale {
            texture: V::parameter(reader, "tex", 1.0),
            scale: reader.float_parameter("scale", 1.0),
        },
        "mix" => TextureKind::Mix { textures: pair(reader), amount: reader.float_parameter("amount", 0.5) },
        "directionmix" => {
            TextureKind::DirectionMix { textures: pair(reader), direction: reader.vector3("dir", Vec3::Y) }
        }
        "bilerp" => TextureKind::Bilerp {
            corners: [("v00", 0.0), ("v01", 1.0), ("v10", 0.0), ("v11", 1.0)]
                .map(|(name, default)| V::value(reader, name, default)),
            mapping: mapping(reader),
        },
        "imagemap" => TextureKind::Image(image::<V>(reader)?),
        "checkerboard" => {
            let dimension = reader.integer("dimension", 2, 2..=3);
            // A texture of numbers alternates 1 and 0 by default, as one of spectra does.
            let textures = [V::parameter(reader, "tex1", 1.0), V::parameter(reader, "tex2", 0.0)];
            let mapping = mapping(reader);
            TextureKind::Checkerboard { textures, mapping: (dimension == 2).then_some(mapping) }
        }
        "dots" => TextureKind::Dots {
            inside: V::parameter(reader, "inside", 1.0),
            outside: V::parameter(reader, "outside", 0.0),
            mapping: mapping(reader),
        },
        "ptex" => {
            let Some(file) = reader.string("filename") else {
                reader.missing("filename");
                return None;
            };
            TextureKind::Ptex {
                filename: reader.builder.path(&file).to_string_lossy().into_owned(),
                encoding: encoding(reader).unwrap_or(EncodingDesc::Gamma(2.2)),
                scale: reader.float("scale", 1.0),
            }
        }
        _ => match V::own_kind(reader) {
            Some(kind) => kind,
            None => {
                reader.unknown_type("texture", "texture", V::TYPES);
                return None;
            }
        },
    })
}

fn octaves(reader: &mut Reader) -> (i32, f32) {
    (reader.integer("octaves", 8, 0..=64), reader.float("roughness", 0.5))
}

fn image<V: TextureValue>(reader: &mut Reader) -> Option<ImageTextureDesc> {
    let encoding = encoding(reader);
    let mapping = mapping(reader);
    let filter = reader.choice(
        "filter",
        TextureFilter::Bilinear,
        &[
            ("point", TextureFilter::Point),
            ("bilinear", TextureFilter::Bilinear),
            ("trilinear", TextureFilter::Trilinear),
            ("ewa", TextureFilter::Ewa),
            ("EWA", TextureFilter::Ewa),
        ],
    );
    let wrap = reader.choice("wrap", WrapMode::Repeat, WrapMode::NAMES);
    let max_anisotropy = reader.positive("maxanisotropy", 8.0);
    let (scale, invert) = (reader.float("scale", 1.0), reader.boolean("invert", false));
    let channel = V::channel(reader);
    let Some(image) = reader.image("filename", encoding) else {
        if !reader.has("filename") {
            reader.missing("filename");
        }
        return None;
    };
    Some(ImageTextureDesc { image, mapping, channel, filter, max_anisotropy, wrap, scale, invert })
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

/// The mapping to texture coordinates. Parameters of other mappings than the chosen one are errors,
/// as unknown.
fn mapping(reader: &mut Reader) -> MappingDesc {
    let kinds = [("uv", 0), ("spherical", 1), ("cylindrical", 2), ("planar", 3), ("affine", 4)];
    let kind = reader.choice("mapping", 0, &kinds);
    let delta = |reader: &mut Reader| [reader.float("udelta", 0.0), reader.float("vdelta", 0.0)];
    match kind {
        0 => MappingDesc::Uv {
            scale: [reader.float("uscale", 1.0), reader.float("vscale", 1.0)],
            delta: delta(reader),
        },
        1 => MappingDesc::Spherical,
        2 => MappingDesc::Cylindrical,
        4 => {
            let [a, b, c, d, e, f] = reader.float_array("columns").unwrap_or([1.0, 0.0, 0.0, 1.0, 0.0, 0.0]);
            MappingDesc::Affine { columns: [[a, b], [c, d], [e, f]] }
        }
        _ => MappingDesc::Planar {
            axes: [reader.vector3("v1", Vec3::X), reader.vector3("v2", Vec3::Y)],
            delta: delta(reader),
        },
    }
}

impl Reader<'_, '_> {
    /// A normal map, by the names of its file, wrap mode, filter and columns.
    pub(super) fn normal_map(&mut self, names: [&'static str; 4]) -> Option<UvImageDesc> {
        self.uv_image(names, Some(EncodingDesc::Linear), WrapMode::Repeat)
    }

    /// An image over (u, v) by the same names, with its wrap mode if none is given.
    pub(super) fn uv_image(
        &mut self,
        [file, wrap, filter, columns]: [&'static str; 4],
        encoding: Option<EncodingDesc>,
        otherwise: WrapMode,
    ) -> Option<UvImageDesc> {
        let image = self.image(file, encoding)?;
        let wrap = self.choice(wrap, otherwise, WrapMode::NAMES);
        let is_nearest = self.choice(filter, false, &[("bilinear", false), ("point", true)]);
        let columns = self
            .float_array(columns)
            .map_or(UvImageDesc::IDENTITY, |[a, b, c, d, e, f]| [[a, b], [c, d], [e, f]]);
        Some(UvImageDesc { image, columns, wrap, is_nearest })
    }
}
