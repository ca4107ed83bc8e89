//! Independent uniform random numbers: the reference for other samplers.

use crate::Rng;
use crate::hash::hash;
use math::Vec2;

/// Uniform random numbers, any number of them.
#[derive(Clone, Debug)]
pub struct Independent {
    samples_per_pixel: u32,
    seed: u32,
    rng: Rng,
}

impl Independent {
    /// A sampler of any number of samples.
    pub fn new(samples_per_pixel: u32, seed: u32) -> Independent {
        Independent { samples_per_pixel: samples_per_pixel.max(1), seed, rng: Rng::new(0, 0) }
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        self.rng = pixel_rng(pixel, index, dimension, self.seed);
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        self.rng.uniform_f32()
    }

    pub(super) fn get_2d(&mut self) -> Vec2 {
        let x = self.get_1d();
        Vec2::new(x, self.get_1d())
    }

    pub(super) fn get_pixel_2d(&mut self) -> Vec2 {
        self.get_2d()
    }
}

/// A generator for one sample of a pixel: a sequence for the pixel, and 2¹⁶ numbers of it for
/// the sample.
pub(super) fn pixel_rng(pixel: [i32; 2], index: u32, dimension: u32, seed: u32) -> Rng {
    let mut rng = Rng::from_sequence(hash(&[pixel[0] as u32, pixel[1] as u32, seed]));
    rng.advance(index as u64 * 65536 + dimension as u64);
    rng
}
