//! Hash functions and pseudo-random permutations.
//!
//! [`mix_bits`] is one of Stafford's variants of MurmurHash3's finaliser, [`hash`] is Appleby's
//! MurmurHash64A, and [`permutation_element`] evaluates one element of a pseudo-random permutation
//! in constant memory by cycle walking [Kensler 2013]. [`mix_word`] and [`mix_quadruple`] compute
//! with 32-bit words, in any number of lanes.

use lanes::{Int, Real};

/// A bijection of 64-bit words under which each input bit changes about half of the output bits.
#[inline]
pub fn mix_bits(v: u64) -> u64 {
    let v = (v ^ (v >> 31)).wrapping_mul(0x7fb5_d329_728e_a185);
    let v = (v ^ (v >> 27)).wrapping_mul(0x81da_def4_bc2d_d44d);
    v ^ (v >> 33)
}

/// The hash of a sequence of words. Floats enter as their bits, 64-bit words as two halves, the
/// lower one first.
#[inline]
pub fn hash(words: &[u32]) -> u64 {
    const M: u64 = 0xc6a4_a793_5bd1_e995;
    let mut h = (4 * words.len() as u64).wrapping_mul(M);
    let pairs = words.chunks_exact(2);
    let rest = pairs.remainder();
    for pair in pairs {
        let k = (pair[0] as u64 | (pair[1] as u64) << 32).wrapping_mul(M);
        h = (h ^ (k ^ (k >> 47)).wrapping_mul(M)).wrapping_mul(M);
    }
    if let [word] = rest {
        h = (h ^ *word as u64).wrapping_mul(M);
    }
    h = (h ^ (h >> 47)).wrapping_mul(M);
    h ^ (h >> 47)
}

/// A bijection of 32-bit words under which each input bit changes about half of the output bits:
/// `lowbias32` of [Wellons 2018].
#[inline(always)]
pub fn mix_word<I: Int>(v: I) -> I {
    let v = (v ^ v.shr(16)).wrapping_mul(I::splat(0x7feb_352d));
    let v = (v ^ v.shr(15)).wrapping_mul(I::splat(0x846c_a68b));
    v ^ v.shr(16)
}

/// A bijection of quadruples of words whose images look independent: `pcg4d` of [Jarzynski 2020].
#[inline(always)]
pub fn mix_quadruple<I: Int>(words: [I; 4]) -> [I; 4] {
    let mut mixed = words;
    for v in &mut mixed {
        *v = v.wrapping_mul(I::splat(1_664_525)).wrapping_add(I::splat(1_013_904_223));
    }
    mixed = stir(mixed);
    for v in &mut mixed {
        *v = *v ^ v.shr(16);
    }
    stir(mixed)
}

/// Adds to each word the product of two others.
#[inline(always)]
fn stir<I: Int>([x, y, z, w]: [I; 4]) -> [I; 4] {
    let x = x.wrapping_add(y.wrapping_mul(w));
    let y = y.wrapping_add(z.wrapping_mul(x));
    let z = z.wrapping_add(x.wrapping_mul(y));
    [x, y, z, w.wrapping_add(y.wrapping_mul(z))]
}

/// 32 bits as a binary fraction in [0, 1).
#[inline(always)]
pub(crate) fn unit_interval<I: Int>(bits: I) -> I::Real {
    let (high, low) = (bits.shr(16).to_real(), (bits & I::splat(0xffff)).to_real());
    // The product is exact, so that the sum is the word rounded once.
    let rounded = high * I::Real::splat(65_536.0) + low;
    (rounded * I::Real::splat(1.0 / 4_294_967_296.0)).min(I::Real::splat(math::ONE_MINUS_EPSILON))
}

/// A number in [0, 1) from a sequence of words.
#[inline]
pub fn hash_float(words: &[u32]) -> f32 {
    unit_interval(hash(words) as u32)
}

/// The image of `index` under a pseudo-random permutation of 0..`length`, chosen by `seed`. `index`
/// must be below `length`.
#[inline]
pub fn permutation_element(index: u32, length: u32, seed: u32) -> u32 {
    debug_assert!(index < length, "{index} is not an index below {length}");
    let mask = (length - 1).checked_ilog2().map_or(0, |bits| u32::MAX >> (31 - bits));
    let mut i = index;
    loop {
        i = (i ^ seed).wrapping_mul(0xe170_893d);
        i ^= seed >> 16;
        i ^= (i & mask) >> 4;
        i = (i ^ (seed >> 8)).wrapping_mul(0x0929_eb3f);
        i ^= seed >> 23;
        i ^= (i & mask) >> 1;
        i = i.wrapping_mul(1 | seed >> 27).wrapping_mul(0x6935_fa69);
        i ^= (i & mask) >> 11;
        i = i.wrapping_mul(0x74dc_b303);
        i ^= (i & mask) >> 2;
        i = i.wrapping_mul(0x9e50_1cc3);
        i ^= (i & mask) >> 2;
        i = i.wrapping_mul(0xc860_a3df) & mask;
        i ^= i >> 5;
        if i < length {
            return ((i as u64 + seed as u64) % length as u64) as u32;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Chi2;

    #[test]
    fn permutations_are_bijective() {
        for length in [1, 2, 3, 7, 64, 1000] {
            for seed in [0, 1, 0xdead_beef] {
                let mut seen = vec![false; length as usize];
                (0..length).for_each(|i| seen[permutation_element(i, length, seed) as usize] = true);
                assert!(seen.iter().all(|&s| s), "length {length}, seed {seed}");
            }
        }
    }

    #[test]
    fn images_are_uniformly_distributed() {
        for index in 0..5 {
            let mut counts = [0; 5];
            for seed in 0..20_000 {
                counts[permutation_element(index, 5, mix_bits(seed) as u32) as usize] += 1;
            }
            Chi2 { tests: 5, ..Chi2::default() }.counts(&counts, &[4000.0; 5]).unwrap();
        }
    }

    #[test]
    fn each_input_bit_changes_half_of_the_output() {
        for bit in 0..96 {
            let changed: u32 = (0..200u32)
                .map(|i| {
                    let words = [i, i.wrapping_mul(77), 3 * i];
                    let mut other = words;
                    other[bit / 32] ^= 1 << (bit % 32);
                    (hash(&words) ^ hash(&other)).count_ones()
                })
                .sum();
            assert!((changed as f64 / 200.0 - 32.0).abs() < 1.5, "bit {bit}: {changed}");
        }
    }

    #[test]
    fn mixing_changes_half_of_the_bits() {
        for bit in 0..64 {
            let changed: u32 = (0..200)
                .map(|i: u64| (mix_bits(i * 977) ^ mix_bits((i * 977) ^ (1 << bit))).count_ones())
                .sum();
            assert!((changed as f64 / 200.0 - 32.0).abs() < 2.5, "bit {bit}: {changed}");
        }
    }

    #[test]
    fn length_is_part_of_the_hash() {
        assert_ne!(hash(&[0]), hash(&[0, 0]));
        assert!((0..1000).all(|i| (0.0..1.0).contains(&hash_float(&[i]))));
    }
}
