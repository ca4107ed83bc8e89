//! The bilinear patch p(u, v) = (1−u)(1−v)·p₀₀ + u(1−v)·p₁₀ + (1−u)v·p₀₁ + uv·p₁₁.
//!
//! A ray meets a line of constant u where the three vectors between them are coplanar, which is a
//! quadratic equation in u; v and t follow from the nearest points of ray and line ([Reshetov
//! 2019]; [Pharr 2023 §6.6]). For a parallelogram, which most patches are, the equations are
//! linear. It is solved in doubles, and the hit point is evaluated from (u, v), so that it lies on
//! the patch whatever t was.
//!
//! Sampling by area follows the area element |∂p/∂u × ∂p/∂v|, bilinear between its values at the
//! corners, or an image given by [`BilinearPatch::with_image`]. A rectangle seen from a point is
//! sampled by solid angle and cosine there (`flat_shape.rs`).

use super::plain::PlainShape;
use super::sample::{ShapeHit, ShapeSample, ShapeSampleContext};
use super::triangle::has_area;
use crate::facet::FacetFrame;
use crate::flat_shape::{FlatShape, SeenRectangle};
use crate::patch::Patch;
use crate::placement::{ROUNDING, rounded};
use crate::surface::{Shading, SurfacePoint, any_tangents, by_texture};
use math::{
    Bounds3, DVec3, DirectionCone, Normal3, Point3, Point3Error, Ray, Transform, Vec2, Vec3, balance,
    face_forward, gamma,
};
use sampling::PiecewiseConstant2d;
use sampling::warp::{bilinear_pdf, sample_bilinear};
use std::sync::Arc;

/// A patch between four corners, ordered p₀₀, p₁₀, p₀₁, p₁₁.
#[derive(Clone, Debug)]
pub struct BilinearPatch {
    p: [Point3; 4],
    n: Option<[Normal3; 4]>,
    uv: Option<[Vec2; 4]>,
    flips: bool,
    /// The error of a point computed from (u, v) before it is rounded to floats.
    error: DVec3,
    is_rectangle: bool,
    /// Whether it has a normal at every corner, in floats.
    is_regular: bool,
    flat: Option<Flat>,
    image: Option<Arc<PiecewiseConstant2d>>,
}

/// A patch that is a parallelogram, p(u, v) = corner + u·right + v·up, up to the rounding of its
/// corners: after a rotation, the corners of few rectangles are those of a parallelogram exactly.
#[derive(Clone, Copy, Debug)]
struct Flat {
    corner: DVec3,
    right: DVec3,
    up: DVec3,
    /// right × up.
    cross: DVec3,
    /// Its direction.
    n: Normal3,
    /// How far u and v may be outside of [0, 1] for a ray along the normal, so that patches overlap
    /// that had an edge in common before each was replaced by a parallelogram. Zero for an exact
    /// one.
    beyond: [f64; 2],
    /// How far the patch is from the parallelogram.
    error: DVec3,
}

impl Flat {
    fn new(p: &[Point3; 4]) -> Option<Self> {
        let [p00, p10, p01, p11] = p.map(|p| p.as_dvec3());
        // The parallelogram with the same centre whose sides are the means of opposite sides; each
        // of its corners is a quarter of p₀₀ − p₁₀ − p₀₁ + p₁₁ away from the patch's.
        let error = (p00 - p10 - p01 + p11) / 4.0;
        let (mut corner, mut right, mut up) = (p00, p10 - p00, p01 - p00);
        if error != DVec3::ZERO {
            (corner, right, up) = (corner - error, right + 2.0 * error, up + 2.0 * error);
        }
        let cross = right.cross(up);
        let n = cross.try_normalize()?.as_vec3().into();
        let far = p.iter().fold(Vec3::ZERO, |far, p| far.max(p.abs())).max_element();
        let sides = [right.length(), up.length()];
        let most = (Self::ROUNDING * f64::from(far)).min(Self::CURVED * sides[0].min(sides[1]));
        let beyond = sides.map(|side| 2.0 * error.length() / side);
        let flat = Self { corner, right, up, cross, n, beyond, error: error.abs() };
        (error.length() <= most).then_some(flat)
    }

    /// The largest value of `beyond` for a ray that grazes the plane.
    const MOST_BEYOND: f64 = 1e-3;

    /// A quarter of the sum of rounding errors of four transformed points, relative to the largest
    /// coordinate.
    const ROUNDING: f64 = gamma(8) as f64;
    /// A patch that deviates by more than this part of its sides is curved, however small it is.
    const CURVED: f64 = 1e-4;

    /// Cramer's rule for o + t·d = p(u, v) [Möller 1997].
    #[inline]
    fn intersect(&self, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        let d = ray.d.as_dvec3();
        let o = ray.o.as_dvec3() - self.corner;
        let inverse = -1.0 / d.dot(self.cross);
        let t = o.dot(self.cross) * inverse;
        let moment = o.cross(d);
        let u = self.up.dot(moment) * inverse;
        let v = -self.right.dot(moment) * inverse;
        // A patch moved away from the plane is met further along it by a ray that grazes it.
        let secant = (d.length_squared() * self.cross.length_squared()).sqrt() * inverse.abs();
        // NaN, where the ray runs along the plane, fails.
        let is_inside = |x: f64, beyond: f64| {
            let beyond = (beyond * secant).min(Self::MOST_BEYOND);
            (-beyond..=1.0 + beyond).contains(&x)
        };
        let is_met =
            t > 0.0 && (t as f32) < t_max && is_inside(u, self.beyond[0]) && is_inside(v, self.beyond[1]);
        let within = |x: f64| x.clamp(0.0, 1.0) as f32;
        is_met.then(|| ShapeHit { t: t as f32, uv: Vec2::new(within(u), within(v)) })
    }
}

impl BilinearPatch {
    /// A patch given in object space, with shading normals and texture coordinates at the corners
    /// where there are any. Given normals point to the outside; with `reverse_orientation`, to the
    /// inside.
    pub fn new(
        p: [Point3; 4],
        n: Option<[Normal3; 4]>,
        uv: Option<[Vec2; 4]>,
        render_from_object: &Transform,
        reverse_orientation: bool,
    ) -> Self {
        let p = p.map(|p| render_from_object.point(p));
        let turn = if reverse_orientation { -1.0 } else { 1.0 };
        let flat = Flat::new(&p);
        let size = p.iter().map(|p| p.abs().as_dvec3()).sum::<DVec3>().max_element();
        Self {
            p,
            n: n.map(|n| n.map(|n| turn * render_from_object.normal(n))),
            uv,
            flips: reverse_orientation != render_from_object.swaps_handedness(),
            error: flat.map_or(DVec3::ZERO, |flat| flat.error) + DVec3::splat(size * ROUNDING),
            is_rectangle: is_rectangle(&p),
            is_regular: is_regular(&p),
            flat,
            image: None,
        }
    }

    /// Samples follow `image`, a distribution over the parameters (u, v) ∈ [0, 1]².
    pub fn with_image(self, image: Arc<PiecewiseConstant2d>) -> Self {
        Self { image: Some(image), ..self }
    }

    /// What samples follow beside the area, if anything.
    pub fn image(&self) -> Option<&PiecewiseConstant2d> {
        self.image.as_deref()
    }

    pub(super) fn is_flat(&self) -> bool {
        self.flat.is_some()
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        Some(Bounds3::around(self.p))
    }

    pub(super) fn intersect(&self, ray: &Ray, [after, t_max]: [f32; 2]) -> Option<ShapeHit> {
        if let Some(flat) = &self.flat {
            return flat.intersect(ray, t_max).filter(|hit| hit.t > after);
        }
        let (o, d) = (ray.o.as_dvec3(), ray.d.as_dvec3());
        let [p00, p10, p01, p11] = self.p.map(|p| p.as_dvec3() - o);
        let mut best: Option<ShapeHit> = None;
        for u in lines_met(&[p00, p10, p01, p11], d)? {
            if !(0.0..=1.0).contains(&u) {
                continue;
            }
            let start = p00.lerp(p10, u);
            let side = p01.lerp(p11, u) - start;
            let across = d.cross(side);
            let scale = across.length_squared();
            let t = start.dot(side.cross(across)) / scale;
            let v = start.dot(d.cross(across)) / scale;
            let nearest = best.map_or(t_max, |hit| hit.t);
            // NaN, where ray and line are parallel, fails.
            if (t as f32) > after && (t as f32) < nearest && (0.0..=1.0).contains(&v) {
                best = Some(ShapeHit { t: t as f32, uv: Vec2::new(u as f32, v as f32) });
            }
        }
        best
    }

    pub(super) fn surface(&self, ray: &Ray, uv: Vec2) -> SurfacePoint {
        let geometric = self.normal(uv);
        let n = if self.flips { -geometric } else { geometric };
        if let (Some(flat), None, None) = (&self.flat, &self.uv, &self.n) {
            let sides = [flat.right.as_vec3().into(), flat.up.as_vec3().into()];
            return SurfacePoint::new(self.point(uv), n, uv, sides, [Vec3::ZERO; 2], ray);
        }
        let p = self.p.map(|p| p.as_dvec3());
        let derivatives = |c: &[DVec3; 4]| [d_du(c, uv), d_dv(c, uv)];
        let by_texture = |d: [DVec3; 2]| match &self.uv {
            None => Some(d),
            Some(st) => {
                let st = st.map(|st| st.extend(0.0).as_dvec3());
                let [du, dv] = derivatives(&st).map(|d| d.truncate().as_vec2().into());
                by_texture(d, du, dv)
            }
        };
        let mut dp = by_texture(derivatives(&p)).unwrap_or_else(|| derivatives(&p));
        if dp[0].cross(dp[1]) == DVec3::ZERO {
            dp = any_tangents(n).map(|d| d.as_dvec3());
        }
        let second = p[0] - p[1] - p[2] + p[3];
        let dn = by_texture(normal_derivatives(derivatives(&p), second)).unwrap_or([DVec3::ZERO; 2]);
        let side = if self.flips { -1.0 } else { 1.0 };
        let mut surface = SurfacePoint::new(
            self.point(uv),
            n,
            self.texture(uv),
            dp.map(|d| d.as_vec3().into()),
            dn.map(|d| (d * side).as_vec3().into()),
            ray,
        );
        if let Some(normals) = &self.n {
            let normals = normals.map(|n| n.as_dvec3());
            let Some(ns) = at(&normals, uv).try_normalize() else { return surface };
            let dn =
                by_texture(derivatives(&normals)).unwrap_or([DVec3::ZERO; 2]).map(|d| d.as_vec3().into());
            let ns = ns.as_vec3().into();
            let turned = |v: Vec3| turn(v, face_forward(n, ns), ns);
            surface.set_shading(Shading {
                n: ns,
                dpdu: turned(surface.dpdu),
                dpdv: turned(surface.dpdv),
                dndu: dn[0],
                dndv: dn[1],
            });
        }
        surface
    }

    /// As plain data; `None` with normals or texture coordinates, or where it has no area.
    #[inline]
    pub(crate) fn patch(&self) -> Option<Patch> {
        let [p00, p10, p01, p11] = self.p;
        let sides = [p10 - p00, p01 - p00];
        let twist = p11 - p10 - sides[1];
        let is_plain = self.n.is_none() && self.uv.is_none();
        (is_plain && self.is_regular).then_some(Patch {
            corner: p00,
            sides,
            twist,
            normals: None,
            uv: [Vec2::ZERO, Vec2::X, Vec2::Y],
            flips: self.flips,
        })
    }

    /// As plain data, if it has no attributes.
    pub(super) fn plain(&self) -> Option<PlainShape> {
        let Patch { corner, sides, twist, flips, .. } = self.patch()?;
        let twist = if self.flat.is_some() { Vec3::ZERO } else { twist };
        Some(PlainShape::Patch { corner, sides, twist, flips })
    }

    /// As plain data for sampling, if it is a rectangle without attributes.
    pub(crate) fn flat_shape(&self) -> Option<FlatShape> {
        let Patch { corner, sides, .. } = self.patch()?;
        let n = self.outside(Vec2::ZERO);
        let is_flat = self.is_rectangle && self.image.is_none();
        is_flat.then_some(FlatShape { corner, sides, n, is_triangle: false })
    }

    /// For rays that are tested in lanes.
    pub(crate) fn facet(&self) -> FacetFrame {
        match &self.flat {
            Some(flat) => FacetFrame {
                corner: flat.corner,
                sides: [flat.right, flat.up],
                twist: DVec3::ZERO,
                is_triangle: false,
                beyond: flat.beyond[0].max(flat.beyond[1]),
            },
            None => {
                let [corner, p10, p01, p11] = self.p.map(|p| p.as_dvec3());
                let sides = [p10 - corner, p01 - corner];
                let twist = p11 - p10 - sides[1];
                FacetFrame { corner, sides, twist, is_triangle: false, beyond: 0.0 }
            }
        }
    }

    pub(super) fn area(&self) -> f32 {
        const STEPS: usize = 16;
        let place = |i: usize| (i as f32 + 0.5) / STEPS as f32;
        let element = |i: usize| self.cross(Vec2::new(place(i % STEPS), place(i / STEPS))).length();
        ((0..STEPS * STEPS).map(element).sum::<f64>() / (STEPS * STEPS) as f64) as f32
    }

    pub(super) fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let uv = match &self.image {
            Some(image) => image.sample(u).0,
            None => sample_bilinear(u, self.area_weights()),
        };
        Some(self.sample_at(uv, self.pdf_area(uv)))
    }

    pub(super) fn pdf_area(&self, uv: Vec2) -> f32 {
        let pdf = match &self.image {
            Some(image) => image.pdf(uv),
            None => bilinear_pdf(uv, self.area_weights()),
        };
        pdf / self.cross(uv).length() as f32
    }

    /// The parameters of the patch's point `p`, where its normal is `n`: of the two lines of
    /// constant u that the normal there may meet, the one that passes through `p`.
    pub(super) fn parameters(&self, p: Point3, n: Normal3) -> Vec2 {
        let kept = |u: f64, v: f64| Vec2::new(u as f32, v as f32).clamp(Vec2::ZERO, Vec2::ONE);
        if let Some(flat) = &self.flat {
            let q = p.as_dvec3() - flat.corner;
            let cross = flat.cross / flat.cross.length_squared();
            return kept(q.cross(flat.up).dot(cross), flat.right.cross(q).dot(cross));
        }
        let (p, n) = (p.as_dvec3(), n.as_dvec3());
        let around = self.p.map(|corner| corner.as_dvec3() - p);
        let near = lines_met(&around, n).into_iter().flatten().map(|u| {
            let start = around[0].lerp(around[1], u);
            let side = around[2].lerp(around[3], u) - start;
            kept(u, -start.dot(side) / side.length_squared())
        });
        let distance = |uv: &Vec2| at(&around, *uv).length_squared();
        near.min_by(|a, b| distance(a).total_cmp(&distance(b))).unwrap_or(Vec2::splat(0.5))
    }

    /// By solid angle, for a rectangle that is not too small.
    pub(super) fn sample_from(&self, reference: &ShapeSampleContext, u: Vec2) -> Option<ShapeSample> {
        let (uv, pdf) = self.seen_from(reference)?.sample(u);
        Some(self.sample_at(uv, pdf))
    }

    /// The density by solid angle towards the point at `uv`.
    pub(super) fn pdf_from(&self, reference: &ShapeSampleContext, uv: Vec2) -> Option<f32> {
        self.seen_from(reference).map(|seen| seen.pdf(self.point(uv).p))
    }

    /// A cone of all normals on the outside: ∂p/∂u × ∂p/∂v is linear in u and v, so that all lie
    /// between those of the corners.
    pub(super) fn normal_bounds(&self) -> DirectionCone {
        let corners = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].map(|uv| self.outside(uv));
        let w = corners.into_iter().sum::<Vec3>().normalize_or_zero();
        let cos = corners.iter().fold(1.0, |cos, n| w.dot(*n).min(cos));
        if cos > 0.0 { DirectionCone::new(w, cos) } else { DirectionCone::ENTIRE_SPHERE }
    }

    fn seen_from(&self, reference: &ShapeSampleContext) -> Option<SeenRectangle> {
        if !self.is_rectangle || self.image.is_some() {
            return None;
        }
        let [corner, right, up, _] = self.p;
        let seen = SeenRectangle::new(corner, [right - corner, up - corner], reference);
        Some(seen).filter(SeenRectangle::is_valid)
    }

    /// The area element at the corners, times a power of two, as sampling squares it.
    fn area_weights(&self) -> [f32; 4] {
        let weights = [Vec2::ZERO, Vec2::X, Vec2::Y, Vec2::ONE].map(|uv| self.cross(uv).length() as f32);
        let scale = balance(weights.into_iter().fold(0.0, f32::max));
        weights.map(|weight| weight * scale)
    }

    fn sample_at(&self, uv: Vec2, pdf: f32) -> ShapeSample {
        ShapeSample { p: self.point(uv), n: self.outside(uv), uv: self.texture(uv), pdf }
    }

    fn point(&self, uv: Vec2) -> Point3Error {
        let p = match &self.flat {
            Some(flat) => flat.corner + flat.right * f64::from(uv.x) + flat.up * f64::from(uv.y),
            None => at(&self.p.map(|p| p.as_dvec3()), uv),
        };
        rounded(p, self.error)
    }

    fn texture(&self, uv: Vec2) -> Vec2 {
        match &self.uv {
            Some(st) => at(&st.map(|st| st.extend(0.0).as_dvec3()), uv).truncate().as_vec2().into(),
            None => uv,
        }
    }

    /// The unit normal on the side of the shading normals, where there are any.
    fn outside(&self, uv: Vec2) -> Normal3 {
        let n = self.normal(uv);
        match &self.n {
            Some(normals) => face_forward(n, at(&normals.map(|n| n.as_dvec3()), uv).as_vec3().into()),
            None if self.flips => -n,
            None => n,
        }
    }

    /// The unit normal on the side of [`Self::cross`].
    #[inline]
    fn normal(&self, uv: Vec2) -> Normal3 {
        match &self.flat {
            Some(flat) => flat.n,
            None => self.cross(uv).normalize_or_zero().as_vec3().into(),
        }
    }

    /// ∂p/∂u × ∂p/∂v.
    fn cross(&self, uv: Vec2) -> DVec3 {
        let p = self.p.map(|p| p.as_dvec3());
        d_du(&p, uv).cross(d_dv(&p, uv))
    }
}

fn is_regular(p: &[Point3; 4]) -> bool {
    let sides = [[0, 1, 2], [1, 0, 3], [2, 0, 3], [3, 1, 2]].map(|[c, a, b]| [p[a] - p[c], p[b] - p[c]]);
    sides.into_iter().all(has_area)
}

fn at(c: &[DVec3; 4], uv: Vec2) -> DVec3 {
    c[0].lerp(c[1], uv.x as f64).lerp(c[2].lerp(c[3], uv.x as f64), uv.y as f64)
}

fn d_du(c: &[DVec3; 4], uv: Vec2) -> DVec3 {
    (c[1] - c[0]).lerp(c[3] - c[2], uv.y as f64)
}

fn d_dv(c: &[DVec3; 4], uv: Vec2) -> DVec3 {
    (c[2] - c[0]).lerp(c[3] - c[1], uv.x as f64)
}

/// ∂n/∂u and ∂n/∂v of the unit normal n ∝ ∂p/∂u × ∂p/∂v, of whose second derivatives only the mixed
/// one is not zero.
fn normal_derivatives([du, dv]: [DVec3; 2], mixed: DVec3) -> [DVec3; 2] {
    let cross = du.cross(dv);
    let length = cross.length();
    if length == 0.0 {
        return [DVec3::ZERO; 2];
    }
    let n = cross / length;
    [du.cross(mixed), mixed.cross(dv)].map(|d| (d - n * n.dot(d)) / length)
}

/// The lines of constant u, of the patch between corners that are given relative to the origin of a
/// line along `d`, that this line meets.
fn lines_met([p00, p10, p01, p11]: &[DVec3; 4], d: DVec3) -> Option<[f64; 2]> {
    let a = (p10 - p00).cross(p01 - p11).dot(d);
    let c = p00.cross(d).dot(p01 - p00);
    let b = p10.cross(d).dot(p11 - p10) - (a + c);
    solve_quadratic(a, b, c)
}

/// The roots of a·t² + b·t + c; a double root is given twice.
fn solve_quadratic(a: f64, b: f64, c: f64) -> Option<[f64; 2]> {
    if a == 0.0 {
        return (b != 0.0).then(|| [-c / b; 2]);
    }
    let discriminant = b * b - 4.0 * a * c;
    if discriminant < 0.0 || discriminant.is_nan() {
        return None;
    }
    let q = -0.5 * (b + discriminant.sqrt().copysign(b));
    Some([q / a, if q == 0.0 { 0.0 } else { c / q }])
}

/// Rotates `v` by the smallest rotation that takes one unit vector to another, less than a right
/// angle away (Rodrigues).
fn turn(v: Vec3, from: Vec3, to: Vec3) -> Vec3 {
    let (axis, cos) = (from.cross(to), from.dot(to));
    v * cos + axis.cross(v) + axis * (axis.dot(v) / (1.0 + cos))
}

fn is_rectangle(p: &[Point3; 4]) -> bool {
    let [p00, p10, p01, p11] = p.map(|p| p.as_dvec3());
    let (right, up) = (p10 - p00, p01 - p00);
    let size = right.length() + up.length();
    let closes = (p00 + right + up - p11).length() <= 1e-6 * size;
    closes
        && right.dot(up).abs() <= 1e-6 * right.length() * up.length()
        && right != DVec3::ZERO
        && up != DVec3::ZERO
}

#[cfg(test)]
mod tests {
    use super::*;
    use sampling::Rng;

    /// Rays from inside to points on the edges, where two sides were replaced by parallelograms
    /// that may not quite meet.
    #[test]
    fn rotated_boxes_are_flat_and_closed() {
        const SIDES: [[usize; 4]; 6] =
            [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 3, 5, 7]];
        let rng = &mut Rng::new(1, 0);
        let mut inexact = 0;
        for _ in 0..50 {
            let mut random = || Vec3::from_array([0; 3].map(|_| 2.0 * rng.uniform_f32() - 1.0));
            let turned = Transform::rotate(random().x * 3.0, random().normalize());
            let m = Transform::translate(random() * 3.0).after(&turned);
            let corner = |i: usize| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
            let sides = SIDES.map(|side| BilinearPatch::new(side.map(corner), None, None, &m, false));
            let flats = sides.iter().map(|side| side.flat.expect("a rectangle"));
            inexact += flats.filter(|flat| flat.error != DVec3::ZERO).count();
            for [a, b, ..] in SIDES {
                for _ in 0..2000 {
                    let o = m.point(Vec3::splat(0.5) + random() * 0.499);
                    let target = m.point(corner(a).lerp(corner(b), random().x.abs()));
                    let ray = Ray::new(o, target - o, 0.0);
                    let hit = sides.iter().find_map(|side| side.intersect(&ray, [0.0, f32::INFINITY]));
                    // A ray that grazes a side may meet it a little beyond the edge.
                    assert!(hit.is_some_and(|hit| (hit.t - 1.0).abs() < 2e-3), "{ray:?} {hit:?}");
                }
            }
        }
        assert!(inexact > 100, "{inexact} of 300 sides");
    }

    #[test]
    fn curved_patches_stay_curved() {
        for (size, moved) in [(1.0, 1e-5), (1.0, 0.1), (1e-3, 1e-6)] {
            let p = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::ONE - Vec3::Z];
            let mut p = p.map(|p| p * size);
            p[3].z += moved;
            assert!(BilinearPatch::new(p, None, None, &Transform::IDENTITY, false).flat.is_none());
        }
    }
}
