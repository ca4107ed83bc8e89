//! Russian roulette: paths of low throughput are ended at random, and survivors are weighted up.
//!
//! From the second scattering event on a path survives with the probability q = min(1, c_max),
//! where c_max is the largest component of its throughput, which is then divided by q. The
//! throughput is taken without the factors η² of refraction, so that paths through glass do not end
//! early. [Pharr 2023 §13.4.4]

use sampling::Sampler;
use spectrum::SampledSpectrum;

/// The survival probability of a path with `depth` scattering events and the throughput `carried`,
/// to be divided by; `None` if it has ended. Takes a random number unless the probability is 1.
#[inline]
pub(crate) fn survival(depth: u32, carried: SampledSpectrum, sampler: &mut Sampler) -> Option<f32> {
    let probability = carried.max_component();
    if depth > 1 && probability < 1.0 {
        (probability > 0.0 && sampler.get_1d() < probability).then_some(probability)
    } else {
        Some(1.0)
    }
}
