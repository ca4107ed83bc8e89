//! Ray intersection: meshes, quadrics, patches, curves, bounding volume hierarchies, and instances.
//!
//! A [`World`] holds everything that a ray can hit. [`World::intersect`] returns a [`Hit`]
//! (distance, primitive and parameters); [`World::surface`] evaluates the [`SurfacePoint`] there
//! (position with error bounds, normals, partial derivatives). A [`Shape`] is a single primitive
//! that has bounds, can be hit, and can be sampled by area or by solid angle from a point.
//!
//! Points, normals and hits are in render space unless a name says otherwise. A surface point has a
//! bound of its error, so that a ray spawned there by [`math::Ray::spawn`] neither hits the surface
//! it leaves nor passes through it.

mod bvh;
mod curve;
mod facet;
mod flat_shape;
mod patch;
mod placement;
mod shape;
mod sphere_set;
mod surface;
mod tessellation;
mod triples;
mod watertight;
mod world;

pub use bvh::BuildQuality;
pub use curve::{CurveProfile, CurveSegment, Curves, SplineBasis, bezier_segments};
pub use flat_shape::FlatShape;
pub use lanes::InstructionSet;
pub use patch::{Patch, PatchPoints};
pub use shape::{
    BilinearPatch, Cone, CurveKind, Cylinder, Disk, Formula, FormulaError, Hyperboloid, Implicit,
    MeshAttributes, MeshError, MovingMesh, MovingTriangle, Operation, Paraboloid, PlainShape, Plane,
    RevolvedKind, Shape, ShapeHit, ShapeSample, ShapeSampleContext, Solid, Sphere, Triangle, TriangleMesh,
};
pub use sphere_set::{SphereSet, SphereSetError};
pub use surface::{Shading, SurfacePoint};
pub use tessellation::{MeshArrays, displaced, loop_subdivision};
pub use world::{
    Filter, Geometry, GeometryId, GroupId, Hit, HitColumns, Instance, InstanceId, InstancePath, PlainChild,
    PlainItem, PlainTree, PlainTriangle, PointColumns, RayBuffer, RayColumns, RayStats, RefitError, World,
    WorldBuilder,
};
