//! Everything that a ray can hit.
//!
//! A world is a set of *groups*, each with trees of its own. Rays start in the top group, group 0.
//! An [`Instance`] places another group in it, or in a group that is itself placed, at rest or
//! moving. A shape that moves is an instance of a group that holds nothing else.

mod batch;
mod builder;
mod columns;
mod enumerate;
mod facet_rays;
mod facets;
mod filter;
mod geometry;
mod group;
mod hit;
mod instance;
mod plain;
mod points;
mod query;
mod ray_order;
mod ray_packet;
mod refit;
mod sphere_points;
mod spheres;
mod stats;
mod tables;
mod trace;
mod triangle_block;
mod triangle_numbering;
mod triangles;

use crate::shape::ShapeHit;
use crate::surface::SurfacePoint;
use facet_rays::FacetRay;
use group::Group;
use lanes::InstructionSet;
use math::{AnimatedTransform, Bounds3, Ray};
use query::{Any, Nearest, Query};
use tables::Tables;
use trace::Trace;

pub use builder::WorldBuilder;
pub use columns::{HitColumns, RayBuffer, RayColumns};
pub use filter::Filter;
pub use geometry::{Geometry, GeometryId};
pub use hit::Hit;
pub use instance::{GroupId, Instance, InstanceId, InstancePath};
pub use plain::{PlainChild, PlainItem, PlainTree, PlainTriangle};
pub use points::PointColumns;
pub use refit::RefitError;
pub use stats::RayStats;

/// Everything that a ray can hit. Geometries may move ([`World::refit`]), but their number is
/// fixed.
#[derive(Clone, Debug)]
pub struct World {
    tables: Tables,
}

impl World {
    /// A box around everything but infinite planes; empty when there is nothing.
    pub fn bounds(&self) -> Bounds3 {
        self.tables.top().bounds()
    }

    /// Whether anything in it is unbounded, as planes are.
    pub fn is_unbounded(&self) -> bool {
        self.tables.top().is_unbounded()
    }

    /// Bytes of memory of trees and geometries; arrays that meshes share count for each mesh.
    pub fn bytes(&self) -> usize {
        let trees: usize = self.tables.groups.iter().map(Group::bytes).sum();
        trees + self.tables.geometries.iter().map(Geometry::bytes).sum::<usize>()
    }

    /// A geometry by its id.
    pub fn geometry(&self, id: GeometryId) -> &Geometry {
        self.tables.geometry(id)
    }

    /// The transform of an instance.
    pub fn render_from_instance(&self, id: InstanceId) -> &AnimatedTransform {
        &self.tables.instances[id.0 as usize].motion
    }

    /// A box around what was hit: the outermost instance or, outside of instances, the geometry.
    /// Curves have that of the whole world.
    pub fn bounds_around(&self, hit: &Hit) -> Bounds3 {
        if let Some(id) = hit.instance.ids().first() {
            let instance = &self.tables.instances[id.0 as usize];
            return instance.motion.motion_bounds(&self.tables.groups[instance.group as usize].bounds());
        }
        let geometry = self.geometry(hit.geometry);
        let primitives = 0..geometry.len() as u32;
        let bounds = |primitive| geometry.shape(primitive).and_then(|shape| shape.bounds());
        let bounds = primitives.filter_map(bounds).reduce(|a, b| a.union(b));
        bounds.unwrap_or_else(|| self.bounds())
    }

    /// The nearest hit at 0 < t < `t_max` that `filter` accepts. The filter sees candidates in no
    /// particular order, and must give the same answer for the same candidate.
    pub fn intersect(
        &self,
        ray: &Ray,
        t_max: f32,
        filter: &impl Filter,
        stats: &mut RayStats,
    ) -> Option<Hit> {
        self.trace(ray, Nearest::new(ray, t_max, filter), stats)
    }

    /// Whether there is a hit at 0 < t < `t_max` that `filter` accepts.
    pub fn occluded(&self, ray: &Ray, t_max: f32, filter: &impl Filter, stats: &mut RayStats) -> bool {
        self.trace(ray, Any::new(ray, t_max, filter), stats)
    }

    #[inline]
    fn trace<Q: Query>(&self, ray: &Ray, mut query: Q, stats: &mut RayStats) -> Q::Answer {
        stats.rays += 1;
        if let Some(facets) = &self.tables.facets {
            stats.primitives += facets.len() as u64;
            FacetRay { tables: &self.tables, facets, ray, query: &mut query }.trace();
            return query.answer();
        }
        let mut trace = Trace { tables: &self.tables, ray, instance: InstancePath::TOP, stats };
        trace.group(self.tables.top(), &mut query);
        query.answer()
    }

    /// Traces rays with another instruction set than the best one, which finds the same hits.
    ///
    /// # Panics
    /// When the processor does not have it.
    pub fn set_instruction_set(&mut self, set: InstructionSet) {
        assert!(set.is_available(), "this processor has no {set:?}");
        self.tables.instruction_set = set;
    }

    /// The surface at a hit of `ray`.
    pub fn surface(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        self.surface_within(hit.instance.ids(), ray, hit)
    }

    fn surface_within(&self, path: &[InstanceId], ray: &Ray, hit: &Hit) -> SurfacePoint {
        match path {
            [] => self.surface_in_group(ray, hit),
            [id, inner @ ..] => self.tables.instances[id.0 as usize].with_placement(ray.time, |placement| {
                self.surface_within(inner, &placement.ray(ray), hit).placed(placement, ray)
            }),
        }
    }

    fn surface_in_group(&self, ray: &Ray, hit: &Hit) -> SurfacePoint {
        let shape_hit = ShapeHit { t: hit.t, uv: hit.uv };
        match self.geometry(hit.geometry) {
            Geometry::Mesh(mesh) => mesh.triangle(hit.primitive as usize).surface(ray, hit.uv),
            Geometry::Shapes(shapes) => shapes[hit.primitive as usize].surface(ray, &shape_hit),
            Geometry::Spheres(set) => set.sphere(hit.primitive as usize).surface(ray, &shape_hit),
            Geometry::Curves(curves) => curves.surface(hit.primitive, ray, &shape_hit),
        }
    }
}
