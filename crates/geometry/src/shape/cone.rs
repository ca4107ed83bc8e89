//! The cone x² + y² = (r/h)²·(h − z)² with 0 ≤ z ≤ h and φ ≤ φ_max: with a circle at
//! z = 0 and its apex at z = h, without a base.
//!
//! p(u, v) = ((1 − v)·r cos φ, (1 − v)·r sin φ, v·h), φ = u·φ_max. Sampled by area: the part above
//! v has the fraction (1 − v)² ([Pharr 2016 §3.5]).

use super::quadric::{Local, Quadric, first_hit, phi, revolved_roots, swept, unrounded};
use super::sample::{ShapeHit, ShapeSample};
use crate::surface::SurfacePoint;
use math::{Bounds3, DVec3, Normal3, Ray, Transform, Vec2};

/// A cone without a base.
#[derive(Clone, Debug)]
pub struct Cone {
    quadric: Quadric,
    radius: f64,
    height: f64,
    phi_max: f64,
    area: f32,
}

impl Cone {
    /// A cone on the object's xy plane with its apex at `height` above it, up to an angle in
    /// degrees.
    pub fn new(
        render_from_object: &Transform,
        reverse_orientation: bool,
        radius: f32,
        height: f32,
        phi_max: f32,
    ) -> Self {
        let mut cone = Self {
            quadric: Quadric::new(render_from_object, reverse_orientation),
            radius: radius.abs() as f64,
            height: height.abs() as f64,
            phi_max: swept(phi_max),
            area: 0.0,
        };
        cone.area = cone.quadric.area(cone.object_area(), |u, _| cone.normal(u));
        cone
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        let r = self.radius;
        Some(self.quadric.bounds(DVec3::new(-r, -r, 0.0), DVec3::new(r, r, self.height)))
    }

    pub(super) fn intersect(&self, ray: &Ray, range: [f32; 2]) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        first_hit(self.roots(o, d)?, range, |t| {
            let p = o + d * t;
            let inside = p.z >= 0.0 && p.z <= self.height && phi(p) <= self.phi_max;
            inside.then(|| self.parameters(p))
        })
    }

    pub(super) fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let q = o + d * unrounded(self.roots(o, d), hit.t);
        let (sin, cos) = libm::sincos(phi(q));
        let below_tip = 1.0 - q.z / self.height;
        let rim = DVec3::new(cos, sin, 0.0) * self.radius;
        let p = rim * below_tip + DVec3::Z * q.z;
        // A direction for the tangents at the apex.
        let around = DVec3::new(-rim.y, rim.x, 0.0) * self.phi_max;
        let local = Local {
            p,
            n: self.normal(phi(q) / self.phi_max),
            uv: self.parameters(p),
            dpdu: around * below_tip.max(1e-5),
            dpdv: DVec3::Z * self.height - rim,
            second: [rim * (-below_tip * self.phi_max * self.phi_max), -around, DVec3::ZERO],
        };
        self.quadric.surface(&local, ray)
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let below_tip = (1.0 - u.x as f64).sqrt();
        let (sin, cos) = libm::sincos(u.y as f64 * self.phi_max);
        let out = self.radius * below_tip;
        let p = DVec3::new(cos * out, sin * out, self.height * (1.0 - below_tip));
        let n = self.normal(u.y as f64);
        Some(self.quadric.sample(p, n, self.parameters(p), 1.0 / self.object_area()))
    }

    pub(super) fn pdf_area(&self, n: Normal3) -> f32 {
        self.quadric.pdf_area(n, 1.0 / self.object_area())
    }

    /// With the origin at the apex, x² + y² = (r/h)²·z².
    fn roots(&self, o: DVec3, d: DVec3) -> Option<[f64; 2]> {
        let slope = self.radius / self.height;
        let tip = DVec3::Z * self.height;
        revolved_roots([0.0, 0.0, slope * slope], o - tip, d, -0.5 * tip)
    }

    /// A ray along the normal that hits the point with parameters (u, v) at t = 1.
    pub(super) fn ray_to(&self, uv: Vec2, time: f32) -> Ray {
        let (p, n) = self.at(uv);
        self.quadric.ray_to(p, n, time)
    }

    /// The point with parameters (u, v) and its unit normal, in object space.
    fn at(&self, uv: Vec2) -> (DVec3, DVec3) {
        let (sin, cos) = libm::sincos(uv.x as f64 * self.phi_max);
        let out = self.radius * (1.0 - uv.y as f64);
        (DVec3::new(cos * out, sin * out, self.height * uv.y as f64), self.normal(uv.x as f64))
    }

    fn object_area(&self) -> f64 {
        0.5 * self.phi_max * self.radius * libm::hypot(self.radius, self.height)
    }

    fn normal(&self, u: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(u * self.phi_max);
        DVec3::new(self.height * cos, self.height * sin, self.radius) / libm::hypot(self.radius, self.height)
    }

    fn parameters(&self, p: DVec3) -> Vec2 {
        Vec2::new((phi(p) / self.phi_max) as f32, (p.z / self.height) as f32)
    }
}
