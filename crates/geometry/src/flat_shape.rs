//! Triangles and rectangles as seen from a point, which are sampled by solid angle and by the
//! cosine there: the solid angle is sampled uniformly ([Arvo 1995], [Ureña et al. 2013]) by numbers
//! that are warped to follow the cosine ([Pharr 2023 §6.5]). Where the solid angle is too small for
//! floats, or that of a triangle too near a hemisphere, they are sampled by area.

use crate::shape::{ShapeSample, ShapeSampleContext};
use lanes::{Mask, Real};
use math::{Normal3, Point3, Point3Error, Vec2, Vector3, gamma};
use sampling::warp::{
    SphericalRectangle, SphericalTriangle, bilinear_pdf, sample_bilinear, sample_uniform_triangle,
};

/// Triangles and rectangles, one for each lane.
#[derive(Clone, Copy, Debug)]
pub struct FlatShape<R: Real = f32> {
    /// A corner.
    pub corner: Point3<R>,
    /// The sides that leave it; those of a rectangle are at right angles.
    pub sides: [Vector3<R>; 2],
    /// Unit normal towards the outside.
    pub n: Normal3<R>,
    /// Whether it is a triangle.
    pub is_triangle: R::Mask,
}

impl<R: Real> FlatShape<R> {
    /// Points by solid angle and by the cosine at a reference point, with their densities per solid
    /// angle, and the lanes that have one: none sees its primitive edge-on. `uv` of a point are the
    /// parts of the sides that lead to it.
    #[inline(always)]
    pub fn sample_from(&self, reference: &ShapeSampleContext<R>, u: Vec2<R>) -> (ShapeSample<R>, R::Mask) {
        let (mut uv, mut pdf) = (u, R::zero());
        let mut is_seen = R::Mask::splat(false);
        if self.is_triangle.any() {
            let seen = self.triangle(reference);
            let (point, density) = seen.sample(u);
            is_seen = self.is_triangle & seen.is_valid();
            uv = Vec2::select(is_seen, point, uv);
            pdf = R::select(is_seen, density, pdf);
        }
        if !self.is_triangle.all() {
            let seen = self.rectangle(reference);
            let (point, density) = seen.sample(u);
            let is_rectangle = seen.is_valid() & !self.is_triangle;
            uv = Vec2::select(is_rectangle, point, uv);
            pdf = R::select(is_rectangle, density, pdf);
            is_seen = is_seen | is_rectangle;
        }
        if !is_seen.all() {
            let [_, b1, b2] = sample_uniform_triangle(u);
            uv = Vec2::select(self.is_triangle & !is_seen, Vec2::new(b1, b2), uv);
        }
        let p = self.point(uv);
        if !is_seen.all() {
            pdf = R::select(is_seen, pdf, self.pdf_by_area(reference, p.p));
        }
        let valid = pdf.gt(R::zero()) & pdf.lt(R::splat(f32::INFINITY));
        (ShapeSample { p, n: self.n, uv, pdf }, valid)
    }

    /// The densities per solid angle of [`sample_from`](Self::sample_from) towards points of the
    /// primitives, which are given by the parts of the sides that lead to them; 0 where they are
    /// seen edge-on.
    #[inline(always)]
    pub fn pdf_from(&self, reference: &ShapeSampleContext<R>, uv: Vec2<R>) -> R {
        let (mut pdf, mut is_seen) = (R::zero(), R::Mask::splat(false));
        if self.is_triangle.any() {
            let seen = self.triangle(reference);
            is_seen = self.is_triangle & seen.is_valid();
            pdf = R::select(is_seen, seen.pdf(uv), pdf);
        }
        if !self.is_triangle.all() {
            let seen = self.rectangle(reference);
            let is_rectangle = seen.is_valid() & !self.is_triangle;
            pdf = R::select(is_rectangle, seen.pdf(self.point(uv).p), pdf);
            is_seen = is_seen | is_rectangle;
        }
        if !is_seen.all() {
            pdf = R::select(is_seen, pdf, self.pdf_by_area(reference, self.point(uv).p));
        }
        R::select(pdf.lt(R::splat(f32::INFINITY)), pdf, R::zero())
    }

    #[inline(always)]
    fn triangle(&self, reference: &ShapeSampleContext<R>) -> SeenTriangle<R> {
        let [right, up] = self.sides;
        SeenTriangle::new([self.corner, self.corner + right, self.corner + up], reference)
    }

    #[inline(always)]
    fn rectangle(&self, reference: &ShapeSampleContext<R>) -> SeenRectangle<R> {
        SeenRectangle::new(self.corner, self.sides, reference)
    }

    #[inline(always)]
    fn pdf_by_area(&self, reference: &ShapeSampleContext<R>, p: Point3<R>) -> R {
        // A normal of the length of the area.
        let cross = self.sides[0].cross(self.sides[1]);
        let n = cross * R::select(self.is_triangle, R::splat(0.5), R::one());
        reference.pdf_per_solid_angle(R::one(), p, n)
    }

    #[inline(always)]
    fn point(&self, uv: Vec2<R>) -> Point3Error<R> {
        let [x, y] = [self.sides[0] * uv.x, self.sides[1] * uv.y];
        let error = (self.corner.abs() + x.abs() + y.abs()) * R::splat(gamma(4));
        Point3Error::new(self.corner + x + y, error)
    }
}

/// A triangle as seen from a point, for each lane.
pub(crate) struct SeenTriangle<R: Real = f32> {
    seen: SphericalTriangle<R>,
    /// Weights at the corners of the unit square: u₁ = 0 becomes corner 1, and u₁ = 1 the side from
    /// corner 0 to corner 2.
    weights: [R; 4],
}

impl<R: Real> SeenTriangle<R> {
    #[inline(always)]
    pub fn new(corners: [Point3<R>; 3], reference: &ShapeSampleContext<R>) -> Self {
        let p = reference.p.p;
        let [w0, w1, w2] = [corners[0] - p, corners[1] - p, corners[2] - p];
        let weights = reference.cosine_weights([w1, w1, w0, w2]);
        Self { seen: SphericalTriangle::new(corners, p), weights }
    }

    /// Where it is sampled by solid angle.
    #[inline(always)]
    pub fn is_valid(&self) -> R::Mask {
        let solid_angle = self.seen.solid_angle();
        self.seen.is_valid() & solid_angle.ge(R::splat(3e-4)) & solid_angle.le(R::splat(6.22))
    }

    /// Barycentric coordinates at corners 1 and 2, with their density per solid angle.
    #[inline(always)]
    pub fn sample(&self, u: Vec2<R>) -> (Vec2<R>, R) {
        let u = sample_bilinear(u, self.weights);
        (self.seen.sample(u), bilinear_pdf(u, self.weights) * self.seen.pdf())
    }

    /// The density of [`sample`](Self::sample) at a point given by barycentric coordinates.
    #[inline(always)]
    pub fn pdf(&self, point: Vec2<R>) -> R {
        bilinear_pdf(self.seen.invert(point), self.weights) * self.seen.pdf()
    }
}

/// A rectangle as seen from a point, for each lane.
pub(crate) struct SeenRectangle<R: Real = f32> {
    seen: SphericalRectangle<R>,
    weights: [R; 4],
}

impl<R: Real> SeenRectangle<R> {
    #[inline(always)]
    pub fn new(corner: Point3<R>, sides: [Vector3<R>; 2], reference: &ShapeSampleContext<R>) -> Self {
        let ([right, up], w) = (sides, corner - reference.p.p);
        Self {
            seen: SphericalRectangle::new(reference.p.p, corner, right, up),
            weights: reference.cosine_weights([w, w + right, w + up, w + right + up]),
        }
    }

    /// Where it is sampled by solid angle.
    #[inline(always)]
    pub fn is_valid(&self) -> R::Mask {
        self.seen.is_valid() & self.seen.solid_angle().gt(R::splat(1e-2))
    }

    /// The parts of the sides, with their density per solid angle.
    #[inline(always)]
    pub fn sample(&self, u: Vec2<R>) -> (Vec2<R>, R) {
        let u = sample_bilinear(u, self.weights);
        (self.seen.sample(u), bilinear_pdf(u, self.weights) * self.seen.pdf())
    }

    /// The density of [`sample`](Self::sample) at a point.
    #[inline(always)]
    pub fn pdf(&self, point: Point3<R>) -> R {
        bilinear_pdf(self.seen.invert(point), self.weights) * self.seen.pdf()
    }
}
