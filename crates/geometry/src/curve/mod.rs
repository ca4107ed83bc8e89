//! Curves: hair, fur, grass, ribbons.
//!
//! A curve is swept by a line segment across it, whose length, the width, changes linearly from end
//! to end. It faces the ray ([`CurveProfile::Flat`]), faces the ray with the shading normals of a
//! tube ([`CurveProfile::Cylinder`]), or is perpendicular to interpolated normals
//! ([`CurveProfile::Ribbon`]). u ∈ [0, 1] runs along a segment, v ∈ [0, 1] across it.
//!
//! Intersection works in a frame with the ray's origin and its direction as z axis. The curve is
//! bisected, without the parts whose boxes the ray misses, until the parts deviate from straight
//! lines by less than a twentieth of the width; such a part is hit where the point of its chord
//! nearest to the z axis is within half the width. The depth for that bound follows from the second
//! differences of the control points ([Wang 1984]). All of this is as in [Pharr 2023 §6.7]: the
//! surface is known to within the width only, which is the error of a hit, so that spawned rays
//! start clear of the curve.
//!
//! Points and widths are in object space; arithmetic is in doubles.

mod bezier;

use crate::placement::Placement;
use crate::shape::{CurveKind, PlainShape, ShapeHit};
use crate::surface::SurfacePoint;
use bezier::{Cubic, evaluate, halves, part};
use math::{Bounds3, DVec3, Normal3, Point3, Ray, Transform, Vec2, Vec3, coordinate_system};

pub use bezier::{SplineBasis, bezier_segments};

/// A part that deviates from its chord by this fraction of the width counts as straight.
const FLATNESS: f64 = 0.05;
/// The most bisections of a part.
const DEEPEST: i32 = 10;
/// The most primitives of curves with split segments.
const MOST_PARTS: usize = 1 << 25;

/// A cubic Bézier segment of a curve.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CurveSegment {
    /// Control points.
    pub points: [Point3; 4],
    /// Width at the start and at the end.
    pub width: [f32; 2],
}

/// The profile swept along a curve.
#[derive(Clone, Debug, PartialEq)]
pub enum CurveProfile {
    /// A line that faces the ray.
    Flat,
    /// A line that faces the ray, with the normals of a tube.
    Cylinder,
    /// A line perpendicular to normals, given at the ends of every segment.
    Ribbon(Vec<[Normal3; 2]>),
}

/// Curves that share a profile. Their primitives are parts of segments, which cost no memory of
/// their own.
#[derive(Clone, Debug)]
pub struct Curves {
    segments: Vec<CurveSegment>,
    profile: CurveProfile,
    split_depth: u32,
    placement: Placement,
    flips: bool,
}

impl Curves {
    /// Curves given in object space. Each segment becomes 2^`split_depth` primitives, for tighter
    /// bounds, or fewer where those would be too many.
    ///
    /// # Panics
    /// When a ribbon has not one pair of normals per segment.
    pub fn new(
        segments: Vec<CurveSegment>,
        mut profile: CurveProfile,
        split_depth: u32,
        render_from_object: &Transform,
        reverse_orientation: bool,
    ) -> Self {
        if let CurveProfile::Ribbon(normals) = &mut profile {
            assert_eq!(normals.len(), segments.len(), "a ribbon has a pair of normals per segment");
            for normal in normals.iter_mut().flatten() {
                *normal = normal.normalize_or_zero();
            }
        }
        Self {
            profile,
            split_depth: split_depth.min((MOST_PARTS / segments.len().max(1)).max(1).ilog2()),
            segments,
            placement: Placement::new(render_from_object),
            flips: reverse_orientation != render_from_object.swaps_handedness(),
        }
    }

    /// The number of primitives.
    pub fn len(&self) -> usize {
        self.segments.len() << self.split_depth
    }

    /// Whether there is no primitive.
    pub fn is_empty(&self) -> bool {
        self.segments.is_empty()
    }

    /// Bytes of memory.
    pub(crate) fn bytes(&self) -> usize {
        let normals = match &self.profile {
            CurveProfile::Ribbon(normals) => size_of_val(&**normals),
            CurveProfile::Flat | CurveProfile::Cylinder => 0,
        };
        size_of_val(&*self.segments) + normals
    }

    /// A box around a primitive, in render space.
    pub fn bounds(&self, primitive: u32) -> Bounds3 {
        let (segment, u) = self.part(primitive);
        let points = part(&segment.cubic(), u);
        let radius = 0.5 * u.map(|u| segment.width_at(u)).into_iter().fold(0.0, f64::max);
        let reach = Vec3::from(self.placement.ball_extent(radius).as_vec3());
        points.iter().map(|&p| self.placement.point(p, DVec3::ZERO)).fold(Bounds3::EMPTY, |all, p| {
            let reach = reach * (1.0 + f32::EPSILON) + p.error;
            all.union(Bounds3 { min: p.p - reach, max: p.p + reach })
        })
    }

    /// The nearest hit on a primitive at 0 < t < `t_max`.
    pub fn intersect(&self, primitive: u32, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        let (segment, u) = self.part(primitive);
        let (o, d) = self.placement.ray_inward(ray);
        let length = d.length();
        let z = d / length;
        let points = part(&segment.cubic(), u);
        let y = z.cross(points[3] - points[0]).try_normalize().unwrap_or_else(|| across(z));
        let x = y.cross(z);
        let points = points.map(|p| p - o).map(|p| DVec3::new(x.dot(p), y.dot(p), z.dot(p)));
        let mut search = Search {
            segment,
            facing: &|u| self.ribbon_normal(primitive, u).map_or(1.0, |n| n.dot(z).abs()),
            length,
            t_max,
            hit: None,
        };
        if search.is_near(&points, u) {
            search.descend(&points, u, depth(&points, segment.width.into_iter().fold(0.0, f32::max).into()));
        }
        search.hit
    }

    /// The surface at a hit of `ray` on a primitive.
    pub fn surface(&self, primitive: u32, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        let (segment, _) = self.part(primitive);
        let (o, d) = self.placement.ray_inward(ray);
        let z = d.normalize_or_zero();
        let [u, v] = hit.uv.to_array().map(f64::from);
        let points = segment.cubic();
        let (_, derivative) = evaluate(&points, u);
        let dpdu = [derivative, points[3] - points[0]].into_iter().find(|d| *d != DVec3::ZERO);
        let dpdu = dpdu.unwrap_or_else(|| across(z));
        let tangent = dpdu.normalize();
        let mut width = segment.width_at(u);
        let sideways = z.cross(tangent).try_normalize().unwrap_or_else(|| across(tangent));
        let side = match &self.profile {
            CurveProfile::Flat => sideways,
            CurveProfile::Cylinder => {
                let (sin, cos) = libm::sincos((v - 0.5) * std::f64::consts::PI);
                sideways * cos - tangent.cross(sideways) * sin
            }
            CurveProfile::Ribbon(_) => {
                let normal = self.ribbon_normal(primitive, u).unwrap_or(z);
                width *= normal.dot(z).abs();
                normal.cross(tangent).try_normalize().unwrap_or(sideways)
            }
        };
        let n = self.placement.unit_normal(tangent.cross(side));
        SurfacePoint::new(
            self.placement.point(o + d * f64::from(hit.t), DVec3::splat(width)),
            if self.flips { -n } else { n },
            hit.uv,
            [self.placement.vector(dpdu), self.placement.vector(side * width)],
            [Vec3::ZERO; 2],
            ray,
        )
    }

    /// A primitive in render space; `None` where widths depend on directions.
    pub fn plain(&self, primitive: u32) -> Option<PlainShape> {
        let scale = self.placement.uniform_scale()?;
        let (segment, range) = self.part(primitive);
        let normal = |u: f64| self.ribbon_normal(primitive, u).map(|n| self.placement.unit_normal(n));
        Some(PlainShape::Curve {
            kind: match &self.profile {
                CurveProfile::Flat => CurveKind::Flat,
                CurveProfile::Cylinder => CurveKind::Cylinder,
                CurveProfile::Ribbon(_) => CurveKind::Ribbon,
            },
            points: part(&segment.cubic(), range).map(|p| self.placement.point(p, DVec3::ZERO).p),
            widths: range.map(|u| (segment.width_at(u) * scale) as f32),
            range: range.map(|u| u as f32),
            normals: range.map(|u| normal(u).unwrap_or(Normal3::ZERO)),
            flips: self.flips,
        })
    }

    /// The segment of a primitive, and the range of its parameters.
    fn part(&self, primitive: u32) -> (&CurveSegment, [f64; 2]) {
        let parts = 1u32 << self.split_depth;
        let i = f64::from(primitive % parts);
        let size = 1.0 / f64::from(parts);
        (&self.segments[(primitive / parts) as usize], [i * size, (i + 1.0) * size])
    }

    /// The normal of a ribbon: spherical linear interpolation between the ends of its segment.
    fn ribbon_normal(&self, primitive: u32, u: f64) -> Option<DVec3> {
        let CurveProfile::Ribbon(normals) = &self.profile else { return None };
        let [start, end] = normals[(primitive >> self.split_depth) as usize].map(|n| n.as_dvec3());
        let angle = start.angle_between(end);
        let sin = libm::sin(angle);
        // An angle of 0 or π, where the plane of rotation is undefined.
        if sin.is_nan() || sin < 1e-6 {
            return Some(if u < 0.5 { start } else { end });
        }
        Some((start * libm::sin((1.0 - u) * angle) + end * libm::sin(u * angle)) / sin)
    }
}

impl CurveSegment {
    fn cubic(&self) -> Cubic {
        self.points.map(|p| p.as_dvec3())
    }

    fn width_at(&self, u: f64) -> f64 {
        let [start, end] = self.width.map(f64::from);
        start + (end - start) * u
    }
}

/// The search for the nearest hit.
struct Search<'a> {
    segment: &'a CurveSegment,
    /// The factor by which the width at u appears narrower.
    facing: &'a dyn Fn(f64) -> f64,
    /// Of the ray's direction.
    length: f64,
    t_max: f32,
    hit: Option<ShapeHit>,
}

impl Search<'_> {
    /// Whether the ray passes within half the width of the box of the control points; never where
    /// there is no width.
    fn is_near(&self, p: &Cubic, [u0, u1]: [f64; 2]) -> bool {
        let radius = 0.5 * self.segment.width_at(u0).max(self.segment.width_at(u1));
        let (low, high) = (p[0].min(p[1]).min(p[2].min(p[3])), p[0].max(p[1]).max(p[2].max(p[3])));
        radius > 0.0
            && low.x <= radius
            && high.x >= -radius
            && low.y <= radius
            && high.y >= -radius
            && high.z >= 0.0
            && low.z <= f64::from(self.t_max) * self.length
    }

    fn descend(&mut self, p: &Cubic, [u0, u1]: [f64; 2], depth: i32) {
        if depth == 0 {
            return self.meet(p, [u0, u1]);
        }
        let middle = 0.5 * (u0 + u1);
        for (half, u) in halves(p).iter().zip([[u0, middle], [middle, u1]]) {
            if self.is_near(half, u) {
                self.descend(half, u, depth - 1);
            }
        }
    }

    /// The hit on a part that is nearly straight.
    fn meet(&mut self, p: &Cubic, [u0, u1]: [f64; 2]) {
        let flat = p.map(|p| p.truncate());
        // Beyond the lines across the curve at its ends, another part is nearer, or none.
        if (flat[1] - flat[0]).dot(-flat[0]) < 0.0 || (flat[2] - flat[3]).dot(-flat[3]) < 0.0 {
            return;
        }
        let chord = flat[3] - flat[0];
        let w = (-flat[0].dot(chord) / chord.length_squared()).clamp(0.0, 1.0);
        let u = u0 + (u1 - u0) * w;
        let width = self.segment.width_at(u) * (self.facing)(u);
        let (nearest, along) = evaluate(p, w);
        let distance = nearest.truncate().length();
        let t = nearest.z / self.length;
        // NaN, of a chord without length, fails.
        if distance <= 0.5 * width && t > 0.0 && (t as f32) < self.t_max {
            let is_left = along.y * nearest.x - along.x * nearest.y > 0.0;
            let across = if width > 0.0 { distance / width } else { 0.0 };
            let v = if is_left { 0.5 + across } else { 0.5 - across };
            self.t_max = t as f32;
            self.hit = Some(ShapeHit { t: t as f32, uv: Vec2::new(u as f32, v as f32) });
        }
    }
}

/// The number of bisections of a curve.
fn depth(p: &Cubic, width: f64) -> i32 {
    let bend = |i: usize| (p[i] - p[i + 1] * 2.0 + p[i + 2]).abs().max_element();
    let ratio = std::f64::consts::SQRT_2 * 6.0 * bend(0).max(bend(1)) / (8.0 * FLATNESS * width);
    (libm::log2(ratio).floor() as i32 / 2).clamp(0, DEEPEST)
}

/// A unit vector perpendicular to a unit vector.
fn across(z: DVec3) -> DVec3 {
    coordinate_system(Vec3::from(z.as_vec3())).0.as_dvec3()
}
