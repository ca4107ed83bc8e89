//! Inverse circular functions.

use super::polynomial;
use crate::Real;
use std::f32::consts::{FRAC_PI_2, PI};

/// π/2 − FRAC_PI_2.
const FRAC_PI_2_REST: f32 = -4.371_139e-8;

/// arcsin x in [−π/2, π/2], with an error below 1.4 ulp; NaN where |x| > 1.
#[inline(always)]
pub fn asin<R: Real>(x: R) -> R {
    let (is_small, arc) = arcsine(x.abs());
    let near_one = R::splat(FRAC_PI_2) - (arc + arc - R::splat(FRAC_PI_2_REST));
    R::select(is_small, arc, near_one).copysign(x)
}

/// arccos x in [0, π], with an error below 1.2 ulp; NaN where |x| > 1.
#[inline(always)]
pub fn acos<R: Real>(x: R) -> R {
    let (is_small, arc) = arcsine(x.abs());
    let (arc, is_negative) = (arc.copysign(x), x.lt(R::zero()));
    let near_zero = R::splat(FRAC_PI_2) - (arc - R::splat(FRAC_PI_2_REST));
    let twice = arc + arc;
    let near_minus_one = R::splat(PI) + (twice + R::splat(2.0 * FRAC_PI_2_REST));
    R::select(is_small, near_zero, R::select(is_negative, near_minus_one, twice))
}

/// Of 0 ≤ x ≤ 1 the arcsine where the mask is true; elsewhere half of the arccosine.
#[inline(always)]
fn arcsine<R: Real>(x: R) -> (R::Mask, R) {
    let is_small = x.lt(R::splat(0.55));
    // cos 2a = 1 − 2 sin² a
    let z = R::select(is_small, x * x, R::splat(0.5) - R::splat(0.5) * x);
    let s = R::select(is_small, x, z.sqrt());
    // Relative error 2⁻²⁹·⁵ for s ≤ 0.55.
    let sum = [0.166_666_4, 7.501_619e-2, 4.431_311e-2, 3.342_478e-2, 8.645_301e-3, 4.520_694e-2];
    (is_small, s + s * z * polynomial(z, sum))
}

/// arctan x in [−π/2, π/2], with an error below 1.6 ulp.
#[inline(always)]
pub fn atan<R: Real>(x: R) -> R {
    let magnitude = x.abs();
    let is_large = magnitude.gt(R::one());
    let arc = arctangent(R::select(is_large, R::one(), magnitude) / R::select(is_large, magnitude, R::one()));
    let from_above = R::splat(FRAC_PI_2) - (arc - R::splat(FRAC_PI_2_REST));
    R::select(is_large, from_above, arc).copysign(x)
}

/// The angle in [−π, π] from the x axis to the point (x, y), with an error below 2 ulp. It has the
/// sign of y. Signs of zeros count, and infinite coordinates are equally far.
#[inline(always)]
pub fn atan2<R: Real>(y: R, x: R) -> R {
    let (a, b) = (y.abs(), x.abs());
    let is_steep = a.gt(b);
    let (small, large) = (R::select(is_steep, b, a), R::select(is_steep, a, b));
    let quotient = small / R::select(large.eq(R::zero()), R::one(), large);
    let infinity = R::splat(f32::INFINITY);
    let quotient = R::select(small.eq(infinity) & large.eq(infinity), R::one(), quotient);
    // From the arc in the first octant to π/2 minus it, and from x > 0 to π minus that.
    let arc = arctangent(quotient);
    let (right, rest) = (R::splat(FRAC_PI_2), R::splat(FRAC_PI_2_REST));
    let is_left = R::one().copysign(x).lt(R::zero());
    let arc = R::select(is_left ^ is_steep, -arc, arc);
    let straight = right + right;
    let start = R::select(is_left, straight, R::zero());
    let start_rest = R::select(is_left, rest + rest, R::zero());
    let arc = R::select(is_steep, right, start) + (arc + R::select(is_steep, rest, start_rest));
    arc.copysign(y)
}

/// arctan x for 0 ≤ x ≤ 1, with a relative error of 2⁻²⁸·⁵ before rounding.
#[inline(always)]
fn arctangent<R: Real>(x: R) -> R {
    let z = x * x;
    let sum = [
        -0.333_333,
        0.199_985_36,
        -0.142_641_26,
        0.109_516_546,
        -8.402_056e-2,
        5.793_580_4e-2,
        -3.115_776_5e-2,
        1.090_453_6e-2,
        -1.791_502e-3,
    ];
    x + x * z * polynomial(z, sum)
}
