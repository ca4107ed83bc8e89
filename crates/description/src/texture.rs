//! Textures: values that vary over surfaces. Numbers and spectra have the same kinds of texture, so
//! that one generic description serves both.

use image::EdgeMode;
use math::{DMat4, Vec3};

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

impl From<f32> for FloatParameter {
    fn from(value: f32) -> Self {
        Self::Value(value)
    }
}

impl From<f32> for SpectrumParameter {
    fn from(value: f32) -> Self {
        Self::Value(SpectrumDesc::Constant(value))
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

/// The textures of the format.
#[derive(Clone, Debug)]
pub enum TextureKind<V> {
    /// A constant.
    Constant(V),
    /// A product.
    Scale {
        /// The first factor.
        texture: Parameter<V>,
        /// The second factor.
        scale: FloatParameter,
    },
    /// `(1 − amount)·textures[0] + amount·textures[1]`.
    Mix {
        /// The two textures.
        textures: [Parameter<V>; 2],
        /// Weight of the second.
        amount: FloatParameter,
    },
    /// A mix by the angle between the normal and a direction: the first texture where they agree.
    DirectionMix {
        /// The two textures.
        textures: [Parameter<V>; 2],
        /// The direction, in texture space.
        direction: Vec3,
    },
    /// Bilinear between four corners.
    Bilerp {
        /// Values at (u, v) = (0, 0), (0, 1), (1, 0), (1, 1).
        corners: [V; 4],
        /// Texture coordinates of a point.
        mapping: MappingDesc,
    },
    /// An image.
    Image(ImageTextureDesc),
    /// Squares or cubes in alternation.
    Checkerboard {
        /// The two values.
        textures: [Parameter<V>; 2],
        /// Squares in two dimensions; absent for cubes in three, in texture space.
        mapping: Option<MappingDesc>,
    },
    /// Random dots.
    Dots {
        /// Between the dots: pbrt-v4 exchanges the two.
        inside: Parameter<V>,
        /// In a dot.
        outside: Parameter<V>,
        /// Texture coordinates of a point.
        mapping: MappingDesc,
    },
    /// Fractional Brownian motion. Numbers only.
    Fbm {
        /// Octaves.
        octaves: i32,
        /// Weight of an octave against the one before.
        roughness: f32,
    },
    /// Turbulence. Numbers only.
    Wrinkled {
        /// Octaves.
        octaves: i32,
        /// Weight of an octave against the one before.
        roughness: f32,
    },
    /// Waves in the wind. Numbers only.
    Windy,
    /// 1 where a number is at least `edge`, else 0. Numbers only.
    Step {
        /// The number.
        texture: FloatParameter,
        /// The least number that gives 1.
        edge: f32,
    },
    /// Marble. Spectra only.
    Marble {
        /// Octaves.
        octaves: i32,
        /// Weight of an octave against the one before.
        roughness: f32,
        /// Scale of the pattern.
        scale: f32,
        /// Displacement of the veins by noise.
        variation: f32,
    },
    /// A Ptex file: described, never decoded.
    Ptex {
        /// Its path.
        filename: String,
        /// How stored values are decoded to linear ones.
        encoding: EncodingDesc,
        /// Factor on the values.
        scale: f32,
    },
}

/// An image as a texture, already decoded.
#[derive(Clone, Debug)]
pub struct ImageTextureDesc {
    /// The image.
    pub image: Handle<ImageDesc>,
    /// Texture coordinates of a point.
    pub mapping: MappingDesc,
    /// The channel of a texture of numbers. `None`: with the filters `Bilinear` and `Trilinear` the
    /// opacity, or the mean of red, green and blue where the image is opaque; with `Point` and
    /// `Ewa` the first channel.
    pub channel: Option<ImageChannel>,
    /// How texels are filtered.
    pub filter: TextureFilter,
    /// Largest ratio of the axes of the ellipse that `Ewa` filters over; at least 1.
    pub max_anisotropy: f32,
    /// Value outside of the image.
    pub wrap: WrapMode,
    /// Factor on the values.
    pub scale: f32,
    /// Subtract the scaled value from one.
    pub invert: bool,
}

impl ImageTextureDesc {
    /// An image with the defaults of the format.
    pub fn new(image: Handle<ImageDesc>) -> Self {
        Self {
            image,
            mapping: MappingDesc::default(),
            channel: None,
            filter: TextureFilter::Bilinear,
            max_anisotropy: 8.0,
            wrap: WrapMode::Repeat,
            scale: 1.0,
            invert: false,
        }
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

impl UvImageDesc {
    /// The columns of the identity.
    pub const IDENTITY: [[f32; 2]; 3] = [[1.0, 0.0], [0.0, 1.0], [0.0, 0.0]];

    /// An image of which (u, v) are the texture coordinates, interpolated.
    pub fn new(image: Handle<ImageDesc>, wrap: WrapMode) -> Self {
        Self { image, columns: Self::IDENTITY, wrap, is_nearest: false }
    }
}

/// A channel of an image. A grey image has its one value as red, green and blue.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub enum ImageChannel {
    /// Red.
    Red,
    /// Green.
    Green,
    /// Blue.
    Blue,
    /// Opacity.
    Alpha,
}

/// How texels are filtered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum TextureFilter {
    /// The nearest texel.
    Point,
    /// Bilinear interpolation in one level of the pyramid.
    #[default]
    Bilinear,
    /// Bilinear interpolation in two levels, and linear between them.
    Trilinear,
    /// Elliptically weighted average: a Gaussian over the footprint.
    Ewa,
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

/// The mapping from surface points to texture coordinates (s, t).
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum MappingDesc {
    /// `(scale · uv + delta)` of the surface's own parameters.
    Uv {
        /// Factors on u and v.
        scale: [f32; 2],
        /// Added to them.
        delta: [f32; 2],
    },
    /// `u · columns[0] + v · columns[1] + columns[2]` of the surface's own parameters.
    Affine {
        /// The columns of the matrix.
        columns: [[f32; 2]; 3],
    },
    /// Polar angles about the origin of texture space.
    Spherical,
    /// Angle about, and height along, the z axis of texture space.
    Cylindrical,
    /// `(p · axes[0] + delta[0], p · axes[1] + delta[1])` in texture space.
    Planar {
        /// The two vectors.
        axes: [Vec3; 2],
        /// Added.
        delta: [f32; 2],
    },
}

impl Default for MappingDesc {
    fn default() -> Self {
        Self::Uv { scale: [1.0, 1.0], delta: [0.0, 0.0] }
    }
}
