//! A light's spectrum and its scale.

use spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// What a light emits: `scale · spectrum(λ)`.
#[derive(Clone, Debug)]
pub struct Emission {
    /// Shape of the spectrum.
    pub spectrum: Spectrum,
    /// Factor.
    pub scale: f32,
}

impl Emission {
    /// Values at the wavelengths.
    #[inline]
    pub fn sample(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.spectrum.sample(lambda) * self.scale
    }

    /// The largest value over all wavelengths.
    pub fn max_value(&self) -> f32 {
        self.spectrum.max_value() * self.scale
    }
}
