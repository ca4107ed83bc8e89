//! The first one or two Sobol' dimensions for each call, their order shuffled and their values
//! scrambled by pixel and dimension, so that each pair of dimensions is stratified and all are
//! independent [Pharr 2023 §8.7.2].
//!
//! A number of samples that is no power of two is not rounded; strata are then filled unevenly.
//! Beyond it the sequence continues.

use super::randomize::{Randomize, pixel_hash, shuffled};
use math::Vec2;

/// Two-dimensional Sobol' points, randomised for each pair of dimensions of each pixel. The number
/// of samples is best a power of two; beyond it the sequence continues.
#[derive(Clone, Debug)]
pub struct PaddedSobol {
    samples_per_pixel: u32,
    randomize: Randomize,
    seed: u32,
    pixel: [i32; 2],
    index: u32,
    dimension: u32,
}

impl PaddedSobol {
    /// A sampler, best with a power of two of samples.
    pub fn new(samples_per_pixel: u32, randomize: Randomize, seed: u32) -> PaddedSobol {
        let samples_per_pixel = samples_per_pixel.max(1);
        PaddedSobol { samples_per_pixel, randomize, seed, pixel: [0; 2], index: 0, dimension: 0 }
    }

    /// The randomisation and the seed.
    pub fn parts(&self) -> (Randomize, u32) {
        (self.randomize, self.seed)
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        (self.pixel, self.index, self.dimension) = (pixel, index, dimension);
    }

    #[inline]
    pub(super) fn dimension(&self) -> u32 {
        self.dimension
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        let (index, hash) = self.next_index(1);
        self.randomize.sobol(index, 0, (hash >> 32) as u32)
    }

    pub(super) fn get_2d(&mut self) -> Vec2 {
        let (index, hash) = self.next_index(2);
        let x = self.randomize.sobol(index, 0, hash as u32);
        Vec2::new(x, self.randomize.sobol(index, 1, (hash >> 32) as u32))
    }

    pub(super) fn get_pixel_2d(&mut self) -> Vec2 {
        self.get_2d()
    }

    /// The point of the sequence that this sample takes in the next dimensions, and their hash.
    fn next_index(&mut self, dimensions: u32) -> (u64, u64) {
        let hash = pixel_hash(self.pixel, self.dimension, self.seed);
        self.dimension += dimensions;
        let (place, round) = shuffled(self.index, self.samples_per_pixel, hash as u32);
        (round as u64 * self.samples_per_pixel as u64 + place as u64, hash)
    }
}
