//! The equal-area map between the unit square and the sphere.
//!
//! The square consists of the diamond |u| + |v| ≤ 1, which is mapped to the upper hemisphere, and
//! four corners, which are folded down to the lower one; within each quadrant areas are
//! preserved. Environment images are stored this way ([Clarberg 2008]; [Pharr 2023 §3.8.3]).

use crate::{Vec2, Vec3, Vector3, safe_sqrt};
use std::f32::consts::{FRAC_2_PI, FRAC_PI_4};

/// The unit direction of a point of [0, 1]².
pub fn equal_area_square_to_sphere(p: Vec2) -> Vector3 {
    let (u, v) = (2.0 * p.x - 1.0, 2.0 * p.y - 1.0);
    let (up, vp) = (u.abs(), v.abs());
    let signed_distance = 1.0 - (up + vp);
    let r = 1.0 - signed_distance.abs();
    let phi = if r == 0.0 { 1.0 } else { (vp - up) / r + 1.0 } * FRAC_PI_4;
    let z = (1.0 - r * r).copysign(signed_distance);
    let (sin_phi, cos_phi) = phi.sin_cos();
    let radius = r * safe_sqrt(2.0 - r * r);
    Vec3::new(cos_phi.copysign(u) * radius, sin_phi.copysign(v) * radius, z)
}

/// The point of [0, 1]² of a unit direction: the inverse of [`equal_area_square_to_sphere`].
pub fn equal_area_sphere_to_square(d: Vector3) -> Vec2 {
    let (x, y, z) = (d.x.abs(), d.y.abs(), d.z.abs());
    // √(1 − z), without cancellation near the poles.
    let r = ((x * x + y * y) / (1.0 + z)).sqrt().min(1.0);
    let (large, small) = if x > y { (x, y) } else { (y, x) };
    let angle = if large == 0.0 { 0.0 } else { (small / large).atan() * FRAC_2_PI };
    let phi = if x < y { 1.0 - angle } else { angle };
    let (mut u, mut v) = (r - phi * r, phi * r);
    if d.z < 0.0 {
        (u, v) = (1.0 - v, 1.0 - u);
    }
    Vec2::new((u.copysign(d.x) + 1.0) * 0.5, (v.copysign(d.y) + 1.0) * 0.5)
}

/// Wraps a point slightly outside of [0, 1]² to the point inside with the same direction.
pub fn wrap_equal_area_square(p: Vec2) -> Vec2 {
    let Vec2 { mut x, mut y } = p;
    if x < 0.0 {
        (x, y) = (-x, 1.0 - y);
    } else if x > 1.0 {
        (x, y) = (2.0 - x, 1.0 - y);
    }
    if y < 0.0 {
        (x, y) = (1.0 - x, -y);
    } else if y > 1.0 {
        (x, y) = (1.0 - x, 2.0 - y);
    }
    Vec2::new(x, y)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn square_and_sphere_are_inverse(u in 0f32..1.0, v in 0f32..1.0) {
            let p = Vec2::new(u, v);
            let d = equal_area_square_to_sphere(p);
            prop_assert!((d.length() - 1.0).abs() < 1e-5);
            let e = equal_area_square_to_sphere(equal_area_sphere_to_square(d));
            prop_assert!((d - e).length() < 2e-6, "{d} {e}");
        }
    }

    #[test]
    fn areas_are_equal() {
        // Mean of z and of z² over the square must be those over the sphere.
        let n = 256;
        let (mut z1, mut z2) = (0.0f64, 0.0f64);
        for i in 0..n * n {
            let p = Vec2::new((i % n) as f32 + 0.5, (i / n) as f32 + 0.5) / n as f32;
            let z = equal_area_square_to_sphere(p).z as f64;
            z1 += z;
            z2 += z * z;
        }
        let total = (n * n) as f64;
        assert!((z1 / total).abs() < 1e-3 && (z2 / total - 1.0 / 3.0).abs() < 1e-3);
    }

    #[test]
    fn neighbours_across_the_border_agree() {
        for t in [0.1f32, 0.37, 0.8] {
            for (outside, inside) in [
                (Vec2::new(-0.01, t), Vec2::new(0.01, 1.0 - t)),
                (Vec2::new(t, 1.01), Vec2::new(1.0 - t, 0.99)),
            ] {
                assert!((wrap_equal_area_square(outside) - inside).length() < 1e-5);
                let across = equal_area_square_to_sphere(wrap_equal_area_square(outside));
                let edge = equal_area_square_to_sphere(outside.clamp(Vec2::ZERO, Vec2::ONE));
                assert!((across - edge).length() < 0.06);
            }
        }
    }
}
