//! Shapes: single primitives.
//!
//! Each shape can be intersected with rays, evaluates its surface at a hit, and can be sampled by
//! area ([`Shape::sample`]) or by solid angle from a point ([`Shape::sample_from`]).
//!
//! - Quadrics and the plane are in canonical form in object space, where F(M⁻¹·r(t)) = 0 is
//!   solved; z is their axis.
//! - Triangles and patches have their vertices in render space.
//! - A [`ShapeHit`]'s parameters are barycentric on a triangle (corners 1 and 2) and (u, v) on
//!   other shapes; a [`SurfacePoint`]'s and a [`ShapeSample`]'s `uv` are texture coordinates, which
//!   vertices may assign freely.
//! - Where a direction from a point meets a shape twice, [`Shape::pdf_from`] is the density of the
//!   nearest hit, and [`Shape::sample_from`] may leave out the other. A shape that rays pass
//!   through is sampled by area instead.

mod bilinear_patch;
mod cone;
mod cylinder;
mod disk;
mod extent;
mod hyperboloid;
mod implicit;
mod level;
mod mesh;
mod moving_triangle;
mod paraboloid;
mod plain;
mod plane;
mod quadric;
mod sample;
mod solid;
mod sphere;
mod triangle;

pub use bilinear_patch::BilinearPatch;
pub use cone::Cone;
pub use cylinder::Cylinder;
pub use disk::Disk;
pub use hyperboloid::Hyperboloid;
pub use implicit::{Formula, FormulaError, Implicit};
pub use mesh::{MeshAttributes, MeshError, TriangleMesh};
pub use moving_triangle::{MovingMesh, MovingTriangle};
pub use paraboloid::Paraboloid;
pub use plain::{CurveKind, PlainShape, RevolvedKind};
pub use plane::Plane;
pub(crate) use quadric::SphereRay;
pub use sample::{ShapeHit, ShapeSample, ShapeSampleContext};
pub use solid::{Operation, Solid};
pub use sphere::Sphere;
pub use triangle::Triangle;

use crate::flat_shape::FlatShape;
use crate::surface::SurfacePoint;
use math::{Bounds3, DirectionCone, Normal3, Point3, Ray, Vec2, Vec3, Vector3, closed_set};

closed_set! {
    /// Any shape.
    #[derive(Clone, Debug)]
    pub enum Shape {
        /// Sphere, or a part of it.
        Sphere(Box<Sphere>),
        /// Cylinder without caps.
        Cylinder(Box<Cylinder>),
        /// Cone without a base.
        Cone(Box<Cone>),
        /// Paraboloid.
        Paraboloid(Box<Paraboloid>),
        /// Hyperboloid of one sheet.
        Hyperboloid(Box<Hyperboloid>),
        /// Disk or annulus.
        Disk(Box<Disk>),
        /// Infinite plane.
        Plane(Box<Plane>),
        /// Implicit surface of a formula.
        Implicit(Box<Implicit>),
        /// Constructive solid geometry.
        Solid(Box<Solid>),
        /// Bilinear patch.
        BilinearPatch(Box<BilinearPatch>),
        /// Triangle.
        Triangle(Triangle),
        /// Triangle whose corners move.
        MovingTriangle(MovingTriangle),
    }
    each each_shape $
}

macro_rules! from_shape {
    ($($name:ident)*) => {$(
        impl From<$name> for Shape {
            fn from(shape: $name) -> Self {
                Self::$name(shape.into())
            }
        }
    )*};
}
from_shape!(Sphere Cylinder Cone Paraboloid Hyperboloid Disk Plane Implicit Solid BilinearPatch Triangle MovingTriangle);

impl Shape {
    /// A box around it; `None` when it is unbounded.
    pub fn bounds(&self) -> Option<Bounds3> {
        each_shape!(self, shape => shape.bounds())
    }

    /// The nearest hit at 0 < t < `t_max`.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        self.intersect_beyond(ray, 0.0, t_max)
    }

    /// The nearest hit at `after` < t < `t_max`, where `after` is 0 or the distance of another hit.
    #[inline]
    pub fn intersect_beyond(&self, ray: &Ray, after: f32, t_max: f32) -> Option<ShapeHit> {
        let range = [after, t_max];
        let hit = match self {
            Self::Sphere(shape) => return shape.intersect(ray, range),
            Self::Cylinder(shape) => return shape.intersect(ray, range),
            Self::Cone(shape) => return shape.intersect(ray, range),
            Self::Paraboloid(shape) => return shape.intersect(ray, range),
            Self::Hyperboloid(shape) => return shape.intersect(ray, range),
            Self::Implicit(shape) => return shape.intersect(ray, range),
            Self::Solid(shape) => return shape.intersect(ray, range),
            Self::BilinearPatch(shape) => return shape.intersect(ray, range),
            // Those that are hit once.
            Self::Disk(shape) => shape.intersect(ray, t_max),
            Self::Plane(shape) => shape.intersect(ray, t_max),
            Self::Triangle(shape) => shape.intersect(ray, t_max),
            Self::MovingTriangle(shape) => shape.intersect(ray, t_max),
        };
        hit.filter(|hit| hit.t > after)
    }

    /// Whether no ray meets it twice, or, if the outside alone counts, its outside not after its
    /// inside.
    pub fn is_hit_once(&self, is_outside_alone: bool) -> bool {
        match self {
            Self::Disk(_) | Self::Plane(_) | Self::Triangle(_) | Self::MovingTriangle(_) => true,
            Self::BilinearPatch(shape) => shape.is_flat(),
            Self::Sphere(shape) => is_outside_alone && shape.is_seen_outside_first(),
            Self::Cylinder(_)
            | Self::Cone(_)
            | Self::Paraboloid(_)
            | Self::Hyperboloid(_)
            | Self::Implicit(_)
            | Self::Solid(_) => false,
        }
    }

    /// The surface at a hit of `ray`.
    pub fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        match self {
            Self::Sphere(shape) => shape.surface(ray, hit),
            Self::Cylinder(shape) => shape.surface(ray, hit),
            Self::Cone(shape) => shape.surface(ray, hit),
            Self::Paraboloid(shape) => shape.surface(ray, hit),
            Self::Hyperboloid(shape) => shape.surface(ray, hit),
            Self::Disk(shape) => shape.surface(ray),
            Self::Plane(shape) => shape.surface(ray),
            Self::Implicit(shape) => shape.surface(ray, hit),
            Self::Solid(shape) => shape.surface(ray, hit),
            Self::BilinearPatch(shape) => shape.surface(ray, hit.uv),
            Self::Triangle(shape) => shape.surface(ray, hit.uv),
            Self::MovingTriangle(shape) => shape.surface(ray, hit),
        }
    }

    /// The surface at the parameters of a [`ShapeHit`], seen along its normal; `None` for shapes
    /// that are not parametrised over a square or triangle: planes, implicit surfaces and solids.
    pub fn surface_at(&self, uv: Vec2, time: f32) -> Option<SurfacePoint> {
        let ray = match self {
            Self::Sphere(shape) => shape.ray_to(uv, time),
            Self::Cylinder(shape) => shape.ray_to(uv, time),
            Self::Cone(shape) => shape.ray_to(uv, time),
            Self::Paraboloid(shape) => shape.ray_to(uv, time),
            Self::Hyperboloid(shape) => shape.ray_to(uv, time),
            Self::Disk(shape) => shape.ray_to(uv, time),
            // The ray matters for the time alone.
            Self::BilinearPatch(_) | Self::Triangle(_) | Self::MovingTriangle(_) => {
                Ray::new(Vec3::ZERO, Vec3::Z, time)
            }
            Self::Plane(_) | Self::Implicit(_) | Self::Solid(_) => return None,
        };
        let surface = self.surface(&ray, &ShapeHit { t: 1.0, uv });
        Some(SurfacePoint { wo: surface.n, ..surface })
    }

    /// The area; infinite for the plane, 0 where points cannot be sampled uniformly. Approximate
    /// where a quadric's transform is no similarity, and for curved patches.
    pub fn area(&self) -> f32 {
        each_shape!(self, shape => shape.area())
    }

    /// A point with its density per area; `None` where the area is zero or infinite.
    pub fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        each_shape!(self, shape => shape.sample(u)).filter(|s| s.pdf.is_finite() && s.pdf > 0.0)
    }

    /// The density per area of [`Shape::sample`] at its point `p` with unit normal `n`.
    #[doc(alias = "pdf")]
    pub fn pdf_area(&self, p: Point3, n: Normal3) -> f32 {
        match self {
            Self::Sphere(shape) => shape.pdf_area(n),
            Self::Cylinder(shape) => shape.pdf_area(n),
            Self::Cone(shape) => shape.pdf_area(n),
            Self::Paraboloid(shape) => shape.pdf_area(n),
            Self::Hyperboloid(shape) => shape.pdf_area(n),
            Self::Disk(shape) => shape.pdf_area(n),
            Self::BilinearPatch(shape) => shape.pdf_area(shape.parameters(p, n)),
            Self::Triangle(shape) => shape.pdf_area(),
            Self::Plane(_) | Self::Implicit(_) | Self::Solid(_) | Self::MovingTriangle(_) => 0.0,
        }
    }

    /// A point with its density per solid angle from `reference`; `None` where no point can be
    /// sampled.
    pub fn sample_from(&self, reference: &ShapeSampleContext, u: Vec2) -> Option<ShapeSample> {
        let special = match self {
            Self::Sphere(shape) => shape.sample_from(reference, u),
            Self::BilinearPatch(shape) => shape.sample_from(reference, u),
            Self::Triangle(shape) => shape.sample_from(reference, u),
            _ => None,
        };
        match special {
            Some(sample) => (sample.pdf.is_finite() && sample.pdf > 0.0).then_some(sample),
            None => reference.by_solid_angle(self.sample(u)?),
        }
    }

    /// The density per solid angle of [`Shape::sample_from`] at the first hit along `wi`; 0 where
    /// there is none.
    pub fn pdf_from(&self, reference: &ShapeSampleContext, wi: Vector3) -> f32 {
        let ray = reference.spawn_ray(wi);
        let Some(hit) = self.intersect(&ray, f32::INFINITY) else { return 0.0 };
        let special = match self {
            Self::Sphere(shape) => shape.pdf_from(reference),
            Self::BilinearPatch(shape) => shape.pdf_from(reference, hit.uv),
            Self::Triangle(shape) => shape.pdf_from(reference, hit.uv),
            _ => None,
        };
        let pdf = special.unwrap_or_else(|| {
            let surface = self.surface(&ray, &hit);
            reference.pdf_per_solid_angle(self.pdf_area(surface.p.p, surface.n), surface.p.p, surface.n)
        });
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    /// As plain data for sampling in lanes: a triangle with the same outside everywhere, or a
    /// rectangle without attributes.
    pub fn flat_shape(&self) -> Option<FlatShape> {
        match self {
            Self::BilinearPatch(shape) => shape.flat_shape(),
            Self::Triangle(shape) => shape.flat_shape(),
            _ => None,
        }
    }

    /// As plain data; `None` of shapes that have no such form.
    pub fn plain(&self) -> Option<PlainShape> {
        match self {
            Self::Sphere(shape) => Some(shape.plain()),
            Self::Cylinder(shape) => Some(shape.plain()),
            Self::Disk(shape) => Some(shape.plain()),
            Self::Plane(shape) => Some(shape.plain()),
            Self::BilinearPatch(shape) => shape.plain(),
            Self::Cone(_)
            | Self::Paraboloid(_)
            | Self::Hyperboloid(_)
            | Self::Implicit(_)
            | Self::Solid(_)
            | Self::Triangle(_)
            | Self::MovingTriangle(_) => None,
        }
    }

    /// A cone of all normals, on the side of [`ShapeSample::n`].
    pub fn normal_bounds(&self) -> DirectionCone {
        match self {
            Self::Sphere(_)
            | Self::Cylinder(_)
            | Self::Cone(_)
            | Self::Paraboloid(_)
            | Self::Hyperboloid(_)
            | Self::Implicit(_)
            | Self::Solid(_)
            | Self::MovingTriangle(_) => DirectionCone::ENTIRE_SPHERE,
            Self::Disk(shape) => DirectionCone::new(shape.normal(), 1.0),
            Self::Plane(shape) => DirectionCone::new(shape.normal(), 1.0),
            Self::BilinearPatch(shape) => shape.normal_bounds(),
            Self::Triangle(shape) => DirectionCone::new(shape.outside(Vec2::splat(1.0 / 3.0)), 1.0),
        }
    }
}
