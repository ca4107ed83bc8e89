//! Randomisation that samplers share: scrambled Sobol' coordinates, and shuffled sets of samples.

use crate::hash::{hash, permutation_element, unit_interval};
use crate::low_discrepancy::{fast_owen_scramble, owen_scramble, reverse_bits, sobol_digits};
use lanes::Int;

/// How a low-discrepancy sequence is randomised.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Randomize {
    /// Not at all.
    None,
    /// Each digit is permuted depending on its position alone.
    PermuteDigits,
    /// Owen scrambling by a hash: each digit is permuted depending on the digits before it.
    #[default]
    FastOwen,
    /// Owen scrambling digit by digit.
    Owen,
}

impl Randomize {
    /// A Sobol' coordinate, randomised by `seed`.
    #[inline]
    pub(super) fn sobol(self, index: u64, dimension: usize, seed: u32) -> f32 {
        self.digits(sobol_digits(index, dimension), seed)
    }

    /// The number with these 32 binary digits, the first of which is the lowest bit, randomised by
    /// `seed`.
    #[inline(always)]
    pub(super) fn digits<I: Int>(self, digits: I, seed: I) -> I::Real {
        let digits = match self {
            Randomize::None => digits,
            Randomize::PermuteDigits => digits ^ reverse_bits(seed),
            Randomize::FastOwen => fast_owen_scramble(digits, seed),
            Randomize::Owen => owen_scramble(digits, seed),
        };
        unit_interval(reverse_bits(digits))
    }
}

/// The first of `count` dimensions from `dimension` on where there are `total`: those beyond start
/// again from the third.
#[inline]
pub(super) fn wrapped(dimension: usize, count: usize, total: usize) -> usize {
    if dimension + count <= total { dimension } else { 2 + (dimension - 2) % (total - 3) }
}

/// A hash of one dimension of one pixel.
#[inline]
pub(super) fn pixel_hash(pixel: [i32; 2], dimension: u32, seed: u32) -> u64 {
    hash(&[pixel[0] as u32, pixel[1] as u32, dimension, seed])
}

/// The position of sample `index` in a shuffled set of `count` samples, and the number of that set.
/// The first set is shuffled by `seed` itself, each further one by a seed of its own.
#[inline]
pub(super) fn shuffled(index: u32, count: u32, seed: u32) -> (u32, u32) {
    let (round, index) = (index / count, index % count);
    let seed = if round == 0 { seed } else { hash(&[seed, round]) as u32 };
    (permutation_element(index, count, seed), round)
}
