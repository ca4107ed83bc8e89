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
use lanes::{Each, Mask, Real};
use math::sqr;

/// The share of the second texture on squares of the plane, in [0, 1].
#[inline(always)]
pub(super) fn squares<R: Real>(c: &TexCoord2d<R>) -> R {
    let product = filtered_wave(c.st.x, radius(c.dstdx.x, c.dstdy.x))
        * filtered_wave(c.st.y, radius(c.dstdx.y, c.dstdy.y));
    R::splat(0.5) - R::splat(0.5) * product
}

/// The share of the second texture in cubes of space, in [0, 1].
#[inline(always)]
pub(super) fn cubes<R: Real>(c: &TexCoord3d<R>) -> R {
    let mut product = R::one();
    for axis in 0..3 {
        product *= filtered_wave(c.p[axis], radius(c.dpdx[axis], c.dpdy[axis]));
    }
    R::splat(0.5) - R::splat(0.5) * product
}

/// The filter's radius along a coordinate with these derivatives by film position.
#[inline(always)]
fn radius<R: Real>(dx: R, dy: R) -> R {
    R::splat(1.5) * dx.abs().max(dy.abs())
}

/// The wave averaged with a triangle of radius `r` about `x`.
#[inline(always)]
fn filtered_wave<R: Real>(x: R, r: R) -> R {
    let [half, one, two] = [0.5, 1.0, 2.0].each(R::splat);
    let is_sharp = r.le(half);
    let mut wave = R::zero();
    if is_sharp.any() {
        let below = x.floor();
        let edge = R::select((x - below).ge(half), below + one, below);
        let pairs = edge * half;
        let right_of_edge = R::select(pairs.eq(pairs.floor()), one, -one);
        let side = R::select(x.ge(edge), right_of_edge, -right_of_edge);
        // `min` makes 1 of the 0/0 of a point on an edge, seen sharp.
        let a = ((x - edge).abs() / r).min(one);
        wave = side * (one - sqr(one - a));
    }
    if !is_sharp.all() {
        let blurred = second_integral(x + r) - two * second_integral(x) + second_integral(x - r);
        let blurred = R::select(r.lt(R::splat(f32::INFINITY)), blurred / sqr(r), R::zero());
        wave = R::select(is_sharp, wave, blurred);
    }
    wave
}

/// A function of period 2 whose second derivative is the wave.
#[inline(always)]
fn second_integral<R: Real>(x: R) -> R {
    let half = R::splat(0.5);
    let y = half * x - (half * x).floor() - half;
    y * (R::one() - R::splat(2.0) * y.abs())
}
