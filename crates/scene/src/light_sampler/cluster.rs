//! Clusters of lights: what the importance of the lights to a point is computed from.
//!
//! Emission leaves within θ_e of normals that lie within θ_o of the axis w. The importance of a
//! cluster to a point at distance d is Φ·cos θ′ / d², where θ′ is the smallest possible angle
//! between an emission direction and the point, given that the box subtends θ_b
//! ([Conty Estevez & Kulla 2018]; [Pharr 2023 §12.6.3]).

use crate::light::LightBounds;
use math::{Normal3, Point3, Vec3, Vector3, safe_sqrt};

/// [`LightBounds`] with what does not depend on the point computed once.
#[derive(Clone, Copy, Debug)]
pub(super) struct Cluster {
    centroid: Point3,
    /// Square of the radius of the box's bounding sphere.
    radius2: f32,
    w: Vector3,
    phi: f32,
    cos_theta_o: f32,
    sin_theta_o: f32,
    cos_theta_e: f32,
    two_sided: bool,
}

/// cos(max(0, a − b)) of angles in [0, π] given by their sines and cosines.
fn cos_sub_clamped(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> f32 {
    if cos_a > cos_b { 1.0 } else { cos_a * cos_b + sin_a * sin_b }
}

/// sin(max(0, a − b)).
fn sin_sub_clamped(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> f32 {
    if cos_a > cos_b { 0.0 } else { sin_a * cos_b - cos_a * sin_b }
}

impl Cluster {
    /// The cluster with these bounds.
    pub fn new(lights: &LightBounds) -> Self {
        let &LightBounds { bounds, w, phi, cos_theta_o, cos_theta_e, two_sided } = lights;
        Self {
            centroid: bounds.centroid(),
            radius2: bounds.diagonal().length_squared() / 4.0,
            w,
            phi,
            cos_theta_o,
            sin_theta_o: safe_sqrt(1.0 - cos_theta_o * cos_theta_o),
            cos_theta_e,
            two_sided,
        }
    }

    /// An estimate ≥ 0 of the unoccluded contribution to `p`. A nonzero `n` is the surface normal
    /// there, and includes the cosine of incidence.
    pub fn importance(&self, p: Point3, n: Normal3) -> f32 {
        let to = p - self.centroid;
        let distance2 = to.length_squared();
        let wi = to.try_normalize().unwrap_or(Vec3::Z);
        let mut cos_w = self.w.dot(wi);
        if self.two_sided {
            cos_w = cos_w.abs();
        }
        let sin_w = safe_sqrt(1.0 - cos_w * cos_w);
        // The cone around the box is the whole sphere of directions for points in the box's
        // bounding sphere.
        let sin2_b = self.radius2 / distance2;
        let (sin_b, cos_b) = if sin2_b < 1.0 { (sin2_b.sqrt(), (1.0 - sin2_b).sqrt()) } else { (0.0, -1.0) };
        let cos_x = cos_sub_clamped(sin_w, cos_w, self.sin_theta_o, self.cos_theta_o);
        let sin_x = sin_sub_clamped(sin_w, cos_w, self.sin_theta_o, self.cos_theta_o);
        let cos_p = cos_sub_clamped(sin_x, cos_x, sin_b, cos_b);
        if cos_p <= self.cos_theta_e {
            return 0.0;
        }
        // The distance is clamped to half of the box's diagonal, as 1/d² diverges near a cluster.
        let mut importance = self.phi * cos_p / distance2.max(self.radius2);
        if n != Vec3::ZERO {
            let cos_i = wi.dot(n).abs();
            let sin_i = safe_sqrt(1.0 - cos_i * cos_i);
            importance *= cos_sub_clamped(sin_i, cos_i, sin_b, cos_b);
        }
        // Finite even at the position of a point light, so that importances can be compared.
        importance.clamp(0.0, f32::MAX / 4.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Bounds3;

    fn importance(lights: LightBounds, p: Point3, n: Normal3) -> f32 {
        Cluster::new(&lights).importance(p, n)
    }

    fn lamp() -> LightBounds {
        LightBounds {
            bounds: Bounds3::new(Vec3::splat(-0.1), Vec3::splat(0.1)),
            w: Vec3::Z,
            phi: 2.0,
            cos_theta_o: 1.0,
            cos_theta_e: 0.0,
            two_sided: false,
        }
    }

    #[test]
    fn importance_behind_a_light_is_zero() {
        assert_eq!(importance(lamp(), Vec3::new(0.0, 0.0, -5.0), Vec3::ZERO), 0.0);
        assert!(importance(lamp(), Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO) > 0.0);
        let both = LightBounds { two_sided: true, ..lamp() };
        assert!(importance(both, Vec3::new(0.0, 0.0, -5.0), Vec3::ZERO) > 0.0);
    }

    #[test]
    fn importance_grows_with_power_and_proximity() {
        let near = importance(lamp(), Vec3::new(0.0, 0.0, 2.0), Vec3::Z);
        assert!(near > importance(lamp(), Vec3::new(0.0, 0.0, 4.0), Vec3::Z));
        assert!(near < importance(LightBounds { phi: 3.0, ..lamp() }, Vec3::new(0.0, 0.0, 2.0), Vec3::Z));
    }

    #[test]
    fn a_union_has_importance_wherever_its_parts_have() {
        let other = LightBounds { w: Vec3::X, bounds: Bounds3::new(Vec3::ONE, Vec3::splat(1.2)), ..lamp() };
        let both = lamp().union(other);
        for p in [Vec3::new(0.0, 0.0, 5.0), Vec3::new(5.0, 1.0, 1.0), Vec3::new(3.0, 3.0, 3.0)] {
            if importance(lamp(), p, Vec3::ZERO) > 0.0 || importance(other, p, Vec3::ZERO) > 0.0 {
                assert!(importance(both, p, Vec3::ZERO) > 0.0);
            }
        }
    }
}
