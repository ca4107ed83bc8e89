//! Rays against shapes: meshes, quadrics, patches and curves, the tree over them, and instances.
//!
//! A [`World`] holds everything that a ray can hit. It is asked in two stages: [`World::intersect`]
//! gives a [`Hit`] (where along the ray, on which primitive), and [`World::surface`] makes of it a
//! [`SurfacePoint`] (position with error bounds, normals, partial derivatives). The other half of
//! the crate is [`Shape`]: one thing that has bounds, can be hit, and can be sampled by area or by
//! the solid angle in which a point sees it.
//!
//! Points, normals and hits are in render space unless a name says otherwise. A point knows how far
//! it may be from the surface it stands for; a ray that leaves by [`math::Ray::spawn`] therefore
//! neither meets its own surface again nor passes through it.

mod bvh;
mod curve;
mod mesh;
mod placement;
mod shape;
mod sphere_set;
mod surface;
mod tessellation;
mod watertight;
mod world;

pub use bvh::BuildQuality;
pub use curve::{CurveProfile, CurveSegment, Curves, SplineBasis, bezier_segments};
pub use lanes::InstructionSet;
pub use mesh::{MeshAttributes, MeshError, TriangleMesh};
pub use shape::{
    BilinearPatch, Cone, Cylinder, Disk, Formula, FormulaError, Hyperboloid, Implicit, MovingMesh,
    MovingTriangle, Operation, Paraboloid, Plane, Shape, ShapeHit, ShapeSample, ShapeSampleContext, Solid,
    Sphere, Triangle,
};
pub use sphere_set::{SphereSet, SphereSetError};
pub use surface::{Shading, SurfacePoint};
pub use tessellation::{MeshArrays, displaced, loop_subdivision};
pub use world::{
    Geometry, GeometryId, GroupId, Hit, Instance, InstanceId, InstancePath, RayStats, RefitError, World,
    WorldBuilder,
};
