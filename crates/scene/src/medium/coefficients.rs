//! Coefficients of absorption and scattering.

use super::MediumProperties;
use spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// Coefficients of absorption and scattering where the density is 1, per unit of length.
#[derive(Clone, Debug)]
pub struct Coefficients {
    /// Absorption, without `scale`.
    pub sigma_a: Spectrum,
    /// Scattering, without `scale`.
    pub sigma_s: Spectrum,
    /// Factor on both.
    pub scale: f32,
}

impl Coefficients {
    /// The properties at a density, without emission.
    #[inline]
    pub(super) fn at(&self, density: f32, lambda: &SampledWavelengths) -> MediumProperties {
        let [sigma_a, sigma_s] = [&self.sigma_a, &self.sigma_s];
        let scale = self.scale * density;
        MediumProperties {
            sigma_a: sigma_a.sample(lambda) * scale,
            sigma_s: sigma_s.sample(lambda) * scale,
            le: SampledSpectrum::ZERO,
        }
    }
}
