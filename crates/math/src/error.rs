//! Points with error bounds, and ray origins that are clear of the surface a ray leaves.
//!
//! A hit point is computed in floats, so that it lies slightly off its surface. Instead of a tuned
//! epsilon it carries an error bound per axis; a spawned ray starts outside of the box of that
//! error, on the side that it leaves to ([Pharr 2023 §6.8.6]).

use crate::{Normal3, Point3, Vec3, Vector3};

/// A point with the bound of the absolute error of each of its coordinates.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point3Error {
    /// The computed position.
    pub p: Point3,
    /// Bound of |computed − exact|, per axis, ≥ 0.
    pub error: Vector3,
}

impl Point3Error {
    /// A point that is known exactly.
    #[inline]
    pub fn exact(p: Point3) -> Self {
        Self { p, error: Vec3::ZERO }
    }

    /// A point with its error bound.
    #[inline]
    pub fn new(p: Point3, error: Vector3) -> Self {
        Self { p, error }
    }
}

/// The origin of a ray in direction `w` that cannot intersect the surface with geometric normal `n`
/// at `p` again.
#[inline]
pub fn offset_ray_origin(p: Point3Error, n: Normal3, w: Vector3) -> Point3 {
    let distance = n.abs().dot(p.error);
    let offset = if w.dot(n) < 0.0 { -n * distance } else { n * distance };
    let q = p.p + offset;
    // One float further than the rounded sum, along the axes that are offset.
    let step = (q.abs() * f32::EPSILON).copysign(offset);
    Vec3::select(offset.cmpeq(Vec3::ZERO), q, q + step)
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
