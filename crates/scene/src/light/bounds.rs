//! Bounds of one light or of a cluster of lights: a box around the positions, a cone around the
//! directions of emission, and the power. Light samplers compute importances from them.
//!
//! Emission leaves within θ_e of normals that lie within θ_o of the axis w
//! ([Conty Estevez & Kulla 2018]; [Pharr 2023 §12.6.3]).

use math::{Bounds3, DirectionCone, Vec3, Vector3};

/// Bounds of the positions and directions of emission of lights.
#[derive(Clone, Copy, Debug)]
pub struct LightBounds {
    /// Box around the positions.
    pub bounds: Bounds3,
    /// Axis of the cone of normals, of unit length.
    pub w: Vector3,
    /// Power, as one number for all wavelengths.
    pub phi: f32,
    /// Cosine of the half angle of the cone of normals.
    pub cos_theta_o: f32,
    /// Cosine of the largest angle between a normal and emission.
    pub cos_theta_e: f32,
    /// Whether the lights emit on both sides.
    pub two_sided: bool,
}

impl LightBounds {
    /// The bounds of no light.
    pub const EMPTY: Self = Self {
        bounds: Bounds3::EMPTY,
        w: Vec3::Z,
        phi: 0.0,
        cos_theta_o: f32::INFINITY,
        cos_theta_e: f32::INFINITY,
        two_sided: false,
    };

    /// The bounds of both.
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
}
