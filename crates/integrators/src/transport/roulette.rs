//! Russian roulette: paths that carry little end early, and those that survive count for more.
//!
//! From the second scattering event on a path survives with the probability q = min(1, c_max),
//! where c_max is the largest component of what it carries, and is then divided by q. Radiance that
//! refraction has compressed by η² is given without that factor, so that what is seen through glass
//! is not cut off early. [Pharr 2023 §13.4.4]

use sampling::Sampler;
use spectrum::SampledSpectrum;

/// The probability with which a path of `depth` scattering events that carries `carried` has
/// survived, to be divided by; `None` if it has ended. Takes a random number where that may happen.
#[inline]
pub(crate) fn survival(depth: u32, carried: SampledSpectrum, sampler: &mut Sampler) -> Option<f32> {
    let probability = carried.max_component();
    if depth > 1 && probability < 1.0 {
        (probability > 0.0 && sampler.get_1d() < probability).then_some(probability)
    } else {
        Some(1.0)
    }
}
