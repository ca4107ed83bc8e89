//! The medium under a surface.

use crate::HenyeyGreenstein;
use spectrum::SampledSpectrum;

/// The medium under a surface, for random walks.
#[derive(Clone, Copy, Debug)]
pub struct Interior<R = f32> {
    /// The coefficient of scattering per unit of length.
    pub sigma_s: SampledSpectrum<R>,
    /// The coefficient of extinction.
    pub sigma_t: SampledSpectrum<R>,
    /// How it scatters.
    pub phase: HenyeyGreenstein<R>,
    /// The index of refraction by which the surface reflects from inside, below over above.
    pub eta: R,
}
