//! Densities of one variable: linear, tent, smooth step, exponential; and pairs of normal
//! variables.
//!
//! Sources: [Pharr 2023 §2.4, §A.4]; [Box 1958] for the normal pair.

use math::{ONE_MINUS_EPSILON, Vec2, lerp, smooth_step};
use std::f32::consts::TAU;

/// A number in [0, 1] with density proportional to `lerp(x, a, b)`, for a, b ≥ 0.
#[inline]
pub fn sample_linear(u: f32, a: f32, b: f32) -> f32 {
    if a + b <= 0.0 {
        return u;
    }
    if u == 0.0 && a == 0.0 {
        return 0.0;
    }
    let x = u * (a + b) / (a + lerp(u, a * a, b * b).sqrt());
    x.min(ONE_MINUS_EPSILON)
}

/// Density of [`sample_linear`].
#[inline]
pub fn linear_pdf(x: f32, a: f32, b: f32) -> f32 {
    if !(0.0..=1.0).contains(&x) {
        0.0
    } else if a + b <= 0.0 {
        1.0
    } else {
        2.0 * lerp(x, a, b) / (a + b)
    }
}

/// Inverse of [`sample_linear`].
#[inline]
pub fn invert_linear(x: f32, a: f32, b: f32) -> f32 {
    if a + b <= 0.0 { x } else { x * (a * (2.0 - x) + b * x) / (a + b) }
}

/// A number in [−r, r] with a density that falls linearly from 0 to both ends.
#[inline]
pub fn sample_tent(u: f32, r: f32) -> f32 {
    if u < 0.5 {
        r * (sample_linear(2.0 * u, 0.0, 1.0) - 1.0)
    } else {
        r * sample_linear(2.0 * u - 1.0, 1.0, 0.0)
    }
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
    let mut t = u.cbrt();
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
    -(-u).ln_1p() / a
}

/// Density of [`sample_exponential`].
#[inline]
pub fn exponential_pdf(x: f32, a: f32) -> f32 {
    if x < 0.0 { 0.0 } else { a * (-a * x).exp() }
}

/// Inverse of [`sample_exponential`].
#[inline]
pub fn invert_exponential(x: f32, a: f32) -> f32 {
    -(-a * x).exp_m1()
}

/// Two independent normal variables with mean `mu` and standard deviation `sigma`.
#[inline]
pub fn sample_two_normal(u: Vec2, mu: f32, sigma: f32) -> Vec2 {
    let r = (-2.0 * (-u.x).ln_1p()).sqrt();
    let (sin, cos) = (TAU * u.y).sin_cos();
    Vec2::splat(mu) + sigma * r * Vec2::new(cos, sin)
}

/// Density of either of the variables of [`sample_two_normal`].
#[inline]
pub fn normal_pdf(x: f32, mu: f32, sigma: f32) -> f32 {
    let z = (x - mu) / sigma;
    (-0.5 * z * z).exp() / (sigma * TAU.sqrt())
}
