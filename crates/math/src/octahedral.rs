//! The equal-area map between the unit square and the sphere.
//!
//! The square consists of the diamond |u| + |v| ≤ 1, which is mapped to the upper hemisphere, and
//! four corners, which are folded down to the lower one; within each quadrant areas are
//! preserved. Environment images are stored this way ([Clarberg 2008]; [Pharr 2023 §3.8.3]).

use crate::{Vec2, Vec3, Vector3, safe_sqrt, sin_cos};
use lanes::{Real, atan};
use std::f32::consts::{FRAC_2_PI, FRAC_PI_4};

/// The unit direction of a point of [0, 1]².
#[inline(always)]
pub fn equal_area_square_to_sphere<R: Real>(p: Vec2<R>) -> Vector3<R> {
    let (one, two) = (R::one(), R::splat(2.0));
    let (u, v) = (two * p.x - one, two * p.y - one);
    let (up, vp) = (u.abs(), v.abs());
    let signed_distance = one - (up + vp);
    let r = one - signed_distance.abs();
    let turn = R::select(r.eq(R::zero()), one, (vp - up) / r + one);
    let z = (one - r * r).copysign(signed_distance);
    let (sin_phi, cos_phi) = sin_cos(turn * R::splat(FRAC_PI_4));
    let radius = r * safe_sqrt(two - r * r);
    Vec3::new(cos_phi.copysign(u) * radius, sin_phi.copysign(v) * radius, z)
}

/// The point of [0, 1]² of a unit direction: the inverse of [`equal_area_square_to_sphere`].
#[inline(always)]
pub fn equal_area_sphere_to_square<R: Real>(d: Vector3<R>) -> Vec2<R> {
    let (one, half) = (R::one(), R::splat(0.5));
    let (x, y, z) = (d.x.abs(), d.y.abs(), d.z.abs());
    // √(1 − z), without cancellation near the poles.
    let r = ((x * x + y * y) / (one + z)).sqrt().min(one);
    let (large, small) = (R::select(x.gt(y), x, y), R::select(x.gt(y), y, x));
    let angle = R::select(large.eq(R::zero()), R::zero(), atan(small / large) * R::splat(FRAC_2_PI));
    let phi = R::select(x.lt(y), one - angle, angle);
    let (u, v) = (r - phi * r, phi * r);
    let is_below = d.z.lt(R::zero());
    let (u, v) = (R::select(is_below, one - v, u), R::select(is_below, one - u, v));
    Vec2::new((u.copysign(d.x) + one) * half, (v.copysign(d.y) + one) * half)
}

/// Wraps a point slightly outside of [0, 1]² to the point inside with the same direction.
#[inline(always)]
pub fn wrap_equal_area_square<R: Real>(p: Vec2<R>) -> Vec2<R> {
    let (zero, one, two) = (R::zero(), R::one(), R::splat(2.0));
    let (is_left, is_right) = (p.x.lt(zero), p.x.gt(one));
    let x = R::select(is_left, -p.x, R::select(is_right, two - p.x, p.x));
    let y = R::select(is_left | is_right, one - p.y, p.y);
    let (is_above, is_below) = (y.lt(zero), y.gt(one));
    let x = R::select(is_above | is_below, one - x, x);
    Vec2::new(x, R::select(is_above, -y, R::select(is_below, two - y, y)))
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
