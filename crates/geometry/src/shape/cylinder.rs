//! The cylinder x² + y² = r² with z_min ≤ z ≤ z_max and φ ≤ φ_max, without caps.
//!
//! p(u, v) = (r cos φ, r sin φ, z), φ = u·φ_max, z = z_min + v·(z_max − z_min). Sampled by area
//! ([Pharr 2023 §6.3]).

use super::plain::{PlainShape, RevolvedKind};
use super::quadric::{Local, Quadric, between, first_hit, phi, roots, swept, unrounded};
use super::sample::{ShapeHit, ShapeSample};
use crate::surface::SurfacePoint;
use math::{Bounds3, DVec3, Normal3, Ray, Transform, Vec2};

/// A cylinder without caps.
#[derive(Clone, Debug)]
pub struct Cylinder {
    quadric: Quadric,
    radius: f64,
    z: [f64; 2],
    phi_max: f64,
    area: f32,
}

const ACROSS: DVec3 = DVec3::new(1.0, 1.0, 0.0);

impl Cylinder {
    /// A cylinder around the object's z axis between two heights, up to an angle in degrees.
    pub fn new(
        render_from_object: &Transform,
        reverse_orientation: bool,
        radius: f32,
        z: [f32; 2],
        phi_max: f32,
    ) -> Self {
        let quadric = Quadric::new(render_from_object, reverse_orientation);
        let mut z = z.map(f64::from);
        z.sort_by(f64::total_cmp);
        let mut cylinder =
            Self { quadric, radius: radius.abs() as f64, z, phi_max: swept(phi_max), area: 0.0 };
        cylinder.area = cylinder.quadric.area(cylinder.object_area(), |u, _| cylinder.normal(u));
        cylinder
    }

    pub(super) fn plain(&self) -> PlainShape {
        self.quadric.plain(RevolvedKind::Cylinder, [self.radius, self.z[0], self.z[1], self.phi_max])
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        let r = self.radius;
        Some(self.quadric.bounds(DVec3::new(-r, -r, self.z[0]), DVec3::new(r, r, self.z[1])))
    }

    pub(super) fn intersect(&self, ray: &Ray, range: [f32; 2]) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        first_hit(roots(o * ACROSS, d * ACROSS, self.radius)?, range, |t| {
            let p = o + d * t;
            let inside = p.z >= self.z[0] && p.z <= self.z[1] && phi(p) <= self.phi_max;
            inside.then(|| self.parameters(p))
        })
    }

    pub(super) fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let t = unrounded(roots(o * ACROSS, d * ACROSS, self.radius), hit.t);
        let q = o + d * t;
        let n = (q * ACROSS).normalize_or(DVec3::X);
        let p = n * self.radius + DVec3::Z * q.z;
        let local = Local {
            p,
            n,
            uv: self.parameters(p),
            dpdu: DVec3::new(-p.y, p.x, 0.0) * self.phi_max,
            dpdv: DVec3::Z * (self.z[1] - self.z[0]),
            second: [p * ACROSS * -self.phi_max * self.phi_max, DVec3::ZERO, DVec3::ZERO],
        };
        self.quadric.surface(&local, ray)
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let n = self.normal(u.y as f64);
        let p = n * self.radius + DVec3::Z * (self.z[0] + (self.z[1] - self.z[0]) * u.x as f64);
        Some(self.quadric.sample(p, n, self.parameters(p), 1.0 / self.object_area()))
    }

    pub(super) fn pdf_area(&self, n: Normal3) -> f32 {
        self.quadric.pdf_area(n, 1.0 / self.object_area())
    }

    /// A ray along the normal that hits the point with parameters (u, v) at t = 1.
    pub(super) fn ray_to(&self, uv: Vec2, time: f32) -> Ray {
        let (p, n) = self.at(uv);
        self.quadric.ray_to(p, n, time)
    }

    /// The point with parameters (u, v) and its unit normal, in object space.
    fn at(&self, uv: Vec2) -> (DVec3, DVec3) {
        let n = self.normal(uv.x as f64);
        (n * self.radius + DVec3::Z * between(self.z, uv.y as f64), n)
    }

    fn object_area(&self) -> f64 {
        self.phi_max * self.radius * (self.z[1] - self.z[0])
    }

    fn normal(&self, u: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(u * self.phi_max);
        DVec3::new(cos, sin, 0.0)
    }

    fn parameters(&self, p: DVec3) -> Vec2 {
        let v = (p.z - self.z[0]) / (self.z[1] - self.z[0]);
        Vec2::new((phi(p) / self.phi_max) as f32, v as f32)
    }
}
