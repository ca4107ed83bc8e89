//! Right-handed orthonormal frames.

use crate::{Vec3, Vector3};
use lanes::{Mask, Real};

/// Three orthonormal axes; local +z is the main axis (the normal of a surface, the axis of a beam).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame<R = f32> {
    /// Local +x in outer coordinates.
    pub x: Vector3<R>,
    /// Local +y in outer coordinates.
    pub y: Vector3<R>,
    /// Local +z in outer coordinates.
    pub z: Vector3<R>,
}

impl<R: Real> Frame<R> {
    /// A frame with the unit vector `z`, and any x and y.
    #[inline(always)]
    pub fn from_z(z: Vector3<R>) -> Self {
        let (x, y) = coordinate_system(z);
        Self { x, y, z }
    }

    /// The frame with the unit vector `z`, and the direction nearest to `x` that is perpendicular
    /// to it; [`Frame::from_z`] where `x` is zero or parallel to `z`.
    #[inline(always)]
    pub fn from_z_and_x(z: Vector3<R>, x: Vector3<R>) -> Self {
        let (x, valid) = (x - z * z.dot(x)).normalize_masked();
        // Where x is almost parallel to z, rounding errors along z remain: orthogonalise again.
        let x = (x - z * z.dot(x)).normalize();
        let frame = Self { x, y: z.cross(x), z };
        if valid.all() { frame } else { Self::select(valid, frame, Self::from_z(z)) }
    }

    /// `a` where the mask is true, else `b`.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        let axis = |a, b| Vec3::select(mask, a, b);
        Self { x: axis(a.x, b.x), y: axis(a.y, b.y), z: axis(a.z, b.z) }
    }

    /// Outer coordinates to local ones.
    #[inline(always)]
    pub fn to_local(&self, v: Vector3<R>) -> Vector3<R> {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Local coordinates to outer ones.
    #[inline(always)]
    pub fn from_local(&self, v: Vector3<R>) -> Vector3<R> {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

/// Two unit vectors that make a right-handed frame with the unit vector `z`, without a branch
/// ([Duff et al. 2017]).
#[inline(always)]
pub fn coordinate_system<R: Real>(z: Vector3<R>) -> (Vector3<R>, Vector3<R>) {
    let sign = R::one().copysign(z.z);
    let a = -R::one() / (sign + z.z);
    let b = z.x * z.y * a;
    let x = Vec3::new(R::one() + sign * z.x * z.x * a, sign * b, -sign * z.x);
    (x, Vec3::new(b, sign + z.y * z.y * a, -z.y))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn an_x_almost_along_z_gives_right_angles() {
        let z = Vec3::new(0.3, -1.0, 2.0).normalize();
        for tilt in [1e-1, 1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-7] {
            let f = Frame::from_z_and_x(z, 3.0 * z + Vec3::new(tilt, 0.0, tilt));
            assert!(f.x.dot(f.z).abs() < 1e-6 && f.x.is_normalized() && f.y.is_normalized(), "{tilt}: {f:?}");
        }
    }

    proptest! {
        #[test]
        fn frames_are_orthonormal_and_right_handed(x in -1f32..1.0, y in -1f32..1.0, z in -1f32..1.0) {
            let Some(n) = Vec3::new(x, y, z).try_normalize() else { return Ok(()) };
            for f in [Frame::from_z(n), Frame::from_z_and_x(n, Vec3::new(0.3, -1.0, 2.0))] {
                prop_assert!(f.x.dot(f.y).abs() < 1e-5 && f.x.dot(f.z).abs() < 1e-5 && f.y.dot(f.z).abs() < 1e-5);
                prop_assert!((f.x.cross(f.y) - f.z).length() < 1e-5);
                let v = Vec3::new(0.2, 0.5, -0.7);
                prop_assert!((f.from_local(f.to_local(v)) - v).length() < 1e-5);
            }
        }
    }
}
