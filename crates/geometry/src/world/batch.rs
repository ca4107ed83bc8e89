//! Batches of rays.
//!
//! Few facets are tested without a tree. Otherwise sixteen rays at a time are read from their
//! columns: coherent ones are traced as packets, others one by one. Many rays with scattered
//! origins are taken in an order in which consecutive rays visit the same nodes and triangles, so
//! that these are in the cache; few rays in the order given.
//!
//! Each ray finds the same hit as on its own.

#![allow(unsafe_code)]

use super::World;
use super::columns::{HitColumns, RayColumns};
use super::facet_rays::{AnyHits, FacetRays, NearestHits};
use super::facets::Facets;
use super::filter::Filter;
use super::group::Group;
use super::hit::Hit;
use super::instance::InstancePath;
use super::query::{Any, Nearest, Query};
use super::ray_order::coherent_order;
use super::ray_packet::TracePacket;
use super::stats::RayStats;
use super::trace::{Trace, TraceEach, is_valid};
use crate::bvh::{Packet, WIDTH};
use lanes::{Simd, Task};
use math::{Ray, Vec3};

impl World {
    /// [`World::intersect`] for each ray. Batches of camera rays are best rows or tiles of sixteen
    /// rays or more; batches of rays with scattered origins pay from tens of thousands on.
    pub fn intersect_batch(
        &self,
        rays: RayColumns,
        filter: &impl Filter,
        hits: &mut HitColumns,
        stats: &mut RayStats,
    ) {
        hits.reset(rays.len());
        let set = self.tables.instruction_set;
        if let Some(facets) = &self.tables.facets {
            let rays = self.facet_rays(facets, rays, filter, stats);
            // SAFETY: the processor has the instruction set of a world.
            return unsafe { set.run(NearestHits(rays, hits)) };
        }
        self.trace_batch(rays, NearestHit { filter, hits }, stats);
    }

    /// [`World::occluded`] for each ray, in batches as for [`World::intersect_batch`].
    ///
    /// # Panics
    /// When `occluded` and `rays` differ in length.
    pub fn occluded_batch(
        &self,
        rays: RayColumns,
        filter: &impl Filter,
        occluded: &mut [bool],
        stats: &mut RayStats,
    ) {
        assert_eq!(rays.len(), occluded.len(), "an answer for each ray");
        let set = self.tables.instruction_set;
        if let Some(facets) = &self.tables.facets {
            let rays = self.facet_rays(facets, rays, filter, stats);
            // SAFETY: the processor has the instruction set of a world.
            return unsafe { set.run(AnyHits(rays, occluded)) };
        }
        self.trace_batch(rays, AnyHit { filter, occluded }, stats);
    }

    fn facet_rays<'a, F>(
        &'a self,
        facets: &'a Facets,
        rays: RayColumns<'a>,
        filter: &'a F,
        stats: &mut RayStats,
    ) -> FacetRays<'a, F> {
        stats.rays += rays.len() as u64;
        stats.primitives += (rays.len() * facets.len()) as u64;
        FacetRays { geometries: &self.tables.geometries, facets, rays, filter }
    }

    fn trace_batch<Q: Queries>(&self, rays: RayColumns, mut queries: Q, stats: &mut RayStats) {
        if !self.tables.extents {
            for place in 0..rays.len() {
                let ray = rays.ray(place);
                let answer = self.trace(&ray, queries.of(&ray, rays.t_max(place)), stats);
                queries.answer(place, answer);
            }
            return;
        }
        let (group, set) = (self.tables.top(), self.tables.instruction_set);
        let size = group.bounds().diagonal().length();
        let order = coherent_order(&rays);
        let place = |turn: usize| order.as_ref().map_or(turn, |order| order[turn]);
        for first in (0..rays.len()).step_by(WIDTH) {
            let turns = first..(first + WIDTH).min(rays.len());
            if let Some(order) = &order {
                for &ahead in order[turns.end..].iter().take(WIDTH) {
                    rays.prefetch(ahead);
                    queries.prefetch(ahead);
                }
            }
            // Rays without a direction fill the last ones up.
            let packet = if order.is_none() && turns.len() == WIDTH {
                rays.packet_from(first)
            } else {
                rays.packet(turns.clone().map(place))
            };
            let mut few = [Ray::new(Vec3::ZERO, Vec3::ZERO, 0.0); WIDTH];
            for (ray, turn) in few.iter_mut().zip(turns.clone()) {
                *ray = rays.ray(place(turn));
            }
            let mut asked: [Q::Of<'_>; WIDTH] = std::array::from_fn(|i| queries.of(&few[i], packet.t_max[i]));
            stats.rays += turns.len() as u64;
            let task = TraceFew { group, size, packet: &packet, rays: &few, queries: &mut asked, stats };
            // SAFETY: the processor has the instruction set of a world.
            let is_packet = unsafe { set.run(task) };
            let is_done = if is_packet { !group.has_items() } else { group.has_only_triangles() };
            for ((query, ray), turn) in asked.iter_mut().zip(&few).zip(turns) {
                if !is_done && !query.is_answered() && is_valid(ray) {
                    let tables = &self.tables;
                    let mut trace = Trace { tables, ray, instance: InstancePath::TOP, stats };
                    if is_packet {
                        trace.items(group, query);
                    } else {
                        trace.all_but_triangles(group, query);
                    }
                }
                queries.answer(place(turn), query.answer());
            }
        }
    }
}

/// Sixteen rays: if they are coherent, all traverse the triangles and the spheres of the top group
/// together, otherwise one after another its triangles.
struct TraceFew<'a, Q> {
    group: &'a Group,
    size: f32,
    packet: &'a Packet,
    /// The same rays.
    rays: &'a [Ray; WIDTH],
    /// A query for each ray.
    queries: &'a mut [Q; WIDTH],
    stats: &'a mut RayStats,
}

impl<Q: Query> Task for TraceFew<'_, Q> {
    const EVERY_SET: bool = Q::EVERY_SET;

    /// Whether they are coherent.
    type Output = bool;

    #[inline(always)]
    unsafe fn run<S: Simd>(self) -> bool {
        let Self { group, size, packet, rays, queries, stats } = self;
        // SAFETY: the caller promises the instruction set.
        unsafe {
            let is_packet = packet.is_coherent::<S::F32x16>(size);
            if is_packet {
                TracePacket { group, packet, rays, queries, stats }.run::<S>();
            } else {
                TraceEach { group, rays, queries, stats }.run::<S>();
            }
            is_packet
        }
    }
}

/// The query of each ray of a batch, and where its answer goes.
trait Queries {
    type Answer;

    type Of<'r>: Query<Answer = Self::Answer>
    where
        Self: 'r;

    /// The query of a ray.
    fn of<'r>(&self, ray: &'r Ray, t_max: f32) -> Self::Of<'r>
    where
        Self: 'r;

    /// Takes the answer of the ray at a place in the batch.
    fn answer(&mut self, place: usize, answer: Self::Answer);

    /// Prefetches the place of an answer.
    fn prefetch(&self, place: usize);
}

struct NearestHit<'a, F> {
    filter: &'a F,
    hits: &'a mut HitColumns,
}

impl<F: Filter> Queries for NearestHit<'_, F> {
    type Answer = Option<Hit>;

    type Of<'r>
        = Nearest<'r, F>
    where
        Self: 'r;

    #[inline(always)]
    fn of<'r>(&self, ray: &'r Ray, t_max: f32) -> Nearest<'r, F>
    where
        Self: 'r,
    {
        Nearest::new(ray, t_max, self.filter)
    }

    #[inline(always)]
    fn answer(&mut self, place: usize, hit: Option<Hit>) {
        self.hits.set(place, hit);
    }

    #[inline(always)]
    fn prefetch(&self, place: usize) {
        self.hits.prefetch(place);
    }
}

struct AnyHit<'a, F> {
    filter: &'a F,
    occluded: &'a mut [bool],
}

impl<F: Filter> Queries for AnyHit<'_, F> {
    type Answer = bool;

    type Of<'r>
        = Any<'r, F>
    where
        Self: 'r;

    #[inline(always)]
    fn of<'r>(&self, ray: &'r Ray, t_max: f32) -> Any<'r, F>
    where
        Self: 'r,
    {
        Any::new(ray, t_max, self.filter)
    }

    #[inline(always)]
    fn answer(&mut self, place: usize, occluded: bool) {
        self.occluded[place] = occluded;
    }

    #[inline(always)]
    fn prefetch(&self, place: usize) {
        lanes::prefetch(&raw const self.occluded[place]);
    }
}
