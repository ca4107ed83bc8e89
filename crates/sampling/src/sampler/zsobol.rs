//! Two-dimensional Sobol' points distributed over the picture along a Morton curve, with the base-4
//! digits of the Morton index randomly permuted: neighbouring pixels take complementary points, and
//! the error is blue noise [Ahmed 2020], [Pharr 2023 §8.7.3].
//!
//! The seed selects both the permutations and the scrambles: all pixels share the scrambles, so
//! that by them alone the errors of two seeds would be correlated. A round has the next power of
//! two of samples, of which a pixel takes the first where that is more than it is to take. Beyond
//! it, each further round has scrambles and permutations of its own. All hashes are of 32 bits, so
//! that lanes of a vector can each compute a coordinate.

use super::address::{Address, interleaved};
use super::randomize::Randomize;
use crate::low_discrepancy::pascal_digits;
use crate::mix_word;
use lanes::{Each, Int, Real};
use math::Vec2;

/// Separates the hash of scrambles from that of permutations.
const SCRAMBLES: u32 = 0x9e37_79b9;

/// Two-dimensional Sobol' points distributed over the picture along a Morton curve, in rounds of
/// the next power of two of samples, each with scrambles of its own.
#[derive(Clone, Debug)]
pub struct ZSobol {
    samples_per_pixel: u32,
    /// Of the samples of a round.
    log2_samples: u32,
    /// Base-4 digits of a pixel's Morton code.
    log2_side: u32,
    randomize: Randomize,
    /// A hash of the seed.
    key: u32,
    address: Address,
}

impl ZSobol {
    /// A sampler for a picture of the given resolution.
    pub fn new(samples_per_pixel: u32, resolution: [i32; 2], randomize: Randomize, seed: u32) -> ZSobol {
        let samples_per_pixel = samples_per_pixel.clamp(1, 1 << 31);
        let side = resolution[0].max(resolution[1]).max(1) as u32;
        ZSobol {
            samples_per_pixel,
            log2_samples: samples_per_pixel.next_power_of_two().ilog2(),
            log2_side: side.next_power_of_two().ilog2(),
            randomize,
            key: mix_word(seed),
            address: Address::new([0; 2], 0, 0),
        }
    }

    /// The binary logarithm of the samples of a round, the base-4 digits of a pixel's Morton code,
    /// the randomisation, and the hash of the seed.
    pub fn parts(&self) -> (u32, u32, Randomize, u32) {
        (self.log2_samples, self.log2_side, self.randomize, self.key)
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
        let [low, _] = self.point(address);
        self.randomize.digits(low, mix_word(self.hash(address, SCRAMBLES)))
    }

    /// The two coordinates at an address.
    #[inline(always)]
    pub(super) fn at_2d<I: Int>(&self, address: &Address<I>) -> [I::Real; 2] {
        let [low, high] = self.point(address);
        let seed = mix_word(self.hash(address, SCRAMBLES));
        let other = mix_word(seed.wrapping_add(I::splat(SCRAMBLES)));
        [self.randomize.digits(low, seed), self.randomize.digits(pascal_digits(low, high), other)]
    }

    /// A hash of dimension, seed and round.
    #[inline(always)]
    fn hash<I: Int>(&self, address: &Address<I>, purpose: u32) -> I {
        let round = address.index >> self.log2_samples;
        let key = mix_word(self.key ^ mix_word(round.wrapping_add(purpose)));
        mix_word(address.dimension ^ I::splat(key))
    }

    /// The point of the sequence that a sample takes in these dimensions, as low and high word of
    /// its index: the Morton code of the pixel and the index of the sample, each base-4 digit
    /// permuted by a hash of the digits above it. Below them there is one binary digit if the
    /// samples of a round are not a power of four.
    #[inline(always)]
    fn point<I: Int>(&self, address: &Address<I>) -> [I; 2] {
        if 2 * self.log2_side + self.log2_samples > 32 {
            self.wide_point(address)
        } else {
            [self.narrow_point(address), I::splat(0)]
        }
    }

    /// The Morton code of the pixel above the index of the sample, as low and high word.
    #[inline(always)]
    fn code<I: Int>(&self, address: &Address<I>) -> [I; 2] {
        let kept = I::splat(if self.log2_side < 32 { (1 << self.log2_side) - 1 } else { u32::MAX });
        let [x, y] = address.pixel.each(|x| x & kept);
        let [low, high] = [interleaved(x, y), interleaved(x.shr(16), y.shr(16))];
        let log2 = self.log2_samples;
        let index = I::splat(address.index & ((1 << self.log2_samples) - 1));
        if log2 == 0 {
            return [low, high];
        }
        [low.shl(log2) | index, high.shl(log2) | low.shr(32 - log2)]
    }

    /// The permuted digits of a code of one word.
    #[inline(always)]
    fn narrow_point<I: Int>(&self, address: &Address<I>) -> I {
        let [code, _] = self.code(address);
        let key = self.hash(address, 0);
        let (digits, odd) = (self.log2_side + self.log2_samples / 2, self.log2_samples & 1);
        // No digit needs the image of another, so that the compiler makes a vector of those of a
        // single point, if their number is a constant. The last of them are left out below.
        let is_single = I::Real::LANES == 1;
        let mut point = I::splat(0);
        for place in 0..if is_single { 16 } else { digits } {
            let shift = 2 * place + odd;
            let digit = code.shr(shift);
            point = point | permuted(digit, hash_above(digit.shr(2), shift + 2, key)).shl(shift);
        }
        if is_single {
            point = point & I::splat(((1_u64 << (2 * digits + odd)) - 1) as u32);
        }
        if odd == 1 {
            point = point | ((code ^ hash_above(code.shr(1), 1, key)) & I::splat(1));
        }
        point
    }

    /// The permuted digits of a code of two words.
    #[inline(always)]
    fn wide_point<I: Int>(&self, address: &Address<I>) -> [I; 2] {
        let code = self.code(address);
        let key = self.hash(address, 0);
        let (mut low, mut high) = (I::splat(0), I::splat(0));
        let (digits, odd) = (self.log2_side.min(32) + self.log2_samples / 2, self.log2_samples & 1);
        for place in (0..digits).rev() {
            let shift = 2 * place + odd;
            high = high.shl(2) | low.shr(30);
            low = low.shl(2) | permuted(shifted_right(code, shift)[0], hash_above_wide(code, shift + 2, key));
        }
        if odd == 1 {
            high = high.shl(1) | low.shr(31);
            low = low.shl(1) | ((code[0] ^ hash_above_wide(code, 1, key)) & I::splat(1));
        }
        [low, high]
    }
}

/// A hash of the bits of a code from `lowest` on.
#[inline(always)]
fn hash_above<I: Int>(bits: I, lowest: u32, key: I) -> I {
    mix_word(bits ^ key.wrapping_add(I::splat(lowest)))
}

/// [`hash_above`] of a code of two words.
#[inline(always)]
fn hash_above_wide<I: Int>(code: [I; 2], lowest: u32, key: I) -> I {
    let [low, high] = shifted_right(code, lowest);
    hash_above(low ^ mix_word(high), lowest, key)
}

/// Two words shifted right together.
#[inline(always)]
fn shifted_right<I: Int>([low, high]: [I; 2], shift: u32) -> [I; 2] {
    let zero = I::splat(0);
    match shift {
        0 => [low, high],
        1..32 => [low.shr(shift) | high.shl(32 - shift), high.shr(shift)],
        32 => [high, zero],
        33..64 => [high.shr(shift - 32), zero],
        _ => [zero; 2],
    }
}

/// The base-4 digit in the low two bits under one of the 24 permutations. Permutations of four
/// digits are the affine maps of two bits: a·low ⊕ b·high ⊕ c, where a and b differ and are not 0.
#[inline(always)]
fn permuted<I: Int>(digit: I, hash: I) -> I {
    let [zero, one, three] = [0, 1, 3].each(I::splat);
    // One of three by 16 bits of the hash.
    let a = hash.shr(16).wrapping_mul(three).shr(16).wrapping_add(one);
    let next = I::select(a.eq(three), one, a.wrapping_add(one));
    let b = next ^ (a & zero.wrapping_sub(hash.shr(2) & one));
    let c = hash & three;
    let [low, high] = [digit & one, digit.shr(1) & one];
    (a & zero.wrapping_sub(low)) ^ (b & zero.wrapping_sub(high)) ^ c
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn codes_interleave() {
        let sampler = ZSobol::new(8, [1 << 20, 1], Randomize::FastOwen, 0);
        let at = |x, y, index| sampler.code(&Address::new([x, y], index, 0));
        assert_eq!(at(0b101, 0b011, 6), [0b1101_1110, 0]);
        assert_eq!(at(1 << 19, 0, 0), [0, 1 << (38 + 3 - 32)]);
        assert_eq!(at(0, 1 << 15, 9), [1, 1 << (31 + 3 - 32)]);
    }

    #[test]
    fn seeds_are_uncorrelated() {
        // Which half of [0, 1) a pixel's only sample lies in, as a sign.
        let signs = |seed: u32| -> Vec<f64> {
            let mut sampler = ZSobol::new(1, [64, 64], Randomize::FastOwen, seed);
            let pixels = (0..64).flat_map(|y| (0..64).map(move |x| [x, y]));
            let sign = |pixel| {
                sampler.start_pixel_sample(pixel, 0, 0);
                if sampler.get_1d() < 0.5 { -1.0 } else { 1.0 }
            };
            pixels.map(sign).collect()
        };
        for seeds in [[0, 1], [1, 2], [5, 77]] {
            let [a, b] = seeds.map(signs);
            let correlation = a.iter().zip(&b).map(|(a, b)| a * b).sum::<f64>() / a.len() as f64;
            // Five standard deviations of 4096 independent signs.
            assert!(correlation.abs() < 5.0 / 64.0, "seeds {seeds:?}: {correlation}");
        }
    }

    #[test]
    fn permutations_are_all_alike_frequent() {
        const TRIES: usize = 24 * 4096;
        let mut counts = std::collections::BTreeMap::new();
        for hash in (0..TRIES as u32).map(mix_word) {
            let image = [0, 1, 2, 3].map(|digit: u32| permuted(digit, hash));
            *counts.entry(image).or_insert(0) += 1;
            let mut sorted = image;
            sorted.sort();
            assert_eq!(sorted, [0, 1, 2, 3]);
        }
        let counts: Vec<u64> = counts.into_values().collect();
        testkit::Chi2::default().counts(&counts, &[4096.0; 24]).unwrap();
    }

    #[test]
    fn the_samples_of_all_pixels_are_points_of_one_net() {
        // The samples of a square of pixels take successive points of the sequence, once each.
        for (spp, side) in [(8, 4), (16, 2), (1, 8), (1 << 20, 1 << 14)] {
            let sampler = ZSobol::new(spp, [side, 1], Randomize::FastOwen, 3);
            let spp = spp.min(16);
            for dimension in [0, 1, 17] {
                let pixels = (0..16).map(|i| [i % 4, i / 4]).filter(|&[x, y]| x.max(y) < side);
                let addresses = pixels.flat_map(|p| (0..spp).map(move |i| Address::new(p, i, dimension)));
                let points: Vec<_> = addresses.map(|address| sampler.point(&address)).collect();
                let different: std::collections::BTreeSet<_> = points.iter().collect();
                assert_eq!(different.len(), points.len());
                if points.len() == (sampler.samples_per_pixel() as i32 * side * side) as usize {
                    assert!(
                        different
                            .into_iter()
                            .eq(&(0..points.len() as u32).map(|i| [i, 0]).collect::<Vec<_>>())
                    );
                }
            }
        }
    }
}
