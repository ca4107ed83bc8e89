//! Russian roulette: paths of low throughput are ended at random, and survivors are weighted up.
//!
//! From the second scattering event on a path survives with the probability q = min(1, c_max),
//! where c_max is the largest component of its throughput, which is then divided by q. The
//! throughput is taken without the factors η² of refraction, so that paths through glass do not end
//! early. [Pharr 2023 §13.4.4]

use sampling::Sampler;
use spectrum::SampledSpectrum;

/// A path of this survival probability or more survives. It is below 1 so that rounding errors of
/// paths that lose no light, such as those through glass, do not decide whether they take a random
/// number.
pub(crate) const CERTAIN: f32 = 0.999;

/// The survival probability of a path with `depth` scattering events and the throughput `carried`,
/// to be divided by; `None` if it has ended. Takes a random number unless survival is certain.
#[inline]
pub(crate) fn survival(depth: u32, carried: SampledSpectrum, sampler: &mut Sampler) -> Option<f32> {
    let probability = carried.max_component();
    if depth > 1 && probability < CERTAIN {
        (probability > 0.0 && sampler.get_1d() < probability).then_some(probability)
    } else {
        Some(1.0)
    }
}
