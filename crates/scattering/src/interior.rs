//! The medium under a surface.

use crate::HenyeyGreenstein;
use spectrum::SampledSpectrum;

/// The medium under a surface, for random walks.
#[derive(Clone, Copy, Debug)]
pub struct Interior {
    /// The coefficient of scattering per unit of length.
    pub sigma_s: SampledSpectrum,
    /// The coefficient of extinction.
    pub sigma_t: SampledSpectrum,
    /// How it scatters.
    pub phase: HenyeyGreenstein,
    /// The index of refraction by which the surface reflects from inside, below over above.
    pub eta: f32,
}
