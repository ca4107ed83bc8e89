//! The triangle p(b₁, b₂) = p₀ + b₁(p₁ − p₀) + b₂(p₂ − p₀).
//!
//! Seen from a point, it is sampled by solid angle and cosine where floats allow that
//! (`flat_shape.rs`), elsewhere by area.

use super::sample::{ShapeHit, ShapeSample, ShapeSampleContext};
use crate::facet::FacetFrame;
use crate::flat_shape::{FlatShape, SeenTriangle};
use crate::patch::Patch;
use crate::placement::{ROUNDING, rounded};
use crate::surface::{Shading, SurfacePoint, any_tangents, barycentric, by_texture};
use crate::watertight::Sheared;
use math::{
    Bounds3, DVec3, Normal3, Point3, Point3Error, Ray, Vec2, Vec3, Vector3, coordinate_system, face_forward,
};
use sampling::warp::sample_uniform_triangle;

/// A triangle with vertex attributes, in render space.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Corners.
    pub p: [Point3; 3],
    /// Shading normals.
    pub n: Option<[Normal3; 3]>,
    /// Shading tangents.
    pub s: Option<[Vector3; 3]>,
    /// Texture coordinates.
    pub uv: [Vec2; 3],
    /// Whether the outside is where the corners run clockwise.
    pub flips: bool,
}

impl Triangle {
    /// Default texture coordinates.
    pub const DEFAULT_UV: [Vec2; 3] = [Vec2::ZERO, Vec2::X, Vec2::ONE];

    /// A triangle without shading normals.
    pub fn new(p: [Point3; 3]) -> Self {
        Self { p, n: None, s: None, uv: Self::DEFAULT_UV, flips: false }
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        Some(Bounds3::around(self.p))
    }

    pub(super) fn intersect(&self, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        Sheared::new(ray).triangle(&self.p, t_max).map(|(t, uv)| ShapeHit { t, uv })
    }

    pub(crate) fn surface(&self, ray: &Ray, b: Vec2) -> SurfacePoint {
        let mut n = Normal3::from(self.cross().normalize_or_zero().as_vec3());
        if self.flips {
            n = -n;
        }
        let [st_du, st_dv] = self.sides(&self.uv);
        let [p_du, p_dv] = self.sides(&self.p).map(|e| e.as_dvec3());
        let by_texture =
            |d: [DVec3; 2]| by_texture(d, st_du, st_dv).map(|d| d.map(|d| Vec3::from(d.as_vec3())));
        let have_area = |[a, b]: &[Vector3; 2]| a.balanced().cross(b.balanced()).length_squared() > 0.0;
        let tangents = by_texture([p_du, p_dv]).filter(have_area);
        let [dpdu, dpdv] = tangents.unwrap_or_else(|| any_tangents(n));
        let mut surface =
            SurfacePoint::new(self.point(b), n, self.texture(b), [dpdu, dpdv], [Vec3::ZERO; 2], ray);
        if self.n.is_some() || self.s.is_some() {
            let mix = |v: &[Vec3; 3]| Vec3::from(barycentric(v, b).as_vec3());
            let ns = self.n.and_then(|n| mix(&n).try_normalize()).unwrap_or(n);
            let ss = self.s.map(|s| mix(&s)).filter(|s| *s != Vec3::ZERO).unwrap_or(dpdu);
            let ts = ns.cross(ss);
            let (ss, ts) = if ts != Vec3::ZERO { (ts.cross(ns), ts) } else { coordinate_system(ns) };
            let dn = self.n.and_then(|n| by_texture(self.sides(&n).map(|e| e.as_dvec3())));
            let [dndu, dndv] = dn.unwrap_or([Vec3::ZERO; 2]);
            surface.set_shading(Shading { n: ns, dpdu: ss, dpdv: ts, dndu, dndv });
        }
        surface
    }

    /// As plain data; `None` with shading tangents, or without area.
    #[inline]
    pub(crate) fn patch(&self) -> Option<Patch> {
        let sides = self.sides(&self.p);
        if self.s.is_some() || !has_area(sides) {
            return None;
        }
        let twist = Vec3::ZERO;
        Some(Patch { corner: self.p[0], sides, twist, normals: self.n, uv: self.uv, flips: self.flips })
    }

    /// For rays that are tested in lanes.
    pub(crate) fn facet(&self) -> FacetFrame {
        let [corner, p1, p2] = self.p.map(|p| p.as_dvec3());
        let sides = [p1 - corner, p2 - corner];
        FacetFrame { corner, sides, twist: DVec3::ZERO, is_triangle: true, beyond: 0.0 }
    }

    pub(super) fn area(&self) -> f32 {
        (0.5 * self.cross().length()) as f32
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let [_, b1, b2] = sample_uniform_triangle(u);
        Some(self.sample_at(Vec2::new(b1, b2), 1.0 / self.area()))
    }

    pub(super) fn pdf_area(&self) -> f32 {
        1.0 / self.area()
    }

    /// By solid angle, where that is neither too small nor too large.
    pub(super) fn sample_from(&self, reference: &ShapeSampleContext, u: Vec2) -> Option<ShapeSample> {
        let (b, pdf) = self.seen_from(reference)?.sample(u);
        Some(self.sample_at(b, pdf))
    }

    /// The density by solid angle towards the point at `b`.
    pub(super) fn pdf_from(&self, reference: &ShapeSampleContext, b: Vec2) -> Option<f32> {
        self.seen_from(reference).map(|seen| seen.pdf(b))
    }

    fn seen_from(&self, reference: &ShapeSampleContext) -> Option<SeenTriangle> {
        Some(SeenTriangle::new(self.p, reference)).filter(SeenTriangle::is_valid)
    }

    /// As plain data for sampling, if it has area and the same outside everywhere.
    pub(crate) fn flat_shape(&self) -> Option<FlatShape> {
        let sides = self.sides(&self.p);
        let [n, others @ ..] = [Vec2::ZERO, Vec2::X, Vec2::Y].map(|b| self.outside(b));
        let is_flat = has_area(sides) && others == [n; 2];
        is_flat.then_some(FlatShape { corner: self.p[0], sides, n, is_triangle: true })
    }

    fn sample_at(&self, b: Vec2, pdf: f32) -> ShapeSample {
        ShapeSample { p: self.point(b), n: self.outside(b), uv: self.texture(b), pdf }
    }

    fn point(&self, b: Vec2) -> Point3Error {
        let size = self.p.iter().fold(DVec3::ZERO, |sum, p| sum + p.as_dvec3().abs());
        rounded(barycentric(&self.p, b), DVec3::splat(size.max_element() * ROUNDING))
    }

    fn texture(&self, b: Vec2) -> Vec2 {
        self.uv[0] * (1.0 - b.x - b.y) + self.uv[1] * b.x + self.uv[2] * b.y
    }

    /// The unit normal on the side of the shading normals, where there are any.
    pub(super) fn outside(&self, b: Vec2) -> Normal3 {
        let n = self.cross().normalize_or_zero().as_vec3().into();
        match &self.n {
            Some(normals) => face_forward(n, barycentric(normals, b).as_vec3().into()),
            None if self.flips => -n,
            None => n,
        }
    }

    /// (p₁ − p₀) × (p₂ − p₀), without overflow.
    fn cross(&self) -> DVec3 {
        let [a, b, c] = self.p.map(|p| p.as_dvec3());
        (b - a).cross(c - a)
    }

    /// From corner 0 to corners 1 and 2.
    fn sides<V: Copy + std::ops::Sub<Output = V>>(&self, v: &[V; 3]) -> [V; 2] {
        [v[1] - v[0], v[2] - v[0]]
    }
}

/// Whether floats have a normal of two sides.
pub(super) fn has_area([a, b]: [Vector3; 2]) -> bool {
    a.balanced().cross(b.balanced()).length_squared() >= f32::MIN_POSITIVE
}
