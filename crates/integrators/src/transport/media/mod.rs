//! Flight through participating media: where a ray interacts with them, and how much light passes.
//!
//! A flight samples the distance to the next interaction by delta tracking. Tentative collisions
//! have the density σ_maj·T_maj at one wavelength, with T_maj = exp(−∫σ_maj); each is real
//! with probability σ_t/σ_maj, else a null collision that changes nothing. At a real one light is
//! scattered, and the path throughput is multiplied by the albedo σ_s/σ_t. In a homogeneous medium
//! σ_maj = σ_t, and every collision is real.
//!
//! As only one wavelength chooses, the hero, the others may be badly sampled by it. Each of the
//! four would have chosen the same path with a density p_i, so it is weighted by the balance
//! heuristic over them: spectral MIS. A [`Throughput`] carries β = f/p and the rescaled densities
//! r_u = p_i/p, where p is the density of the hero, and β/mean(r_u) is the estimate ([Wilkie 2014];
//! [Miller 2019]; [Pharr 2023 §14.2.2]). r_l are the densities, over p, with which light sampling
//! at the last vertex would have found the path.
//!
//! Subpaths that are connected to others choose a new hero for each flight, with probabilities in
//! proportion to β, and divide β by the mean density with these weights. Their flights are then
//! independent of each other, and as heroes have large throughputs no β grows beyond the sum of
//! all.
//!
//! Shadow rays estimate their transmittance: exactly in homogeneous media, and in others by ratio
//! tracking, the product of σ_n/σ_maj = 1 − σ_t/σ_maj over all tentative collisions.

mod arrival;
mod flight;
mod passage;
#[cfg(test)]
mod tests;
mod throughput;

pub(crate) use arrival::Arrival;
pub(crate) use flight::{Flight, FlightEnd};
pub(crate) use passage::Passage;
pub(crate) use throughput::{Heroes, SpectralMis, Throughput};

use lanes::exp;
use sampling::{Rng, hash, warp};
use spectrum::SampledSpectrum;

use super::Tracer;

impl Tracer<'_> {
    /// The random numbers of a flight.
    #[inline]
    pub(super) fn collisions(&mut self) -> Collisions {
        Collisions::new(self.two_numbers())
    }

    /// The coordinates of the sample that a flight or shadow ray takes.
    #[inline]
    pub(crate) fn two_numbers(&mut self) -> [f32; 2] {
        [self.sampler.get_1d(), self.sampler.get_1d()]
    }
}

/// The random numbers of the collisions along a flight or shadow ray: the first is a coordinate of
/// the sample, the others follow from two of them.
pub(super) struct Collisions {
    /// The number of the next free path.
    u: f32,
    rng: Rng,
}

impl Collisions {
    #[inline]
    fn new([first, seed]: [f32; 2]) -> Self {
        Self { u: first, rng: Rng::from_sequence(hash(&[first.to_bits(), seed.to_bits()])) }
    }

    /// The distance to the next collision in a medium of extinction `sigma`; infinite without any.
    #[inline]
    pub fn free_path(&mut self, sigma: f32) -> f32 {
        let u = std::mem::replace(&mut self.u, self.rng.uniform_f32());
        if sigma == 0.0 { f32::INFINITY } else { warp::sample_exponential(u, sigma) }
    }

    /// A number that is uniform in [0, 1).
    #[inline]
    pub fn uniform(&mut self) -> f32 {
        self.rng.uniform_f32()
    }
}

/// exp(−σ·d).
#[inline]
pub(super) fn attenuation(sigma: SampledSpectrum, distance: f32) -> SampledSpectrum {
    sigma.map(|sigma| exp(-sigma * distance))
}
