//! What is known of a light, or of many, without asking them one by one: a box, a cone of emission,
//! a power; and from that how much they may matter to a point.
//!
//! Emission leaves within θ_e of normals that lie within θ_o of the axis w. The importance of a
//! cluster to a point at distance d is Φ·cos θ′ / d², where θ′ is the smallest possible angle
//! between an emission direction and the point, given that the box subtends θ_b
//! ([Conty Estevez & Kulla 2018]; [Pharr 2023 §12.6.3]).

use math::{Bounds3, DirectionCone, Normal3, Point3, Vec3, Vector3, safe_sqrt};

/// Where light comes from and whereto it goes.
#[derive(Clone, Copy, Debug)]
pub struct LightBounds {
    /// Box around the positions.
    pub bounds: Bounds3,
    /// Axis of the cone of normals, of unit length.
    pub w: Vector3,
    /// Power, as one number.
    pub phi: f32,
    /// Cosine of the half angle of the cone of normals.
    pub cos_theta_o: f32,
    /// Cosine of the largest angle between a normal and emission.
    pub cos_theta_e: f32,
    /// Whether light leaves against the normals, too.
    pub two_sided: bool,
}

/// cos(max(0, a − b)) of angles in [0, π] given by their sines and cosines.
fn cos_sub_clamped(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> f32 {
    if cos_a > cos_b { 1.0 } else { cos_a * cos_b + sin_a * sin_b }
}

/// sin(max(0, a − b)).
fn sin_sub_clamped(sin_a: f32, cos_a: f32, sin_b: f32, cos_b: f32) -> f32 {
    if cos_a > cos_b { 0.0 } else { sin_a * cos_b - cos_a * sin_b }
}

impl LightBounds {
    /// The bounds of nothing.
    pub const EMPTY: Self = Self {
        bounds: Bounds3::EMPTY,
        w: Vec3::Z,
        phi: 0.0,
        cos_theta_o: f32::INFINITY,
        cos_theta_e: f32::INFINITY,
        two_sided: false,
    };

    /// Bounds of both.
    pub fn union(self, other: Self) -> Self {
        if self.phi == 0.0 {
            return other;
        }
        if other.phi == 0.0 {
            return self;
        }
        let cone = DirectionCone::new(self.w, self.cos_theta_o)
            .union(DirectionCone::new(other.w, other.cos_theta_o));
        Self {
            bounds: self.bounds.union(other.bounds),
            w: cone.w,
            phi: self.phi + other.phi,
            cos_theta_o: cone.cos_theta,
            cos_theta_e: self.cos_theta_e.min(other.cos_theta_e),
            two_sided: self.two_sided || other.two_sided,
        }
    }

    /// An estimate ≥ 0 of how much arrives at `p`; a surface with normal `n` (zero: none) counts
    /// the angle of incidence.
    pub fn importance(&self, p: Point3, n: Normal3) -> f32 {
        let to = p - self.bounds.centroid();
        let distance2 = to.length_squared();
        let radius2 = self.bounds.diagonal().length_squared() / 4.0;
        let wi = to.try_normalize().unwrap_or(Vec3::Z);
        let mut cos_w = self.w.dot(wi);
        if self.two_sided {
            cos_w = cos_w.abs();
        }
        let sin_w = safe_sqrt(1.0 - cos_w * cos_w);
        // Of the cone that holds the box: everything, from inside of its sphere.
        let sin2_b = radius2 / distance2;
        let (sin_b, cos_b) = if sin2_b < 1.0 { (sin2_b.sqrt(), (1.0 - sin2_b).sqrt()) } else { (0.0, -1.0) };
        let sin_o = safe_sqrt(1.0 - self.cos_theta_o * self.cos_theta_o);
        let cos_x = cos_sub_clamped(sin_w, cos_w, sin_o, self.cos_theta_o);
        let sin_x = sin_sub_clamped(sin_w, cos_w, sin_o, self.cos_theta_o);
        let cos_p = cos_sub_clamped(sin_x, cos_x, sin_b, cos_b);
        if cos_p <= self.cos_theta_e {
            return 0.0;
        }
        // Near a cluster, 1/d² would blow up: no nearer than half of its size.
        let mut importance = self.phi * cos_p / distance2.max(radius2);
        if n != Vec3::ZERO {
            let cos_i = wi.dot(n).abs();
            let sin_i = safe_sqrt(1.0 - cos_i * cos_i);
            importance *= cos_sub_clamped(sin_i, cos_i, sin_b, cos_b);
        }
        // Finite even on top of a point light, so that importances can be compared.
        importance.clamp(0.0, f32::MAX / 4.0)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
    fn the_dark_side_does_not_matter() {
        assert_eq!(lamp().importance(Vec3::new(0.0, 0.0, -5.0), Vec3::ZERO), 0.0);
        assert!(lamp().importance(Vec3::new(0.0, 0.0, 5.0), Vec3::ZERO) > 0.0);
        let both = LightBounds { two_sided: true, ..lamp() };
        assert!(both.importance(Vec3::new(0.0, 0.0, -5.0), Vec3::ZERO) > 0.0);
    }

    #[test]
    fn nearer_and_brighter_matter_more() {
        let near = lamp().importance(Vec3::new(0.0, 0.0, 2.0), Vec3::Z);
        assert!(near > lamp().importance(Vec3::new(0.0, 0.0, 4.0), Vec3::Z));
        assert!(near < LightBounds { phi: 3.0, ..lamp() }.importance(Vec3::new(0.0, 0.0, 2.0), Vec3::Z));
    }

    #[test]
    fn a_union_is_never_less_visible_than_its_parts() {
        let other = LightBounds { w: Vec3::X, bounds: Bounds3::new(Vec3::ONE, Vec3::splat(1.2)), ..lamp() };
        let both = lamp().union(other);
        for p in [Vec3::new(0.0, 0.0, 5.0), Vec3::new(5.0, 1.0, 1.0), Vec3::new(3.0, 3.0, 3.0)] {
            if lamp().importance(p, Vec3::ZERO) > 0.0 || other.importance(p, Vec3::ZERO) > 0.0 {
                assert!(both.importance(p, Vec3::ZERO) > 0.0);
            }
        }
    }
}
