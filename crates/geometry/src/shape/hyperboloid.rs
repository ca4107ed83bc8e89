//! The hyperboloid of one sheet that the line from p₁ to p₂ sweeps around the z axis, up to an
//! angle φ_max.
//!
//! p(u, v) = R(φ)·((1 − v)·p₁ + v·p₂), φ = u·φ_max, with R(φ) the rotation around z. With e = p₂ −
//! p₁ and ē its part in the xy plane, x² + y² = w² + (|ē|/e_z)²·(z − z_w)²: the waist has the
//! radius w and the height z_w. Lines in a plane with the axis sweep cones and cylinders; e_z must
//! not be zero.
//!
//! Sampled by area: its element is √((e_z·w)² + (|e||ē|(v − v_w))²) dv dφ, whose integral has a
//! closed form but its inverse none; that is found by Newton's method within a shrinking bracket
//! ([Pharr 2016 §3.5]; [Press 2007 §9.4]).

use super::quadric::{Local, Quadric, between, first_hit, phi, revolved_roots, swept, unrounded};
use super::sample::{ShapeHit, ShapeSample};
use crate::surface::SurfacePoint;
use math::{Bounds3, DVec3, Normal3, Point3, Ray, Transform, Vec2};

/// A hyperboloid of one sheet.
#[derive(Clone, Debug)]
pub struct Hyperboloid {
    quadric: Quadric,
    from: DVec3,
    to: DVec3,
    /// Radius of the waist, and its v.
    waist: (f64, f64),
    phi_max: f64,
    area: f32,
}

const ACROSS: DVec3 = DVec3::new(1.0, 1.0, 0.0);

impl Hyperboloid {
    /// The surface that the line between two points of different z sweeps around the object's z
    /// axis, up to an angle in degrees.
    pub fn new(
        render_from_object: &Transform,
        reverse_orientation: bool,
        ends: [Point3; 2],
        phi_max: f32,
    ) -> Self {
        let [from, to] = ends.map(|p| p.as_dvec3());
        let along = (to - from) * ACROSS;
        let waist = if along == DVec3::ZERO {
            ((from * ACROSS).length(), 0.0)
        } else {
            (from.cross(along).z.abs() / along.length(), -from.dot(along) / along.length_squared())
        };
        let mut hyperboloid = Self {
            quadric: Quadric::new(render_from_object, reverse_orientation),
            from,
            to,
            waist,
            phi_max: swept(phi_max),
            area: 0.0,
        };
        hyperboloid.area = hyperboloid.quadric.area(hyperboloid.object_area(), |u, v| {
            hyperboloid.local(hyperboloid.at_area(u), v * hyperboloid.phi_max).n
        });
        hyperboloid
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        let out = (self.from * ACROSS).length().max((self.to * ACROSS).length());
        let corner = DVec3::new(out, out, 0.0);
        let (low, high) = (self.from.z.min(self.to.z), self.from.z.max(self.to.z));
        Some(self.quadric.bounds(DVec3::Z * low - corner, DVec3::Z * high + corner))
    }

    pub(super) fn intersect(&self, ray: &Ray, range: [f32; 2]) -> Option<ShapeHit> {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        first_hit(self.roots(o, d)?, range, |t| {
            let (v, phi) = self.parameters(o + d * t);
            let inside = (0.0..=1.0).contains(&v) && phi <= self.phi_max;
            inside.then(|| self.uv(v, phi))
        })
    }

    pub(super) fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        let (o, d) = self.quadric.placement.ray_inward(ray);
        let (v, phi) = self.parameters(o + d * unrounded(self.roots(o, d), hit.t));
        self.quadric.surface(&self.local(v, phi), ray)
    }

    pub(super) fn area(&self) -> f32 {
        self.area
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let local = self.local(self.at_area(u.x as f64), u.y as f64 * self.phi_max);
        Some(self.quadric.sample(local.p, local.n, local.uv, 1.0 / self.object_area()))
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
        let Local { p, n, .. } = self.local(uv.y as f64, uv.x as f64 * self.phi_max);
        (p, n)
    }

    /// With the origin in the waist, x² + y² = w² + (|ē|/e_z)²·z².
    fn roots(&self, o: DVec3, d: DVec3) -> Option<[f64; 2]> {
        let (radius, v) = self.waist;
        let center = DVec3::Z * between([self.from.z, self.to.z], v);
        let middle = DVec3::Z * (0.5 * (self.from.z + self.to.z));
        let along = self.to - self.from;
        let slope2 = (along * ACROSS).length_squared() / (along.z * along.z);
        revolved_roots([radius * radius, 0.0, slope2], o - center, d, middle - center)
    }

    fn local(&self, v: f64, phi: f64) -> Local {
        let (sin, cos) = libm::sincos(phi);
        let turned = |p: DVec3| DVec3::new(p.x * cos - p.y * sin, p.x * sin + p.y * cos, p.z);
        let dpdv = turned(self.to - self.from);
        let p = turned(self.on_line(v));
        // A direction for the tangents where the line crosses the axis.
        let out = if p.x == 0.0 && p.y == 0.0 { dpdv * 1e-5 } else { p };
        let around = |p: DVec3| DVec3::new(-p.y, p.x, 0.0) * self.phi_max;
        let dpdu = around(out);
        Local {
            p,
            n: dpdu.cross(dpdv).normalize_or(DVec3::Z),
            uv: self.uv(v, phi),
            dpdu,
            dpdv,
            second: [around(dpdu), around(dpdv), DVec3::ZERO],
        }
    }

    /// v and φ of a point of the surface.
    fn parameters(&self, p: DVec3) -> (f64, f64) {
        let v = (p.z - self.from.z) / (self.to.z - self.from.z);
        let line = self.on_line(v) * ACROSS;
        (v, phi(DVec3::new(line.dot(p), line.cross(p).z, 0.0)))
    }

    fn on_line(&self, v: f64) -> DVec3 {
        self.from + (self.to - self.from) * v
    }

    fn uv(&self, v: f64, phi: f64) -> Vec2 {
        Vec2::new((phi / self.phi_max) as f32, v as f32)
    }

    fn object_area(&self) -> f64 {
        self.phi_max * (self.area_below(1.0) - self.area_below(0.0))
    }

    /// ∂A/∂v of a radian of the sweep.
    fn area_element(&self, v: f64) -> f64 {
        let (constant, slope) = self.element();
        libm::hypot(constant, slope * (v - self.waist.1))
    }

    /// The area of a radian of the sweep between the waist and v; negative below the waist.
    fn area_below(&self, v: f64) -> f64 {
        let (constant, slope) = self.element();
        let from_waist = v - self.waist.1;
        let x = slope * from_waist;
        let bent = if x == 0.0 || constant == 0.0 {
            constant
        } else {
            constant * (x / constant).asinh() / x * constant
        };
        0.5 * from_waist * (libm::hypot(constant, x) + bent)
    }

    /// e_z·w and |e||ē|.
    fn element(&self) -> (f64, f64) {
        let along = self.to - self.from;
        (along.z.abs() * self.waist.0, along.length() * (along * ACROSS).length())
    }

    /// The v below which a fraction of the area lies.
    fn at_area(&self, fraction: f64) -> f64 {
        let wanted = between([self.area_below(0.0), self.area_below(1.0)], fraction);
        let (mut low, mut high) = (0.0, 1.0);
        let mut v = fraction;
        for _ in 0..64 {
            let excess = self.area_below(v) - wanted;
            if excess > 0.0 {
                high = v;
            } else {
                low = v;
            }
            let newton = v - excess / self.area_element(v);
            let next = if newton > low && newton < high { newton } else { 0.5 * (low + high) };
            if (next - v).abs() < 1e-15 {
                break;
            }
            v = next;
        }
        v
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_area_is_inverted_for_waists_cones_tubes_and_near_tubes() {
        let lines = [
            [Point3::new(0.9, 0.1, -0.8), Point3::new(-0.2, 0.8, 0.9)],
            [Point3::new(1.0, 1.0, -1.0), Point3::new(-1.0, -1.0, 2.0)],
            [Point3::new(0.0, 0.0, 0.0), Point3::new(1.0, 1.0, 1.0)],
            [Point3::new(1.0, 0.0, 0.0), Point3::new(1.0, 0.0, 1.0)],
            [Point3::new(1.0, 0.5, 0.0), Point3::new(1.000_000_1, 0.5, 1.0)],
            [Point3::new(1.0, 3.0, 0.0), Point3::new(1.0, -4.0, 1e-6)],
        ];
        for line in lines {
            let shape = Hyperboloid::new(&Transform::IDENTITY, false, line, 360.0);
            let [from, to] = [0.0, 1.0].map(|v| shape.area_below(v));
            let by_steps = (0..4096).map(|i| shape.area_element((i as f64 + 0.5) / 4096.0)).sum::<f64>();
            assert!((by_steps / 4096.0 / (to - from) - 1.0).abs() < 1e-6, "{line:?}");
            for i in 0..=1000 {
                let fraction = i as f64 / 1000.0;
                let found = (shape.area_below(shape.at_area(fraction)) - from) / (to - from);
                assert!((found - fraction).abs() < 1e-8, "{line:?}: {found} for {fraction}");
            }
        }
    }
}
