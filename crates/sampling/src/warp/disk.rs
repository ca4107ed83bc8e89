//! Uniform sampling of the unit disk, by polar coordinates and by the concentric map, which
//! preserves stratification [Shirley 1997].

use lanes::Real;
use math::{Vec2, sin_cos};
use std::f32::consts::{FRAC_1_PI, FRAC_PI_2, FRAC_PI_4, TAU};

/// A point of the unit disk: radius √u₀ at the angle 2π·u₁.
#[inline(always)]
pub fn sample_uniform_disk_polar<R: Real>(u: Vec2<R>) -> Vec2<R> {
    let (sin, cos) = sin_cos(u.y * R::splat(TAU));
    Vec2::new(cos, sin) * u.x.sqrt()
}

/// Inverse of [`sample_uniform_disk_polar`].
#[inline]
pub fn invert_uniform_disk_polar(p: Vec2) -> Vec2 {
    Vec2::new(p.length_squared(), turn(p.x, p.y))
}

/// A point of the unit disk: squares around the centre of the unit square are mapped to circles.
#[inline(always)]
pub fn sample_uniform_disk_concentric<R: Real>(u: Vec2<R>) -> Vec2<R> {
    let p = u * R::splat(2.0) - R::one();
    let along_x = p.x.abs().gt(p.y.abs());
    let r = R::select(along_x, p.x, p.y);
    // The centre has the radius 0 at any angle.
    let slope = R::select(r.eq(R::zero()), R::zero(), R::select(along_x, p.y, p.x) / r);
    let turn = slope * R::splat(FRAC_PI_4);
    let (sin, cos) = sin_cos(R::select(along_x, turn, R::splat(FRAC_PI_2) - turn));
    Vec2::new(cos, sin) * r
}

/// Inverse of [`sample_uniform_disk_concentric`].
#[inline]
pub fn invert_uniform_disk_concentric(p: Vec2) -> Vec2 {
    let r = p.length();
    if r == 0.0 {
        return Vec2::splat(0.5);
    }
    let q = if p.x.abs() > p.y.abs() {
        let x = r.copysign(p.x);
        Vec2::new(x, x * lanes::atan(p.y / p.x) / FRAC_PI_4)
    } else {
        let y = r.copysign(p.y);
        Vec2::new(y * lanes::atan(p.x / p.y) / FRAC_PI_4, y)
    };
    0.5 * (q + Vec2::ONE)
}

/// Density of both disk warps, per area.
#[inline]
pub fn uniform_disk_pdf() -> f32 {
    FRAC_1_PI
}

/// The angle of (x, y) in turns, in [0, 1).
#[inline]
pub(super) fn turn(x: f32, y: f32) -> f32 {
    let t = lanes::atan2(y, x) / TAU;
    if t < 0.0 { (t + 1.0).min(math::ONE_MINUS_EPSILON) } else { t }
}
