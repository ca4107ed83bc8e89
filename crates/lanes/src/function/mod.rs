//! Elementary functions of numbers with lanes.
//!
//! They have the special values of the functions of `std`, of zeros with their signs, infinities
//! and NaN, and neither take nor give subnormal numbers for zeros. Errors are in units in the last
//! place (ulp) of the result; a correctly rounded one has 0.5. Of functions of one number they are
//! the largest over all floats. There are no tables and no fused multiply-adds, so that they are
//! fast, and have the same bits, on every instruction set.
//!
//! Polynomials have nearly the smallest relative error that coefficients of 24 bits allow
//! ([Brisebarre 2007], computed by Sollya's `fpminimax`). A comment beside each gives that error.

mod arc;
mod circular;
mod exponential;
mod logarithm;
mod power;

pub use arc::{acos, asin, atan, atan2};
pub use circular::{cos, sin, sin_cos};
pub use exponential::{exp, exp_m1};
pub use logarithm::{ln, ln_1p, log2};
pub use power::{cbrt, coarse_inverse_sqrt, hypot, pow, powi};

use crate::{Int, Real};

/// The sum of `coefficients[i]`·xⁱ.
#[inline(always)]
fn polynomial<R: Real, const N: usize>(x: R, coefficients: [f32; N]) -> R {
    let mut sum = R::splat(coefficients[N - 1]);
    for &coefficient in coefficients[..N - 1].iter().rev() {
        sum = sum * x + R::splat(coefficient);
    }
    sum
}

/// The integer nearest to |x| < 2²², as a float and as an integer in two's complement.
#[inline(always)]
fn round<R: Real>(x: R) -> (R, R::Int) {
    // Between 2²³ and 2²⁴ floats are the integers.
    let shift = R::splat(1.5 * 8_388_608.0);
    let sum = x + shift;
    (sum - shift, sum.to_bits().wrapping_sub(shift.to_bits()))
}

/// x·2ⁿ for −252 ≤ n ≤ 254, rounded once.
#[inline(always)]
fn scale<R: Real>(x: R, n: R::Int) -> R {
    let integer = R::Int::splat;
    let half = n.wrapping_add(integer(256)).shr(1).wrapping_sub(integer(128));
    x * power_of_two(half) * power_of_two(n.wrapping_sub(half))
}

/// 2ⁿ for −126 ≤ n ≤ 127.
#[inline(always)]
fn power_of_two<R: Real>(n: R::Int) -> R {
    R::from_bits(n.wrapping_add(R::Int::splat(127)).shl(23))
}

/// x > 0 as (1 + f)·2ⁿ with √½ ≤ 1 + f < √2: f, which is exact, and n.
#[inline(always)]
fn logarithmic_parts<R: Real>(x: R) -> (R, R) {
    let integer = R::Int::splat;
    // A subnormal number gets its leading one.
    let is_subnormal = x.lt(R::splat(f32::MIN_POSITIVE));
    let scaled = R::select(is_subnormal, x * R::splat(8_388_608.0), x);
    let bias = R::Int::select(is_subnormal, integer(127 + 23), integer(127));
    // Adding the distance from √½ to 1 carries into the exponent from √2 on.
    let root = integer(std::f32::consts::FRAC_1_SQRT_2.to_bits());
    let shifted = scaled.to_bits().wrapping_sub(root).wrapping_add(R::one().to_bits());
    let mantissa = (shifted & integer(0x7f_ffff)).wrapping_add(root);
    (R::from_bits(mantissa) - R::one(), shifted.shr(23).wrapping_sub(bias).to_real())
}
