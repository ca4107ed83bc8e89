//! Independent uniform random numbers: the reference for other samplers.
//!
//! A number is a hash of its address, so that any of them can be computed on its own.

use super::address::Address;
use crate::hash::{mix_quadruple, mix_word, unit_interval};
use lanes::Int;
use math::Vec2;

/// Uniform random numbers, any number of them.
#[derive(Clone, Debug)]
pub struct Independent {
    samples_per_pixel: u32,
    /// A hash of the seed.
    key: u32,
    address: Address,
}

impl Independent {
    /// A sampler of any number of samples.
    pub fn new(samples_per_pixel: u32, seed: u32) -> Independent {
        let address = Address::new([0; 2], 0, 0);
        Independent { samples_per_pixel: samples_per_pixel.max(1), key: mix_word(seed), address }
    }

    /// The hash of the seed.
    pub fn key(&self) -> u32 {
        self.key
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        self.address = Address::new(pixel, index, dimension);
    }

    #[inline]
    pub(super) fn dimension(&self) -> u32 {
        self.address.dimension
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        let address = self.address.advance(1);
        self.at_1d(&address)
    }

    pub(super) fn get_2d(&mut self) -> Vec2 {
        let address = self.address.advance(2);
        let [x, y] = self.at_2d(&address);
        Vec2::new(x, y)
    }

    pub(super) fn get_pixel_2d(&mut self) -> Vec2 {
        self.get_2d()
    }

    /// The number at an address.
    #[inline(always)]
    pub(super) fn at_1d<I: Int>(&self, address: &Address<I>) -> I::Real {
        self.at_2d(address)[0]
    }

    /// Two numbers at an address.
    #[inline(always)]
    pub(super) fn at_2d<I: Int>(&self, address: &Address<I>) -> [I::Real; 2] {
        let Address { pixel: [x, y], index, dimension } = *address;
        let [a, b, ..] = mix_quadruple([x, y, I::splat(index ^ self.key), dimension]);
        [unit_interval(a), unit_interval(b)]
    }
}
