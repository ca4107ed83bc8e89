//! The film: what is stored of the light that arrives.

use crate::{ColorSpaceDesc, Spanned};

/// A film.
#[derive(Clone, Debug, PartialEq)]
pub struct FilmDesc {
    /// What is stored per pixel.
    pub kind: FilmKind,
    /// Width and height of the whole image in pixels.
    pub resolution: [i32; 2],
    /// The pixels to render, `[x0, x1, y0, y1)` in pixels of the whole image; all if absent.
    pub pixel_bounds: Option<[i32; 4]>,
    /// The part to render as fractions `[x0, x1, y0, y1]` of the whole image, used if
    /// `pixel_bounds` is absent.
    pub crop_window: Option<[f32; 4]>,
    /// Diagonal of the film in millimetres, for physical cameras.
    pub diagonal: f32,
    /// The file to write.
    pub filename: Spanned<String>,
    /// Store half floats.
    pub save_fp16: bool,
    /// Samples are scaled down so that no sensor component exceeds this.
    pub max_component_value: f32,
    /// How light becomes sensor values.
    pub sensor: SensorDesc,
    /// The colour space of the image.
    pub color_space: ColorSpaceDesc,
    /// The names of layers beside the colour.
    pub layers: Vec<Spanned<String>>,
}

/// What a film stores per pixel.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum FilmKind {
    /// Colour.
    #[default]
    Rgb,
    /// Colour and geometry.
    GBuffer {
        /// The space of positions and normals.
        space: GBufferSpace,
    },
    /// Radiance in wavelength buckets.
    Spectral {
        /// Number of buckets.
        buckets: i32,
        /// Lower end of the first bucket in nanometres.
        lambda_min: f32,
        /// Upper end of the last bucket in nanometres.
        lambda_max: f32,
    },
}

/// The coordinate system of a geometry buffer.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum GBufferSpace {
    /// The camera's.
    #[default]
    Camera,
    /// The world's.
    World,
}

/// How light becomes sensor values. The imaging ratio is exposure time × ISO / 100; the exposure
/// time is that of the camera's shutter.
#[derive(Clone, Debug, PartialEq)]
pub struct SensorDesc {
    /// `cie1931` (an ideal XYZ sensor) or the name of a measured camera.
    pub name: Spanned<String>,
    /// Sensitivity.
    pub iso: f32,
    /// Temperature in kelvin of the light that shall look white; 0 leaves colours as they are
    /// (`cie1931`) or takes 6500 (measured cameras).
    pub white_balance: f32,
}

impl Default for SensorDesc {
    fn default() -> Self {
        Self { name: Spanned::new("cie1931".into(), crate::Span::NONE), iso: 100.0, white_balance: 0.0 }
    }
}

impl Default for FilmDesc {
    fn default() -> Self {
        Self {
            kind: FilmKind::Rgb,
            resolution: [1280, 720],
            pixel_bounds: None,
            crop_window: None,
            diagonal: 35.0,
            filename: Spanned::new("pbrt.exr".into(), crate::Span::NONE),
            save_fp16: true,
            max_component_value: f32::INFINITY,
            sensor: SensorDesc::default(),
            color_space: ColorSpaceDesc::Srgb,
            layers: Vec::new(),
        }
    }
}
