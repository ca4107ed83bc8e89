//! The film: resolution, sensor and output file.

use crate::schema::{above, choices, from, one_of, settings};
use crate::{ColorSpaceDesc, Spanned};

/// The sensors of the format: an ideal one with the responses of CIE 1931 XYZ, and measured
/// cameras.
const SENSORS: &[&str] = &[
    "cie1931",
    "canon_eos_100d",
    "canon_eos_1dx_mkii",
    "canon_eos_200d_mkii",
    "canon_eos_200d",
    "canon_eos_5d",
    "canon_eos_5d_mkii",
    "canon_eos_5d_mkiii",
    "canon_eos_5d_mkiv",
    "canon_eos_5ds",
    "canon_eos_m",
    "hasselblad_l1d_20c",
    "nikon_d810",
    "nikon_d850",
    "sony_ilce_6400",
    "sony_ilce_7m3",
    "sony_ilce_7rm3",
    "sony_ilce_9",
];

settings! {
    /// A film.
    #[derive(Clone, Debug, PartialEq)]
    pub struct FilmDesc {
        /// What is stored per pixel.
        kind: FilmKind = FilmKind::Rgb => ..;
        /// Width or height of the whole image.
        resolution: [i32; 2] = [1280, 720] => [
            "xresolution"[0]: from(1.0, 1e6).unit("pixels"),
            "yresolution"[1]: from(1.0, 1e6).unit("pixels")
        ];
        /// The pixels to render, x0, x1, y0, y1 in pixels of the whole image, without x1 and y1. If
        /// absent, all.
        pixel_bounds: Option<[i32; 4]> = None => ["pixelbounds"];
        /// The part to render as fractions x0, x1, y0, y1 of the whole image, instead of
        /// `pixelbounds`.
        crop_window: Option<[f32; 4]> = None => ["cropwindow"];
        /// Diagonal of the film, for physical cameras.
        diagonal: f32 = 35.0 => ["diagonal": above(0.0).unit("mm")];
        /// The file to write.
        filename: String = "pbrt.exr".to_owned() => ["filename"];
        /// Store half floats instead of single floats.
        save_fp16: bool = true => ["savefp16"];
        /// Samples are scaled down so that no sensor response exceeds this.
        max_component_value: f32 = f32::INFINITY
            => ["maxcomponentvalue": above(0.0).at_most(f64::INFINITY)];
        /// How light becomes sensor values.
        sensor: SensorDesc = SensorDesc::default() => ..;
        /// The colour space of the image.
        color_space: ColorSpaceDesc = ColorSpaceDesc::Srgb;
        /// The names of additional layers (AOVs).
        layers: Vec<Spanned<String>> = Vec::new();
    }
}

settings! {
    /// What a film stores per pixel.
    #[derive(Clone, Debug, PartialEq)]
    pub enum FilmKind = Rgb {
        /// Colour.
        Rgb = "rgb",
        /// Colour and geometry.
        GBuffer = "gbuffer" {
            /// The space of positions and normals.
            space: GBufferSpace = GBufferSpace::Camera => ["coordinatesystem"];
        },
        /// Colour, and radiance in buckets of wavelengths.
        Spectral = "spectral" {
            /// Number of buckets.
            buckets: i32 = 16 => ["nbuckets": from(1.0, 4096.0)];
            /// Lower end of the first bucket.
            lambda_min: f32 = 360.0 => ["lambdamin": from(360.0, 830.0).unit("nm")];
            /// Upper end of the last bucket.
            lambda_max: f32 = 830.0 => ["lambdamax": from(360.0, 830.0).unit("nm")];
        },
    }
}

choices! {
    /// The coordinate system of a geometry buffer.
    pub enum GBufferSpace {
        /// The camera's.
        #[default]
        Camera = "camera",
        /// The world's.
        World = "world",
    }
}

settings! {
    /// Conversion of light to sensor values. The imaging ratio is exposure time × ISO / 100; the
    /// exposure time is that of the camera's shutter.
    #[derive(Clone, Debug, PartialEq)]
    pub struct SensorDesc {
        /// The sensor: `cie1931`, an ideal one, or a measured camera.
        name: String = "cie1931".to_owned() => ["sensor": one_of(SENSORS)];
        /// Sensitivity.
        iso: f32 = 100.0 => ["iso": above(0.0).unit("ISO")];
        /// Colour temperature of the light that becomes white. 0 does not change colours
        /// (`cie1931`) or means 6500 (measured cameras).
        white_balance: f32 = 0.0 => ["whitebalance": from(0.0, 1e5).unit("K")];
    }
}
