//! The bilinear density over the unit square [Pharr 2023 §A.5.5]: the marginal of y is linear, and
//! so is x given y.

use super::{invert_linear, sample_linear};
use lanes::Real;
use math::{Vec2, lerp};

/// A point of [0, 1]² with density proportional to the bilinear interpolation of weights ≥ 0 at
/// (0,0), (1,0), (0,1), (1,1).
#[inline(always)]
pub fn sample_bilinear<R: Real>(u: Vec2<R>, w: [R; 4]) -> Vec2<R> {
    let y = sample_linear(u.y, w[0] + w[1], w[2] + w[3]);
    Vec2::new(sample_linear(u.x, lerp(y, w[0], w[2]), lerp(y, w[1], w[3])), y)
}

/// Density of [`sample_bilinear`].
#[inline(always)]
pub fn bilinear_pdf<R: Real>(p: Vec2<R>, w: [R; 4]) -> R {
    let (zero, one) = (R::zero(), R::one());
    let inside = p.x.ge(zero) & p.x.le(one) & p.y.ge(zero) & p.y.le(one);
    let sum = w[0] + w[1] + w[2] + w[3];
    let pdf = R::splat(4.0) * lerp(p.x, lerp(p.y, w[0], w[2]), lerp(p.y, w[1], w[3])) / sum;
    R::select(inside, R::select(sum.le(zero), one, pdf), zero)
}

/// Inverse of [`sample_bilinear`].
#[inline]
pub fn invert_bilinear(p: Vec2, w: [f32; 4]) -> Vec2 {
    Vec2::new(
        invert_linear(p.x, lerp(p.y, w[0], w[2]), lerp(p.y, w[1], w[3])),
        invert_linear(p.y, w[0] + w[1], w[2] + w[3]),
    )
}
