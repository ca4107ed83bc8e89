//! Sobol' points of all dimensions: one sequence over a square of pixels, whose first two
//! dimensions are the position on the film [Pharr 2023 §8.7.1].
//!
//! On a square with side 2^m, every 2^(2m) successive points have one in each pixel. Which index
//! that is follows from the first 2m rows of the two matrices: a linear system over the binary
//! field, inverted here once. The digits of a coordinate thus are linear in the bits of pixel and
//! sample, and have a table of their own: a matrix of these bits for each dimension. Any number of
//! samples is the beginning of the sequence, best a power of two.

use super::address::Address;
use super::randomize::{Randomize, wrapped};
use crate::hash::hash;
use crate::low_discrepancy::{SOBOL_DIMENSIONS, sobol_digits};
use lanes::{Each, Int, Mask, Real};
use math::Vec2;
use std::sync::Arc;

/// For each bit of a word, the digits that it adds.
type Matrix = [u32; 32];

/// Sobol' points of all dimensions, one sequence over the picture, which any number of samples
/// begins. The number is best a power of two.
#[derive(Clone, Debug)]
pub struct Sobol {
    samples_per_pixel: u32,
    randomize: Randomize,
    /// A hash for each dimension.
    seeds: Arc<[u32]>,
    /// The side of the square of pixels is 2^log2_side.
    log2_side: u32,
    /// For each dimension, the matrices of the bits of the pixel (y's below x's) and of the index.
    matrices: Arc<[[Matrix; 2]]>,
    address: Address,
}

impl Sobol {
    /// A sampler for a picture of the given resolution, at most 2¹⁵ pixels on a side (beyond,
    /// positions repeat).
    pub fn new(samples_per_pixel: u32, resolution: [i32; 2], randomize: Randomize, seed: u32) -> Sobol {
        let side = resolution[0].max(resolution[1]).clamp(1, 1 << 15) as u32;
        let log2_side = side.next_power_of_two().ilog2();
        let points = points_of_bits(log2_side);
        let matrices = |dimension| points.map(|points| points.map(|point| sobol_digits(point, dimension)));
        Sobol {
            samples_per_pixel: samples_per_pixel.clamp(1, 1 << 31),
            randomize,
            seeds: (0..SOBOL_DIMENSIONS as u32).map(|dimension| hash(&[dimension, seed]) as u32).collect(),
            log2_side,
            matrices: (0..SOBOL_DIMENSIONS).map(matrices).collect(),
            address: Address::new([0; 2], 0, 2),
        }
    }

    /// Randomisation, the hash of each dimension, the binary logarithm of the side of the square of
    /// pixels, and for each dimension the digits that each bit of a pixel (x's above y's) adds, and
    /// those of each bit of the index.
    pub fn parts(&self) -> (Randomize, &[u32], u32, &[[[u32; 32]; 2]]) {
        (self.randomize, &self.seeds, self.log2_side, &self.matrices)
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.samples_per_pixel
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        self.address = Address::new(pixel, index, dimension.max(2));
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
        let [x, y] = self.at_pixel_2d(&self.address);
        Vec2::new(x, y)
    }

    /// The coordinate at an address.
    #[inline(always)]
    pub(super) fn at_1d<I: Int>(&self, address: &Address<I>) -> I::Real {
        let ([digits], [seed]) = self.digits(address);
        self.randomize.digits(digits, seed)
    }

    /// The two coordinates at an address.
    #[inline(always)]
    pub(super) fn at_2d<I: Int>(&self, address: &Address<I>) -> [I::Real; 2] {
        let ([a, b], [seed, other]) = self.digits(address);
        [self.randomize.digits(a, seed), self.randomize.digits(b, other)]
    }

    /// The position in the pixel of the sample at an address.
    #[inline(always)]
    pub(super) fn at_pixel_2d<I: Int>(&self, address: &Address<I>) -> [I::Real; 2] {
        // The first digits are the pixel; the rest, which is the position in it, is randomised like
        // any dimension, or pictures of different seeds would have samples in common.
        let [x, y] = self.products(self.pixel_bits(address), address.index, 0);
        let [seed, other] = [0, 1].each(|dimension: usize| I::splat(self.seeds[dimension]));
        [
            self.randomize.digits(x.shr(self.log2_side), seed),
            self.randomize.digits(y.shr(self.log2_side), other),
        ]
    }

    /// The digits of `C` coordinates at an address, and the hashes of their dimensions. Dimensions
    /// beyond the last start again from the third. Lanes of the same dimension, which usually are
    /// all, are computed together.
    #[inline(always)]
    fn digits<I: Int, const C: usize>(&self, address: &Address<I>) -> ([I; C], [I; C]) {
        let bits = self.pixel_bits(address);
        let dimensions = address.dimension.to_array();
        let (mut digits, mut seeds) = ([I::splat(0); C], [I::splat(0); C]);
        let mut rest = I::Mask::splat(true);
        while rest.any() {
            let dimension = dimensions[rest.bits().trailing_zeros() as usize];
            let lanes = address.dimension.eq(I::splat(dimension));
            rest = rest & !lanes;
            let first = wrapped(dimension.max(2) as usize, C, SOBOL_DIMENSIONS);
            let products = self.products::<I, C>(bits, address.index, first);
            for c in 0..C {
                digits[c] = I::select(lanes, products[c], digits[c]);
                seeds[c] = I::select(lanes, I::splat(self.seeds[first + c]), seeds[c]);
            }
        }
        (digits, seeds)
    }

    /// The bits of a pixel: x's above y's.
    #[inline(always)]
    fn pixel_bits<I: Int>(&self, address: &Address<I>) -> I {
        let kept = I::splat((1 << self.log2_side) - 1);
        let [x, y] = address.pixel;
        (x & kept).shl(self.log2_side) | (y & kept)
    }

    /// The digits in `C` dimensions from `first` on, which are the same for all lanes.
    #[inline(always)]
    fn products<I: Int, const C: usize>(&self, pixel_bits: I, index: u32, first: usize) -> [I; C] {
        let matrices = &self.matrices[first..first + C];
        let is_single = I::Real::LANES == 1;
        let mut digits = [I::splat(0); C];
        for c in 0..C {
            let shared = if is_single { pixel_bits.to_array()[0] } else { 0 };
            digits[c] = I::splat(product(&matrices[c], [shared, index]));
        }
        if !is_single {
            for bit in 0..2 * self.log2_side {
                let is_unset = (pixel_bits & I::splat(1 << bit)).eq(I::splat(0));
                for c in 0..C {
                    let added = digits[c] ^ I::splat(matrices[c][0][bit as usize]);
                    digits[c] = I::select(is_unset, digits[c], added);
                }
            }
        }
        digits
    }
}

/// The exclusive or of the columns that the bits of two words select.
#[inline(always)]
fn product([a, b]: &[Matrix; 2], [x, y]: [u32; 2]) -> u32 {
    let mut digits = 0;
    for bit in 0..32 {
        // Without branches, so that columns are added in lanes.
        let all_if = |word: u32| 0_u32.wrapping_sub(word >> bit & 1);
        digits ^= (a[bit] & all_if(x)) ^ (b[bit] & all_if(y));
    }
    digits
}

/// For each bit of a pixel and of an index, the index in the sequence of the point that has this
/// bit alone; the point of other bits is the exclusive or of theirs.
fn points_of_bits(m: u32) -> [[u64; 32]; 2] {
    let index_from_pixel = index_from_pixel(m);
    let mut points = [[0; 32]; 2];
    points[0][..index_from_pixel.len()].copy_from_slice(&index_from_pixel);
    for (bit, point) in points[1].iter_mut().enumerate() {
        // Of the points of this sample, the one in the first pixel.
        *point = 1 << (2 * m as usize + bit);
        let mut pixel = pixel_of(*point, m);
        while pixel != 0 {
            *point ^= index_from_pixel[pixel.trailing_zeros() as usize];
            pixel &= pixel - 1;
        }
    }
    points
}

/// The pixel of point `index` on a square of side 2^m: m bits of x above m bits of y.
fn pixel_of(index: u64, m: u32) -> u64 {
    let [x, y] = [0, 1].map(|dimension| (sobol_digits(index, dimension).reverse_bits() as u64) << m >> 32);
    x << m | y
}

/// Inverts [`pixel_of`] on the indices below 2^(2m): its matrix is brought to the identity by
/// operations on columns, which bring the identity to the inverse.
fn index_from_pixel(m: u32) -> Vec<u64> {
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
    fn samples_are_points_of_the_sequence_in_their_pixel() {
        for side in [1, 2, 5, 64, 1920, 1 << 15] {
            let sampler = Sobol::new(4, [side, 1], Randomize::None, 0);
            let m = sampler.log2_side;
            let points = points_of_bits(m);
            for i in 0..50 {
                let pixel = [(i * 37) % side, (i * 101 + 3) % side];
                for index in [0, 1, 7, 1000, u32::MAX] {
                    let address = Address::new(pixel, index, 700);
                    let words = [sampler.pixel_bits(&address), index];
                    let set = (0..64).filter(|bit| words[bit / 32] >> (bit % 32) & 1 == 1);
                    let point = set.fold(0, |point, bit| point ^ points[bit / 32][bit % 32]);
                    assert_eq!(pixel_of(point, m), (pixel[0] as u64) << m | pixel[1] as u64);
                    assert_eq!(point >> (2 * m), u64::from(index));
                    assert_eq!(sampler.digits(&address).0, [700, 701].map(|d| sobol_digits(point, d)));
                }
            }
        }
    }
}
