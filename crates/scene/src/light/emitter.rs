//! An emitting primitive at one shutter time.
//!
//! Primitives of instances, and of shapes under animated transforms, are sampled in their own
//! space; densities follow by the Jacobian of the affine map p ↦ M·p + t to render space. An area
//! with the unit normal n grows by |det M|·|M⁻ᵀn|. A solid angle around the unit direction ω of
//! render space shrinks to its size in the primitive's space by |det M⁻¹|/|M⁻¹ω|³. Under rotation
//! and translation both factors are 1.

use geometry::{InstancePath, Shape, ShapeSample, World};
use lanes::Real;
use math::{
    Bounds3, DirectionCone, MACHINE_EPSILON, Normal3, Point3, Point3Error, Transform, Vec2, Vec3, Vector3,
    balance,
};

use super::LightSampleContext;

/// Strata per axis to average the area factor of curved surfaces over, under maps other than
/// similarities.
const AREA_STRATA: u32 = 8;

/// An emitting primitive at one shutter time.
pub(super) struct Emitter<'a> {
    /// The shape in its own space, at the shutter time.
    shape: &'a Shape,
    world: &'a World,
    instance: &'a InstancePath,
    time: f32,
}

impl<'a> Emitter<'a> {
    /// Calls `f` with the emitter that is `shape`, seen through `instance`, at `time`.
    #[inline]
    pub fn with<T>(
        shape: &Shape,
        world: &World,
        instance: &InstancePath,
        time: f32,
        f: impl FnOnce(&Emitter) -> T,
    ) -> T {
        let moved;
        let shape = match shape {
            Shape::MovingTriangle(triangle) => {
                moved = triangle.at(time).into();
                &moved
            }
            _ => shape,
        };
        f(&Emitter { shape, world, instance, time })
    }

    /// From the space of the shape to render space; `None` for the identity, the common case.
    #[inline]
    fn render_from_shape(&self) -> Option<Transform> {
        if self.instance.is_top() { None } else { self.render_from_instances() }
    }

    #[inline(never)]
    fn render_from_instances(&self) -> Option<Transform> {
        let transforms =
            self.instance.ids().iter().map(|&id| self.world.render_from_instance(id).at(self.time));
        transforms.reduce(|outer, inner| outer.after(&inner))
    }

    /// Its area.
    pub fn area(&self) -> f32 {
        let area = self.shape.area();
        let Some(transform) = self.render_from_shape() else { return area };
        let is_flat = self.shape.normal_bounds().cos_theta == 1.0;
        let n = if is_flat || is_similarity(&transform) { 1 } else { AREA_STRATA };
        let center = |i: u32| (i as f32 + 0.5) / n as f32;
        let factors = (0..n * n).filter_map(|i| {
            let sample = self.shape.sample(Vec2::new(center(i % n), center(i / n)))?;
            // Weighted by 1/pdf, as not all shapes sample their area uniformly.
            let weight = f64::from(sample.pdf).recip();
            Some((f64::from(area_factor(&transform, sample.n)) * weight, weight))
        });
        let (sum, weights) = factors.fold((0.0, 0.0), |(s, w), (factor, weight)| (s + factor, w + weight));
        if weights > 0.0 { area * (sum / weights) as f32 } else { 0.0 }
    }

    /// A point with its density per area of render space.
    pub fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        let sample = self.shape.sample(u)?;
        let Some(transform) = self.render_from_shape() else { return Some(sample) };
        let pdf = sample.pdf / area_factor(&transform, sample.n);
        pdf.is_finite().then(|| placed(&transform, &sample, pdf))
    }

    /// The density per area with which [`sample`](Self::sample) chooses its point `p`, where its
    /// unit normal is `n`.
    pub fn pdf_area(&self, p: Point3, n: Normal3) -> f32 {
        let pdf = match self.render_from_shape() {
            None => self.shape.pdf_area(p, n),
            Some(transform) => {
                let inverse = transform.inverse();
                let n = inverse.normal(n).normalize_or_zero();
                self.shape.pdf_area(inverse.point(p), n) / area_factor(&transform, n)
            }
        };
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    /// A point with its density per solid angle around `context`.
    #[inline]
    pub fn sample_from(&self, context: &LightSampleContext, u: Vec2) -> Option<ShapeSample> {
        match self.render_from_shape() {
            None => self.shape.sample_from(context, u),
            Some(transform) => self.sample_from_inside(&transform, context, u),
        }
    }

    fn sample_from_inside(
        &self,
        transform: &Transform,
        context: &LightSampleContext,
        u: Vec2,
    ) -> Option<ShapeSample> {
        let inverse = transform.inverse();
        let sample = self.shape.sample_from(&inward(&inverse, context), u)?;
        let outside = placed(transform, &sample, 0.0);
        let wi = (outside.p.p - context.p.p).try_normalize()?;
        let pdf = sample.pdf * solid_angle_factor(&inverse, wi);
        (pdf.is_finite() && pdf > 0.0).then_some(ShapeSample { pdf, ..outside })
    }

    /// The density per solid angle with which [`sample_from`](Self::sample_from) chooses the first
    /// intersection along the unit direction `wi`.
    pub fn pdf_from(&self, context: &LightSampleContext, wi: Vector3) -> f32 {
        let Some(transform) = self.render_from_shape() else { return self.shape.pdf_from(context, wi) };
        let inverse = transform.inverse();
        let direction = inverse.vector(wi).normalize_or_zero();
        let pdf = self.shape.pdf_from(&inward(&inverse, context), direction);
        let pdf = pdf * solid_angle_factor(&inverse, wi);
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    /// See [`Shape::is_hit_once`].
    pub fn is_hit_once(&self, is_outside_alone: bool) -> bool {
        self.shape.is_hit_once(is_outside_alone)
    }

    /// A cone that bounds all its normals.
    pub fn normal_bounds(&self) -> DirectionCone {
        let cone = self.shape.normal_bounds();
        match self.render_from_shape() {
            Some(transform) if cone.cos_theta == 1.0 || is_similarity(&transform) => {
                DirectionCone::new(transform.normal(cone.w).normalize_or(cone.w), cone.cos_theta)
            }
            Some(_) => DirectionCone::ENTIRE_SPHERE,
            None => cone,
        }
    }
}

/// Bounds of `shape`, seen through `instance`, over all times.
pub(super) fn motion_bounds(shape: &Shape, world: &World, instance: &InstancePath) -> Option<Bounds3> {
    let outward = instance.ids().iter().rev();
    Some(outward.fold(shape.bounds()?, |b, &id| world.render_from_instance(id).motion_bounds(&b)))
}

/// A sample transformed to render space, with the density `pdf`. Its error includes that of rays
/// that are transformed back to the space of the shape.
fn placed(transform: &Transform, sample: &ShapeSample, pdf: f32) -> ShapeSample {
    let return_loss = sample.p.p.abs() * (2.0 * MACHINE_EPSILON);
    ShapeSample {
        p: transform.point_with_error(Point3Error::new(sample.p.p, sample.p.error + return_loss)),
        n: transform.normal(sample.n).normalize_or_zero(),
        uv: sample.uv,
        pdf,
    }
}

fn inward(inverse: &Transform, context: &LightSampleContext) -> LightSampleContext {
    LightSampleContext {
        p: inverse.point_with_error(context.p),
        n: inverse.normal(context.n).normalize_or_zero(),
        ns: inverse.normal(context.ns).normalize_or_zero(),
        time: context.time,
    }
}

/// The axes times a power of two, which keeps products of three lengths from overflow.
fn axes(transform: &Transform) -> ([Vec3; 3], f32) {
    let axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|axis| transform.vector(axis));
    let scale = balance(axes.iter().fold(0.0, |largest, axis| axis.abs().max_element().max(largest)));
    (axes.map(|axis| axis * scale), scale)
}

fn determinant([x, y, z]: [Vec3; 3]) -> f32 {
    x.cross(y).dot(z)
}

/// |det M|·|M⁻ᵀn|.
fn area_factor(transform: &Transform, n: Normal3) -> f32 {
    let (axes, scale) = axes(transform);
    let length = balance(scale);
    determinant(axes).abs() * (transform.normal(n) * length).length() * length * length
}

/// |det M⁻¹|/|M⁻¹ω|³.
#[inline(always)]
pub(super) fn solid_angle_factor<R: Real>(inverse: &Transform, w: Vector3<R>) -> R {
    let (axes, scale) = axes(inverse);
    let length = (inverse.vector_lanes(w) * R::splat(scale)).length();
    R::splat(determinant(axes).abs()) / (length * length * length)
}

/// Whether the transform scales all lengths by the same factor.
pub(super) fn is_similarity(transform: &Transform) -> bool {
    let (axes, _) = axes(transform);
    let squared = axes[0].length_squared();
    let tolerance = 1e-5 * squared;
    axes.iter().all(|a| (a.length_squared() - squared).abs() <= tolerance)
        && (0..3).all(|i| axes[i].dot(axes[(i + 1) % 3]).abs() <= tolerance)
}

#[cfg(test)]
mod tests {
    use super::*;
    use geometry::{GroupId, Instance, Sphere, Triangle};
    use math::{AnimatedTransform, DMat4, DVec3};

    /// A shape seen through an instance that stretches, rotates and mirrors it.
    fn stretched(shape: Shape) -> (World, InstancePath, Shape) {
        let matrix = DMat4::from_translation(DVec3::new(0.5, -1.0, 4.0))
            * DMat4::from_axis_angle(DVec3::new(1.0, 2.0, -1.0).normalize(), 0.7)
            * DMat4::from_scale(DVec3::new(-2.0, 0.5, 1.5));
        let mut builder = World::builder();
        let group = builder.add_group();
        builder.add_geometry(group, shape.clone());
        let render_from_instance = AnimatedTransform::new(matrix, matrix, [0.0, 1.0]).expect("invertible");
        let id = builder.add_instance(GroupId::TOP, Instance { group, render_from_instance });
        (builder.build(), InstancePath::TOP.into(id), shape)
    }

    #[test]
    fn the_area_of_a_stretched_triangle_is_that_of_its_corners() {
        let corners = [Vec3::ZERO, Vec3::new(1.0, 0.2, 0.0), Vec3::new(0.1, 1.0, 0.5)];
        let (world, path, shape) = stretched(Triangle::new(corners).into());
        let emitter = Emitter { shape: &shape, world: &world, instance: &path, time: 0.0 };
        let transform = emitter.render_from_shape().expect("an instance");
        let expected = Shape::from(Triangle::new(corners.map(|p| transform.point(p)))).area();
        assert!((emitter.area() / expected - 1.0).abs() < 1e-5);
    }

    #[test]
    fn the_area_of_an_ellipsoid_is_near_that_of_thomsens_formula() {
        let (world, path, shape) = stretched(Sphere::whole(&Transform::IDENTITY, false, 1.0).into());
        let area = Emitter { shape: &shape, world: &world, instance: &path, time: 0.0 }.area();
        // Thomsen's formula holds within 1.1 %.
        let power = |x: f32, y: f32| (x * y).powf(1.6075);
        let mean = (power(2.0, 0.5) + power(2.0, 1.5) + power(0.5, 1.5)) / 3.0;
        let expected = 4.0 * std::f32::consts::PI * mean.powf(1.0 / 1.6075);
        assert!((area / expected - 1.0).abs() < 0.02, "{area} {expected}");
    }
}
