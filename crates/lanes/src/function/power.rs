//! Powers and roots.

use super::{logarithmic_parts, polynomial, round, scale};
use crate::{Int, Real};
use std::f32::consts::LN_2;

/// xʸ, with an error below 2 ulp. A negative number has powers with integers only, others are NaN.
#[inline(always)]
pub fn pow<R: Real>(x: R, y: R) -> R {
    let (zero, one, infinity) = (R::zero(), R::one(), R::splat(f32::INFINITY));
    let base = x.abs();
    let log = log2_parts(base);
    // The product in two parts. Large ones give zero or infinity.
    let product = y * log.0;
    let rest = product_rest(y, log.0, product) + y * log.1;
    let limit = R::splat(200.0);
    let rest = R::select(product.abs().lt(limit), rest, zero);
    let product = limit.min((-limit).max(product));
    let (n, integer) = round(product);
    let r = (product - n) + rest;
    // 2ʳ with a relative error of 2⁻²⁸.
    let sum = [LN_2, 0.240_226_45, 5.550_358e-2, 9.618_826e-3, 1.339_168_4e-3, 1.524_499_5e-4];
    let power = scale(one + r * polynomial(r, sum), integer);
    // Where the base or the exponent has no logarithm or product.
    let grows = base.gt(one) ^ y.lt(zero);
    let has_limit = base.eq(zero) | base.eq(infinity) | y.abs().eq(infinity);
    let power = R::select(has_limit, R::select(grows, infinity, zero), power);
    let power = R::select(base.eq(one), one, power);
    // Signs of odd powers.
    let half = y * R::splat(0.5);
    let is_integer = y.floor().eq(y);
    let is_odd = is_integer & half.floor().ne(half);
    let power = power.copysign(R::select(is_odd, x, one));
    let is_undefined = x.lt(zero) & x.ne(-infinity) & !is_integer | x.ne(x) | y.ne(y);
    let power = R::select(is_undefined, R::splat(f32::NAN), power);
    R::select(x.eq(one) | y.eq(zero), one, power)
}

/// xⁿ by repeated multiplication, with an error below |n| ulp. For n < 0 it is the reciprocal of
/// x⁻ⁿ, and zero where that is infinite.
#[inline(always)]
pub fn powi<R: Real>(x: R, n: i32) -> R {
    let (mut square, mut rest, mut power) = (x, n.unsigned_abs(), R::one());
    while rest > 0 {
        if rest & 1 == 1 {
            power *= square;
        }
        rest >>= 1;
        if rest > 0 {
            square *= square;
        }
    }
    if n < 0 { R::one() / power } else { power }
}

/// 1/√x of a positive normal number with a relative error below 5·10⁻⁶, in a fraction of the time
/// of root and quotient; any finite numbers elsewhere.
#[inline(always)]
pub fn coarse_inverse_sqrt<R: Real>(x: R) -> R {
    // Half of the exponent, from the bits, and two steps of Newton's method.
    let half = R::splat(0.5) * x;
    let mut root = R::from_bits(R::Int::splat(0x5f37_5a86).wrapping_sub(x.to_bits().shr(1)));
    for _ in 0..2 {
        root = root * (R::splat(1.5) - half * root * root);
    }
    root
}

/// ∛x, with an error below 0.6 ulp.
#[inline(always)]
pub fn cbrt<R: Real>(x: R) -> R {
    let (real, integer) = (R::splat, R::Int::splat);
    let magnitude = x.abs();
    let is_subnormal = magnitude.lt(real(f32::MIN_POSITIVE));
    let scaled = R::select(is_subnormal, magnitude * real(16_777_216.0), magnitude).to_bits();
    // With 127 = 3·42 + 1 the biased exponent is 3(q + 43) + k − 2, for the cube root 2^q of all
    // but k < 3 of it. Its third is exact.
    let shifted = scaled.shr(23).wrapping_add(integer(2));
    let third = shifted.wrapping_mul(integer(171)).shr(9);
    let k = shifted.wrapping_sub(third.wrapping_mul(integer(3)));
    let mantissa = R::from_bits(scaled & integer(0x7f_ffff) | integer(127 << 23));
    let number = R::from_bits(mantissa.to_bits().wrapping_add(k.shl(23)));
    // The root with an error of 2⁻¹⁰·⁶, rounded to eight bits, so that its cube is exact.
    let first = polynomial(mantissa, [0.621_513_6, 0.439_441_83, -6.031_939_4e-2]);
    let (is_one, is_two) = (k.eq(integer(1)), k.eq(integer(2)));
    let root_of_two = real(1.259_921_1);
    let factor = R::select(is_two, real(1.587_401), R::select(is_one, root_of_two, R::one()));
    let bits = (first * factor).to_bits().wrapping_add(integer(0x8000));
    let root = R::from_bits(bits & integer(0xffff_0000));
    // ∛(1 + u) − 1, a series
    let cube = root * root * root;
    let u = (number - cube) / cube;
    let correction = u * polynomial(u, [1.0 / 3.0, -1.0 / 9.0, 5.0 / 81.0]);
    let offset = R::Int::select(is_subnormal, integer(84 - 8), integer(84));
    let result = (root + root * correction) * R::from_bits(third.wrapping_add(offset).shl(23));
    let is_finite = magnitude.gt(R::zero()) & magnitude.lt(real(f32::INFINITY));
    R::select(is_finite, result.copysign(x), x)
}

/// √(x² + y²), with an error below 1.5 ulp, and no overflow of the squares; infinite where x or y
/// is.
#[inline(always)]
pub fn hypot<R: Real>(x: R, y: R) -> R {
    let (a, b, infinity) = (x.abs(), y.abs(), R::splat(f32::INFINITY));
    let larger = R::select(a.gt(b), a, b);
    // Scaled so that no square overflows, and none that counts is subnormal.
    const LARGE: f32 = (1_u128 << 100) as f32;
    let (up, down) = (R::splat(LARGE), R::splat(1.0 / LARGE));
    let (is_large, is_small) = (larger.gt(R::splat(1e18)), larger.lt(R::splat(1e-12)));
    let pick = |large, small| R::select(is_large, large, R::select(is_small, small, R::one()));
    let (a_scaled, b_scaled) = (a * pick(down, up), b * pick(down, up));
    let length = (a_scaled * a_scaled + b_scaled * b_scaled).sqrt() * pick(up, down);
    R::select(a.eq(infinity) | b.eq(infinity), infinity, length)
}

/// log₂ of a positive number in two parts, with a relative error of about 2⁻³².
#[inline(always)]
fn log2_parts<R: Real>(x: R) -> (R, R) {
    let (f, n) = logarithmic_parts(x);
    let mantissa = R::one() + f;
    // The nearest of 2^(−1/3), 1 and 2^(1/3), and its logarithm in two parts, the first of 13 bits.
    let is_low = mantissa.lt(R::splat(0.890_898_7));
    let is_high = mantissa.gt(R::splat(1.122_462));
    let choose = |low, middle, high| {
        R::select(is_low, R::splat(low), R::select(is_high, R::splat(high), R::splat(middle)))
    };
    let centre = choose(0.793_700_5, 1.0, 1.259_921_1);
    let start = n + choose(-0.333_313, 0.0, 0.333_313);
    let start_rest = choose(-2.036_279_3e-5, 0.0, 2.037_255_6e-5);
    // ln(m / c) = 2 artanh s for s = (m − c) / (m + c), in two parts.
    let (difference, sum) = (mantissa - centre, mantissa + centre);
    let sum_rest = mantissa - (sum - centre);
    let reciprocal = R::one() / sum;
    let s = difference * reciprocal;
    let product = s * sum;
    let s_rest = (difference - product - product_rest(s, sum, product) - s * sum_rest) * reciprocal;
    // artanh s with a relative error of 2⁻³⁸; the terms after s are below s / 900.
    let z = s * s;
    let terms = s * z * polynomial(z, [0.333_333_34, 0.199_990_82, 0.145_118_5]);
    let artanh = s + terms;
    let artanh_rest = (s - artanh) + terms + s_rest;
    // 2 log₂ e in two parts
    let factor = R::splat(2.885_39);
    let product = artanh * factor;
    let rest = product_rest(artanh, factor, product)
        + (artanh * R::splat(3.851_926e-8) + artanh_rest * factor)
        + start_rest;
    let log = start + product;
    (log, (start - log) + product + rest)
}

/// a·b minus its rounded value, from products of halves, which are exact ([Dekker 1971]).
#[inline(always)]
fn product_rest<R: Real>(a: R, b: R, product: R) -> R {
    let split = |x: R| {
        let high = R::from_bits(x.to_bits() & R::Int::splat(0xffff_f000));
        (high, x - high)
    };
    let ((a, a_low), (b, b_low)) = (split(a), split(b));
    ((a * b - product) + a * b_low + a_low * b) + a_low * b_low
}
