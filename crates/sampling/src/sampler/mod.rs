//! Samplers: the coordinates of each sample of each pixel.
//!
//! A [`Sampler`] is set to a sample by [`Sampler::start_pixel_sample`] and then asked for one or
//! two coordinates after another; each call moves on to further dimensions. Values lie in [0, 1)
//! and depend on the sampler's settings, pixel, sample index, dimension and seed alone, so that any
//! sample can be replayed, from any clone, in any order.
//!
//! [`Sampler::samples_per_pixel`] is the count for which a sampler is arranged; some round up what
//! was asked for. Indices beyond it are valid: the sequence goes on, or a further arrangement,
//! randomised anew, is begun. The mean over pixels and seeds is right at any count, save that
//! nothing is random with [`Randomize::None`] in [`PaddedSobol`], [`Sobol`] and [`ZSobol`], which
//! is there to look at.

mod halton;
mod independent;
mod padded_sobol;
mod primary_sample;
mod sobol;
mod stratified;
mod zsobol;

pub use halton::Halton;
pub use independent::Independent;
pub use padded_sobol::PaddedSobol;
pub use primary_sample::PrimarySample;
pub use sobol::Sobol;
pub use stratified::Stratified;
pub use zsobol::ZSobol;

use crate::low_discrepancy::{fast_owen_scramble, owen_scramble, sobol_bits};
use crate::{hash, unit_interval};
use math::Vec2;

/// How a low-discrepancy sequence is made random.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Randomize {
    /// Not at all.
    None,
    /// Each digit is permuted, alike in all points.
    PermuteDigits,
    /// Each digit is permuted by the digits before it, through a hash that does so in a few steps.
    #[default]
    FastOwen,
    /// Each digit is permuted by the digits before it, one by one.
    Owen,
}

impl Randomize {
    /// A Sobol' coordinate made random by `seed`.
    #[inline]
    fn sobol(self, index: u64, dimension: usize, seed: u32) -> f32 {
        self.bits(sobol_bits(index, dimension), seed)
    }

    /// A binary fraction of 32 bits, made random by `seed`.
    #[inline]
    fn bits(self, bits: u32, seed: u32) -> f32 {
        unit_interval(match self {
            Randomize::None => bits,
            Randomize::PermuteDigits => bits ^ seed,
            Randomize::FastOwen => fast_owen_scramble(bits, seed),
            Randomize::Owen => owen_scramble(bits, seed),
        })
    }
}

/// The source of a pixel sample's coordinates.
#[derive(Clone, Debug)]
pub enum Sampler {
    /// Uniform random numbers.
    Independent(Independent),
    /// One sample in each cell of a grid.
    Stratified(Stratified),
    /// Radical inverses in prime bases, one sequence over the picture.
    Halton(Halton),
    /// Two-dimensional Sobol' points, randomised for each pair of dimensions of each pixel.
    PaddedSobol(PaddedSobol),
    /// Sobol' points of all dimensions, one sequence over the picture.
    Sobol(Sobol),
    /// Two-dimensional Sobol' points, spread over the picture along a curve: error becomes blue
    /// noise.
    ZSobol(ZSobol),
    /// Uniform random numbers that can be changed step by step.
    PrimarySample(PrimarySample),
}

macro_rules! each_sampler {
    ($self:expr, $sampler:ident => $result:expr) => {
        match $self {
            Sampler::Independent($sampler) => $result,
            Sampler::Stratified($sampler) => $result,
            Sampler::Halton($sampler) => $result,
            Sampler::PaddedSobol($sampler) => $result,
            Sampler::Sobol($sampler) => $result,
            Sampler::ZSobol($sampler) => $result,
            Sampler::PrimarySample($sampler) => $result,
        }
    };
}

impl Sampler {
    /// The number of samples per pixel for which this sampler is arranged.
    pub fn samples_per_pixel(&self) -> u32 {
        each_sampler!(self, sampler => sampler.samples_per_pixel())
    }

    /// Goes to sample `index` of a pixel, at the coordinate `dimension`. A sample begins with
    /// dimension 0, and [`get_pixel_2d`](Self::get_pixel_2d) is to be its first coordinates.
    #[inline]
    pub fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        each_sampler!(self, sampler => sampler.start_pixel_sample(pixel, index, dimension));
    }

    /// The next coordinate.
    #[inline]
    pub fn get_1d(&mut self) -> f32 {
        each_sampler!(self, sampler => sampler.get_1d())
    }

    /// The next two coordinates.
    #[inline]
    pub fn get_2d(&mut self) -> Vec2 {
        each_sampler!(self, sampler => sampler.get_2d())
    }

    /// The coordinates of the sample within its pixel.
    #[inline]
    pub fn get_pixel_2d(&mut self) -> Vec2 {
        each_sampler!(self, sampler => sampler.get_pixel_2d())
    }
}

/// A hash for what is drawn for one dimension of one pixel.
#[inline]
fn pixel_hash(pixel: [i32; 2], dimension: u32, seed: u32) -> u64 {
    hash(&[pixel[0] as u32, pixel[1] as u32, dimension, seed])
}

/// A place in a shuffled arrangement of `count` samples, and which arrangement it is that `index`
/// falls in. The first is shuffled by `seed` itself, each further one by a seed of its own.
#[inline]
fn shuffled(index: u32, count: u32, seed: u32) -> (u32, u32) {
    let (round, index) = (index / count, index % count);
    let seed = if round == 0 { seed } else { hash(&[seed, round]) as u32 };
    (crate::permutation_element(index, count, seed), round)
}
