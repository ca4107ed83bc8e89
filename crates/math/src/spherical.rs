//! Spherical coordinates, θ from +z and φ from +x towards +y, and the trigonometry of local shading
//! frames.

use crate::{Vec3, Vector3, safe_sqrt, sin_cos};
use lanes::Real;
use std::f32::consts::TAU;

/// The unit vector with the given sine and cosine of θ, and φ in radians.
#[inline(always)]
pub fn spherical_direction<R: Real>(sin_theta: R, cos_theta: R, phi: R) -> Vector3<R> {
    let (sin_phi, cos_phi) = sin_cos(phi);
    Vec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}

/// θ ∈ [0, π] of a unit vector.
#[inline(always)]
pub fn spherical_theta<R: Real>(v: Vector3<R>) -> R {
    lanes::acos(v.z.clamp(-R::one(), R::one()))
}

/// φ ∈ [0, 2π) of a vector.
#[inline(always)]
pub fn spherical_phi<R: Real>(v: Vector3<R>) -> R {
    let phi = lanes::atan2(v.y, v.x);
    R::select(phi.lt(R::zero()), phi + R::splat(TAU), phi)
}

/// cos²θ of a local direction.
#[inline(always)]
pub fn cos2_theta<R: Real>(w: Vector3<R>) -> R {
    w.z * w.z
}

/// sin θ ≥ 0 of a local direction.
#[inline(always)]
pub fn sin_theta<R: Real>(w: Vector3<R>) -> R {
    safe_sqrt(R::one() - cos2_theta(w))
}

/// cos φ of a local direction; 1 at the pole.
#[inline(always)]
pub fn cos_phi<R: Real>(w: Vector3<R>) -> R {
    let sin = sin_theta(w);
    R::select(sin.eq(R::zero()), R::one(), (w.x / sin).clamp(-R::one(), R::one()))
}

/// sin φ of a local direction; 0 at the pole.
#[inline(always)]
pub fn sin_phi<R: Real>(w: Vector3<R>) -> R {
    let sin = sin_theta(w);
    R::select(sin.eq(R::zero()), R::zero(), (w.y / sin).clamp(-R::one(), R::one()))
}

/// Whether two local directions lie on the same side of the surface.
#[inline(always)]
pub fn same_hemisphere<R: Real>(a: Vector3<R>, b: Vector3<R>) -> R::Mask {
    (a.z * b.z).gt(R::zero())
}

/// `v` or −`v`, whichever lies on the side of `reference`.
#[inline(always)]
pub fn face_forward<R: Real>(v: Vector3<R>, reference: Vector3<R>) -> Vector3<R> {
    Vec3::select(v.dot(reference).lt(R::zero()), -v, v)
}

/// The angle between two unit vectors in radians, accurate near 0 and π too.
#[inline]
pub fn angle_between(a: Vector3, b: Vector3) -> f32 {
    if a.dot(b) < 0.0 {
        std::f32::consts::PI - 2.0 * crate::safe_asin((a + b).length() * 0.5)
    } else {
        2.0 * crate::safe_asin((b - a).length() * 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn angles_round_trip() {
        for (theta, phi) in [(0.1f32, 0.2f32), (1.5, 3.0), (3.0, 6.0)] {
            let v = spherical_direction(theta.sin(), theta.cos(), phi);
            assert!((spherical_theta(v) - theta).abs() < 1e-5 && (spherical_phi(v) - phi).abs() < 1e-5);
            assert!((cos_phi(v) - phi.cos()).abs() < 1e-4 && (sin_phi(v) - phi.sin()).abs() < 1e-4);
        }
    }

    #[test]
    fn small_angles_are_exact() {
        let a = Vec3::Z;
        let b = spherical_direction(1e-4, 1.0, 0.3).normalize();
        assert!((angle_between(a, b) - 1e-4).abs() < 1e-9);
        assert!((angle_between(a, -a) - std::f32::consts::PI).abs() < 1e-6);
    }
}
