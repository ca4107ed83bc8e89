//! Coordinates by their address: computed from pixel, sample and dimension alone.

use lanes::Int;

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
        Self { pixel: pixel.map(|x| x as u32), index, dimension }
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

    /// The address in one lane.
    #[inline]
    pub(super) fn lane(&self, lane: usize) -> Address {
        let [x, y] = self.pixel.map(|x| x.to_array()[lane]);
        Address { pixel: [x, y], index: self.index, dimension: self.dimension.to_array()[lane] }
    }
}
