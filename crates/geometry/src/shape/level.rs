//! A point of a level set F(x, y, z) = 0 in object space.
//!
//! The normal is n = ∇F/|∇F|; along a tangent v it changes by (H·v − n·(n·H·v))/|∇F|, with H the
//! second derivatives of F. The parameters are the spherical angles around a centre, u = φ/2π and v
//! = 1 − θ/π, as on a whole sphere. Their gradients in space give the tangents: ∂p/∂u is
//! perpendicular to n and ∇v, and ∇u·∂p/∂u = 1.

use super::quadric::Quadric;
use crate::surface::{SurfacePoint, any_tangents};
use math::{DMat3, DVec3, Ray, Vec2};
use std::f64::consts::{PI, TAU};

/// A point of a level set, with derivatives of F.
pub(super) struct Level {
    pub p: DVec3,
    pub gradient: DVec3,
    pub hessian: DMat3,
    /// The centre of the spherical angles.
    pub center: DVec3,
    /// The direction of the ray.
    pub d: DVec3,
}

impl Level {
    /// (u, v).
    pub fn parameters(&self) -> Vec2 {
        let q = self.p - self.center;
        let (u, v) = (libm::atan2(q.y, q.x) / TAU, 1.0 - libm::atan2(libm::hypot(q.x, q.y), q.z) / PI);
        Vec2::new((if u < 0.0 { u + 1.0 } else { u }) as f32, v as f32)
    }

    /// Unit normal. Where the gradient vanishes, its direction just before the point, which is that
    /// of −H·d; where there is none either, back along the ray.
    pub fn normal(&self) -> DVec3 {
        let candidates = [self.gradient, -(self.hessian * self.d), -self.d];
        candidates.into_iter().find_map(DVec3::try_normalize).unwrap_or(DVec3::Z)
    }

    /// ∂p/∂u and ∂p/∂v.
    fn tangents(&self, n: DVec3) -> [DVec3; 2] {
        let q = self.p - self.center;
        let radius = q.length();
        let across = f64::max(libm::hypot(q.x, q.y), 1e-5 * radius);
        let (cos, sin) = if q.x == 0.0 && q.y == 0.0 { (1.0, 0.0) } else { (q.x / across, q.y / across) };
        let grad_u = DVec3::new(-sin, cos, 0.0) / (across * TAU);
        let grad_v = DVec3::new(-q.z * cos, -q.z * sin, across) / (radius * radius * PI);
        let determinant = n.dot(grad_u.cross(grad_v));
        // A surface seen edge-on from the centre has no such tangents.
        if determinant.abs() > 1e-3 * grad_u.length() * grad_v.length() {
            [grad_v.cross(n) / determinant, n.cross(grad_u) / determinant]
        } else {
            any_tangents(n.as_vec3().into()).map(|tangent| tangent.as_dvec3())
        }
    }

    /// The surface point in render space. The point is within `error` of the surface.
    pub fn surface(&self, quadric: &Quadric, error: DVec3, ray: &Ray) -> SurfacePoint {
        let n = self.normal();
        let tangents = self.tangents(n);
        let change = |v: DVec3| {
            let h = self.hessian * v;
            let dn = (h - n * n.dot(h)) / self.gradient.length();
            quadric.normal_change(n, if dn.is_finite() { dn } else { DVec3::ZERO })
        };
        SurfacePoint::new(
            quadric.placement.point(self.p, error),
            quadric.normal(n),
            self.parameters(),
            tangents.map(|v| quadric.placement.vector(v)),
            tangents.map(change),
            ray,
        )
    }
}
