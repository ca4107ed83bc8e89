//! The Halton sequence: dimension d is the radical inverse in the base of prime number d
//! [Pharr 2023 §8.6].
//!
//! All pixels take the first points of the sequence, each with digits permuted in its own way. With
//! [`Randomize::None`], each begins at a point of its own, chosen at random [Wang 2000]. The points
//! of a pixel have the low discrepancy of the sequence, and the errors of pixels are independent.
//! No number of samples is preferred, and beyond it the sequence continues.

use super::randomize::{Randomize, wrapped};
use crate::low_discrepancy::{
    PRIME_COUNT, owen_scrambled_radical_inverse, permuted_radical_inverse, radical_inverse,
};
use crate::mix_word;
use lanes::Each;
use math::Vec2;

/// Radical inverses in prime bases, randomised for each pixel, of any number of samples.
#[derive(Clone, Debug)]
pub struct Halton {
    samples_per_pixel: u32,
    randomize: Randomize,
    /// A hash of the seed.
    key: u32,
    pixel_hash: u32,
    index: u32,
    dimension: usize,
}

impl Halton {
    /// A sampler. [`Randomize::FastOwen`] is treated as [`Randomize::Owen`], as the fast hash is
    /// for base 2.
    pub fn new(samples_per_pixel: u32, randomize: Randomize, seed: u32) -> Halton {
        let samples_per_pixel = samples_per_pixel.max(1);
        Halton { samples_per_pixel, randomize, key: mix_word(seed), pixel_hash: 0, index: 0, dimension: 0 }
    }

    /// Randomisation, and the hash of the seed.
    pub fn parts(&self) -> (Randomize, u32) {
        (self.randomize, self.key)
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        let [x, y] = pixel.each(|i| i as u32);
        self.pixel_hash = mix_word(mix_word(self.key ^ x) ^ y);
        let start = if self.randomize == Randomize::None { self.pixel_hash } else { 0 };
        self.index = start.wrapping_add(index);
        self.dimension = dimension as usize;
    }

    #[inline]
    pub(super) fn dimension(&self) -> u32 {
        self.dimension as u32
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        let dimension = self.next_dimension(1);
        self.coordinate(dimension)
    }

    pub(super) fn get_2d(&mut self) -> Vec2 {
        let dimension = self.next_dimension(2);
        Vec2::new(self.coordinate(dimension), self.coordinate(dimension + 1))
    }

    pub(super) fn get_pixel_2d(&mut self) -> Vec2 {
        self.get_2d()
    }

    /// Allocates dimensions, starting again from the third when all are used.
    fn next_dimension(&mut self, count: usize) -> usize {
        let dimension = wrapped(self.dimension, count, PRIME_COUNT);
        self.dimension += count;
        dimension
    }

    fn coordinate(&self, dimension: usize) -> f32 {
        let hash = mix_word(self.pixel_hash ^ mix_word(dimension as u32));
        match self.randomize {
            Randomize::None => radical_inverse(dimension, self.index as u64),
            Randomize::PermuteDigits => permuted_radical_inverse(dimension, self.index, hash),
            Randomize::FastOwen | Randomize::Owen => {
                owen_scrambled_radical_inverse(dimension, self.index as u64, hash)
            }
        }
    }
}
