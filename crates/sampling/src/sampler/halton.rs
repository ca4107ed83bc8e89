//! The Halton sequence: dimension d is the radical inverse in the base of prime number d, one
//! sequence over a tile of the picture whose first two dimensions are the position on the film
//! [Pharr 2023 §8.6].
//!
//! On a tile of 2^j × 3^k pixels every 2^j·3^k successive points have one in each pixel; which one
//! follows from the Chinese remainder theorem. Tiles of 128 pixels repeat over larger pictures. No
//! number of samples is preferred, and beyond it the sequence continues. [`Randomize::FastOwen`] is
//! treated as [`Randomize::Owen`], as the fast hash is for base 2.

use super::randomize::Randomize;
use crate::low_discrepancy::{
    DigitPermutations, PRIME_COUNT, inverse_radical_inverse, owen_scrambled_radical_inverse, radical_inverse,
};
use crate::mix_bits;
use math::Vec2;
use std::sync::{Arc, OnceLock};

/// The largest side of the tile that the first two dimensions cover.
const MAX_TILE: i32 = 128;

/// Radical inverses in prime bases, one sequence over the picture, of any number of samples.
#[derive(Clone, Debug)]
pub struct Halton {
    samples_per_pixel: u32,
    randomize: Randomize,
    seed: u32,
    /// Those of each dimension, made when it is first asked for.
    permutations: Arc<[OnceLock<DigitPermutations>]>,
    /// 2^j and 3^k, the sides of the tile, and the exponents.
    scales: [u64; 2],
    exponents: [u32; 2],
    /// For each axis, the index (modulo both sides) that is 1 modulo its own side and 0 modulo the
    /// other.
    units: [u64; 2],
    index: u64,
    dimension: usize,
}

impl Halton {
    /// A sampler for a picture of the given resolution. [`Randomize::FastOwen`] is treated as
    /// [`Randomize::Owen`].
    pub fn new(samples_per_pixel: u32, resolution: [i32; 2], randomize: Randomize, seed: u32) -> Halton {
        let mut scales = [1u64; 2];
        let mut exponents = [0; 2];
        for (axis, base) in [2, 3].into_iter().enumerate() {
            while scales[axis] < resolution[axis].clamp(1, MAX_TILE) as u64 {
                scales[axis] *= base;
                exponents[axis] += 1;
            }
        }
        let [width, height] = scales;
        // The sides are small and have no common factor, so that a search finds the one solution.
        let unit = |own: u64, other: u64| {
            (0..own).map(|k| k * other).find(|index| index % own == 1 % own).unwrap_or_default()
        };
        Halton {
            samples_per_pixel: samples_per_pixel.max(1),
            randomize,
            seed,
            permutations: (0..PRIME_COUNT).map(|_| OnceLock::new()).collect(),
            scales,
            exponents,
            units: [unit(width, height), unit(height, width)],
            index: 0,
            dimension: 2,
        }
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        let stride = self.scales[0] * self.scales[1];
        let mut first = 0;
        for (axis, base) in [2, 3].into_iter().enumerate() {
            let place = pixel[axis].rem_euclid(MAX_TILE) as u64;
            first += inverse_radical_inverse(place, base, self.exponents[axis]) * self.units[axis];
        }
        self.index = first % stride + index as u64 * stride;
        self.dimension = (dimension as usize).max(2);
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        let dimension = self.next_dimension(1);
        self.coordinate(dimension, self.index)
    }

    pub(super) fn get_2d(&mut self) -> Vec2 {
        let dimension = self.next_dimension(2);
        Vec2::new(self.coordinate(dimension, self.index), self.coordinate(dimension + 1, self.index))
    }

    pub(super) fn get_pixel_2d(&mut self) -> Vec2 {
        // The low digits are the pixel; the others, which are the position in it, are randomised
        // like those of any dimension, or pictures of different seeds would have samples in common.
        let position = |axis: usize| self.coordinate(axis, self.index / self.scales[axis]);
        Vec2::new(position(0), position(1))
    }

    /// Allocates dimensions, starting again from the third when all are used.
    fn next_dimension(&mut self, count: usize) -> usize {
        if self.dimension + count > PRIME_COUNT {
            self.dimension = 2;
        }
        let dimension = self.dimension;
        self.dimension += count;
        dimension
    }

    fn coordinate(&self, dimension: usize, index: u64) -> f32 {
        match self.randomize {
            Randomize::None => radical_inverse(dimension, index),
            Randomize::PermuteDigits => self.permutations[dimension]
                .get_or_init(|| DigitPermutations::new(dimension, self.seed))
                .radical_inverse(index),
            Randomize::FastOwen | Randomize::Owen => {
                let hash = mix_bits((1 + ((dimension as u64) << 4)) ^ ((self.seed as u64) << 32));
                owen_scrambled_radical_inverse(dimension, index, hash as u32)
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_lies_in_its_pixel() {
        for resolution in [[1, 1], [10, 7], [128, 100], [1000, 2]] {
            let mut sampler = Halton::new(4, resolution, Randomize::None, 0);
            for i in 0..100 {
                let pixel = [(i * 37) % resolution[0].min(128), (i * 11) % resolution[1].min(128)];
                for index in [0, 1, 12] {
                    sampler.start_pixel_sample(pixel, index, 0);
                    // The position on the film has the low digits of the index as its high digits.
                    let place = |axis: usize, base| {
                        let low = sampler.index % sampler.scales[axis];
                        inverse_radical_inverse(low, base, sampler.exponents[axis]) as i32
                    };
                    assert_eq!([place(0, 2), place(1, 3)], pixel);
                }
            }
        }
    }
}
