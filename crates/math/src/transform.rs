//! Affine and projective maps with their inverses.

use crate::{Bounds3, DMat4, Mat4, Normal3, Point3, Point3Error, Ray, Vec3, Vector3, gamma};
use lanes::{Each, Real};

/// A 4 × 4 matrix and its inverse. Names read right to left: `render_from_object`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Transform {
    m: Mat4,
    inverse: Mat4,
    /// The rest of the translation after rounding to floats.
    rest: Vec3,
}

impl Default for Transform {
    fn default() -> Self {
        Self::IDENTITY
    }
}

impl Transform {
    /// The identity.
    pub const IDENTITY: Self = Self { m: Mat4::IDENTITY, inverse: Mat4::IDENTITY, rest: Vec3::ZERO };

    /// From a double-precision matrix, which is inverted in double precision; `None` when there is
    /// no inverse.
    pub fn from_f64(m: DMat4) -> Option<Self> {
        let inverse = m.inverse();
        (inverse.is_finite() && m.is_finite()).then(|| {
            let rounded = m.as_mat4();
            let rest = m.w_axis - rounded.w_axis.as_dvec4();
            Self { m: rounded, inverse: inverse.as_mat4(), rest: rest.truncate().as_vec3().into() }
        })
    }

    /// From a matrix and its inverse.
    pub fn from_parts(m: Mat4, inverse: Mat4) -> Self {
        Self { m, inverse, rest: Vec3::ZERO }
    }

    /// A translation by `v`.
    pub fn translate(v: Vector3) -> Self {
        Self::from_parts(Mat4::from_translation(v.into()), Mat4::from_translation((-v).into()))
    }

    /// A scale of each axis; no factor may be zero.
    pub fn scale(s: Vec3) -> Self {
        Self::from_parts(Mat4::from_scale(s.into()), Mat4::from_scale(s.recip().into()))
    }

    /// A rotation by `angle` radians around `axis`, counter-clockwise as seen from its tip.
    pub fn rotate(angle: f32, axis: Vector3) -> Self {
        let m = Mat4::from_axis_angle(axis.normalize().into(), angle);
        Self::from_parts(m, m.transpose())
    }

    /// The matrix.
    #[inline]
    pub fn matrix(&self) -> &Mat4 {
        &self.m
    }

    /// The matrix in double precision, with the translation of [`from_f64`](Self::from_f64), which
    /// floats may miss by more than what is large and far away is from the camera.
    #[inline]
    pub fn in_doubles(&self) -> DMat4 {
        let mut m = self.m.as_dmat4();
        m.w_axis += self.rest.as_dvec3().extend(0.0);
        m
    }

    /// The inverse map.
    #[inline]
    pub fn inverse(&self) -> Self {
        Self::from_parts(self.inverse, self.m)
    }

    /// This map after `first`.
    #[inline]
    pub fn after(&self, first: &Self) -> Self {
        Self::from_parts(self.m * first.m, first.inverse * self.inverse)
    }

    /// Whether it is the identity.
    pub fn is_identity(&self) -> bool {
        self.m == Mat4::IDENTITY
    }

    /// Whether it reverses handedness.
    pub fn swaps_handedness(&self) -> bool {
        glam::Mat3::from_mat4(self.m).determinant() < 0.0
    }

    /// Maps a position, dividing by w where the map is projective.
    #[inline]
    pub fn point(&self, p: Point3) -> Point3 {
        let q = self.m * p.extend(1.0);
        let p = q.truncate().into();
        if q.w == 1.0 { p } else { p / q.w }
    }

    /// Maps positions in lanes by an affine map.
    #[inline(always)]
    pub fn affine_point<R: Real>(&self, p: Point3<R>) -> Point3<R> {
        let [x, y, z, t] = columns(&self.m).each(Vec3::broadcast);
        x * p.x + y * p.y + z * p.z + t
    }

    /// [`point`](Self::point) in lanes.
    #[inline(always)]
    pub fn point_lanes<R: Real>(&self, p: Point3<R>) -> Point3<R> {
        let m = &self.m;
        let [x, y, z, t] = [m.x_axis.w, m.y_axis.w, m.z_axis.w, m.w_axis.w].each(R::splat);
        let w = x * p.x + y * p.y + z * p.z + t;
        let p = self.affine_point(p);
        Vec3::select(w.eq(R::one()), p, p / w)
    }

    /// Maps a difference of positions.
    #[inline]
    pub fn vector(&self, v: Vector3) -> Vector3 {
        self.m.transform_vector3(v.into()).into()
    }

    /// [`vector`](Self::vector) in lanes.
    #[inline(always)]
    pub fn vector_lanes<R: Real>(&self, v: Vector3<R>) -> Vector3<R> {
        let [x, y, z, _] = columns(&self.m).each(Vec3::broadcast);
        x * v.x + y * v.y + z * v.z
    }

    /// Maps a normal (by the inverse transpose), not normalised.
    #[inline(always)]
    pub fn normal<R: Real>(&self, n: Normal3<R>) -> Normal3<R> {
        let [x, y, z, _] = columns(&self.inverse).each(Vec3::broadcast);
        Vec3::new(x.dot(n), y.dot(n), z.dot(n))
    }

    /// Maps a point by an affine map, and bounds the error: that of the product and that of the
    /// point.
    #[inline]
    pub fn point_with_error(&self, p: Point3Error) -> Point3Error {
        let [x, y, z, t] = columns(&self.m);
        let a = p.p.abs();
        let rounding = x.abs() * a.x + y.abs() * a.y + z.abs() * a.z + t.abs();
        let carried = x.abs() * p.error.x + y.abs() * p.error.y + z.abs() * p.error.z;
        Point3Error::new(
            x * p.p.x + y * p.p.y + z * p.p.z + t,
            rounding * gamma(3) + carried * (1.0 + gamma(3)),
        )
    }

    /// Maps a ray by an affine map; t is unchanged.
    #[inline(always)]
    pub fn ray<R: Real>(&self, ray: &Ray<R>) -> Ray<R> {
        affine_ray(&columns(&self.m).each(Vec3::broadcast), ray)
    }

    /// The box around the mapped box.
    pub fn bounds(&self, b: &Bounds3) -> Bounds3 {
        if b.is_empty() { *b } else { Bounds3::around(b.corners().map(|p| self.point(p))) }
    }
}

/// Maps a ray by the affine map of a matrix with these columns; t is unchanged.
#[inline(always)]
pub fn affine_ray<R: Real>([x, y, z, t]: &[Vec3<R>; 4], ray: &Ray<R>) -> Ray<R> {
    let (o, d) = (ray.o, ray.d);
    let d = *x * d.x + *y * d.y + *z * d.z;
    Ray::new(*x * o.x + *y * o.y + *z * o.z + *t, d, ray.time)
}

/// The columns of a matrix, without their last coordinates.
#[inline]
fn columns(m: &Mat4) -> [Vec3; 4] {
    [m.x_axis, m.y_axis, m.z_axis, m.w_axis].each(|c| c.truncate().into())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn inverse_undoes(tx in -9f32..9.0, s in 0.2f32..5.0, angle in -3f32..3.0, x in -9f32..9.0, y in -9f32..9.0) {
            let t = Transform::translate(Vec3::new(tx, 1.0, -2.0))
                .after(&Transform::rotate(angle, Vec3::new(1.0, 2.0, -0.5)))
                .after(&Transform::scale(Vec3::new(s, 1.0, -2.0)));
            let p = Vec3::new(x, y, 3.0);
            prop_assert!((t.inverse().point(t.point(p)) - p).length() < 1e-4);
            // A normal stays perpendicular to tangents.
            let (n, v) = (Vec3::new(y, -x, 0.0), Vec3::new(x, y, 0.7));
            prop_assert!(t.normal(n).dot(t.vector(v)).abs() < 1e-2);
            prop_assert!(t.swaps_handedness());
        }

        #[test]
        fn error_bounds_hold(x in -99f32..99.0, y in -99f32..99.0, angle in -3f32..3.0) {
            let t = Transform::rotate(angle, Vec3::new(1.0, 1.0, 0.2)).after(&Transform::scale(Vec3::new(3.0, 0.1, 7.0)));
            let p = Vec3::new(x, y, 5.0);
            let q = t.point_with_error(Point3Error::exact(p));
            let exact = t.matrix().as_dmat4().transform_point3(p.as_dvec3());
            let off = (q.p.as_dvec3() - exact).abs();
            prop_assert!(off.cmple(q.error.as_dvec3()).all(), "{off} {}", q.error);
        }
    }

    #[test]
    fn a_singular_matrix_has_no_transform() {
        assert!(Transform::from_f64(DMat4::from_scale(crate::DVec3::new(1.0, 0.0, 1.0))).is_none());
    }
}
