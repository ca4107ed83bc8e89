//! The radical inverse: the digits of an index mirrored at the radix point, Φ_b(Σ dᵢ bⁱ) = Σ dᵢ
//! b^(−i−1), plain or with its digits permuted at random.
//!
//! Digits are permuted by their position alone ([`permuted_radical_inverse`]), or depending on the
//! digits before them ([`owen_scrambled_radical_inverse`], [Owen 1995]).
//! See [Pharr 2023 §8.6].

use crate::{mix_word, permutation_element};
use math::ONE_MINUS_EPSILON;
use std::sync::LazyLock;

/// How many primes serve as bases.
pub const PRIME_COUNT: usize = 1000;

static PRIMES: LazyLock<Box<[u32]>> = LazyLock::new(|| {
    /// The thousandth prime.
    const LAST: usize = 7919;
    let mut composite = [false; LAST + 1];
    let mut primes = Vec::with_capacity(PRIME_COUNT);
    for n in 2..=LAST {
        if !composite[n] {
            primes.push(n as u32);
            (n * n..=LAST).step_by(n).for_each(|multiple| composite[multiple] = true);
        }
    }
    primes.into()
});

/// The prime with this index, 2 having index 0; `index` is below [`PRIME_COUNT`].
#[inline]
pub fn prime(index: usize) -> u32 {
    PRIMES[index]
}

/// The radical inverse of `a` in the base of prime number `prime_index`.
#[inline]
pub fn radical_inverse(prime_index: usize, a: u64) -> f32 {
    let base = prime(prime_index) as u64;
    if base == 2 {
        return to_unit(a.reverse_bits() as f64 * 0.5f64.powi(64));
    }
    mirror(base, a, |a, _| a > 0, |digit| digit)
}

/// [`radical_inverse`] with each digit, leading zeros too, permuted by its position and `hash`.
///
/// A digit d becomes (m d + s) mod b with a random m in 1..b and a random s in 0..b for each
/// position [Matoušek 1998]. As b is prime, two different digits become each such pair with the
/// same probability, as by random permutations, so that integrals have the same variance. The s are
/// the digits of one random number; what is left of it stands for all leading zeros.
#[inline]
pub fn permuted_radical_inverse(prime_index: usize, mut a: u32, hash: u32) -> f32 {
    let base = prime(prime_index);
    let inverse_base = 1.0 / base as f64;
    // Binary fractions, whose digits in a base are the integer parts of repeated products.
    let (mut shifts, mut multipliers) = (mix_word(hash), mix_word(!hash));
    let next_digit = |fraction: &mut u32, base: u32| {
        let product = *fraction as u64 * base as u64;
        *fraction = product as u32;
        (product >> 32) as u32
    };
    let (mut mirrored, mut scale) = (0u64, 1.0);
    while a > 0 {
        let next = a / base;
        let multiplier = 1 + next_digit(&mut multipliers, base - 1);
        let shift = next_digit(&mut shifts, base);
        mirrored = mirrored * base as u64 + ((multiplier * (a - next * base) + shift) % base) as u64;
        scale *= inverse_base;
        a = next;
    }
    to_unit((mirrored as f64 + shifts as f64 * 0.5f64.powi(32)) * scale)
}

/// [`radical_inverse`] with Owen scrambling: each digit permuted by those before it and
/// `hash`.
#[inline]
pub fn owen_scrambled_radical_inverse(prime_index: usize, a: u64, hash: u32) -> f32 {
    let base = prime(prime_index);
    let shows = |_, scale: f64| scale > VISIBLE;
    // The permuted digits so far after a one, so that leading zeros count.
    let mut before = 1_u32;
    let permute = |digit| {
        let permuted = permutation_element(digit as u32, base, mix_word(hash ^ before));
        before = before.wrapping_mul(base).wrapping_add(permuted);
        permuted as u64
    };
    mirror(base as u64, a, shows, permute)
}

/// Terms below half an epsilon of single precision do not change a sum near 1.
const VISIBLE: f64 = 0.5 * f32::EPSILON as f64;

/// Mirrors the digits of `a`, while `more(rest, scale of the last digit)`, each replaced by
/// `permute(digit)`.
#[inline]
fn mirror(
    base: u64,
    mut a: u64,
    more: impl Fn(u64, f64) -> bool,
    mut permute: impl FnMut(u64) -> u64,
) -> f32 {
    // Beyond this the mirrored integer might overflow.
    let limit = u64::MAX / base - base;
    let inverse_base = 1.0 / base as f64;
    let (mut mirrored, mut scale) = (0u64, 1.0f64);
    while more(a, scale) && mirrored < limit {
        let next = a / base;
        mirrored = mirrored * base + permute(a - next * base);
        scale *= inverse_base;
        a = next;
    }
    to_unit(mirrored as f64 * scale)
}

#[inline]
fn to_unit(x: f64) -> f32 {
    (x as f32).min(ONE_MINUS_EPSILON)
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Chi2;

    #[test]
    fn the_bases_are_the_first_thousand_primes() {
        assert_eq!(PRIMES.len(), PRIME_COUNT);
        assert_eq!((prime(0), prime(1), prime(4), prime(999)), (2, 3, 11, 7919));
    }

    #[test]
    fn digits_are_mirrored() {
        assert_eq!(radical_inverse(0, 0b1101), 0.6875);
        assert!((radical_inverse(1, 5) - (2.0 / 3.0 + 1.0 / 9.0)).abs() < 1e-7);
        assert!((0..PRIME_COUNT).all(|i| radical_inverse(i, u64::MAX) < 1.0));
    }

    #[test]
    fn two_digits_become_any_two() {
        let mut counts = [0; 25];
        for hash in 0..20_000 {
            let [x, y] = [1, 3].map(|a| (permuted_radical_inverse(2, a, mix_word(hash)) * 5.0) as usize);
            counts[5 * x + y] += 1;
        }
        let expected: [f64; 25] = std::array::from_fn(|i| if i / 5 == i % 5 { 0.0 } else { 1000.0 });
        Chi2::default().counts(&counts, &expected).unwrap();
    }

    #[test]
    fn scrambling_keeps_the_strata() {
        for prime_index in [0, 1, 3] {
            let base = prime(prime_index) as usize;
            for seed in 0..10 {
                let permuted = |a: u64| permuted_radical_inverse(prime_index, a as u32, mix_word(1 + seed));
                let owen = |a| owen_scrambled_radical_inverse(prime_index, a, seed);
                for scrambled in [&permuted as &dyn Fn(u64) -> f32, &owen] {
                    let count = base * base;
                    let mut seen = vec![false; count];
                    for a in 0..count {
                        let x = scrambled(a as u64);
                        assert!((0.0..1.0).contains(&x));
                        seen[(x as f64 * count as f64) as usize] = true;
                    }
                    assert!(seen.iter().all(|&s| s), "base {base}, seed {seed}");
                }
            }
        }
    }
}
