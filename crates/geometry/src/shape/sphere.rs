//! The sphere x² + y² + z² = r², or the part of it with z_min ≤ z ≤ z_max and φ ≤ φ_max.
//!
//! p(u, v) = r·(sin θ cos φ, sin θ sin φ, cos θ), φ = u·φ_max, θ = θ(z_min) + v·(θ(z_max) −
//! θ(z_min)).
//!
//! A whole sphere under a similarity transform is sampled over the cone in which it is seen from
//! outside: with sin θ_max = r/d, the cosine is uniform in [cos θ_max, 1], so that the density is
//! 1/(2π(1 − cos θ_max)). All other spheres are sampled by area ([Pharr 2023 §6.2]).

use super::plain::{PlainShape, RevolvedKind};
use super::quadric::{Local, Quadric, between, first_hit, phi, roots, swept, unrounded};
use super::sample::{ShapeHit, ShapeSample, ShapeSampleContext};
use crate::placement::Placement;
use crate::surface::SurfacePoint;
use math::{Bounds3, DVec3, Normal3, Ray, Transform, Vec2};
use std::f64::consts::{PI, TAU};

/// A sphere, or a part of it.
#[derive(Clone, Debug)]
pub struct Sphere {
    quadric: Quadric,
    radius: f64,
    z: [f64; 2],
    theta: [f64; 2],
    phi_max: f64,
    /// Centre and radius in render space, where it is a whole sphere there too.
    ball: Option<(DVec3, f64)>,
    area: f32,
}

impl Sphere {
    /// A part of the sphere around the object's origin: between two heights along z, up to an angle
    /// in degrees.
    pub fn new(
        render_from_object: &Transform,
        reverse_orientation: bool,
        radius: f32,
        z: [f32; 2],
        phi_max: f32,
    ) -> Self {
        let quadric = Quadric::new(render_from_object, reverse_orientation);
        let radius = radius.abs() as f64;
        let mut z = z.map(|z| (z as f64).clamp(-radius, radius));
        z.sort_by(f64::total_cmp);
        let phi_max = swept(phi_max);
        let is_whole = z == [-radius, radius] && phi_max >= TAU;
        let scale = quadric.placement.uniform_scale().filter(|_| is_whole);
        let ball = scale.map(|s| (quadric.placement.center(), radius * s));
        let theta = z.map(|z| libm::acos((z / radius).clamp(-1.0, 1.0)));
        let mut sphere = Self { quadric, radius, z, theta, phi_max, ball, area: 0.0 };
        sphere.area = match sphere.ball {
            Some((_, r)) => (4.0 * PI * r * r) as f32,
            None => sphere.quadric.area(sphere.object_area(), |u, v| sphere.place(u, v) / radius),
        };
        sphere
    }

    /// A whole sphere.
    pub fn whole(render_from_object: &Transform, reverse_orientation: bool, radius: f32) -> Self {
        Self::new(render_from_object, reverse_orientation, radius, [-radius, radius], 360.0)
    }

    /// A whole sphere of a rigid placement.
    pub(crate) fn ball(placement: Placement, flips: bool, radius: f32) -> Self {
        let radius = radius as f64;
        let ball = Some((placement.center(), radius));
        let quadric = Quadric::placed(placement, flips);
        let area = (4.0 * PI * radius * radius) as f32;
        Self { quadric, radius, z: [-radius, radius], theta: [PI, 0.0], phi_max: TAU, ball, area }
    }

    /// Whether it is whole in render space, too, with its outside away from its centre.
    pub(super) fn is_seen_outside_first(&self) -> bool {
        self.ball.is_some() && !self.quadric.flips()
    }

    pub(super) fn plain(&self) -> PlainShape {
        self.quadric.plain(RevolvedKind::Sphere, [self.radius, self.z[0], self.z[1], self.phi_max])
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        let r = self.radius;
        Some(self.quadric.bounds(DVec3::new(-r, -r, self.z[0]), DVec3::new(r, r, self.z[1])))
    }

    pub(super) fn intersect(&self, ray: &Ray, range: [f32; 2]) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        first_hit(roots(o, d, self.radius)?, range, |t| {
            let p = o + d * t;
            let clipped =
                self.ball.is_none() && (p.z < self.z[0] || p.z > self.z[1] || phi(p) > self.phi_max);
            (!clipped).then(|| self.parameters(p))
        })
    }

    pub(crate) fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let r = self.radius;
        let mut p = (o + d * unrounded(roots(o, d, r), hit.t)).normalize_or(DVec3::Z) * r;
        let uv = self.parameters(p);
        let n = p / r;
        if p.x == 0.0 && p.y == 0.0 {
            // A direction for the tangents at the pole.
            p.x = 1e-5 * r;
        }
        let height = self.theta[1] - self.theta[0];
        let across = libm::hypot(p.x, p.y);
        let (cos_phi, sin_phi) = (p.x / across, p.y / across);
        let local = Local {
            p: n * r,
            n,
            uv,
            dpdu: DVec3::new(-p.y, p.x, 0.0) * self.phi_max,
            dpdv: DVec3::new(p.z * cos_phi, p.z * sin_phi, -across) * height,
            second: [
                DVec3::new(p.x, p.y, 0.0) * -self.phi_max * self.phi_max,
                DVec3::new(-sin_phi, cos_phi, 0.0) * (height * p.z * self.phi_max),
                p * -height * height,
            ],
        };
        self.quadric.surface(&local, ray)
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let p = self.place(u.x as f64, u.y as f64);
        Some(self.quadric.sample(p, p / self.radius, self.parameters(p), 1.0 / self.object_area()))
    }

    pub(super) fn pdf_area(&self, n: Normal3) -> f32 {
        self.quadric.pdf_area(n, 1.0 / self.object_area())
    }

    /// By the cone, for a whole sphere seen from outside.
    pub(super) fn sample_from(&self, reference: &ShapeSampleContext, u: Vec2) -> Option<ShapeSample> {
        let cone = self.cone(reference)?;
        let (center, radius) = self.ball?;
        // The near point of the sphere in a direction at θ from its centre, by the angle α that it
        // makes there.
        let below_one = cone.one_minus_cos * u.x as f64;
        let cos = 1.0 - below_one;
        let sin2 = below_one * (1.0 + cos);
        let cos_alpha = sin2 / cone.sin + cos * (1.0 - sin2 / (cone.sin * cone.sin)).max(0.0).sqrt();
        let local = direction(cos_alpha, u.y as f64 * TAU);
        let z = cone.axis;
        let x = z.any_orthonormal_vector();
        let n = -(x * local.x + z.cross(x) * local.y + z * local.z);
        let p = self.quadric.placement.point_inward(center + n * radius).normalize_or(DVec3::Z);
        let sample = self.quadric.sample(p * self.radius, p, self.parameters(p * self.radius), 1.0);
        Some(ShapeSample { pdf: cone.pdf(), ..sample })
    }

    /// The density within the cone, for a whole sphere seen from outside.
    pub(super) fn pdf_from(&self, reference: &ShapeSampleContext) -> Option<f32> {
        self.cone(reference).map(|cone| cone.pdf())
    }

    fn cone(&self, reference: &ShapeSampleContext) -> Option<Cone> {
        let (center, radius) = self.ball?;
        let toward = center - reference.p.p.as_dvec3();
        // From a point that may be on the sphere there is no cone.
        let distance = toward.length();
        let outside = distance - reference.p.error.length() as f64 > radius;
        outside.then(|| {
            let sin = radius / distance;
            Cone { axis: toward / distance, sin, one_minus_cos: sin * sin / (1.0 + (1.0 - sin * sin).sqrt()) }
        })
    }

    /// A ray along the normal that hits the point with parameters (u, v) at t = 1.
    pub(super) fn ray_to(&self, uv: Vec2, time: f32) -> Ray {
        let (p, n) = self.at(uv);
        self.quadric.ray_to(p, n, time)
    }

    /// The point with parameters (u, v) and its unit normal, in object space.
    fn at(&self, uv: Vec2) -> (DVec3, DVec3) {
        let theta = between(self.theta, uv.y as f64);
        let n = direction(libm::cos(theta), uv.x as f64 * self.phi_max);
        (n * self.radius, n)
    }

    fn object_area(&self) -> f64 {
        self.phi_max * self.radius * (self.z[1] - self.z[0])
    }

    /// The point at fractions of the height and of the angle, which are uniform over the area
    /// (Archimedes).
    fn place(&self, u: f64, v: f64) -> DVec3 {
        let z = self.z[0] + (self.z[1] - self.z[0]) * u;
        direction(z / self.radius, v * self.phi_max) * self.radius
    }

    fn parameters(&self, p: DVec3) -> Vec2 {
        let theta = libm::acos((p.z / self.radius).clamp(-1.0, 1.0));
        let v = (theta - self.theta[0]) / (self.theta[1] - self.theta[0]);
        Vec2::new((phi(p) / self.phi_max) as f32, v as f32)
    }
}

/// The cone in which a sphere is seen.
struct Cone {
    axis: DVec3,
    /// Of the half angle.
    sin: f64,
    one_minus_cos: f64,
}

impl Cone {
    fn pdf(&self) -> f32 {
        (1.0 / (TAU * self.one_minus_cos)) as f32
    }
}

fn direction(cos_theta: f64, phi: f64) -> DVec3 {
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    let (sin_phi, cos_phi) = libm::sincos(phi);
    DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
}
