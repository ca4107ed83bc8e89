//! Descriptions of spectra and colour spaces.

use std::sync::Arc;

use crate::schema::choices;

choices! {
    /// An RGB colour space.
    #[derive(Hash)]
    pub enum ColorSpaceDesc {
        /// Rec. 709 primaries, D65 white.
        #[default]
        Srgb = "srgb",
        /// DCI-P3 primaries, D65 white.
        DciP3 = "dci-p3",
        /// Rec. 2020 primaries, D65 white.
        Rec2020 = "rec2020",
        /// ACES 2065-1 (AP0) primaries, ACES (about D60) white.
        Aces2065_1 = "aces2065-1",
    }
}

/// A function of wavelength.
#[derive(Clone, Debug, PartialEq)]
pub enum SpectrumDesc {
    /// The same value at all wavelengths.
    Constant(f32),
    /// A colour; how it becomes a spectrum depends on what it is used for (reflectance, light, or
    /// neither).
    Rgb {
        /// Red, green and blue, linear.
        rgb: [f32; 3],
        /// The space they are in.
        space: ColorSpaceDesc,
    },
    /// A predefined spectrum of the format, such as `metal-Cu-eta` or `stdillum-D65`.
    Named(String),
    /// Values at wavelengths in nanometres, increasing; linear between them and zero outside.
    Samples(Arc<[(f32, f32)]>),
    /// Emission of a black body at a temperature in kelvin, scaled to a maximum of one.
    Blackbody(f32),
    /// The standard illuminant of a colour space, its white.
    Illuminant(ColorSpaceDesc),
}

impl SpectrumDesc {
    /// A colour in sRGB primaries.
    pub fn rgb(r: f32, g: f32, b: f32) -> Self {
        Self::Rgb { rgb: [r, g, b], space: ColorSpaceDesc::Srgb }
    }
}

impl From<f32> for SpectrumDesc {
    fn from(value: f32) -> Self {
        Self::Constant(value)
    }
}
