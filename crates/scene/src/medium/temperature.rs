//! Emission of hot media: fire.

use description::TemperatureDesc;
use spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// The temperature below which nothing is emitted, in kelvin: even its reddest light is too faint.
const COLDEST: f32 = 100.0;

/// A conversion of stored values to blackbody emission.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Temperature {
    /// Subtracted from values.
    pub offset: f32,
    /// Factor that gives kelvin.
    pub scale: f32,
}

impl From<TemperatureDesc> for Temperature {
    fn from(TemperatureDesc { offset, scale }: TemperatureDesc) -> Self {
        Self { offset, scale }
    }
}

impl Temperature {
    /// The radiance of a blackbody at the temperature of a stored value, with the maximum 1 over
    /// all wavelengths.
    pub(super) fn le(&self, value: f32, lambda: &SampledWavelengths) -> SampledSpectrum {
        let kelvin = (value - self.offset) * self.scale;
        if kelvin > COLDEST { Spectrum::blackbody(kelvin).sample(lambda) } else { SampledSpectrum::ZERO }
    }
}
