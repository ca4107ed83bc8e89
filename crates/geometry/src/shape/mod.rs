//! Shapes: what a single primitive can do.
//!
//! Each shape is met by rays, describes its surface at a hit, and samples itself: by area
//! ([`Shape::sample`]), or as seen from a point ([`Shape::sample_from`], by solid angle). Every
//! sample has its density.
//!
//! - Quadrics and the plane live in canonical form in object space, where F(M⁻¹·r(t)) = 0 is
//!   solved; z is their axis.
//! - Triangles and patches have their vertices in render space.
//! - A [`ShapeHit`]'s parameters are barycentric on a triangle (corners 1 and 2) and (u, v) on
//!   other shapes; a [`SurfacePoint`]'s and a [`ShapeSample`]'s `uv` are texture coordinates, which
//!   vertices may assign at will.
//! - Where a surface covers a direction twice, the density of the direction is that of its nearest
//!   point; the other is out of sight.

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
pub use plane::Plane;
pub(crate) use quadric::first_root;
pub use sample::{ShapeHit, ShapeSample, ShapeSampleContext};
pub use solid::{Operation, Solid};
pub use sphere::Sphere;
pub use triangle::Triangle;

use crate::surface::SurfacePoint;
use math::{Bounds3, DirectionCone, Normal3, Point3, Ray, Vec2, Vec3, Vector3};

/// Any shape.
#[derive(Clone, Debug)]
pub enum Shape {
    /// Ball, or a part of it.
    Sphere(Box<Sphere>),
    /// Tube without ends.
    Cylinder(Box<Cylinder>),
    /// Cone without a base.
    Cone(Box<Cone>),
    /// Bowl.
    Paraboloid(Box<Paraboloid>),
    /// What a straight line sweeps.
    Hyperboloid(Box<Hyperboloid>),
    /// Flat disk or ring.
    Disk(Box<Disk>),
    /// Infinite plane.
    Plane(Box<Plane>),
    /// Surface given by a formula.
    Implicit(Box<Implicit>),
    /// Bodies combined.
    Solid(Box<Solid>),
    /// Bilinear patch.
    BilinearPatch(Box<BilinearPatch>),
    /// Triangle.
    Triangle(Triangle),
    /// Triangle whose corners move.
    MovingTriangle(MovingTriangle),
}

macro_rules! each_shape {
    ($self:expr, $shape:ident => $result:expr) => {
        match $self {
            Shape::Sphere($shape) => $result,
            Shape::Cylinder($shape) => $result,
            Shape::Cone($shape) => $result,
            Shape::Paraboloid($shape) => $result,
            Shape::Hyperboloid($shape) => $result,
            Shape::Disk($shape) => $result,
            Shape::Plane($shape) => $result,
            Shape::Implicit($shape) => $result,
            Shape::Solid($shape) => $result,
            Shape::BilinearPatch($shape) => $result,
            Shape::Triangle($shape) => $result,
            Shape::MovingTriangle($shape) => $result,
        }
    };
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
    /// A box around it; `None` when it has no end.
    pub fn bounds(&self) -> Option<Bounds3> {
        each_shape!(self, shape => shape.bounds())
    }

    /// The nearest point where the ray meets it at 0 < t < `t_max`.
    #[inline]
    pub fn intersect(&self, ray: &Ray, t_max: f32) -> Option<ShapeHit> {
        each_shape!(self, shape => shape.intersect(ray, t_max))
    }

    /// What is known of the surface where `ray` met it.
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

    /// What is known of the surface where a [`ShapeHit`] has these parameters, seen from along its
    /// normal; `None` of shapes that are not made of points with parameters in a square or
    /// triangle: planes, formulas and solids.
    pub fn surface_at(&self, uv: Vec2, time: f32) -> Option<SurfacePoint> {
        let ray = match self {
            Self::Sphere(shape) => shape.ray_to(uv, time),
            Self::Cylinder(shape) => shape.ray_to(uv, time),
            Self::Cone(shape) => shape.ray_to(uv, time),
            Self::Paraboloid(shape) => shape.ray_to(uv, time),
            Self::Hyperboloid(shape) => shape.ray_to(uv, time),
            Self::Disk(shape) => shape.ray_to(uv, time),
            // These look at the parameters alone.
            Self::BilinearPatch(_) | Self::Triangle(_) | Self::MovingTriangle(_) => {
                Ray::new(Vec3::ZERO, Vec3::Z, time)
            }
            Self::Plane(_) | Self::Implicit(_) | Self::Solid(_) => return None,
        };
        let surface = self.surface(&ray, &ShapeHit { t: 1.0, uv });
        Some(SurfacePoint { wo: surface.n, ..surface })
    }

    /// The area; infinite for the plane, 0 where points cannot be chosen evenly. Approximate where
    /// a quadric's transform is no similarity, and for bent patches.
    pub fn area(&self) -> f32 {
        each_shape!(self, shape => shape.area())
    }

    /// A point with its density per area; `None` where the shape has no area, or no finite one.
    pub fn sample(&self, u: Vec2) -> Option<ShapeSample> {
        each_shape!(self, shape => shape.sample(u)).filter(|s| s.pdf.is_finite() && s.pdf > 0.0)
    }

    /// The density per area with which [`Shape::sample`] chooses its point `p`, where its unit
    /// normal is `n`.
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

    /// A point with its density per solid angle around `reference`; `None` where no point can be
    /// chosen.
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

    /// The density per solid angle with which [`Shape::sample_from`] chooses what is first met
    /// along `wi`; 0 where nothing is.
    pub fn pdf_from(&self, reference: &ShapeSampleContext, wi: Vector3) -> f32 {
        let ray = reference.spawn_ray(wi);
        let Some(hit) = self.intersect(&ray, f32::INFINITY) else { return 0.0 };
        let special = match self {
            Self::Sphere(shape) => shape.pdf_from(reference),
            Self::BilinearPatch(shape) => shape.pdf_from(reference, hit.uv),
            Self::Triangle(shape) => shape.pdf_from(reference, wi),
            _ => None,
        };
        let pdf = special.unwrap_or_else(|| {
            let surface = self.surface(&ray, &hit);
            self.pdf_area(surface.p.p, surface.n) * reference.area_per_solid_angle(surface.p.p, surface.n)
        });
        if pdf.is_finite() { pdf } else { 0.0 }
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
