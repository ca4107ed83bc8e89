//! Densities of one variable: linear, tent, smooth step, exponential; and pairs of normal
//! variables.
//!
//! Sources: [Pharr 2023 §2.4, §A.4]; [Box 1958] for the normal pair.

use lanes::{Each, Real};
use math::{ONE_MINUS_EPSILON, Vec2, lerp, smooth_step};
use std::f32::consts::TAU;

/// A number in [0, 1] with density proportional to `lerp(x, a, b)`, for a, b ≥ 0.
#[inline(always)]
pub fn sample_linear<R: Real>(u: R, a: R, b: R) -> R {
    let x = u * (a + b) / (a + lerp(u, a * a, b * b).sqrt());
    let x = x.min(R::splat(ONE_MINUS_EPSILON));
    let at_zero = u.eq(R::zero()) & a.eq(R::zero());
    R::select((a + b).le(R::zero()), u, R::select(at_zero, R::zero(), x))
}

/// Density of [`sample_linear`].
#[inline(always)]
pub fn linear_pdf<R: Real>(x: R, a: R, b: R) -> R {
    let inside = x.ge(R::zero()) & x.le(R::one());
    let pdf = lerp(x, a, b) * R::splat(2.0) / (a + b);
    let pdf = R::select((a + b).le(R::zero()), R::one(), pdf);
    R::select(inside, pdf, R::zero())
}

/// Inverse of [`sample_linear`].
#[inline(always)]
pub fn invert_linear<R: Real>(x: R, a: R, b: R) -> R {
    let u = x * (a * (R::splat(2.0) - x) + b * x) / (a + b);
    R::select((a + b).le(R::zero()), x, u)
}

/// A number in [−r, r] with a density that falls linearly from 0 to both ends.
#[inline(always)]
pub fn sample_tent<R: Real>(u: R, r: R) -> R {
    let (zero, one) = (R::zero(), R::one());
    let rises = u.lt(R::splat(0.5));
    let doubled = R::splat(2.0) * u;
    let [v, a, b] =
        [(doubled, doubled - one), (zero, one), (one, zero)].each(|(x, y)| R::select(rises, x, y));
    let x = sample_linear(v, a, b);
    r * R::select(rises, x - one, x)
}

/// Density of [`sample_tent`].
#[inline]
pub fn tent_pdf(x: f32, r: f32) -> f32 {
    (1.0 - x.abs() / r).max(0.0) / r
}

/// Inverse of [`sample_tent`].
#[inline]
pub fn invert_tent(x: f32, r: f32) -> f32 {
    if x <= 0.0 {
        0.5 - 0.5 * invert_linear(-x / r, 1.0, 0.0)
    } else {
        0.5 + 0.5 * invert_linear(x / r, 1.0, 0.0)
    }
}

/// A number in [a, b], for a < b, with density proportional to the smooth step from a to b.
///
/// With t = (x − a)/(b − a) its distribution is F(t) = 2t³ − t⁴. As t³ ≤ F ≤ 2t³ and F is convex,
/// Newton's iteration falls from ∛u to the root without passing it.
#[inline]
pub fn sample_smooth_step(u: f32, a: f32, b: f32) -> f32 {
    let mut t = lanes::cbrt(u);
    if t > 0.0 {
        for _ in 0..5 {
            t -= (t * t * t * (2.0 - t) - u) / (t * t * (6.0 - 4.0 * t));
        }
    }
    lerp(t, a, b)
}

/// Density of [`sample_smooth_step`].
#[inline]
pub fn smooth_step_pdf(x: f32, a: f32, b: f32) -> f32 {
    if x < a || x > b { 0.0 } else { 2.0 * smooth_step(x, a, b) / (b - a) }
}

/// Inverse of [`sample_smooth_step`].
#[inline]
pub fn invert_smooth_step(x: f32, a: f32, b: f32) -> f32 {
    let t = (x - a) / (b - a);
    t * t * t * (2.0 - t)
}

/// A number in [0, ∞) with density a·e^(−a·x), for a > 0.
#[inline]
pub fn sample_exponential(u: f32, a: f32) -> f32 {
    -lanes::ln_1p(-u) / a
}

/// Density of [`sample_exponential`].
#[inline]
pub fn exponential_pdf(x: f32, a: f32) -> f32 {
    if x < 0.0 { 0.0 } else { a * lanes::exp(-a * x) }
}

/// Inverse of [`sample_exponential`].
#[inline]
pub fn invert_exponential(x: f32, a: f32) -> f32 {
    -lanes::exp_m1(-a * x)
}

/// Two independent normal variables with mean `mu` and standard deviation `sigma`.
#[inline]
pub fn sample_two_normal(u: Vec2, mu: f32, sigma: f32) -> Vec2 {
    let r = (-2.0 * lanes::ln_1p(-u.x)).sqrt();
    let (sin, cos) = lanes::sin_cos(TAU * u.y);
    Vec2::splat(mu) + sigma * r * Vec2::new(cos, sin)
}

/// Density of either of the variables of [`sample_two_normal`].
#[inline]
pub fn normal_pdf(x: f32, mu: f32, sigma: f32) -> f32 {
    let z = (x - mu) / sigma;
    lanes::exp(-0.5 * z * z) / (sigma * TAU.sqrt())
}
