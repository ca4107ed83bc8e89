//! Two-dimensional Sobol' points distributed over the picture along a Morton curve, with the base-4
//! digits of the Morton index randomly permuted: neighbouring pixels take complementary points, and
//! the error is blue noise [Ahmed 2020], [Pharr 2023 §8.7.3].
//!
//! The seed selects both the permutations and the scrambles: all pixels share the scrambles, so
//! that by them alone the errors of two seeds would be correlated. A number of samples that is no
//! power of two is rounded up to one. Beyond it, each further round has scrambles and permutations
//! of its own.

use super::randomize::Randomize;
use crate::{hash, mix_bits};
use math::Vec2;

/// Two-dimensional Sobol' points distributed over the picture along a Morton curve. The number of
/// samples is rounded up to a power of two; beyond it each round has scrambles of its own.
#[derive(Clone, Debug)]
pub struct ZSobol {
    log2_samples: u32,
    base4_digits: u32,
    randomize: Randomize,
    seed: u32,
    /// Changes the permutations by the seed; 0 for seed 0.
    seed_key: u32,
    morton_index: u64,
    dimension: u32,
    /// Changes scrambles and permutations by the round; 0 for the first.
    round: u32,
}

impl ZSobol {
    /// A sampler for a picture of the given resolution.
    pub fn new(samples_per_pixel: u32, resolution: [i32; 2], randomize: Randomize, seed: u32) -> ZSobol {
        let log2_samples = samples_per_pixel.clamp(1, 1 << 31).next_power_of_two().ilog2();
        let side = resolution[0].max(resolution[1]).max(1) as u32;
        let base4_digits = side.next_power_of_two().ilog2() + log2_samples.div_ceil(2);
        let seed_key = key(seed);
        ZSobol {
            log2_samples,
            base4_digits,
            randomize,
            seed,
            seed_key,
            morton_index: 0,
            dimension: 0,
            round: 0,
        }
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        1 << self.log2_samples
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        let round = index >> self.log2_samples;
        let index = index & (self.samples_per_pixel() - 1);
        self.round = key(round);
        self.morton_index = (encode_morton(pixel) << self.log2_samples) | index as u64;
        self.dimension = dimension;
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        let (index, hash) = self.next_index(1);
        self.randomize.sobol(index, 0, hash as u32)
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
        let index = self.permuted_index();
        self.dimension += dimensions;
        (index, hash(&[self.dimension, self.seed ^ self.round]))
    }

    /// The Morton index with each base-4 digit permuted by the digits above it; below them there is
    /// one binary digit if the number of samples is not a power of four.
    fn permuted_index(&self) -> u64 {
        let key = 0x5555_5555u32.wrapping_mul(self.dimension) ^ self.round ^ self.seed_key;
        let choose = |above: u64| mix_bits(above ^ key as u64);
        let last = self.log2_samples & 1;
        let mut index = 0;
        for place in (last..self.base4_digits).rev() {
            let shift = 2 * place - last;
            let digit = (self.morton_index >> shift) & 3;
            let permutation = (choose(self.morton_index >> (shift + 2)) >> 24) % 24;
            index |= permute_digit(digit, permutation) << shift;
        }
        if last == 1 {
            index |= (self.morton_index & 1) ^ (choose(self.morton_index >> 1) & 1);
        }
        index
    }
}

/// A hash of a seed or round; 0 for 0.
fn key(number: u32) -> u32 {
    if number == 0 { 0 } else { hash(&[number]) as u32 }
}

/// The image of a base-4 digit under permutation number `permutation` of 24.
#[inline]
fn permute_digit(digit: u64, permutation: u64) -> u64 {
    const PERMUTATIONS: [[u8; 4]; 24] = permutations();
    PERMUTATIONS[permutation as usize][digit as usize] as u64
}

/// All permutations of four digits.
const fn permutations() -> [[u8; 4]; 24] {
    let mut all = [[0; 4]; 24];
    let (mut count, mut code) = (0, 0u8);
    // Each code of four base-4 digits without a repeated digit is a permutation.
    loop {
        let digits = [code >> 6, (code >> 4) & 3, (code >> 2) & 3, code & 3];
        if (1 << digits[0]) | (1 << digits[1]) | (1 << digits[2]) | (1 << digits[3]) == 15u8 {
            all[count] = digits;
            count += 1;
        }
        if code == u8::MAX {
            return all;
        }
        code += 1;
    }
}

/// The bits of both coordinates interleaved, x lowest.
#[inline]
fn encode_morton(pixel: [i32; 2]) -> u64 {
    fn spread(x: i32) -> u64 {
        let mut x = x as u32 as u64;
        for (shift, mask) in [
            (16, 0x0000_ffff_0000_ffff),
            (8, 0x00ff_00ff_00ff_00ff),
            (4, 0x0f0f_0f0f_0f0f_0f0f),
            (2, 0x3333_3333_3333_3333),
            (1, 0x5555_5555_5555_5555),
        ] {
            x = (x | x << shift) & mask;
        }
        x
    }
    spread(pixel[1]) << 1 | spread(pixel[0])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn morton_interleaves() {
        assert_eq!(encode_morton([0b101, 0b011]), 0b01_10_11);
        assert_eq!(encode_morton([1, 0]), 1);
        assert_eq!(encode_morton([0, 1]), 2);
        assert_eq!(encode_morton([2, 2]), 12);
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
    fn permutations_are_all_and_different() {
        let mut all = permutations();
        all.sort();
        assert!(all.windows(2).all(|pair| pair[0] != pair[1]));
        for mut permutation in all {
            permutation.sort();
            assert_eq!(permutation, [0, 1, 2, 3]);
        }
    }
}
