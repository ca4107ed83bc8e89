//! The light of light samples, after its passage through media.

use spectrum::SampledSpectrum;

use super::{Heroes, Passage};
use crate::transport::direct::power_heuristic;

/// The light of a light sample at a vertex, as if its shadow ray passed nothing.
pub(crate) struct Arrival {
    /// β·f·|cos|·L over the density p_l of the light sample.
    pub l: SampledSpectrum,
    /// The density of the path up to the vertex at each wavelength, over that of the hero.
    pub r_u: SampledSpectrum,
    /// The density with which scattering finds the light over p_l; 0 where it cannot.
    pub ratio: f32,
}

impl Arrival {
    /// The light after a passage, weighted against that of scattering.
    #[inline]
    pub fn through(&self, passage: &Passage, heroes: &Heroes) -> SampledSpectrum {
        let by_light = heroes.mean(self.r_u * passage.r_l);
        let by_scattering = heroes.mean(self.r_u * passage.r_u) * self.ratio;
        if by_light > 0.0 {
            self.l * passage.t * (power_heuristic(by_light, by_scattering) / by_light)
        } else {
            SampledSpectrum::ZERO
        }
    }
}
