//! Progressive multi-jittered (0, 2) points with blue noise between pixels.
//!
//! A sequence is progressive multi-jittered (0, 2) if each prefix of 2ᵏ points has one in each
//! elementary interval of area 2⁻ᵏ: every 2ⁱ × 2ᵏ⁻ⁱ grid of cells [Christensen 2018]. Sobol' points
//! of two dimensions under Owen scrambling have this property [Helmer 2021], so that no table of
//! points is needed: for each call, the samples of all pixels of a tile are the points of one such
//! sequence.
//!
//! Sample and pixel choose their point by an index, the Morton code of the pixel in its tile above
//! the number of the sample. Each bit of the index is flipped or not by a hash of the bits above it
//! (Owen scrambling of the mirrored index, [Burley 2020]), which leaves together what differs in
//! the lower bits alone. So not only each pixel and each prefix of 2ᵏ of its samples, but also each
//! pair of pixels, each square of 2 × 2 and so on along the Z-order curve has an aligned block of
//! the sequence, which is a (0, 2)-net: neighbours take complementary points, their errors cancel,
//! and low frequencies of the error are weak.
//!
//! pbrt-v4 has tables of points that also keep their distance, and shifts them by the values of
//! blue-noise textures, which moves them between elementary intervals.
//!
//! A round has the next power of two of samples, of which a pixel takes the first where that is
//! more than it is to take. Each further round has a sequence of its own. So have tiles, of 2¹⁶
//! pixels a side where there is one sample per pixel, and of 2¹³ where there are 64.

use super::address::{Address, interleaved};
use super::randomize::Randomize;
use crate::low_discrepancy::{fast_owen_scramble, pascal_digits, reverse_bits};
use crate::mix_word;
use lanes::{Each, Int};
use math::Vec2;

/// Progressive multi-jittered (0, 2) points, distributed over pixels along a Z-order curve, in
/// rounds of the next power of two of samples, each with points of its own.
#[derive(Clone, Debug)]
pub struct Pmj02Bn {
    samples_per_pixel: u32,
    /// Of the samples of a round.
    log2_samples: u32,
    /// A hash of the seed.
    key: u32,
    address: Address,
}

impl Pmj02Bn {
    /// A sampler, best with a power of four of samples.
    pub fn new(samples_per_pixel: u32, seed: u32) -> Pmj02Bn {
        let samples_per_pixel = samples_per_pixel.clamp(1, 1 << 31);
        let log2_samples = samples_per_pixel.next_power_of_two().ilog2();
        let address = Address::new([0; 2], 0, 0);
        Pmj02Bn { samples_per_pixel, log2_samples, key: mix_word(seed), address }
    }

    /// The binary logarithm of the samples of a round, and the hash of the seed.
    pub fn parts(&self) -> (u32, u32) {
        (self.log2_samples, self.key)
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

    /// The coordinate at an address.
    #[inline(always)]
    pub(super) fn at_1d<I: Int>(&self, address: &Address<I>) -> I::Real {
        let (point, hash) = self.point(address);
        Randomize::FastOwen.digits(point, hash)
    }

    /// The two coordinates at an address.
    #[inline(always)]
    pub(super) fn at_2d<I: Int>(&self, address: &Address<I>) -> [I::Real; 2] {
        let (point, hash) = self.point(address);
        let y = pascal_digits(point, I::splat(0));
        [Randomize::FastOwen.digits(point, hash), Randomize::FastOwen.digits(y, other(hash))]
    }

    /// The point of its sequence that a sample takes in these dimensions, and the hash of the
    /// sequence.
    #[inline(always)]
    fn point<I: Int>(&self, address: &Address<I>) -> (I, I) {
        let log2_side = (32 - self.log2_samples) / 2;
        let kept = I::splat((1 << log2_side) - 1);
        let [x, y] = address.pixel.each(|x| x & kept);
        let sample = address.index & ((1 << self.log2_samples) - 1);
        let index = interleaved(x, y).shl(self.log2_samples) | I::splat(sample);
        let round = mix_word(self.key ^ mix_word(address.index >> self.log2_samples));
        let [column, row] = address.pixel.each(|x| x.shr(log2_side));
        let tile = mix_word(mix_word(column ^ I::splat(round)) ^ row);
        let hash = mix_word(mix_word(address.dimension) ^ tile);
        let point = reverse_bits(fast_owen_scramble(reverse_bits(index), hash));
        (point, other(hash))
    }
}

/// Another hash of the same words.
#[inline(always)]
fn other<I: Int>(hash: I) -> I {
    mix_word(hash.wrapping_add(I::splat(0x9e37_79b9)))
}
