//! Russian roulette: paths of low throughput are ended at random, and survivors are weighted up.
//!
//! From the second scattering event on a path survives with a probability q, by which its
//! throughput is then divided. [Pharr 2023 §13.4.4] has q = min(1, c_max), where c_max is the
//! largest component of the throughput, taken without the factors η² of refraction, so that paths
//! through glass do not end early. Subpaths of bidirectional methods and light paths have this q,
//! too, as each of their vertices costs connections.
//!
//! Camera paths have q = min(1, 3 c_max) ([`camera_path_survival`]). Their vertices are cheap, and
//! a path that ends by chance is no longer spread evenly by the sampler: the log of the wavefront
//! in `docs/measurements` has figures.

use lanes::{Int, Real};
use sampling::Sampler;
use spectrum::SampledSpectrum;

/// A path of this survival probability or more survives. It is below 1 so that rounding errors of
/// paths that lose no light, such as those through glass, do not decide whether they take a random
/// number.
const CERTAIN: f32 = 0.999;

/// Whether a path plays that has been scattered so many times and survives with a probability.
#[inline(always)]
pub(crate) fn plays_roulette<R: Real>(depth: R::Int, probability: R) -> R::Mask {
    !depth.lt(R::Int::splat(2)) & probability.lt(R::splat(CERTAIN))
}

/// The survival probability of a camera path with the throughput `carried`; may be above one.
#[inline(always)]
pub(crate) fn camera_path_survival<R: Real>(carried: SampledSpectrum<R>) -> R {
    carried.max_component() * R::splat(3.0)
}

/// What the throughput of a path with `depth` scattering events is to be divided by: the survival
/// probability, or one where that is larger; `None` if the path has ended. Takes a random number
/// unless survival is certain.
#[inline]
pub(crate) fn survival(depth: u32, probability: f32, sampler: &mut Sampler) -> Option<f32> {
    if plays_roulette(depth, probability) {
        (probability > 0.0 && sampler.get_1d() < probability).then_some(probability)
    } else {
        Some(1.0)
    }
}
