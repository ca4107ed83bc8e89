//! Sobol' points: in each dimension, the exclusive or of the columns of a binary matrix that the
//! bits of the index select.
//!
//! The columns are direction numbers v_k, begun with those of [Joe 2008] (`data/sobol-joe-kuo.txt`)
//! and continued by the recurrence of a primitive polynomial of degree s with coefficients a: v_k =
//! a₁v_{k−1} ⊕ … ⊕ a_{s−1}v_{k−s+1} ⊕ v_{k−s} ⊕ (v_{k−s} ≫ s). Scrambling follows [Owen 1995]; the
//! fast form is a hash of [Laine 2011] with constants of [Vegdahl 2021].

use crate::mix_bits;
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
        1 => pascal(index),
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

/// The coordinate in dimension 1. Its matrix is Pascal's triangle modulo 2: digit r is the sum over
/// k of C(k, r)·bit k of the index. That is the Kronecker power of ((1, 1), (0, 1)), applied level
/// by level without branches.
#[inline]
fn pascal(index: u64) -> u32 {
    const EVEN: [u64; 6] = [
        0x5555_5555_5555_5555,
        0x3333_3333_3333_3333,
        0x0f0f_0f0f_0f0f_0f0f,
        0x00ff_00ff_00ff_00ff,
        0x0000_ffff_0000_ffff,
        0x0000_0000_ffff_ffff,
    ];
    let levels = EVEN.iter().enumerate();
    levels.fold(index, |digits, (level, even)| digits ^ ((digits >> (1 << level)) & even)) as u32
}

/// Owen scrambling of binary digits, the first of which is the lowest bit: each is flipped or not
/// by a hash of the digits before it and `seed`.
#[inline]
pub fn owen_scramble(digits: u32, seed: u32) -> u32 {
    let mut v = digits.reverse_bits();
    if seed & 1 == 1 {
        v ^= 1 << 31;
    }
    for b in 1..32 {
        let above = u32::MAX << (32 - b);
        if mix_bits(((v & above) ^ seed) as u64) as u32 & (1 << b) != 0 {
            v ^= 1 << (31 - b);
        }
    }
    v.reverse_bits()
}

/// A scrambling of the same form as [`owen_scramble`], by a hash in which bits act only on higher
/// ones.
#[inline]
pub fn fast_owen_scramble(digits: u32, seed: u32) -> u32 {
    let mut v = digits;
    v ^= v.wrapping_mul(0x3d20_adea);
    v = v.wrapping_add(seed);
    v = v.wrapping_mul((seed >> 16) | 1);
    v ^= v.wrapping_mul(0x0552_6c56);
    v ^ v.wrapping_mul(0x53a2_2864)
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
        for index in (0..10_000).chain((0..10_000).map(mix_bits)) {
            assert_eq!(pascal(index), product(&MATRICES[1], index), "index {index:#x}");
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
        for scramble in [owen_scramble, fast_owen_scramble] {
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
