//! Sine and cosine.

use super::{polynomial, round};
use crate::{Int, MAX_LANES, Mask, Real};
use std::f32::consts::FRAC_2_PI;

/// sin x, of radians, with an error below 1.6 ulp. Angles from 800 on take longer.
#[inline(always)]
pub fn sin<R: Real>(x: R) -> R {
    sin_cos(x).0
}

/// cos x, of radians, with an error below 1.6 ulp. Angles from 800 on take longer.
#[inline(always)]
pub fn cos<R: Real>(x: R) -> R {
    sin_cos(x).1
}

/// Both [`sin`] and [`cos`].
#[inline(always)]
pub fn sin_cos<R: Real>(x: R) -> (R, R) {
    let magnitude = x.abs();
    let (r, quadrant) = reduce(magnitude);
    let z = r * r;
    // sin r and cos r for |r| ≤ π/4; relative errors 2⁻²⁷·⁹ and 2⁻³³.
    let sin = r + r * z * polynomial(z, [-0.166_666_55, 8.332_189e-3, -1.951_826_3e-4]);
    let quartic = z * z * polynomial(z, [4.166_664_6e-2, -1.388_731_1e-3, 2.443_255_3e-5]);
    let cos = R::one() - (R::splat(0.5) * z - quartic);
    let integer = R::Int::splat;
    let is_odd = (quadrant & integer(1)).eq(integer(1));
    let sign = |quadrant: R::Int| (quadrant & integer(2)).shl(30);
    let sin_sign = sign(quadrant) ^ x.to_bits() & integer(1 << 31);
    let cos_sign = sign(quadrant.wrapping_add(integer(1)));
    (
        R::from_bits(R::select(is_odd, cos, sin).to_bits() ^ sin_sign),
        R::from_bits(R::select(is_odd, sin, cos).to_bits() ^ cos_sign),
    )
}

/// A positive angle as a multiple of π/2, whose last two bits count, and a rest of at most π/4.
#[inline(always)]
fn reduce<R: Real>(x: R) -> (R, R::Int) {
    let (n, quadrant) = round(x * R::splat(FRAC_2_PI));
    // π/2 in three parts, of which two have 15 bits: products with n < 2⁹ are exact, and so are the
    // first difference and the rounding error of the second ([Cody 1980]).
    let (first, part) = (x - n * R::splat(1.570_800_8), n * R::splat(-4.454_516e-6));
    let second = first - part;
    let lost = (first - second) - part;
    let rest = second - (n * R::splat(6.077_100_6e-11) - lost);
    let is_large = x.ge(R::splat(FIRST_LARGE));
    if !is_large.any() {
        return (rest, quadrant);
    }
    let (large_rest, large_quadrant) = reduce_large(&x.to_array());
    (
        R::select(is_large, R::load(&large_rest), rest),
        R::Int::select(is_large, R::Int::load(&large_quadrant), quadrant),
    )
}

const FIRST_LARGE: f32 = 800.0;

/// Rests and multiples of π/2 of the angles from [`FIRST_LARGE`] on, in integers: of 2/π only the
/// bits that change the quadrant and the rest are multiplied ([Payne 1983]).
#[cold]
#[inline(never)]
fn reduce_large(angles: &[f32; MAX_LANES]) -> ([f32; MAX_LANES], [u32; MAX_LANES]) {
    /// 2/π in units of 2⁻¹²⁸, and the fraction of that.
    const TWO_BY_PI: [u128; 2] =
        [0xa2f9_836e_4e44_1529_fc27_57d1_f534_ddc0, 0xdb62_9599_3c43_9041_fe51_63ab_debb_c561];
    const FRACTION_BITS: u32 = 94;
    let (mut rests, mut quadrants) = ([0.0; MAX_LANES], [0; MAX_LANES]);
    for ((&x, rest), quadrant) in angles.iter().zip(&mut rests).zip(&mut quadrants) {
        if x == f32::INFINITY {
            *rest = f32::NAN;
        } else if x >= FIRST_LARGE {
            // x = mantissa·2^(exponent − 150)
            let (mantissa, exponent) = (x.to_bits() & 0x7f_ffff | 1 << 23, x.to_bits() >> 23);
            let shift = 256 + 150 - FRACTION_BITS - exponent;
            let factor = match shift.checked_sub(128) {
                Some(shift) => TWO_BY_PI[0] >> shift,
                None => TWO_BY_PI[0] << (128 - shift) | TWO_BY_PI[1] >> shift,
            };
            // The quadrant in the top two bits. Others overflow.
            let product = (factor << 32 >> 32).wrapping_mul(mantissa.into()) << (126 - FRACTION_BITS);
            let nearest = product.wrapping_add(1 << 125) >> 126;
            *quadrant = nearest as u32;
            let fraction = product.wrapping_sub(nearest << 126) as i128;
            *rest = (fraction as f64 * (std::f64::consts::FRAC_PI_2 / (1_u128 << 126) as f64)) as f32;
        }
    }
    (rests, quadrants)
}
