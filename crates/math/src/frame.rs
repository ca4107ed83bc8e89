//! Right-handed orthonormal frames.

use crate::{Vec3, Vector3};

/// Three orthonormal axes; local +z is the main axis (the normal of a surface, the axis of a beam).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Frame {
    /// Local +x in outer coordinates.
    pub x: Vector3,
    /// Local +y in outer coordinates.
    pub y: Vector3,
    /// Local +z in outer coordinates.
    pub z: Vector3,
}

impl Frame {
    /// A frame with the unit vector `z`, and any x and y.
    #[inline]
    pub fn from_z(z: Vector3) -> Self {
        let (x, y) = coordinate_system(z);
        Self { x, y, z }
    }

    /// The frame with the unit vector `z`, and the direction nearest to `x` that is perpendicular
    /// to it; [`Frame::from_z`] where `x` is zero or parallel to `z`.
    #[inline]
    pub fn from_z_and_x(z: Vector3, x: Vector3) -> Self {
        let across = |x: Vector3| x - z * z.dot(x);
        match across(x).try_normalize() {
            Some(x) => {
                // Where x is almost parallel to z, rounding errors along z remain: orthogonalise
                // again.
                let x = across(x).normalize();
                Self { x, y: z.cross(x), z }
            }
            None => Self::from_z(z),
        }
    }

    /// Outer coordinates to local ones.
    #[inline]
    pub fn to_local(&self, v: Vector3) -> Vector3 {
        Vec3::new(v.dot(self.x), v.dot(self.y), v.dot(self.z))
    }

    /// Local coordinates to outer ones.
    #[inline]
    pub fn from_local(&self, v: Vector3) -> Vector3 {
        self.x * v.x + self.y * v.y + self.z * v.z
    }
}

/// Two unit vectors that make a right-handed frame with the unit vector `z`, without a branch
/// ([Duff et al. 2017]).
#[inline]
pub fn coordinate_system(z: Vector3) -> (Vector3, Vector3) {
    let sign = 1f32.copysign(z.z);
    let a = -1.0 / (sign + z.z);
    let b = z.x * z.y * a;
    (Vec3::new(1.0 + sign * z.x * z.x * a, sign * b, -sign * z.x), Vec3::new(b, sign + z.y * z.y * a, -z.y))
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
