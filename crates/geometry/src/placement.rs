//! A transform and its inverse in double precision, with error bounds of transformed points.
//!
//! The matrix is the scene's, in floats but for its translation; its inverse is computed in
//! doubles, so that the two are inverse to a few parts in 10¹⁶. A round trip then costs only the
//! rounding to floats, |x|·ε per coordinate, whatever the matrix.

use math::{DMat3, DMat4, DVec3, MACHINE_EPSILON, Normal3, Point3Error, Ray, Transform, Vec3};

/// The relative rounding error of a short chain of double operations.
pub(crate) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// The transform between an inner space, such as object space, and the space around it.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    /// Outer space from inner space.
    forward: DMat4,
    inverse: DMat4,
}

impl Placement {
    pub fn new(transform: &Transform) -> Self {
        let forward = transform.in_doubles();
        Self { forward, inverse: forward.inverse() }
    }

    /// A rotation, given by an orthonormal matrix, followed by a translation to `center`.
    pub fn rigid(rotation: DMat3, center: DVec3) -> Self {
        let back = rotation.transpose();
        Self {
            forward: DMat4::from_mat3_translation(rotation, center),
            inverse: DMat4::from_mat3_translation(back, back * -center),
        }
    }

    /// Outer space from inner space.
    pub fn forward(&self) -> DMat4 {
        self.forward
    }

    /// Origin and direction of an outer ray in inner space; t keeps its meaning.
    #[inline]
    pub fn ray_inward(&self, ray: &Ray) -> (DVec3, DVec3) {
        (self.inverse.transform_point3(ray.o.as_dvec3()), self.inverse.transform_vector3(ray.d.as_dvec3()))
    }

    /// The same, rounded to floats.
    #[inline]
    pub fn ray(&self, ray: &Ray) -> Ray {
        let (o, d) = self.ray_inward(ray);
        Ray::new(o.as_vec3().into(), d.as_vec3().into(), ray.time)
    }

    /// An outer point in inner space.
    #[inline]
    pub fn point_inward(&self, p: DVec3) -> DVec3 {
        self.inverse.transform_point3(p)
    }

    /// The inner origin in outer space.
    pub fn center(&self) -> DVec3 {
        self.forward.w_axis.truncate()
    }

    /// Transforms an inner point that is within `error` of its surface to outer space.
    #[inline]
    pub fn point(&self, p: DVec3, error: DVec3) -> Point3Error {
        let m = &self.forward;
        let spread = |v: DVec3| {
            m.x_axis.truncate().abs() * v.x
                + m.y_axis.truncate().abs() * v.y
                + m.z_axis.truncate().abs() * v.z
        };
        let doubles = (spread(p.abs()) + m.w_axis.truncate().abs()) * ROUNDING;
        rounded(m.transform_point3(p), spread(error) + doubles)
    }

    /// The half extents in outer space of an inner ball of `radius`.
    pub fn ball_extent(&self, radius: f64) -> DVec3 {
        let row = |axis: usize| self.forward.row(axis).truncate().length();
        DVec3::new(row(0), row(1), row(2)) * radius
    }

    /// Transforms an inner direction to outer space.
    #[inline]
    pub fn vector(&self, v: DVec3) -> Vec3 {
        self.forward.transform_vector3(v).as_vec3().into()
    }

    /// Transforms an inner normal to outer space (by the inverse transpose), not normalised.
    #[inline]
    pub fn normal(&self, n: DVec3) -> DVec3 {
        let i = &self.inverse;
        DVec3::new(i.x_axis.truncate().dot(n), i.y_axis.truncate().dot(n), i.z_axis.truncate().dot(n))
    }

    /// The derivative of the unit normal in outer space, from inner normal and derivative.
    #[inline]
    pub fn normal_change(&self, n: DVec3, dn: DVec3) -> Vec3 {
        let (n, dn) = (self.normal(n), self.normal(dn));
        let squared = n.length_squared();
        let change = (dn - n * (n.dot(dn) / squared)) / squared.sqrt();
        if change.is_finite() { change.as_vec3().into() } else { Vec3::ZERO }
    }

    /// The unit normal in outer space; zero where it is undefined.
    #[inline]
    pub fn unit_normal(&self, n: DVec3) -> Normal3 {
        self.normal(n).normalize_or_zero().as_vec3().into()
    }

    /// The ratio of outer to inner area of a surface element with inner unit normal `n`:
    /// |det M|·|M⁻ᵀn|.
    pub fn area_factor(&self, n: DVec3) -> f64 {
        self.forward.determinant().abs() * self.normal(n).length()
    }

    /// [`Self::area_factor`] by the outer unit normal: |det M| / |Mᵀn|.
    pub fn area_factor_outside(&self, n: DVec3) -> f64 {
        let m = &self.forward;
        let inward = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.truncate().dot(n));
        m.determinant().abs() / DVec3::from(inward).length()
    }

    /// The factor of a uniform scale; `None` where lengths scale differently.
    pub fn uniform_scale(&self) -> Option<f64> {
        let axes = [self.forward.x_axis, self.forward.y_axis, self.forward.z_axis].map(|a| a.truncate());
        let scale = axes[0].length();
        let tolerance = 1e-6 * scale * scale;
        let regular = axes.iter().all(|a| (a.length_squared() - scale * scale).abs() <= tolerance)
            && (0..3).all(|i| axes[i].dot(axes[(i + 1) % 3]).abs() <= tolerance);
        regular.then_some(scale)
    }
}

/// A point known to within `error`, rounded to floats. Intersection tests mix the axes, so that the
/// error along one axis may come from coordinates along another: it is at least relative to the
/// largest coordinate.
#[inline]
pub(crate) fn rounded(p: DVec3, error: DVec3) -> Point3Error {
    let q = Vec3::from(p.as_vec3());
    let mixed = p.abs().max_element() * ROUNDING;
    Point3Error::new(q, q.abs() * (2.0 * MACHINE_EPSILON) + Vec3::from((error + mixed).as_vec3()) * 1.001)
}
