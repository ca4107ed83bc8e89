//! Batches of rays.
//!
//! Coherent rays are traced as packets. Other rays are traced one by one: many rays with scattered
//! origins in an order in which consecutive rays visit the same nodes and triangles, so that these
//! are in the cache; few rays in the order given.
//!
//! Each ray finds the same hit as on its own.

#![allow(unsafe_code)]

use super::World;
use super::hit::Hit;
use super::instance::InstancePath;
use super::query::{Any, Nearest, Query};
use super::ray_order::coherent_order;
use super::ray_packet::{RayPacket, are_coherent};
use super::stats::RayStats;
use super::trace::{Trace, is_valid};
use crate::bvh::WIDTH;
use lanes::{Simd, Task};
use math::Ray;

/// How many rays ahead rays are prefetched.
const PREFETCH_DISTANCE: usize = 16;

impl World {
    /// [`World::intersect`] for each ray and its `t_max`. Batches of camera rays are best rows or
    /// tiles of sixteen rays or more; batches of rays with scattered origins pay from tens of
    /// thousands on.
    ///
    /// # Panics
    /// When `hits` and `rays` differ in length.
    pub fn intersect_batch(
        &self,
        rays: &[(Ray, f32)],
        filter: &impl Fn(&Hit, &Ray) -> bool,
        hits: &mut [Option<Hit>],
        stats: &mut RayStats,
    ) {
        self.trace_batch(rays, |(ray, t_max)| Nearest::new(ray, *t_max, filter), hits, stats);
    }

    /// [`World::occluded`] for each ray and its `t_max`, in batches as for
    /// [`World::intersect_batch`].
    ///
    /// # Panics
    /// When `occluded` and `rays` differ in length.
    pub fn occluded_batch(
        &self,
        rays: &[(Ray, f32)],
        filter: &impl Fn(&Hit, &Ray) -> bool,
        occluded: &mut [bool],
        stats: &mut RayStats,
    ) {
        self.trace_batch(rays, |(ray, t_max)| Any::new(ray, *t_max, filter), occluded, stats);
    }

    fn trace_batch<'a, Q: Query>(
        &self,
        rays: &'a [(Ray, f32)],
        query: impl Fn(&'a (Ray, f32)) -> Q,
        answers: &mut [Q::Answer],
        stats: &mut RayStats,
    ) {
        assert_eq!(rays.len(), answers.len(), "an answer for each ray");
        if !self.tables.extents {
            for (ray, answer) in rays.iter().zip(answers) {
                *answer = self.trace(&ray.0, query(ray), stats);
            }
            return;
        }
        // SAFETY: the processor has the instruction set of a world.
        unsafe { self.tables.instruction_set.run(Batch { world: self, rays, query, answers, stats }) }
    }
}

/// Traces a batch.
struct Batch<'a, 'b, Q: Query, F> {
    world: &'b World,
    rays: &'a [(Ray, f32)],
    query: F,
    answers: &'b mut [Q::Answer],
    stats: &'b mut RayStats,
}

impl<'a, Q: Query, F: Fn(&'a (Ray, f32)) -> Q> Task for Batch<'a, '_, Q, F> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        let Self { world, rays, query, answers, stats } = self;
        if let Some(order) = coherent_order(rays) {
            for (turn, &i) in order.iter().enumerate() {
                if let Some(&ahead) = order.get(turn + PREFETCH_DISTANCE) {
                    prefetch(&rays[ahead]);
                    prefetch(&answers[ahead]);
                }
                answers[i] = world.trace(&rays[i].0, query(&rays[i]), stats);
            }
            return;
        }
        for (rays, answers) in rays.chunks(WIDTH).zip(answers.chunks_mut(WIDTH)) {
            match rays.try_into() {
                Ok(packet) if are_coherent(packet) => {
                    stats.rays += WIDTH as u64;
                    let mut queries = std::array::from_fn(|i| query(&rays[i]));
                    // SAFETY: the caller promises the instruction set.
                    unsafe {
                        RayPacket::new(packet).trace::<S, Q>(world.tables.top(), &mut queries, stats);
                    }
                    for ((answer, (ray, _)), query) in answers.iter_mut().zip(packet).zip(queries) {
                        *answer = finish(world, ray, query, stats);
                    }
                }
                _ => {
                    for (answer, ray) in answers.iter_mut().zip(rays) {
                        *answer = world.trace(&ray.0, query(ray), stats);
                    }
                }
            }
        }
    }
}

/// Prefetches a value that spans at most two cache lines.
#[inline(always)]
fn prefetch<T>(value: &T) {
    let first = (&raw const *value).cast::<u8>();
    lanes::prefetch(first);
    lanes::prefetch(first.wrapping_add(size_of::<T>() - 1));
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
