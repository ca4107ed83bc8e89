//! Textures: values that vary over surfaces. Numbers and spectra have the same kinds of texture, so
//! that one generic description serves both.

use image::EdgeMode;
use math::{DMat4, Vec3};

use crate::schema::{Kind, SettingType, Value, above, choices, from, members, settings, vector};
use crate::{Handle, ImageDesc, SpectrumDesc};

/// A constant value or a texture.
#[derive(Clone, Debug, PartialEq)]
pub enum Parameter<V> {
    /// A constant.
    Value(V),
    /// The value of a texture at the shading point.
    Texture(Handle<TextureDesc<V>>),
}

/// A number or a texture of numbers.
pub type FloatParameter = Parameter<f32>;
/// A spectrum or a texture of spectra.
pub type SpectrumParameter = Parameter<SpectrumDesc>;
/// A texture of numbers.
pub type FloatTextureDesc = TextureDesc<f32>;
/// A texture of spectra.
pub type SpectrumTextureDesc = TextureDesc<SpectrumDesc>;

impl<V> Parameter<V> {
    /// The value, if it is a constant.
    pub fn value(&self) -> Option<&V> {
        match self {
            Self::Value(value) => Some(value),
            Self::Texture(_) => None,
        }
    }
}

impl<V: From<f32>> From<f32> for Parameter<V> {
    fn from(value: f32) -> Self {
        Self::Value(value.into())
    }
}

impl From<SpectrumDesc> for SpectrumParameter {
    fn from(value: SpectrumDesc) -> Self {
        Self::Value(value)
    }
}

impl<V> From<Handle<TextureDesc<V>>> for Parameter<V> {
    fn from(texture: Handle<TextureDesc<V>>) -> Self {
        Self::Texture(texture)
    }
}

/// A texture.
#[derive(Clone, Debug)]
pub struct TextureDesc<V> {
    /// Its name; empty for a texture that was built by hand.
    pub name: String,
    /// Its kind, with parameters.
    pub kind: TextureKind<V>,
    /// From texture space to world space: the current transformation where the texture was
    /// defined. Mappings and patterns that are functions of position use it.
    pub world_from_texture: DMat4,
}

impl<V> TextureDesc<V> {
    /// A texture without a name, in world space.
    pub fn new(kind: TextureKind<V>) -> Self {
        Self { name: String::new(), kind, world_from_texture: DMat4::IDENTITY }
    }
}

/// The values of a texture: numbers or spectra.
pub trait TextureValue: SettingType + From<f32> + Clone + PartialEq {
    /// The format's name of their type.
    const NAME: &'static str;
    /// The type of a setting that is such a value or a texture of them.
    const PARAMETER: Kind;

    /// Whether textures of the kind have such values.
    fn are_of(kind: TextureType) -> bool;

    /// A texture as the value of a setting.
    fn from_texture(texture: Handle<TextureDesc<Self>>) -> Value;

    /// The texture that is the value of a setting.
    fn to_texture(value: &Value) -> Option<Handle<TextureDesc<Self>>>;
}

impl TextureValue for f32 {
    const NAME: &'static str = "float";
    const PARAMETER: Kind = Kind::FloatParameter;

    fn are_of(kind: TextureType) -> bool {
        kind != TextureType::Marble
    }

    fn from_texture(texture: Handle<FloatTextureDesc>) -> Value {
        Value::FloatTexture(texture.untyped())
    }

    fn to_texture(value: &Value) -> Option<Handle<FloatTextureDesc>> {
        if let Value::FloatTexture(texture) = value { Some(texture.typed()) } else { None }
    }
}

impl TextureValue for SpectrumDesc {
    const NAME: &'static str = "spectrum";
    const PARAMETER: Kind = Kind::SpectrumParameter;

    fn are_of(kind: TextureType) -> bool {
        use TextureType::{Fbm, Step, Windy, Wrinkled};
        !matches!(kind, Fbm | Wrinkled | Windy | Step)
    }

    fn from_texture(texture: Handle<SpectrumTextureDesc>) -> Value {
        Value::SpectrumTexture(texture.untyped())
    }

    fn to_texture(value: &Value) -> Option<Handle<SpectrumTextureDesc>> {
        if let Value::SpectrumTexture(texture) = value { Some(texture.typed()) } else { None }
    }
}

impl<V: TextureValue> SettingType for Parameter<V> {
    const KIND: Kind = V::PARAMETER;

    fn to_value(&self) -> Value {
        match self {
            Self::Value(value) => value.to_value(),
            Self::Texture(texture) => V::from_texture(*texture),
        }
    }

    fn from_value(value: &Value) -> Option<Self> {
        let texture = V::to_texture(value).map(Self::Texture);
        texture.or_else(|| V::from_value(value).map(Self::Value))
    }
}

members! {
    /// The textures of the format.
    #[derive(Clone, Debug)]
    pub enum TextureKind<V: TextureValue>: TextureType = Constant {
        /// One value.
        Constant = "constant" {
            /// The value.
            value: V = 1.0.into() => ["value"];
        },
        /// A product.
        Scale = "scale" {
            /// The first factor.
            texture: Parameter<V> = 1.0.into() => ["tex"];
            /// The second factor.
            scale: FloatParameter = 1.0.into() => ["scale"];
        },
        /// `(1 − amount) · tex1 + amount · tex2`.
        Mix = "mix" {
            /// The two textures.
            textures: [Parameter<V>; 2] = [0.0.into(), 1.0.into()] => ["tex1"[0], "tex2"[1]];
            /// The share of `tex2`.
            amount: FloatParameter = 0.5.into() => ["amount"];
        },
        /// A mix by the angle between the normal and a direction: `tex1` where they agree.
        DirectionMix = "directionmix" {
            /// The two textures.
            textures: [Parameter<V>; 2] = [0.0.into(), 1.0.into()] => ["tex1"[0], "tex2"[1]];
            /// The direction, in texture space.
            direction: Vec3 = Vec3::Y => ["dir": vector()];
        },
        /// Bilinear between four corners.
        Bilerp = "bilerp" {
            /// Values at (u, v) = (0, 0), (0, 1), (1, 0) and (1, 1).
            corners: [V; 4] = [0.0, 1.0, 0.0, 1.0].map(V::from) => ["v00"[0], "v01"[1], "v10"[2], "v11"[3]];
            /// Texture coordinates of a point.
            mapping: MappingDesc = MappingDesc::default();
        },
        /// An image.
        Image(ImageTextureDesc) = "imagemap",
        /// Squares or cubes in alternation.
        Checkerboard = "checkerboard" {
            /// The two textures.
            textures: [Parameter<V>; 2] = [1.0.into(), 0.0.into()] => ["tex1"[0], "tex2"[1]];
            /// Squares in two dimensions; absent for cubes in three, in texture space.
            mapping: Option<MappingDesc> = Some(MappingDesc::default());
        },
        /// Round dots at random places. As in pbrt-v4, `inside` and `outside` are exchanged.
        Dots = "dots" {
            /// Between the dots.
            inside: Parameter<V> = 1.0.into() => ["inside"];
            /// In the dots.
            outside: Parameter<V> = 0.0.into() => ["outside"];
            /// Texture coordinates of a point.
            mapping: MappingDesc = MappingDesc::default();
        },
        /// A Ptex file: described, never decoded.
        Ptex = "ptex" {
            /// Its path.
            filename: String = String::new();
            /// How stored values are decoded to linear ones.
            encoding: EncodingDesc = EncodingDesc::Gamma(2.2);
            /// Factor on the values.
            scale: f32 = 1.0 => ["scale"];
        },
        /// Fractional Brownian motion. Textures of `float` only.
        Fbm = "fbm" {
            /// Octaves of noise.
            octaves: i32 = 8 => ["octaves": from(0.0, 64.0)];
            /// Amplitude of an octave relative to the one before.
            roughness: f32 = 0.5 => ["roughness"];
        },
        /// Turbulence. Textures of `float` only.
        Wrinkled = "wrinkled" {
            /// Octaves of noise.
            octaves: i32 = 8 => ["octaves": from(0.0, 64.0)];
            /// Amplitude of an octave relative to the one before.
            roughness: f32 = 0.5 => ["roughness"];
        },
        /// Waves in the wind. Textures of `float` only.
        Windy = "windy",
        /// 1 where a texture is at least `edge`, else 0. Textures of `float` only.
        Step = "step" [extension] {
            /// The texture.
            texture: FloatParameter = 1.0.into() => ["tex"];
            /// The least value that gives 1.
            edge: f32 = 0.5 => ["edge"];
        },
        /// Marble. Textures of `spectrum` only.
        Marble = "marble" {
            /// Octaves of noise.
            octaves: i32 = 8 => ["octaves": from(0.0, 64.0)];
            /// Amplitude of an octave relative to the one before.
            roughness: f32 = 0.5 => ["roughness"];
            /// Factor on the noise's frequency.
            scale: f32 = 1.0 => ["scale"];
            /// Displacement of the veins by noise.
            variation: f32 = 0.2 => ["variation"];
        },
    }
}

settings! {
    /// An image as a texture, already decoded.
    #[derive(Clone, Debug)]
    pub struct ImageTextureDesc {
        /// The image; the first one of the scene, if it is not set.
        image: Handle<ImageDesc> = Handle::new(0);
        /// Texture coordinates of a point.
        mapping: MappingDesc = MappingDesc::default();
        /// The channel of a texture of numbers. `None`: with the filters `Bilinear` and `Trilinear`
        /// the opacity, or the mean of red, green and blue where the image is opaque; with `Point`
        /// and `Ewa` the first channel.
        channel: Option<ImageChannel> = None;
        /// How texels are filtered; `EWA` is `ewa`.
        filter: TextureFilter = TextureFilter::Bilinear => ["filter"];
        /// Largest ratio of the axes of the ellipse that `ewa` filters over; at least 1.
        max_anisotropy: f32 = 8.0 => ["maxanisotropy": above(0.0)];
        /// Value outside of the image.
        wrap: WrapMode = WrapMode::Repeat;
        /// Factor on the values.
        scale: f32 = 1.0 => ["scale"];
        /// Whether the scaled value is subtracted from one.
        invert: bool = false => ["invert"];
    }
}

impl ImageTextureDesc {
    /// An image with the defaults of the format.
    pub fn new(image: Handle<ImageDesc>) -> Self {
        Self { image, ..Self::default() }
    }
}

/// An image over the parameters (u, v) of surfaces, of which the finest level is seen: of emission,
/// or of normals.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct UvImageDesc {
    /// The image.
    pub image: Handle<ImageDesc>,
    /// The columns of the matrix from (u, v) to texture coordinates.
    pub columns: [[f32; 2]; 3],
    /// Value outside of the image.
    pub wrap: WrapMode,
    /// Whether the nearest texel is seen, not an interpolation of four.
    pub is_nearest: bool,
}

/// The names of the parameters of an image over (u, v).
#[derive(Clone, Copy, Debug)]
pub struct UvImageNames {
    /// Of the file.
    pub file: &'static str,
    /// Of the wrap mode.
    pub wrap: &'static str,
    /// Of the filter.
    pub filter: &'static str,
    /// Of the columns of the matrix.
    pub columns: &'static str,
}

impl UvImageDesc {
    /// The names of an image of emission.
    pub const EMISSION: UvImageNames =
        UvImageNames { file: "filename", wrap: "wrap", filter: "filter", columns: "columns" };

    /// The names of a map of normals.
    pub const NORMALS: UvImageNames = UvImageNames {
        file: "normalmap",
        wrap: "normalmap_wrap",
        filter: "normalmap_filter",
        columns: "normalmap_columns",
    };

    /// The names of a map of the coat's normals.
    pub const COAT_NORMALS: UvImageNames = UvImageNames {
        file: "geometry_coat_normal",
        wrap: "geometry_coat_normal_wrap",
        filter: "geometry_coat_normal_filter",
        columns: "geometry_coat_normal_columns",
    };

    /// The columns of the identity.
    pub const IDENTITY: [[f32; 2]; 3] = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]];

    /// An image of which (u, v) are the texture coordinates, interpolated.
    pub fn new(image: Handle<ImageDesc>, wrap: WrapMode) -> Self {
        Self { image, columns: Self::IDENTITY, wrap, is_nearest: false }
    }
}

choices! {
    /// A channel of an image. A grey image has its one value as red, green and blue.
    #[derive(Hash)]
    pub enum ImageChannel {
        /// Red.
        #[default]
        Red = "r",
        /// Green.
        Green = "g",
        /// Blue.
        Blue = "b",
        /// Opacity.
        Alpha = "a",
    }
}

choices! {
    /// How texels are filtered.
    pub enum TextureFilter {
        /// The nearest texel.
        Point = "point",
        /// Bilinear interpolation in one level of the pyramid.
        #[default]
        Bilinear = "bilinear",
        /// Bilinear interpolation in two levels, and linear between them.
        Trilinear = "trilinear",
        /// Elliptically weighted average: a Gaussian over the footprint.
        Ewa = "ewa" | "EWA",
    }
}

/// The value of an image outside of its edges.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum WrapMode {
    /// The image is repeated.
    #[default]
    Repeat,
    /// Zero.
    Black,
    /// The texel at the edge.
    Clamp,
    /// The neighbour on the sphere, for equal-area octahedral images.
    OctahedralSphere,
    /// Columns and rows each by a rule of their own, which differ.
    Axes([EdgeMode; 2]),
}

impl WrapMode {
    /// The names of all modes.
    pub const NAMES: &'static [(&'static str, Self)] = &[
        ("repeat", Self::Repeat),
        ("black", Self::Black),
        ("clamp", Self::Clamp),
        ("octahedralsphere", Self::OctahedralSphere),
        ("repeat-black", Self::Axes([EdgeMode::Repeat, EdgeMode::Black])),
        ("repeat-clamp", Self::Axes([EdgeMode::Repeat, EdgeMode::Clamp])),
        ("black-repeat", Self::Axes([EdgeMode::Black, EdgeMode::Repeat])),
        ("black-clamp", Self::Axes([EdgeMode::Black, EdgeMode::Clamp])),
        ("clamp-repeat", Self::Axes([EdgeMode::Clamp, EdgeMode::Repeat])),
        ("clamp-black", Self::Axes([EdgeMode::Clamp, EdgeMode::Black])),
    ];

    /// The mode of an image whose columns and rows go on by these rules.
    pub fn of_axes(axes: [EdgeMode; 2]) -> Self {
        match axes {
            [EdgeMode::Repeat, EdgeMode::Repeat] => Self::Repeat,
            [EdgeMode::Black, EdgeMode::Black] => Self::Black,
            [EdgeMode::Clamp, EdgeMode::Clamp] => Self::Clamp,
            axes => Self::Axes(axes),
        }
    }

    /// Its name.
    pub fn name(self) -> &'static str {
        let named = Self::NAMES.iter().find(|&&(_, mode)| mode == self);
        named.map_or("repeat", |(name, _)| name)
    }
}

/// How stored values are decoded to linear ones.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum EncodingDesc {
    /// They are linear.
    Linear,
    /// The sRGB curve.
    Srgb,
    /// linear = storedᵞ.
    Gamma(f32),
}

settings! {
    /// The mapping from surface points to texture coordinates (s, t).
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub enum MappingDesc = Uv {
        /// `scale · uv + delta` of the surface's own parameters.
        Uv = "uv" {
            /// Factors on u and v.
            scale: [f32; 2] = [1.0; 2] => ["uscale"[0], "vscale"[1]];
            /// Added to u and v.
            delta: [f32; 2] = [0.0; 2] => ["udelta"[0], "vdelta"[1]];
        },
        /// Polar angles about the origin of texture space.
        Spherical = "spherical",
        /// Angle about, and height along, the z axis of texture space.
        Cylindrical = "cylindrical",
        /// `(p · axes[0] + delta[0], p · axes[1] + delta[1])` in texture space.
        Planar = "planar" {
            /// The vectors along which the coordinates grow.
            axes: [Vec3; 2] = [Vec3::X, Vec3::Y] => ["v1"[0]: vector(), "v2"[1]: vector()];
            /// Added to the coordinates.
            delta: [f32; 2] = [0.0; 2] => ["udelta"[0], "vdelta"[1]];
        },
        /// `u · columns[0] + v · columns[1] + columns[2]` of the surface's own parameters.
        Affine = "affine" {
            /// u times the first pair, v times the second, plus the third.
            columns: [[f32; 2]; 3] = UvImageDesc::IDENTITY => ["columns"];
        },
    }
}
