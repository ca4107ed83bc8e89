//! The paraboloid x² + y² = s·z, s = r²/z_max, with z_min ≤ z ≤ z_max and φ ≤ φ_max: its radius
//! at z_max is r.
//!
//! p(u, v) = (√(s·z) cos φ, √(s·z) sin φ, z), φ = u·φ_max, z = z_min + v·(z_max − z_min). Sampled
//! by area: its element is √(s·z + s²/4) dz dφ, so that (z + s/4)^(3/2) is uniform ([Pharr 2016
//! §3.5]).

use super::quadric::{Local, Quadric, between, first_hit, phi, revolved_roots, swept, unrounded};
use super::sample::{ShapeHit, ShapeSample};
use crate::surface::SurfacePoint;
use math::{Bounds3, DVec3, Normal3, Ray, Transform, Vec2};

/// A paraboloid.
#[derive(Clone, Debug)]
pub struct Paraboloid {
    quadric: Quadric,
    radius: f64,
    z: [f64; 2],
    /// The derivative of x² + y² by z.
    spread: f64,
    phi_max: f64,
    area: f32,
}

impl Paraboloid {
    /// The paraboloid that opens along the object's z axis, between two heights, with `radius` at
    /// the larger one (which must be above 0), up to an angle in degrees.
    pub fn new(
        render_from_object: &Transform,
        reverse_orientation: bool,
        radius: f32,
        z: [f32; 2],
        phi_max: f32,
    ) -> Self {
        let radius = radius.abs() as f64;
        let mut z = z.map(|z| z.max(0.0) as f64);
        z.sort_by(f64::total_cmp);
        let mut paraboloid = Self {
            quadric: Quadric::new(render_from_object, reverse_orientation),
            radius,
            z,
            spread: radius * radius / z[1],
            phi_max: swept(phi_max),
            area: 0.0,
        };
        paraboloid.area = paraboloid
            .quadric
            .area(paraboloid.object_area(), |u, v| paraboloid.normal(paraboloid.place(u, v)));
        paraboloid
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        let r = self.radius;
        Some(self.quadric.bounds(DVec3::new(-r, -r, self.z[0]), DVec3::new(r, r, self.z[1])))
    }

    pub(super) fn intersect(&self, ray: &Ray, range: [f32; 2]) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        first_hit(self.roots(o, d)?, range, |t| {
            let p = o + d * t;
            let inside = p.z >= self.z[0] && p.z <= self.z[1] && phi(p) <= self.phi_max;
            inside.then(|| self.parameters(p))
        })
    }

    pub(super) fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let mut p = o + d * unrounded(self.roots(o, d), hit.t);
        p.z = (p.x * p.x + p.y * p.y) / self.spread;
        let (uv, n) = (self.parameters(p), self.normal(p));
        // A direction for the tangents at the bottom.
        let mut out = DVec3::new(p.x, p.y, 0.0);
        if out.length() < 1e-5 * self.radius {
            out = out.normalize_or(DVec3::X) * (1e-5 * self.radius);
        }
        let around = DVec3::new(-out.y, out.x, 0.0) * self.phi_max;
        // x and y grow as √z, whose derivatives are √z/2z and −√z/4z².
        let rise = (self.z[1] - self.z[0]) * 0.5 * self.spread / out.length_squared();
        let local = Local {
            p,
            n,
            uv,
            dpdu: around,
            dpdv: out * rise + DVec3::Z * (self.z[1] - self.z[0]),
            second: [out * (-self.phi_max * self.phi_max), around * rise, out * (-rise * rise)],
        };
        self.quadric.surface(&local, ray)
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let p = self.place(u.x as f64, u.y as f64);
        Some(self.quadric.sample(p, self.normal(p), self.parameters(p), 1.0 / self.object_area()))
    }

    pub(super) fn pdf_area(&self, n: Normal3) -> f32 {
        self.quadric.pdf_area(n, 1.0 / self.object_area())
    }

    fn roots(&self, o: DVec3, d: DVec3) -> Option<[f64; 2]> {
        revolved_roots([0.0, self.spread, 0.0], o, d, DVec3::Z * (0.5 * self.z[1]))
    }

    fn object_area(&self) -> f64 {
        let [low, high] = self.z.map(|z| libm::pow(z + 0.25 * self.spread, 1.5));
        self.phi_max * self.spread.sqrt() * (high - low) / 1.5
    }

    /// The point at fractions of the area below it and of the angle.
    fn place(&self, u: f64, v: f64) -> DVec3 {
        let powers = self.z.map(|z| libm::pow(z + 0.25 * self.spread, 1.5));
        let z = libm::pow(between(powers, u), 2.0 / 3.0) - 0.25 * self.spread;
        self.at_height(z.clamp(self.z[0], self.z[1]), v)
    }

    /// A ray along the normal that hits the point with parameters (u, v) at t = 1.
    pub(super) fn ray_to(&self, uv: Vec2, time: f32) -> Ray {
        let (p, n) = self.at(uv);
        self.quadric.ray_to(p, n, time)
    }

    /// The point with parameters (u, v) and its unit normal, in object space.
    fn at(&self, uv: Vec2) -> (DVec3, DVec3) {
        let p = self.at_height(between(self.z, uv.y as f64), uv.x as f64);
        (p, self.normal(p))
    }

    fn at_height(&self, z: f64, u: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(u * self.phi_max);
        let out = (self.spread * z).sqrt();
        DVec3::new(out * cos, out * sin, z)
    }

    fn normal(&self, p: DVec3) -> DVec3 {
        DVec3::new(p.x, p.y, -0.5 * self.spread).normalize()
    }

    fn parameters(&self, p: DVec3) -> Vec2 {
        let v = (p.z - self.z[0]) / (self.z[1] - self.z[0]);
        Vec2::new((phi(p) / self.phi_max) as f32, v as f32)
    }
}
