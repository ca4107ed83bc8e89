//! Code shared by quadrics.
//!
//! Rays are transformed to object space, where the equation is solved in doubles; the point is then
//! refined onto the surface and rounded to floats in render space. The only error left is that last
//! rounding: it depends neither on the distance of the ray's origin nor on the transform.

use super::plain::{PlainShape, RevolvedKind};
use super::sample::ShapeSample;
use crate::placement::{Placement, ROUNDING};
use crate::surface::SurfacePoint;
use math::{Bounds3, DVec3, MACHINE_EPSILON, Normal3, Point3Error, Ray, Transform, Vec2, Vec3};

/// The placement and orientation of a quadric.
#[derive(Clone, Debug)]
pub(super) struct Quadric {
    pub placement: Placement,
    flips: bool,
}

/// A point of a parametrised surface in object space.
pub(super) struct Local {
    pub p: DVec3,
    /// Unit normal, along dpdu × dpdv.
    pub n: DVec3,
    pub uv: Vec2,
    pub dpdu: DVec3,
    pub dpdv: DVec3,
    /// ∂²p/∂u², ∂²p/∂u∂v, ∂²p/∂v².
    pub second: [DVec3; 3],
}

impl Quadric {
    pub fn new(render_from_object: &Transform, reverse_orientation: bool) -> Self {
        Self {
            placement: Placement::new(render_from_object),
            flips: reverse_orientation != render_from_object.swaps_handedness(),
        }
    }

    /// Where it is placed; `flips` turns its outside in.
    pub fn placed(placement: Placement, flips: bool) -> Self {
        Self { placement, flips }
    }

    /// As plain data.
    pub fn plain(&self, kind: RevolvedKind, numbers: [f64; 4]) -> PlainShape {
        let (render_from_object, numbers) = (self.placement.forward(), numbers.map(|x| x as f32));
        PlainShape::Revolved { kind, render_from_object, flips: self.flips, numbers }
    }

    /// Whether its outside is that of −dpdu × dpdv.
    pub fn flips(&self) -> bool {
        self.flips
    }

    /// Reverses its orientation.
    pub fn turn_round(&mut self) {
        self.flips = !self.flips;
    }

    pub fn surface(&self, local: &Local, ray: &Ray) -> SurfacePoint {
        let vector = |v: DVec3| self.placement.vector(v);
        let dn = weingarten(local).map(|dn| self.normal_change(local.n, dn));
        SurfacePoint::new(
            self.point(local.p),
            self.normal(local.n),
            local.uv,
            [vector(local.dpdu), vector(local.dpdv)],
            dn,
            ray,
        )
    }

    /// A point of the surface in render space.
    pub fn point(&self, p: DVec3) -> Point3Error {
        self.placement.point(p, p.abs() * ROUNDING)
    }

    /// The unit normal in render space, on the shape's outside.
    pub fn normal(&self, n: DVec3) -> Normal3 {
        let n = self.placement.unit_normal(n);
        if self.flips { -n } else { n }
    }

    /// A ray along the normal that hits a point at t = 1, from so near that no other part of the
    /// surface is hit before.
    pub fn ray_to(&self, p: DVec3, n: DVec3, time: f32) -> Ray {
        let (p, n) = (self.point(p).p, self.normal(n));
        let height = (p.abs().max_element() * 1e-4).max(f32::MIN_POSITIVE / MACHINE_EPSILON);
        Ray::new(p + n * height, n * -height, time)
    }

    /// The derivative of the unit normal in render space, towards the outside, from that in object
    /// space.
    pub fn normal_change(&self, n: DVec3, dn: DVec3) -> Normal3 {
        let change = self.placement.normal_change(n, dn);
        if self.flips { -change } else { change }
    }

    /// A sample at a point with unit normal `n` and density `pdf` per area in object space.
    pub fn sample(&self, p: DVec3, n: DVec3, uv: Vec2, pdf: f64) -> ShapeSample {
        ShapeSample {
            p: self.point(p),
            n: self.normal(n),
            uv,
            pdf: (pdf / self.placement.area_factor(n)) as f32,
        }
    }

    /// Converts a density per area from object to render space, where the unit normal is `n`.
    pub fn pdf_area(&self, n: Normal3, pdf: f64) -> f32 {
        (pdf / self.placement.area_factor_outside(n.as_dvec3())) as f32
    }

    /// The area in render space of a surface with `area` in object space, and the unit normal
    /// `normal(u, v)` at parameters that are uniform over that area.
    pub fn area(&self, area: f64, normal: impl Fn(f64, f64) -> DVec3) -> f32 {
        const STEPS: usize = 64;
        let place = |i: usize| (i as f64 + 0.5) / STEPS as f64;
        let mean = (0..STEPS * STEPS)
            .map(|i| self.placement.area_factor(normal(place(i % STEPS), place(i / STEPS))))
            .sum::<f64>()
            / (STEPS * STEPS) as f64;
        (area * mean) as f32
    }

    /// A box around the box of two corners in object space.
    pub fn bounds(&self, min: DVec3, max: DVec3) -> Bounds3 {
        let corner = |i: usize| {
            let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
            self.point(DVec3::new(pick(0), pick(1), pick(2)))
        };
        (0..8).map(corner).fold(Bounds3::EMPTY, |all, p| {
            all.union(Bounds3 { min: p.p - p.error * 2.0, max: p.p + p.error * 2.0 })
        })
    }
}

/// ∂n/∂u and ∂n/∂v of n ∝ dpdu × dpdv, by the fundamental forms.
fn weingarten(local: &Local) -> [DVec3; 2] {
    let Local { n, dpdu, dpdv, second, .. } = local;
    let (e1, f1, g1) = (dpdu.dot(*dpdu), dpdu.dot(*dpdv), dpdv.dot(*dpdv));
    let [e2, f2, g2] = second.map(|d| n.dot(d));
    let determinant = e1 * g1 - f1 * f1;
    if determinant == 0.0 {
        return [DVec3::ZERO; 2];
    }
    [
        (*dpdu * (f2 * f1 - e2 * g1) + *dpdv * (e2 * f1 - f2 * e1)) / determinant,
        (*dpdu * (g2 * f1 - f2 * g1) + *dpdv * (f2 * f1 - g2 * e1)) / determinant,
    ]
}

/// The roots of |o + t·d|² = r² in ascending order, without cancellation.
pub(super) fn roots(o: DVec3, d: DVec3, radius: f64) -> Option<[f64; 2]> {
    roots_of(o, d, d.dot(d).recip(), radius)
}

/// The same, given 1/d².
///
/// The discriminant is (r² − m²)/d² with m the least distance from the centre, and of the two roots
/// the one of larger size is found first; the other is the quotient of their product ([Pharr 2023
/// §6.8.3]). A ray that only touches has the root twice.
#[inline(always)]
fn roots_of(o: DVec3, d: DVec3, inverse: f64, radius: f64) -> Option<[f64; 2]> {
    let middle = -o.dot(d) * inverse;
    let discriminant = (radius * radius - (o + d * middle).length_squared()) * inverse;
    if discriminant < 0.0 || discriminant.is_nan() {
        return None;
    }
    let larger = middle + discriminant.sqrt().copysign(middle);
    let other = if larger == 0.0 { 0.0 } else { (o.dot(o) - radius * radius) * inverse / larger };
    Some(if larger < other { [larger, other] } else { [other, larger] })
}

/// The roots of x² + y² = q₀ + q₁z + q₂z² along o + t·d: where a ray meets a surface of revolution
/// around the z axis. One of them is infinite where the ray runs along an asymptote.
///
/// The ray is first moved up to `near`, a point amid the part of the surface that counts: its
/// coefficients then have the size of the surface, however far the origin is. The root of larger
/// size is found first, as in [`roots`].
pub(super) fn revolved_roots(q: [f64; 3], o: DVec3, d: DVec3, near: DVec3) -> Option<[f64; 2]> {
    let start = (near - o).dot(d) / d.dot(d);
    let o = o + d * start;
    let a = d.x * d.x + d.y * d.y - q[2] * d.z * d.z;
    let half_b = o.x * d.x + o.y * d.y - (q[2] * o.z + 0.5 * q[1]) * d.z;
    let c = o.x * o.x + o.y * o.y - (q[2] * o.z + q[1]) * o.z - q[0];
    let discriminant = half_b * half_b - a * c;
    if discriminant < 0.0 || discriminant.is_nan() {
        return None;
    }
    let larger = -(half_b + discriminant.sqrt().copysign(half_b));
    let other = if larger == 0.0 { 0.0 } else { c / larger };
    let [first, second] = [start + larger / a, start + other];
    Some(if first < second { [first, second] } else { [second, first] })
}

/// A ray prepared for tests against many spheres.
pub(crate) struct SphereRay {
    o: DVec3,
    d: DVec3,
    /// 1/d².
    inverse: f64,
}

impl SphereRay {
    #[inline(always)]
    pub fn new(ray: &Ray) -> Self {
        let d = ray.d.as_dvec3();
        Self { o: ray.o.as_dvec3(), d, inverse: d.dot(d).recip() }
    }

    /// Where the ray first meets a sphere between two distances.
    #[inline]
    pub fn meets(&self, center: Vec3, radius: f32, [after, t_max]: [f32; 2]) -> Option<f32> {
        let roots = roots_of(self.o - center.as_dvec3(), self.d, self.inverse, f64::from(radius))?;
        roots.map(|t| t as f32).into_iter().find(|&t| t > after && t < t_max)
    }
}

/// The root that a hit at `t` was rounded from.
pub(super) fn unrounded(roots: Option<[f64; 2]>, t: f32) -> f64 {
    let t = t as f64;
    roots.map_or(t, |[a, b]| if (a - t).abs() <= (b - t).abs() { a } else { b })
}

/// The angle of a point around the z axis, in [0, 2π).
pub(super) fn phi(p: DVec3) -> f64 {
    let phi = libm::atan2(p.y, p.x);
    if phi < 0.0 { phi + std::f64::consts::TAU } else { phi }
}

/// The number at a fraction of the way between two others.
pub(super) fn between([from, to]: [f64; 2], fraction: f64) -> f64 {
    from + (to - from) * fraction
}

/// Degrees, clamped to [0, 360], in radians.
pub(super) fn swept(degrees: f32) -> f64 {
    (degrees.clamp(0.0, 360.0) as f64).to_radians()
}

/// The first of the ascending `roots` between `after` and `t_max` for which `parameters` are found.
pub(super) fn first_hit(
    roots: [f64; 2],
    [after, t_max]: [f32; 2],
    parameters: impl Fn(f64) -> Option<Vec2>,
) -> Option<super::sample::ShapeHit> {
    roots.into_iter().filter(|&t| (t as f32) > after && (t as f32) < t_max).find_map(|t| {
        let uv = parameters(t)?;
        Some(super::sample::ShapeHit { t: t as f32, uv })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn none_one_and_two_roots() {
        let o = DVec3::new(0.0, 0.0, -5.0);
        assert_eq!(roots(o + DVec3::X * 1.5, DVec3::Z, 1.0), None);
        assert_eq!(roots(o + DVec3::X, DVec3::Z, 1.0), Some([5.0, 5.0]));
        assert_eq!(roots(o, DVec3::Z * 2.0, 1.0), Some([2.0, 3.0]));
        assert_eq!(roots(o, -DVec3::Z, 1.0), Some([-6.0, -4.0]));
        assert_eq!(roots(DVec3::ZERO, DVec3::X, 2.0), Some([-2.0, 2.0]));
        assert_eq!(roots(o, DVec3::ZERO, 1.0), None);
    }

    #[test]
    fn a_surface_of_revolution_has_the_roots_of_its_meridian() {
        // A cone of 45° hit across, along its axis, along its side, and from very far.
        let cone = |o, d| revolved_roots([0.0, 0.0, 1.0], o, d, DVec3::ZERO);
        let o = DVec3::new(-4.0, 0.0, 2.0);
        assert_eq!(cone(o, DVec3::X), Some([2.0, 6.0]));
        assert_eq!(cone(DVec3::new(1.0, 0.0, -4.0), DVec3::Z), Some([3.0, 5.0]));
        assert_eq!(cone(o, DVec3::new(1.0, 0.0, 1.0)), Some([1.0, f64::INFINITY]));
        let [near, _] = cone(o - DVec3::X * 2f64.powi(40), DVec3::X).expect("two roots");
        assert_eq!(near - 2f64.powi(40), 2.0);
        assert_eq!(cone(DVec3::Y, DVec3::X).map(|[near, far]| near == far), None);
        assert_eq!(revolved_roots([1.0, 0.0, 1.0], DVec3::Z, DVec3::Z, DVec3::ZERO), None, "within");
        assert_eq!(cone(o, DVec3::ZERO), None);
    }

    #[test]
    fn the_small_root_keeps_its_digits() {
        let [near, far] = roots(DVec3::new(0.0, 0.0, -1.0 - 1e-12), DVec3::Z, 1.0).expect("two roots");
        assert!((near - 1e-12).abs() < 1e-15 && (far - 2.0).abs() < 1e-11);
    }
}
