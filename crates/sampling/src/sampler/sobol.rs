//! Sobol' points of all dimensions: one sequence over a square of pixels, whose first two
//! dimensions are the position on the film [Pharr 2023 §8.7.1].
//!
//! On a square with side 2^m, every 2^(2m) successive points have one in each pixel. Which index
//! that is follows from the first 2m rows of the two matrices: a linear system over the binary
//! field, inverted here once. The number of samples is rounded up to a power of two; beyond it the
//! sequence continues.

use super::randomize::{Randomize, wrapped};
use crate::hash::hash;
use crate::low_discrepancy::{SOBOL_DIMENSIONS, sobol_digits};
use math::Vec2;
use std::sync::Arc;

/// Sobol' points of all dimensions, one sequence over the picture. The number of samples is rounded
/// up to a power of two; beyond it the sequence continues.
#[derive(Clone, Debug)]
pub struct Sobol {
    samples_per_pixel: u32,
    randomize: Randomize,
    /// A hash for each dimension.
    seeds: Arc<[u32]>,
    /// The side of the square of pixels is 2^log2_side.
    log2_side: u32,
    /// For each bit of the pixel (y's below x's), the low bits of the index that make it.
    index_from_pixel: Arc<[u64]>,
    index: u64,
    dimension: usize,
}

impl Sobol {
    /// A sampler for a picture of the given resolution, at most 2¹⁵ pixels on a side (beyond,
    /// positions repeat).
    pub fn new(samples_per_pixel: u32, resolution: [i32; 2], randomize: Randomize, seed: u32) -> Sobol {
        let side = resolution[0].max(resolution[1]).clamp(1, 1 << 15) as u32;
        let log2_side = side.next_power_of_two().ilog2();
        Sobol {
            samples_per_pixel: samples_per_pixel.clamp(1, 1 << 31).next_power_of_two(),
            randomize,
            seeds: (0..SOBOL_DIMENSIONS as u32).map(|dimension| hash(&[dimension, seed]) as u32).collect(),
            log2_side,
            index_from_pixel: index_from_pixel(log2_side),
            index: 0,
            dimension: 2,
        }
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        let m = self.log2_side;
        let [x, y] = pixel.map(|p| p as u64 & ((1 << m) - 1));
        let high = (index as u64) << (2 * m);
        let mut wanted = (x << m | y) ^ pixel_of(high, m);
        self.index = high;
        while wanted != 0 {
            self.index ^= self.index_from_pixel[wanted.trailing_zeros() as usize];
            wanted &= wanted - 1;
        }
        self.dimension = (dimension as usize).max(2);
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
        // The first digits are the pixel; the rest, which is the position in it, is randomised like
        // any dimension, or pictures of different seeds would have samples in common.
        let position = |dimension| {
            let digits = sobol_digits(self.index, dimension) >> self.log2_side;
            self.randomize.digits(digits, self.seeds[dimension])
        };
        Vec2::new(position(0), position(1))
    }

    /// Allocates dimensions, starting again from the third when all are used.
    fn next_dimension(&mut self, count: usize) -> usize {
        let dimension = wrapped(self.dimension, count, SOBOL_DIMENSIONS);
        self.dimension += count;
        dimension
    }

    fn coordinate(&self, dimension: usize) -> f32 {
        self.randomize.sobol(self.index, dimension, self.seeds[dimension])
    }
}

/// The pixel of point `index` on a square of side 2^m: m bits of x above m bits of y.
fn pixel_of(index: u64, m: u32) -> u64 {
    let [x, y] = [0, 1].map(|dimension| (sobol_digits(index, dimension).reverse_bits() as u64) << m >> 32);
    x << m | y
}

/// Inverts [`pixel_of`] on the indices below 2^(2m): its matrix is brought to the identity by
/// operations on columns, which bring the identity to the inverse.
fn index_from_pixel(m: u32) -> Arc<[u64]> {
    let size = 2 * m as usize;
    let mut columns: Vec<(u64, u64)> = (0..size).map(|bit| (pixel_of(1 << bit, m), 1 << bit)).collect();
    for bit in 0..size {
        let pivot = (bit..size)
            .find(|&k| columns[k].0 >> bit & 1 == 1)
            .expect("invariant: the first two Sobol' dimensions are a (0, 2)-sequence");
        columns.swap(bit, pivot);
        let (image, index) = columns[bit];
        for (k, column) in columns.iter_mut().enumerate() {
            if k != bit && column.0 >> bit & 1 == 1 {
                column.0 ^= image;
                column.1 ^= index;
            }
        }
    }
    columns.into_iter().map(|(_, index)| index).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_sample_lies_in_its_pixel() {
        for side in [1, 2, 5, 64, 1920] {
            let mut sampler = Sobol::new(4, [side, 1], Randomize::None, 0);
            let m = sampler.log2_side;
            for i in 0..50 {
                let pixel = [(i * 37) % side, (i * 101 + 3) % side];
                for index in [0, 1, 7, 1000] {
                    sampler.start_pixel_sample(pixel, index, 0);
                    assert_eq!(pixel_of(sampler.index, m), (pixel[0] as u64) << m | pixel[1] as u64);
                    assert_eq!(sampler.index >> (2 * m), index as u64);
                }
            }
        }
    }
}
