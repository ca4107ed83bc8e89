//! Two textures in alternation, on squares of the plane or cubes of space with unit sides.
//!
//! In one dimension the pattern is the square wave c(x), +1 where ⌊x⌋ is even and −1 where it is
//! odd; in several it is the product of one wave for each axis, and the first texture is seen where
//! that is +1. A wave is averaged over the pixel with a triangle filter of radius r, 1.5 times the
//! distance to the next pixel's coordinate:
//!
//! ```text
//! c̄(x, r) = ∫ c(x + e)·(1 − |e|/r)/r de = (C(x + r) − 2C(x) + C(x − r))/r²        C″ = c
//! ```
//!
//! For r ≤ ½ the triangle reaches one edge of the wave at most, and with a = |distance to the
//! edge|/r ≤ 1 the integral is ±(1 − (1 − a)²), which has none of the cancellation of the second
//! difference. The amount of the second texture is ½ − ½·∏ c̄.
//!
//! Source: [Pharr 2023 §10.3.3], with the box filter replaced as pbrt-v4 does.

use super::{TexCoord2d, TexCoord3d};
use math::sqr;

/// The share of the second texture on squares of the plane, in [0, 1].
pub(super) fn squares(c: &TexCoord2d) -> f32 {
    let product = filtered_wave(c.st.x, radius(c.dstdx.x, c.dstdy.x))
        * filtered_wave(c.st.y, radius(c.dstdx.y, c.dstdy.y));
    0.5 - 0.5 * product
}

/// The share of the second texture in cubes of space, in [0, 1].
pub(super) fn cubes(c: &TexCoord3d) -> f32 {
    let product: f32 = (0..3).map(|i| filtered_wave(c.p[i], radius(c.dpdx[i], c.dpdy[i]))).product();
    0.5 - 0.5 * product
}

/// The filter's radius along a coordinate with these derivatives by film position.
fn radius(dx: f32, dy: f32) -> f32 {
    1.5 * dx.abs().max(dy.abs())
}

/// The wave averaged with a triangle of radius `r` about `x`.
fn filtered_wave(x: f32, r: f32) -> f32 {
    if r <= 0.5 {
        let edge = x.round();
        let right_of_edge = if edge.rem_euclid(2.0) == 0.0 { 1.0 } else { -1.0 };
        let side = if x >= edge { right_of_edge } else { -right_of_edge };
        // `min` makes 1 of the 0/0 of a point on an edge, seen sharp.
        let a = ((x - edge).abs() / r).min(1.0);
        side * (1.0 - sqr(1.0 - a))
    } else if r.is_finite() {
        (second_integral(x + r) - 2.0 * second_integral(x) + second_integral(x - r)) / sqr(r)
    } else {
        0.0
    }
}

/// A function of period 2 whose second derivative is the wave.
fn second_integral(x: f32) -> f32 {
    let y = 0.5 * x - (0.5 * x).floor() - 0.5;
    y * (1.0 - 2.0 * y.abs())
}
