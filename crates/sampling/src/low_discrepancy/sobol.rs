//! Sobol' points: in each dimension, the exclusive or of the columns of a binary matrix that the
//! bits of the index select.
//!
//! The columns are direction numbers v_k, begun with those of [Joe 2008] (`data/sobol-joe-kuo.txt`)
//! and continued by the recurrence of a primitive polynomial of degree s with coefficients a: v_k =
//! a₁v_{k−1} ⊕ … ⊕ a_{s−1}v_{k−s+1} ⊕ v_{k−s} ⊕ (v_{k−s} ≫ s). Scrambling follows [Owen 1995]; the
//! fast form is a hash of [Laine 2011] with constants of [Vegdahl 2021].

use crate::mix_word;
use lanes::Int;
use std::sync::LazyLock;

/// The number of dimensions with direction numbers.
pub const SOBOL_DIMENSIONS: usize = 1024;
/// Columns of a matrix: one for each bit of an index.
const COLUMNS: usize = 64;

static MATRICES: LazyLock<Box<[[u32; COLUMNS]]>> = LazyLock::new(|| {
    let table = include_str!("../../data/sobol-joe-kuo.txt");
    let van_der_corput = std::array::from_fn(|k| if k < 32 { 1 << k } else { 0 });
    let lines = table.lines().filter(|line| !line.starts_with('#'));
    std::iter::once(van_der_corput).chain(lines.map(matrix)).collect()
});

/// The matrix of a line of the table: polynomial, then initial numbers.
fn matrix(line: &str) -> [u32; COLUMNS] {
    let mut numbers =
        line.split(' ').map(|n| n.parse::<u64>().expect("invariant: the table is made of numbers"));
    let polynomial = numbers.next().expect("invariant: a line begins with a polynomial");
    let degree = polynomial.ilog2() as usize;
    let mut v = [0u64; COLUMNS];
    for (k, m) in numbers.enumerate() {
        v[k] = m << (63 - k);
    }
    for k in degree..COLUMNS {
        v[k] = v[k - degree] ^ (v[k - degree] >> degree);
        for i in 1..degree {
            if (polynomial >> (degree - i)) & 1 == 1 {
                v[k] ^= v[k - i];
            }
        }
    }
    v.map(|v| ((v >> 32) as u32).reverse_bits())
}

/// The 32 binary digits of the coordinate of point `index` in a dimension below
/// [`SOBOL_DIMENSIONS`]; the first digit after the point is the lowest bit.
#[inline]
pub fn sobol_digits(index: u64, dimension: usize) -> u32 {
    match dimension {
        0 => index as u32,
        1 => pascal_digits(index as u32, (index >> 32) as u32),
        _ => product(&MATRICES[dimension], index),
    }
}

/// The exclusive or of the columns that the bits of `index` select.
#[inline]
fn product(matrix: &[u32; COLUMNS], mut index: u64) -> u32 {
    let mut digits = 0;
    while index != 0 {
        digits ^= matrix[index.trailing_zeros() as usize];
        index &= index - 1;
    }
    digits
}

/// The digits of the coordinate in dimension 1 of the point whose index has these two words. Its
/// matrix is Pascal's triangle modulo 2: digit r is the sum over k of C(k, r)·bit k of the index.
/// That is the Kronecker power of ((1, 1), (0, 1)), applied level by level without branches: the
/// last level adds the digits of the high word to those of the low one.
#[inline(always)]
pub fn pascal_digits<I: Int>(low: I, high: I) -> I {
    const EVEN: [u32; 5] = [0x5555_5555, 0x3333_3333, 0x0f0f_0f0f, 0x00ff_00ff, 0x0000_ffff];
    let mut digits = low ^ high;
    for (level, even) in EVEN.into_iter().enumerate() {
        digits = digits ^ (digits.shr(1 << level) & I::splat(even));
    }
    digits
}

/// Owen scrambling of binary digits, the first of which is the lowest bit: each is flipped or not
/// by a hash of the digits before it and `seed`.
#[inline(always)]
pub fn owen_scramble<I: Int>(digits: I, seed: I) -> I {
    let mut v = digits;
    let mut before = I::splat(0);
    for b in 0..32 {
        // Of each level another bit, because levels whose digits before it are zeros share a hash.
        v = v ^ (mix_word((v & before) ^ seed) & I::splat(1 << b));
        before = before.shl(1) | I::splat(1);
    }
    v
}

/// A scrambling of the same form as [`owen_scramble`], by a hash in which bits act only on higher
/// ones.
#[inline(always)]
pub fn fast_owen_scramble<I: Int>(digits: I, seed: I) -> I {
    let mul = |v: I, factor: u32| v ^ v.wrapping_mul(I::splat(factor));
    let v = mul(digits, 0x3d20_adea).wrapping_add(seed);
    let v = v.wrapping_mul(seed.shr(16) | I::splat(1));
    mul(mul(v, 0x0552_6c56), 0x53a2_2864)
}

/// The word whose bits are in reverse order.
#[inline(always)]
pub fn reverse_bits<I: Int>(v: I) -> I {
    let swap = |v: I, bits: u32, even: u32| (v.shr(bits) & I::splat(even)) | (v & I::splat(even)).shl(bits);
    let v = swap(v, 1, 0x5555_5555);
    let v = swap(v, 2, 0x3333_3333);
    let v = swap(v, 4, 0x0f0f_0f0f);
    let v = swap(v, 8, 0x00ff_00ff);
    v.shr(16) | v.shl(16)
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::HashSet;

    #[test]
    fn the_table_has_every_dimension() {
        assert_eq!(MATRICES.len(), SOBOL_DIMENSIONS);
    }

    #[test]
    fn first_points_of_the_published_sequence() {
        // The order is that of the index, not of Gray's code.
        let point = |i| [0, 1, 2, 3, 4].map(|d| sobol_digits(i, d).reverse_bits() as f64 / 4294967296.0);
        assert_eq!(point(1), [0.5; 5]);
        assert_eq!(point(2), [0.25, 0.75, 0.75, 0.75, 0.25]);
        assert_eq!(point(3), [0.75, 0.25, 0.25, 0.25, 0.75]);
    }

    #[test]
    fn the_second_dimension_is_pascals_triangle() {
        for index in (0..10_000).chain((0..10_000).map(crate::mix_bits)) {
            assert_eq!(sobol_digits(index, 1), product(&MATRICES[1], index), "index {index:#x}");
        }
    }

    #[test]
    fn each_dimension_is_stratified() {
        for dimension in 0..SOBOL_DIMENSIONS {
            let cells: HashSet<u32> = (0..256).map(|i| sobol_digits(i, dimension) & 0xff).collect();
            assert_eq!(cells.len(), 256, "dimension {dimension}");
        }
    }

    #[test]
    fn scrambling_permutes_every_level_of_strata() {
        for scramble in [owen_scramble::<u32>, fast_owen_scramble::<u32>] {
            for seed in [0, 1, 0x1234_5678, u32::MAX] {
                for level in [1, 4, 9] {
                    let strata: HashSet<u32> = (0..1 << level)
                        .map(|i| scramble(sobol_digits(i, 0), seed) & ((1 << level) - 1))
                        .collect();
                    assert_eq!(strata.len(), 1 << level);
                }
                // What lies in one stratum stays together.
                assert_eq!(scramble(0x0000_0001, seed) & 0xff, scramble(0xffff_ff01, seed) & 0xff);
            }
        }
    }
}
