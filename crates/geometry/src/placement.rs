//! A transform and its inverse in double precision, with what rounding does to the points that pass
//! through.
//!
//! The matrix is the one of the scene, in floats; its inverse is taken again in doubles, so that
//! the two undo each other to a few parts in 10¹⁶. Going out and coming back then costs only the
//! rounding to floats, |x|·ε per coordinate, whatever the matrix is.

use math::{DMat3, DMat4, DVec3, MACHINE_EPSILON, Normal3, Point3Error, Ray, Transform, Vec3};

/// How large the rounding of a short chain of double operations is beside the numbers that went in.
pub(crate) const ROUNDING: f64 = 16.0 * f64::EPSILON;

/// Where something stands.
#[derive(Clone, Debug)]
pub(crate) struct Placement {
    /// Outer space from the space of the thing placed.
    forward: DMat4,
    inverse: DMat4,
}

impl Placement {
    pub fn new(transform: &Transform) -> Self {
        let forward = transform.matrix().as_dmat4();
        Self { forward, inverse: forward.inverse() }
    }

    /// At `center`, turned by an orthonormal matrix.
    pub fn rigid(turn: DMat3, center: DVec3) -> Self {
        let back = turn.transpose();
        Self {
            forward: DMat4::from_mat3_translation(turn, center),
            inverse: DMat4::from_mat3_translation(back, back * -center),
        }
    }

    /// Origin and direction of an outer ray as seen from the thing placed; t keeps its meaning.
    #[inline]
    pub fn ray_inward(&self, ray: &Ray) -> (DVec3, DVec3) {
        (self.inverse.transform_point3(ray.o.as_dvec3()), self.inverse.transform_vector3(ray.d.as_dvec3()))
    }

    /// The same, rounded to floats.
    #[inline]
    pub fn ray(&self, ray: &Ray) -> Ray {
        let (o, d) = self.ray_inward(ray);
        Ray::new(o.as_vec3(), d.as_vec3(), ray.time)
    }

    /// An outer point as seen from the thing placed.
    #[inline]
    pub fn point_inward(&self, p: DVec3) -> DVec3 {
        self.inverse.transform_point3(p)
    }

    /// Where the origin of what is placed stands.
    pub fn center(&self) -> DVec3 {
        self.forward.w_axis.truncate()
    }

    /// Brings out a point that is within `error` of its surface.
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

    /// How far a ball of `radius` reaches along each axis when it is brought out.
    pub fn ball_extent(&self, radius: f64) -> DVec3 {
        let row = |axis: usize| self.forward.row(axis).truncate().length();
        DVec3::new(row(0), row(1), row(2)) * radius
    }

    /// Brings out a direction.
    #[inline]
    pub fn vector(&self, v: DVec3) -> Vec3 {
        self.forward.transform_vector3(v).as_vec3()
    }

    /// Brings out a normal (by the inverse transpose); its length changes.
    #[inline]
    pub fn normal(&self, n: DVec3) -> DVec3 {
        let i = &self.inverse;
        DVec3::new(i.x_axis.truncate().dot(n), i.y_axis.truncate().dot(n), i.z_axis.truncate().dot(n))
    }

    /// Brings out a unit normal and its change: the change of the unit normal that comes out.
    #[inline]
    pub fn normal_change(&self, n: DVec3, dn: DVec3) -> Vec3 {
        let (n, dn) = (self.normal(n), self.normal(dn));
        let squared = n.length_squared();
        let change = (dn - n * (n.dot(dn) / squared)) / squared.sqrt();
        if change.is_finite() { change.as_vec3() } else { Vec3::ZERO }
    }

    /// Brings out a normal and makes it a unit vector; zero where it has no direction.
    #[inline]
    pub fn unit_normal(&self, n: DVec3) -> Normal3 {
        self.normal(n).normalize_or_zero().as_vec3()
    }

    /// By what factor an area at right angles to the unit normal `n` grows when it is brought out:
    /// |det M|·|M⁻ᵀn|.
    pub fn area_factor(&self, n: DVec3) -> f64 {
        self.forward.determinant().abs() * self.normal(n).length()
    }

    /// [`Self::area_factor`] where the unit normal outside is `n`: |det M| / |Mᵀn|.
    pub fn area_factor_outside(&self, n: DVec3) -> f64 {
        let m = &self.forward;
        let inward = [m.x_axis, m.y_axis, m.z_axis].map(|axis| axis.truncate().dot(n));
        m.determinant().abs() / DVec3::from(inward).length()
    }

    /// The one factor by which all lengths grow; `None` where they grow differently.
    pub fn uniform_scale(&self) -> Option<f64> {
        let axes = [self.forward.x_axis, self.forward.y_axis, self.forward.z_axis].map(|a| a.truncate());
        let scale = axes[0].length();
        let tolerance = 1e-6 * scale * scale;
        let regular = axes.iter().all(|a| (a.length_squared() - scale * scale).abs() <= tolerance)
            && (0..3).all(|i| axes[i].dot(axes[(i + 1) % 3]).abs() <= tolerance);
        regular.then_some(scale)
    }
}

/// A point known to within `error`, rounded to floats. A test of the surface mixes the axes, so
/// that its rounding along one may come from coordinates along another: none is known better than
/// the largest lets it be, not even a zero.
#[inline]
pub(crate) fn rounded(p: DVec3, error: DVec3) -> Point3Error {
    let q = p.as_vec3();
    let mixed = p.abs().max_element() * ROUNDING;
    Point3Error::new(q, q.abs() * (2.0 * MACHINE_EPSILON) + (error + mixed).as_vec3() * 1.001)
}
