//! The disk z = h with r_i ≤ √(x² + y²) ≤ r and φ ≤ φ_max; hit at t = (h − o_z)/d_z, and not at all
//! when d_z = 0.
//!
//! p(u, v) = (ρ cos φ, ρ sin φ, h), φ = u·φ_max, ρ = r − v·(r − r_i). Sampled by area: a whole disk
//! concentrically, parts by uniform angle and uniform square of the radius ([Pharr 2023 §6.4]).

use super::plain::{PlainShape, RevolvedKind};
use super::quadric::{Local, Quadric, between, phi, swept};
use super::sample::{ShapeHit, ShapeSample};
use crate::surface::SurfacePoint;
use math::{Bounds3, DVec3, Normal3, Ray, Transform, Vec2};
use sampling::warp::sample_uniform_disk_concentric;
use std::f64::consts::TAU;

/// A disk or annulus, or a sector of it.
#[derive(Clone, Debug)]
pub struct Disk {
    quadric: Quadric,
    height: f64,
    radius: f64,
    inner_radius: f64,
    phi_max: f64,
    area: f32,
}

impl Disk {
    /// A disk at a height along the object's z axis, with a hole of `inner_radius`, up to an angle
    /// in degrees.
    pub fn new(
        render_from_object: &Transform,
        reverse_orientation: bool,
        height: f32,
        radius: f32,
        inner_radius: f32,
        phi_max: f32,
    ) -> Self {
        let quadric = Quadric::new(render_from_object, reverse_orientation);
        let mut disk = Self {
            quadric,
            height: height as f64,
            radius: radius as f64,
            inner_radius: inner_radius as f64,
            phi_max: swept(phi_max),
            area: 0.0,
        };
        disk.area = disk.quadric.area(disk.object_area(), |_, _| DVec3::Z);
        disk
    }

    pub(super) fn plain(&self) -> PlainShape {
        self.quadric.plain(RevolvedKind::Disk, [self.height, self.radius, self.inner_radius, self.phi_max])
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        let (r, h) = (self.radius, self.height);
        Some(self.quadric.bounds(DVec3::new(-r, -r, h), DVec3::new(r, r, h)))
    }

    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let t = (self.height - o.z) / d.z;
        // NaN fails.
        if !(t > 0.0 && (t as f32) < t_max) {
            return None;
        }
        let p = o + d * t;
        let distance = libm::hypot(p.x, p.y);
        let inside = distance <= self.radius && distance >= self.inner_radius && phi(p) <= self.phi_max;
        inside.then(|| ShapeHit { t: t as f32, uv: self.parameters(p) })
    }

    pub(super) fn surface(&self, ray: &Ray) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let mut p = o + d * ((self.height - o.z) / d.z);
        p.z = self.height;
        let uv = self.parameters(p);
        let mut out = DVec3::new(p.x, p.y, 0.0);
        if out == DVec3::ZERO {
            // A direction for the tangents at the centre.
            out.x = 1e-5 * self.radius;
        }
        let local = Local {
            p,
            n: DVec3::Z,
            uv,
            dpdu: DVec3::new(-out.y, out.x, 0.0) * self.phi_max,
            dpdv: out.normalize_or(DVec3::X) * (self.inner_radius - self.radius),
            second: [DVec3::ZERO; 3],
        };
        self.quadric.surface(&local, ray)
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let across = if self.inner_radius == 0.0 && self.phi_max >= TAU {
            let q = sample_uniform_disk_concentric(u).as_dvec2() * self.radius;
            q.extend(0.0)
        } else {
            let (r2, i2) = (self.radius * self.radius, self.inner_radius * self.inner_radius);
            let (sin, cos) = libm::sincos(u.y as f64 * self.phi_max);
            DVec3::new(cos, sin, 0.0) * (i2 + (r2 - i2) * u.x as f64).sqrt()
        };
        let p = across + DVec3::Z * self.height;
        Some(self.quadric.sample(p, DVec3::Z, self.parameters(p), 1.0 / self.object_area()))
    }

    pub(super) fn pdf_area(&self, n: Normal3) -> f32 {
        self.quadric.pdf_area(n, 1.0 / self.object_area())
    }

    pub(super) fn normal(&self) -> Normal3 {
        self.quadric.normal(DVec3::Z)
    }

    /// A ray along the normal that hits the point with parameters (u, v) at t = 1.
    pub(super) fn ray_to(&self, uv: Vec2, time: f32) -> Ray {
        let (p, n) = self.at(uv);
        self.quadric.ray_to(p, n, time)
    }

    /// The point with parameters (u, v) and its unit normal, in object space.
    fn at(&self, uv: Vec2) -> (DVec3, DVec3) {
        let (sin, cos) = libm::sincos(uv.x as f64 * self.phi_max);
        let out = between([self.radius, self.inner_radius], uv.y as f64);
        (DVec3::new(cos * out, sin * out, self.height), DVec3::Z)
    }

    fn object_area(&self) -> f64 {
        0.5 * self.phi_max * (self.radius * self.radius - self.inner_radius * self.inner_radius)
    }

    fn parameters(&self, p: DVec3) -> Vec2 {
        let v = (self.radius - libm::hypot(p.x, p.y)) / (self.radius - self.inner_radius);
        Vec2::new((phi(p) / self.phi_max) as f32, v as f32)
    }
}
