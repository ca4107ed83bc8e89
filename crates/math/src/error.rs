//! Points with error bounds, and ray origins that are clear of the surface a ray leaves.
//!
//! A hit point is computed in floats, so that it lies slightly off its surface. Instead of a tuned
//! epsilon it carries an error bound per axis; a spawned ray starts outside of the box of that
//! error, on the side that it leaves to ([Pharr 2023 §6.8.6]).

use crate::{Normal3, Point3, Vec3, Vector3};
use lanes::Real;

/// A point with the bound of the absolute error of each of its coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point3Error<R = f32> {
    /// The computed position.
    pub p: Point3<R>,
    /// Bound of |computed − exact|, per axis, ≥ 0.
    pub error: Vector3<R>,
}

impl<R: Real> Point3Error<R> {
    /// A point that is known exactly.
    #[inline(always)]
    pub fn exact(p: Point3<R>) -> Self {
        Self { p, error: Vec3::splat(R::zero()) }
    }

    /// A point with its error bound.
    #[inline(always)]
    pub fn new(p: Point3<R>, error: Vector3<R>) -> Self {
        Self { p, error }
    }
}

/// The origin of a ray in direction `w` that cannot intersect the surface with geometric normal `n`
/// at `p` again.
#[inline(always)]
pub fn offset_ray_origin<R: Real>(p: Point3Error<R>, n: Normal3<R>, w: Vector3<R>) -> Point3<R> {
    let distance = n.abs().dot(p.error);
    let offset = n * R::select(w.dot(n).lt(R::zero()), -distance, distance);
    let q = p.p + offset;
    // One float further than the rounded sum, along the axes that are offset.
    let step = (q.abs() * R::splat(f32::EPSILON)).copysign(offset);
    let along = |offset: R, q: R, step: R| R::select(offset.eq(R::zero()), q, q + step);
    Vec3::new(along(offset.x, q.x, step.x), along(offset.y, q.y, step.y), along(offset.z, q.z, step.z))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn origins_leave_the_error_box_on_the_right_side() {
        let p = Point3Error::new(Vec3::new(1.0, 2.0, 3.0), Vec3::splat(1e-5));
        let up = offset_ray_origin(p, Vec3::Z, Vec3::new(0.5, 0.0, 0.5));
        let down = offset_ray_origin(p, Vec3::Z, Vec3::new(0.5, 0.0, -0.5));
        assert!(up.z > 3.0 + 0.99e-5 && down.z < 3.0 - 0.99e-5);
        assert_eq!((up.x, up.y), (1.0, 2.0));
    }
}
