//! Batches of rays.
//!
//! Few facets are tested without a tree. Otherwise coherent rays are traced as packets, and other
//! rays one by one: many rays with scattered origins in an order in which consecutive rays visit
//! the same nodes and triangles, so that these are in the cache; few rays in the order given.
//!
//! Each ray finds the same hit as on its own.

#![allow(unsafe_code)]

use super::World;
use super::columns::{HitColumns, RayColumns};
use super::facet_rays::{AnyHits, FacetRays, NearestHits};
use super::facets::Facets;
use super::filter::Filter;
use super::hit::Hit;
use super::instance::InstancePath;
use super::query::{Any, Nearest, Query};
use super::ray_order::coherent_order;
use super::ray_packet::{RayPacket, coherent_packet};
use super::stats::RayStats;
use super::trace::{Trace, is_valid};
use crate::bvh::WIDTH;
use lanes::{Simd, Task};
use math::Ray;

/// How many rays ahead rays are prefetched.
const PREFETCH_DISTANCE: usize = 16;

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

    fn trace_batch(&self, rays: RayColumns, mut queries: impl Queries, stats: &mut RayStats) {
        if !self.tables.extents {
            for place in 0..rays.len() {
                self.trace_alone(&rays, place, &mut queries, stats);
            }
            return;
        }
        // SAFETY: the processor has the instruction set of a world.
        unsafe { self.tables.instruction_set.run(Batch { world: self, rays, queries, stats }) }
    }

    #[inline(always)]
    fn trace_alone(&self, rays: &RayColumns, place: usize, queries: &mut impl Queries, stats: &mut RayStats) {
        let ray = rays.ray(place);
        let answer = self.trace(&ray, queries.of(&ray, rays.t_max(place)), stats);
        queries.answer(place, answer);
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

/// Traces a batch through trees.
struct Batch<'a, 'b, Q> {
    world: &'b World,
    rays: RayColumns<'a>,
    queries: Q,
    stats: &'b mut RayStats,
}

impl<Q: Queries> Task for Batch<'_, '_, Q> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        let Self { world, rays, mut queries, stats } = self;
        if let Some(order) = coherent_order(&rays) {
            for (turn, &place) in order.iter().enumerate() {
                if let Some(&ahead) = order.get(turn + PREFETCH_DISTANCE) {
                    rays.prefetch(ahead);
                    queries.prefetch(ahead);
                }
                world.trace_alone(&rays, place, &mut queries, stats);
            }
            return;
        }
        let mut first = 0;
        while first < rays.len() {
            let end = (first + WIDTH).min(rays.len());
            let whole = end - first == WIDTH;
            match whole.then(|| coherent_packet(&rays, first)).flatten() {
                Some(packet) => {
                    stats.rays += WIDTH as u64;
                    let mut asked: [Q::Of<'_>; WIDTH] =
                        std::array::from_fn(|i| queries.of(&packet[i].0, packet[i].1));
                    // SAFETY: the caller promises the instruction set.
                    unsafe {
                        RayPacket::new(&packet).trace::<S, _>(world.tables.top(), &mut asked, stats);
                    }
                    for (i, (query, (ray, _))) in asked.into_iter().zip(&packet).enumerate() {
                        queries.answer(first + i, finish(world, ray, query, stats));
                    }
                }
                None => {
                    for place in first..end {
                        world.trace_alone(&rays, place, &mut queries, stats);
                    }
                }
            }
            first = end;
        }
    }
}

/// Offers the remaining hits, those not on triangles, and returns the answer.
#[inline(always)]
fn finish<Q: Query>(world: &World, ray: &Ray, mut query: Q, stats: &mut RayStats) -> Q::Answer {
    if !query.is_answered() && is_valid(ray) {
        let tables = &world.tables;
        let mut trace = Trace { tables, ray, instance: InstancePath::TOP, stats };
        trace.all_but_triangles(tables.top(), &mut query);
    }
    query.answer()
}
