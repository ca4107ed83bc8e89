//! Hits and samples of shapes.

use math::{Normal3, Point3Error, Ray, Vec2, Vec3, Vector3};

/// Where a ray meets a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeHit {
    /// Distance along the ray, in lengths of its direction.
    pub t: f32,
    /// The shape's parameters there.
    pub uv: Vec2,
}

/// A point sampled on a shape.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSample {
    /// Position, with a bound of its error.
    pub p: Point3Error,
    /// Unit normal, towards the outside as defined by the shape's orientation (or its shading
    /// normals).
    pub n: Normal3,
    /// Texture coordinates.
    pub uv: Vec2,
    /// Density: per area from [`sample`](crate::shape::Shape::sample), per solid angle from
    /// [`sample_from`](crate::shape::Shape::sample_from).
    pub pdf: f32,
}

/// The reference point that a shape is sampled from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSampleContext {
    /// Position, with a bound of its error.
    pub p: Point3Error,
    /// Geometric normal; zero where there is no surface.
    pub n: Normal3,
    /// Shading normal; zero where there is no surface, or where light from all sides counts.
    pub ns: Normal3,
    /// Shutter time.
    pub time: f32,
}

impl ShapeSampleContext {
    /// The ray that leaves along `w`.
    #[inline]
    pub fn spawn_ray(&self, w: Vector3) -> Ray {
        Ray::spawn(self.p, self.n, w, self.time)
    }

    /// dA/dω = d²/|cos θ| of an area at `p` with normal `n`.
    pub(super) fn area_per_solid_angle(&self, p: Vec3, n: Normal3) -> f32 {
        let toward = p - self.p.p;
        let distance2 = toward.length_squared();
        distance2 * distance2.sqrt() / n.dot(toward).abs()
    }

    /// Converts a sample by area to one by solid angle; `None` where it is seen edge-on, or is the
    /// reference point itself.
    pub(super) fn by_solid_angle(&self, sample: ShapeSample) -> Option<ShapeSample> {
        let pdf = sample.pdf * self.area_per_solid_angle(sample.p.p, sample.n);
        (pdf.is_finite() && pdf > 0.0).then_some(ShapeSample { pdf, ..sample })
    }

    /// Weights of the corners of the unit square for bilinear sampling by the cosine at this point,
    /// given directions to the corners; at least 0.01.
    pub(super) fn cosine_weights(&self, corners: [Vector3; 4]) -> [f32; 4] {
        corners.map(|w| (w.dot(self.ns) / w.length()).abs().max(0.01))
    }
}
