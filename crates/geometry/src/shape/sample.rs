//! Hits and samples of shapes.

use lanes::{Real, coarse_inverse_sqrt};
use math::{Normal3, Point3, Point3Error, Ray, Vec2, Vector3, balance};

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
pub struct ShapeSample<R = f32> {
    /// Position, with a bound of its error.
    pub p: Point3Error<R>,
    /// Unit normal, towards the outside as defined by the shape's orientation (or its shading
    /// normals).
    pub n: Normal3<R>,
    /// Texture coordinates.
    pub uv: Vec2<R>,
    /// Density: per area from [`sample`](crate::shape::Shape::sample), per solid angle from
    /// [`sample_from`](crate::shape::Shape::sample_from).
    pub pdf: R,
}

/// The reference point that a shape is sampled from.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ShapeSampleContext<R = f32> {
    /// Position, with a bound of its error.
    pub p: Point3Error<R>,
    /// Geometric normal; zero where there is no surface.
    pub n: Normal3<R>,
    /// Shading normal; zero where there is no surface, or where light from all sides counts.
    pub ns: Normal3<R>,
    /// Shutter time.
    pub time: R,
}

impl<R: Real> ShapeSampleContext<R> {
    /// The ray that leaves along `w`.
    #[inline(always)]
    pub fn spawn_ray(&self, w: Vector3<R>) -> Ray<R> {
        Ray::spawn(self.p, self.n, w, self.time)
    }

    /// The density per solid angle of a density per area at `p` with unit normal `n`: times dA/dω =
    /// d²/|cos θ|; with a normal of another length, divided by that.
    #[inline(always)]
    pub fn pdf_per_solid_angle(&self, pdf_area: R, p: Point3<R>, n: Normal3<R>) -> R {
        let toward = p - self.p.p;
        // A power of two near 1/d, since cubes of distances may overflow or vanish.
        let scale = balance(toward.abs().max_element());
        let toward = toward * scale;
        let distance2 = toward.length_squared();
        let unit = balance(scale);
        pdf_area * unit * (distance2 * distance2.sqrt() / n.dot(toward).abs()) * unit
    }

    /// Weights of the corners of the unit square for bilinear sampling by the cosine at this point,
    /// given directions to the corners; at least 0.01.
    #[inline(always)]
    pub(crate) fn cosine_weights(&self, corners: [Vector3<R>; 4]) -> [R; 4] {
        let mut weights = [R::zero(); 4];
        for i in 0..4 {
            let w = corners[i].balanced();
            let cosine = (w.dot(self.ns) * coarse_inverse_sqrt(w.length_squared())).abs();
            weights[i] = cosine.max(R::splat(0.01));
        }
        weights
    }
}

impl ShapeSampleContext {
    /// Converts a sample by area to one by solid angle; `None` where it is seen edge-on, or is the
    /// reference point itself.
    pub fn by_solid_angle(&self, sample: ShapeSample) -> Option<ShapeSample> {
        let pdf = self.pdf_per_solid_angle(sample.pdf, sample.p.p, sample.n);
        (pdf.is_finite() && pdf > 0.0).then_some(ShapeSample { pdf, ..sample })
    }
}
