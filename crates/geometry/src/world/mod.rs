//! Everything that a ray can hit.
//!
//! A world is a set of *groups*, each with trees of its own. Group 0 is what rays enter; an
//! [`Instance`] places another group in it, or in a group that is placed itself, at rest or moving.
//! A shape that moves is an instance of a group with that shape alone.

mod batch;
mod builder;
mod group;
mod numbers;
mod order;
mod packet;
mod path;
mod placed;
mod query;
mod refit;
mod spheres;
mod stats;

use crate::curve::Curves;
use crate::mesh::TriangleMesh;
use crate::placement::Placement;
use crate::shape::{Shape, ShapeHit};
use crate::sphere_set::SphereSet;
use crate::surface::SurfacePoint;
use group::{Group, Trace};
use lanes::InstructionSet;
use math::{AnimatedTransform, Bounds3, Ray, Vec2};
use query::{Any, Nearest, Query};
use std::borrow::Cow;
use std::sync::Arc;

pub use builder::WorldBuilder;
pub use path::InstancePath;
pub use refit::RefitError;
pub use stats::RayStats;

/// A geometry, counted over the whole world in the order of [`WorldBuilder::add_geometry`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GeometryId(pub u32);

/// An instance, in the order of [`WorldBuilder::add_instance`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct InstanceId(pub u32);

/// A group, in the order of [`WorldBuilder::add_group`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
pub struct GroupId(pub u32);

impl GroupId {
    /// The group that rays enter.
    pub const TOP: Self = Self(0);
}

/// What one description of an object becomes: one or more primitives that share whatever a scene
/// ties to a [`GeometryId`].
#[derive(Clone, Debug)]
pub enum Geometry {
    /// The triangles of a mesh.
    Mesh(Arc<TriangleMesh>),
    /// Any other shapes: one quadric, the patches of a bilinear mesh.
    Shapes(Arc<[Shape]>),
    /// The spheres of a set.
    Spheres(Arc<SphereSet>),
    /// The parts of curves.
    Curves(Arc<Curves>),
}

impl From<TriangleMesh> for Geometry {
    fn from(mesh: TriangleMesh) -> Self {
        Self::Mesh(Arc::new(mesh))
    }
}

impl From<Shape> for Geometry {
    fn from(shape: Shape) -> Self {
        Self::Shapes(Arc::new([shape]))
    }
}

impl From<SphereSet> for Geometry {
    fn from(set: SphereSet) -> Self {
        Self::Spheres(Arc::new(set))
    }
}

impl From<Curves> for Geometry {
    fn from(curves: Curves) -> Self {
        Self::Curves(Arc::new(curves))
    }
}

impl Geometry {
    /// How many primitives there are.
    pub fn len(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.len(),
            Self::Shapes(shapes) => shapes.len(),
            Self::Spheres(set) => set.len(),
            Self::Curves(curves) => curves.len(),
        }
    }

    /// Whether there is nothing to hit.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Bytes of memory that the primitives take, boxes of their own apart.
    fn bytes(&self) -> usize {
        match self {
            Self::Mesh(mesh) => mesh.bytes(),
            Self::Shapes(shapes) => size_of_val(&**shapes),
            Self::Spheres(set) => set.bytes(),
            Self::Curves(curves) => curves.bytes(),
        }
    }

    /// Whether its primitives move by themselves.
    pub fn is_moving(&self) -> bool {
        matches!(self, Self::Shapes(shapes) if matches!(shapes.first(), Some(Shape::MovingTriangle(_))))
    }

    /// One primitive as a shape, as lights sample it; `None` of curves, which do not emit.
    pub fn shape(&self, primitive: u32) -> Option<Cow<'_, Shape>> {
        match self {
            Self::Mesh(mesh) => Some(Cow::Owned(mesh.triangle(primitive as usize).into())),
            Self::Shapes(shapes) => Some(Cow::Borrowed(&shapes[primitive as usize])),
            Self::Spheres(set) => Some(Cow::Owned(set.sphere(primitive as usize).into())),
            Self::Curves(_) => None,
        }
    }
}

/// A group placed in another.
#[derive(Clone, Debug)]
pub struct Instance {
    /// What is placed.
    pub group: GroupId,
    /// Where: from its own space to that of the group it is placed in.
    pub render_from_instance: AnimatedTransform,
}

/// Where a ray meets something.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Hit {
    /// How far along the ray, in lengths of its direction.
    pub t: f32,
    /// Where on the primitive: barycentric coordinates of corners 1 and 2 on a triangle, nothing on
    /// a sphere of a set, the parameters (u, v) on other shapes.
    pub uv: Vec2,
    /// Which geometry.
    pub geometry: GeometryId,
    /// Which triangle, patch or part of a curve of it.
    pub primitive: u32,
    /// Through which instances.
    pub instance: InstancePath,
}

/// An instance made ready for rays.
#[derive(Clone, Debug)]
struct Placed {
    group: u32,
    motion: AnimatedTransform,
    at_rest: Option<Placement>,
}

impl Placed {
    fn new(instance: Instance) -> Self {
        let motion = instance.render_from_instance;
        let at_rest = (!motion.is_moving()).then(|| Placement::new(motion.start()));
        Self { group: instance.group.0, motion, at_rest }
    }

    /// Calls `f` with the placement at a moment.
    #[inline]
    fn with_placement<T>(&self, time: f32, f: impl FnOnce(&Placement) -> T) -> T {
        match &self.at_rest {
            Some(placement) => f(placement),
            None => f(&Placement::new(&self.motion.at(time))),
        }
    }
}

/// Everything that a ray can hit. Geometries may move ([`World::refit`]), but there will never be
/// more or fewer of them.
#[derive(Clone, Debug)]
pub struct World {
    groups: Vec<Group>,
    geometries: Vec<Geometry>,
    /// Where each geometry is.
    group_of: Vec<GroupId>,
    instances: Vec<Placed>,
    instruction_set: InstructionSet,
    /// Whether rays are tested against extents first.
    extents: bool,
}

impl World {
    /// Starts an empty world.
    pub fn builder() -> WorldBuilder {
        WorldBuilder::default()
    }

    /// A box around everything but infinite planes; empty when there is nothing.
    pub fn bounds(&self) -> Bounds3 {
        self.groups[0].bounds()
    }

    /// Whether anything in it has no end, as planes have none.
    pub fn is_endless(&self) -> bool {
        self.groups[0].is_endless()
    }

    /// Bytes of memory that the trees and the meshes take; arrays that meshes share count for each.
    pub fn bytes(&self) -> usize {
        let trees: usize = self.groups.iter().map(Group::bytes).sum();
        trees + self.geometries.iter().map(Geometry::bytes).sum::<usize>()
    }

    /// A geometry by its id.
    pub fn geometry(&self, id: GeometryId) -> &Geometry {
        &self.geometries[id.0 as usize]
    }

    /// Where an instance stands.
    pub fn render_from_instance(&self, id: InstanceId) -> &AnimatedTransform {
        &self.instances[id.0 as usize].motion
    }

    /// The nearest hit at 0 < t < `t_max` that `filter` keeps. The filter sees candidates in no
    /// promised order, and must answer alike for the same candidate.
    pub fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        filter: &impl Fn(&Hit, &Ray) -> bool,
        stats: &mut RayStats,
    ) -> Option<Hit> {
        self.trace(ray, Nearest::new(ray, t_max, filter), stats)
    }

    /// Whether anything that `filter` keeps is hit at 0 < t < `t_max`.
    pub fn occluded(
        &self,
        ray: &Ray,
        t_max: f32,
        filter: &impl Fn(&Hit, &Ray) -> bool,
        stats: &mut RayStats,
    ) -> bool {
        self.trace(ray, Any::new(ray, t_max, filter), stats)
    }

    #[inline]
    fn trace<Q: Query>(&self, ray: &Ray, mut query: Q, stats: &mut RayStats) -> Q::Answer {
        stats.rays += 1;
        let mut trace = Trace { world: self, ray, instance: InstancePath::TOP, stats };
        self.groups[0].trace(&mut trace, &mut query);
        query.answer()
    }

    /// Traces rays with another set of instructions than the best one, which finds the same hits.
    ///
    /// # Panics
    /// When the processor does not have it.
    pub fn set_instruction_set(&mut self, set: InstructionSet) {
        assert!(set.is_available(), "this processor has no {set:?}");
        self.instruction_set = set;
    }

    /// What is known of the surface where `ray` met it.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        self.surface_within(hit.instance.ids(), ray, hit)
    }

    fn surface_within(&self, path: &[InstanceId], ray: &Ray, hit: &Hit) -> SurfacePoint {
        match path {
            [] => self.surface_in_group(ray, hit),
            [id, inner @ ..] => self.instances[id.0 as usize].with_placement(ray.time, |placement| {
                self.surface_within(inner, &placement.ray(ray), hit).placed(placement, ray)
            }),
        }
    }

    fn surface_in_group(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        match &self.geometries[hit.geometry.0 as usize] {
            Geometry::Mesh(mesh) => mesh.triangle(hit.primitive as usize).surface(ray, hit.uv),
            Geometry::Shapes(shapes) => {
                shapes[hit.primitive as usize].surface(ray, &ShapeHit { t: hit.t, uv: hit.uv })
            }
            Geometry::Spheres(set) => {
                set.sphere(hit.primitive as usize).surface(ray, &ShapeHit { t: hit.t, uv: hit.uv })
            }
            Geometry::Curves(curves) => {
                curves.surface(hit.primitive, ray, &ShapeHit { t: hit.t, uv: hit.uv })
            }
        }
    }
}
