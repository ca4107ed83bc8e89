//! Exponential functions.

use super::{polynomial, power_of_two, round, scale};
use crate::{Int, Real};
use std::f32::consts::LOG2_E;

/// eˣ, with an error below 1.1 ulp.
#[inline(always)]
pub fn exp<R: Real>(x: R) -> R {
    // Beyond these limits the result is zero or infinite. A NaN stays.
    let (n, power_m1) = reduce(R::splat(89.0).min(R::splat(-104.0).max(x)));
    scale(R::one() + power_m1, n)
}

/// eˣ − 1, with an error below 1.7 ulp, also where x is small.
#[inline(always)]
pub fn exp_m1<R: Real>(x: R) -> R {
    let (n, power_m1) = reduce(R::splat(89.0).min(R::splat(-20.0).max(x)));
    // (2ⁿ·(1 + p) − 1) / 2, because 2¹²⁸ is no float.
    let half = power_of_two::<R>(n.wrapping_sub(R::Int::splat(1)));
    let result = half * power_m1 + (half - R::splat(0.5));
    // The half of a tiny number may be subnormal.
    let is_tiny = x.abs().lt(R::splat(1e-30));
    R::select(is_tiny, x, result + result).copysign(x)
}

/// An integer n and p = e^(x − n ln 2) − 1 with |x − n ln 2| ≤ ln 2 / 2.
#[inline(always)]
fn reduce<R: Real>(x: R) -> (R::Int, R) {
    let (n, integer) = round(x * R::splat(LOG2_E));
    // ln 2 in two parts: the first has 15 bits, so that its product with n is exact ([Cody 1980]).
    let r = x - n * R::splat(0.693_145_75) - n * R::splat(1.428_606_8e-6);
    // Relative error 2⁻²⁶·¹.
    let sum = [0.499_999_97, 0.166_665_43, 4.166_750_6e-2, 8.366_556e-3, 1.386_428_7e-3];
    (integer, r + r * r * polynomial(r, sum))
}
