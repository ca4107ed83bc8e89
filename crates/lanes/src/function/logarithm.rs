//! Logarithms.

use super::{logarithmic_parts, polynomial};
use crate::Real;

/// ln x, with an error below 0.9 ulp; −∞ for zeros, NaN below.
#[inline(always)]
pub fn ln<R: Real>(x: R) -> R {
    let (f, n) = logarithmic_parts(x);
    let result = logarithm(f, n, R::zero());
    limits(x, x, result)
}

/// log₂ x, with an error below 2 ulp; exact for powers of two, −∞ for zeros, NaN below.
#[inline(always)]
pub fn log2<R: Real>(x: R) -> R {
    let (f, n) = logarithmic_parts(x);
    let part = logarithm(f, R::zero(), R::zero()) * R::splat(std::f32::consts::LOG2_E);
    limits(x, x, n + part)
}

/// ln(1 + x), with an error below 1 ulp, also where x is small; −∞ for −1, NaN below.
#[inline(always)]
pub fn ln_1p<R: Real>(x: R) -> R {
    // The sum and its rounding error (Knuth's two-sum).
    let sum = R::one() + x;
    let part = sum - R::one();
    let lost = (R::one() - (sum - part)) + (x - part);
    let (f, n) = logarithmic_parts(sum);
    // ln(sum + lost) = ln sum + lost / sum
    let result = logarithm(f, n, lost / sum);
    limits(x, sum, result).copysign(x)
}

/// ln(1 + f) + n ln 2 + rest for √½ ≤ 1 + f < √2 and a small rest.
#[inline(always)]
fn logarithm<R: Real>(f: R, n: R, rest: R) -> R {
    // Relative error 2⁻²⁶·⁷.
    let sum = [
        0.333_332_75,
        -0.250_007_96,
        0.200_043_11,
        -0.166_262_67,
        0.141_504_62,
        -0.130_887_42,
        0.130_323_17,
        -8.114_867e-2,
    ];
    let z = f * f;
    let cubic = f * z * polynomial(f, sum);
    // ln 2 in two parts: the first has 15 bits, so that its product with n is exact ([Cody 1980]).
    let small = cubic + (n * R::splat(1.428_606_8e-6) + rest) - R::splat(0.5) * z;
    n * R::splat(0.693_145_75) + (f + small)
}

/// The logarithm where it is finite; else that of zero, negative numbers, infinity and NaN. `x`
/// and the argument of the logarithm differ by a constant.
#[inline(always)]
fn limits<R: Real>(x: R, argument: R, logarithm: R) -> R {
    let limit = R::select(argument.eq(R::zero()), R::splat(f32::NEG_INFINITY), R::splat(f32::NAN));
    let positive = R::select(x.lt(R::splat(f32::INFINITY)), logarithm, x);
    R::select(argument.gt(R::zero()), positive, limit)
}
