//! Cones of directions, which bound the emission of lights and the directions to boxes.

use crate::{Bounds3, Point3, Transform, Vec3, Vector3, angle_between, safe_acos, safe_sqrt};
use std::f32::consts::PI;

/// All directions within an angle of an axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct DirectionCone {
    /// The axis, of unit length.
    pub w: Vector3,
    /// Cosine of the half angle; above 1 for the empty cone.
    pub cos_theta: f32,
}

impl DirectionCone {
    /// The empty cone.
    pub const EMPTY: Self = Self { w: Vec3::Z, cos_theta: f32::INFINITY };
    /// The cone of all directions.
    pub const ENTIRE_SPHERE: Self = Self { w: Vec3::Z, cos_theta: -1.0 };

    /// The cone around the unit vector `w`.
    pub fn new(w: Vector3, cos_theta: f32) -> Self {
        Self { w, cos_theta }
    }

    /// Whether no direction is in it.
    pub fn is_empty(&self) -> bool {
        self.cos_theta > 1.0
    }

    /// Whether the unit vector `w` is in it.
    pub fn contains(&self, w: Vector3) -> bool {
        !self.is_empty() && self.w.dot(w) >= self.cos_theta
    }

    /// A cone around both.
    pub fn union(self, other: Self) -> Self {
        if self.is_empty() {
            return other;
        }
        if other.is_empty() {
            return self;
        }
        let (theta_a, theta_b) = (safe_acos(self.cos_theta), safe_acos(other.cos_theta));
        let between = angle_between(self.w, other.w);
        if (between + theta_b).min(PI) <= theta_a {
            return self;
        }
        if (between + theta_a).min(PI) <= theta_b {
            return other;
        }
        let theta = 0.5 * (theta_a + between + theta_b);
        let axis = self.w.cross(other.w);
        if theta >= PI || axis.length_squared() == 0.0 {
            return Self::ENTIRE_SPHERE;
        }
        let w = Transform::rotate(theta - theta_a, axis).vector(self.w);
        Self::new(w.normalize(), lanes::cos(theta))
    }
}

/// The cone in which a box is seen from `p`; the whole sphere from inside.
pub fn bound_subtended_directions(b: &Bounds3, p: Point3) -> DirectionCone {
    let (center, radius) = b.bounding_sphere();
    let distance2 = p.distance_squared(center);
    if b.contains(p) || distance2 <= radius * radius {
        return DirectionCone::ENTIRE_SPHERE;
    }
    DirectionCone::new((center - p).normalize(), safe_sqrt(1.0 - radius * radius / distance2))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_union_contains_both() {
        let a = DirectionCone::new(Vec3::X, 0.9);
        let b = DirectionCone::new(Vec3::new(0.0, 0.6, 0.8), 0.7);
        let u = a.union(b);
        for c in [a, b] {
            let theta = safe_acos(c.cos_theta) * 0.999;
            let frame = crate::Frame::from_z(c.w);
            for i in 0..100 {
                let d = crate::spherical_direction(theta.sin(), theta.cos(), i as f32 * 0.0628);
                assert!(u.contains(frame.from_local(d)));
            }
        }
        assert_eq!(a.union(DirectionCone::EMPTY), a);
        assert_eq!(a.union(DirectionCone::new(-Vec3::X, 0.9)), DirectionCone::ENTIRE_SPHERE);
    }
}
