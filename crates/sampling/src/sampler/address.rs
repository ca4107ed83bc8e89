//! Coordinates by their address: computed from pixel, sample and dimension alone.

use lanes::{Each, Int, MAX_LANES};

/// Which coordinate of which sample, in each lane.
#[derive(Clone, Copy, Debug)]
pub struct Address<I = u32> {
    /// Column and row of the pixel, in two's complement.
    pub pixel: [I; 2],
    /// The index of the sample, the same in all lanes.
    pub index: u32,
    /// The first dimension of the coordinates.
    pub dimension: I,
}

impl Address {
    /// The first coordinate of a sample.
    pub(super) fn new(pixel: [i32; 2], index: u32, dimension: u32) -> Self {
        Self { pixel: pixel.each(|x| x as u32), index, dimension }
    }

    /// The current address; continues after `dimensions` more.
    pub(super) fn advance(&mut self, dimensions: u32) -> Self {
        let current = *self;
        self.dimension = self.dimension.wrapping_add(dimensions);
        current
    }
}

impl<I: Int> Address<I> {
    /// Continues after `dimensions` more.
    #[inline(always)]
    pub fn skip(&mut self, dimensions: u32) {
        self.dimension = self.dimension.wrapping_add(I::splat(dimensions));
    }

    /// The addresses of all lanes, in memory.
    #[inline(always)]
    pub(super) fn to_arrays(self) -> AddressArrays {
        let Self { pixel, index, dimension } = self;
        AddressArrays { pixel: pixel.each(I::to_array), index, dimension: dimension.to_array() }
    }
}

/// The lower 16 bits of `x` at the even places and those of `y` at the odd ones: a Morton code.
#[inline(always)]
pub(super) fn interleaved<I: Int>(x: I, y: I) -> I {
    spread(x) | spread(y).shl(1)
}

/// The lower 16 bits at the even places.
#[inline(always)]
fn spread<I: Int>(x: I) -> I {
    let mut spread = x & I::splat(0xffff);
    for (shift, mask) in [(8, 0x00ff_00ff), (4, 0x0f0f_0f0f), (2, 0x3333_3333), (1, 0x5555_5555)] {
        spread = (spread | spread.shl(shift)) & I::splat(mask);
    }
    spread
}

/// Addresses, lane by lane.
pub(super) struct AddressArrays {
    pub pixel: [[u32; MAX_LANES]; 2],
    pub index: u32,
    pub dimension: [u32; MAX_LANES],
}
