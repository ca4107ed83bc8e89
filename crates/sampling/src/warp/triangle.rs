//! Triangles: in the plane, uniformly by area; as seen from a point, uniformly by solid angle.
//!
//! The plane warp folds the square along its diagonal without a square root [Heitz 2019]. The
//! spherical one cuts off a part of the triangle with u₀ of its solid angle by an arc through b,
//! then walks u₁ along that arc [Arvo 1995], [Pharr 2023 §6.5.4]. Solid angles are those of
//! [Van Oosterom 1983]; arithmetic is in double precision, so that small and thin triangles need no
//! special case.

use lanes::Real;
use math::{DVec3, Point3, Vec2, Vector3};

/// Barycentric coordinates, uniform over a triangle.
#[inline(always)]
pub fn sample_uniform_triangle<R: Real>(u: Vec2<R>) -> [R; 3] {
    let below = u.x.lt(u.y);
    let half = R::select(below, u.x, u.y) * R::splat(0.5);
    let rest = R::select(below, u.y, u.x) - half;
    let (b0, b1) = (R::select(below, half, rest), R::select(below, rest, half));
    [b0, b1, R::one() - b0 - b1]
}

/// Density of [`sample_uniform_triangle`] per area of the (b₀, b₁) plane.
#[inline]
pub fn uniform_triangle_pdf() -> f32 {
    2.0
}

/// Inverse of [`sample_uniform_triangle`].
#[inline]
pub fn invert_uniform_triangle(b: [f32; 3]) -> Vec2 {
    if b[0] > b[1] { Vec2::new(b[0] + b[1], 2.0 * b[1]) } else { Vec2::new(2.0 * b[0], b[1] + b[0]) }
}

/// A triangle as seen from a point.
#[derive(Clone, Copy, Debug)]
pub struct SphericalTriangle {
    /// Vertices relative to the point.
    vertices: [DVec3; 3],
    /// Unit directions to them.
    a: DVec3,
    b: DVec3,
    c: DVec3,
    cos_alpha: f64,
    sin_alpha: f64,
    solid_angle: f64,
}

impl SphericalTriangle {
    /// The triangle with these vertices seen from `p`; `None` if it has no solid angle there.
    pub fn new(vertices: [Point3; 3], p: Point3) -> Option<SphericalTriangle> {
        let vertices = vertices.map(|v| v.as_dvec3() - p.as_dvec3());
        let [a, b, c] = vertices.map(|v| v.try_normalize());
        let (a, b, c) = (a?, b?, c?);
        let solid_angle = solid_angle(a, b, c);
        let (n_ab, n_ca) = (a.cross(b).try_normalize()?, c.cross(a).try_normalize()?);
        let cos_alpha = -n_ab.dot(n_ca);
        let sin_alpha = n_ab.cross(n_ca).length();
        (solid_angle > 0.0 && sin_alpha > 0.0).then_some(SphericalTriangle {
            vertices,
            a,
            b,
            c,
            cos_alpha,
            sin_alpha,
            solid_angle,
        })
    }

    /// In steradians.
    #[inline]
    pub fn solid_angle(&self) -> f32 {
        self.solid_angle as f32
    }

    /// The density of [`sample`](Self::sample) per solid angle.
    #[inline]
    pub fn pdf(&self) -> f32 {
        (1.0 / self.solid_angle) as f32
    }

    /// A direction from the point to the triangle, and the barycentric coordinates of the point of
    /// the triangle.
    pub fn sample(&self, u: Vec2) -> (Vector3, [f32; 3]) {
        let Self { a, b, c, cos_alpha, sin_alpha, .. } = *self;
        // The vertex c' on the arc from a to c for which the triangle a b c' has u₀ of the solid
        // angle; φ is that solid angle less α, and cos_b the cosine of the arc from a to c'.
        let (sin_area, cos_area) = (u.x as f64 * self.solid_angle).sin_cos();
        let sin_phi = sin_area * cos_alpha - cos_area * sin_alpha;
        let cos_phi = cos_area * cos_alpha + sin_area * sin_alpha;
        let k1 = cos_phi - cos_alpha;
        let k2 = sin_phi + sin_alpha * a.dot(b);
        let numerator = (k2 * cos_phi - k1 * sin_phi) * cos_alpha - k2;
        let denominator = (k2 * sin_phi + k1 * cos_phi) * sin_alpha;
        let cos_b = if denominator == 0.0 { 1.0 } else { (numerator / denominator).clamp(-1.0, 1.0) };
        let sin_b = (1.0 - cos_b * cos_b).max(0.0).sqrt();
        let cut = cos_b * a + sin_b * perpendicular(c, a);

        // 1 − cos θ along the arc from b to c'.
        let height = u.y as f64 * one_minus_dot(cut, b);
        let sin_theta = (height * (2.0 - height)).max(0.0).sqrt();
        let w = (1.0 - height) * b + sin_theta * perpendicular(cut, b);
        (w.as_vec3().into(), self.barycentric(w))
    }

    /// The `u` that [`sample`](Self::sample) sends to the direction `w`, which must meet the
    /// triangle.
    pub fn invert(&self, w: Vector3) -> Vec2 {
        let Self { a, b, c, .. } = *self;
        let w = w.as_dvec3();
        let Some(cut) = b.cross(w).cross(c.cross(a)).try_normalize() else {
            return Vec2::ZERO;
        };
        let cut = if cut.dot(a + c) < 0.0 { -cut } else { cut };
        let u0 = solid_angle(a, b, cut) / self.solid_angle;
        let u1 = one_minus_dot(w, b) / one_minus_dot(cut, b);
        Vec2::new(u0.clamp(0.0, 1.0) as f32, u1.clamp(0.0, 1.0) as f32)
    }

    /// The barycentric coordinates of a direction, by Cramer's rule, clamped to the triangle.
    fn barycentric(&self, w: DVec3) -> [f32; 3] {
        let [v0, v1, v2] = self.vertices;
        let parts = [v1.cross(v2).dot(w), v2.cross(v0).dot(w), v0.cross(v1).dot(w)];
        let sum: f64 = parts.iter().sum();
        let b0 = (parts[0] / sum).clamp(0.0, 1.0);
        let b1 = (parts[1] / sum).clamp(0.0, 1.0 - b0);
        [b0 as f32, b1 as f32, (1.0 - b0 - b1) as f32]
    }
}

/// The unit vector orthogonal to the unit vector `axis` on the side of `v`; 0 if `v` lies along the
/// axis.
fn perpendicular(v: DVec3, axis: DVec3) -> DVec3 {
    (v - v.dot(axis) * axis).normalize_or_zero()
}

/// 1 − a·b of unit vectors, without cancellation.
fn one_minus_dot(a: DVec3, b: DVec3) -> f64 {
    0.5 * (a - b).length_squared()
}

/// The solid angle of a spherical triangle of unit vectors: tan(Ω/2) = |a·(b×c)| / (1 + a·b + b·c +
/// c·a).
fn solid_angle(a: DVec3, b: DVec3, c: DVec3) -> f64 {
    // The triple product of edges is accurate for small triangles.
    let volume = a.dot((b - a).cross(c - a)).abs();
    2.0 * volume.atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
}
