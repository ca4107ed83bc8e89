//! Many rays at once.
//!
//! Rays that run side by side from one point, as those of a camera do, pass the tree together: a
//! beam around sixteen of them finds the boxes that any of them may enter, and these boxes and the
//! triangles in them are tested against all sixteen at once.
//!
//! Other rays pass it one by one. Many with scattered origins do so in an order of their own, so
//! that nodes and triangles of which one has just had need are at hand for the next.
//!
//! Each ray finds the very hit that it would find alone.

#![allow(unsafe_code)]

use super::group::{Group, Trace, Triangles, goes_somewhere};
use super::order::order;
use super::packet::Packet;
use super::query::{Any, Nearest, Query};
use super::{Hit, InstancePath, RayStats, World};
use crate::bvh::{Leaves, WIDTH};
use crate::watertight::{LaneHits, Sheared, ShearedLanes, main_axis};
use lanes::{Simd, Task, Vector};
use math::Ray;
use std::ops::Range;

/// How many rays ahead of its turn a ray is asked for from memory.
const AHEAD: usize = 16;

impl World {
    /// What [`World::intersect`] says of each ray and its `t_max`. Rays of a camera are best given
    /// by rows or tiles, in any number from sixteen on; rays with scattered origins by tens of
    /// thousands, for fewer are no faster than alone.
    ///
    /// # Panics
    /// When there are not as many hits as rays.
    pub fn intersect_batch(
        &self,
        rays: &[(Ray, f32)],
        filter: &impl Fn(&Hit, &Ray) -> bool,
        hits: &mut [Option<Hit>],
        stats: &mut RayStats,
    ) {
        self.trace_batch(rays, |(ray, t_max)| Nearest::new(ray, *t_max, filter), hits, stats);
    }

    /// What [`World::occluded`] says of each ray and its `t_max`. How many are best is as for
    /// [`World::intersect_batch`].
    ///
    /// # Panics
    /// When there are not as many answers as rays.
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
        question: impl Fn(&'a (Ray, f32)) -> Q,
        answers: &mut [Q::Answer],
        stats: &mut RayStats,
    ) {
        assert_eq!(rays.len(), answers.len(), "an answer for each ray");
        if !self.extents {
            for (ray, answer) in rays.iter().zip(answers) {
                *answer = self.trace(&ray.0, question(ray), stats);
            }
            return;
        }
        // SAFETY: worlds are only given sets that the processor has.
        unsafe { self.instruction_set.run(Batch { world: self, rays, question, answers, stats }) }
    }
}

/// Traces a batch with a set of instructions.
struct Batch<'a, 'b, Q: Query, F> {
    world: &'b World,
    rays: &'a [(Ray, f32)],
    question: F,
    answers: &'b mut [Q::Answer],
    stats: &'b mut RayStats,
}

impl<'a, Q: Query, F: Fn(&'a (Ray, f32)) -> Q> Task for Batch<'a, '_, Q, F> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        let Self { world, rays, question, answers, stats } = self;
        if let Some(order) = order(rays) {
            for (turn, &i) in order.iter().enumerate() {
                if let Some(&ahead) = order.get(turn + AHEAD) {
                    prefetch(&rays[ahead]);
                    prefetch(&answers[ahead]);
                }
                answers[i] = world.trace(&rays[i].0, question(&rays[i]), stats);
            }
            return;
        }
        for (rays, answers) in rays.chunks(WIDTH).zip(answers.chunks_mut(WIDTH)) {
            match rays.try_into() {
                Ok(group) if are_side_by_side(group) => {
                    stats.rays += WIDTH as u64;
                    let mut queries = std::array::from_fn(|i| question(&rays[i]));
                    // SAFETY: the caller promises the instructions.
                    unsafe { SideBySide::new(group).trace::<S, Q>(world, &mut queries, stats) };
                    for ((answer, (ray, _)), query) in answers.iter_mut().zip(group).zip(queries) {
                        *answer = finish(world, ray, query, stats);
                    }
                }
                _ => {
                    for (answer, ray) in answers.iter_mut().zip(rays) {
                        *answer = world.trace(&ray.0, question(ray), stats);
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

/// How far apart the directions of rays side by side may be, in parts of their length.
const SPREAD: f32 = 0.1;

/// Whether rays are worth being taken together: they come from one point, go about the same way,
/// with the same signs, and mostly along the same axis.
#[inline(always)]
fn are_side_by_side(rays: &[(Ray, f32); WIDTH]) -> bool {
    let lead = &rays[0].0;
    let axis = main_axis(lead.d);
    let spread = lead.d.length_squared() * (SPREAD * SPREAD);
    rays.iter().all(|(ray, t_max)| {
        ray.o == lead.o
            && goes_somewhere(ray)
            && *t_max >= 0.0
            && ray.d.distance_squared(lead.d) < spread
            && ray.d.is_negative_bitmask() == lead.d.is_negative_bitmask()
            && main_axis(ray.d) == axis
    })
}

/// Rays that are taken together.
struct SideBySide<'a> {
    rays: &'a [(Ray, f32); WIDTH],
    sheared: [Sheared; WIDTH],
}

impl<'a> SideBySide<'a> {
    /// So few are tested against triangles one by one.
    const FEW: u32 = 4;

    #[inline(always)]
    fn new(rays: &'a [(Ray, f32); WIDTH]) -> Self {
        Self { rays, sheared: std::array::from_fn(|i| Sheared::new(&rays[i].0)) }
    }

    /// # Safety
    /// The processor must have the instructions of the set.
    #[inline(always)]
    unsafe fn trace<S: Simd, Q: Query>(&self, world: &World, queries: &mut [Q; WIDTH], stats: &mut RayStats) {
        let group = &world.groups[0];
        let mut t_max = std::array::from_fn(|i| self.rays[i].1);
        let mut primitives = 0;
        // SAFETY: the caller promises the instructions.
        unsafe {
            let lanes: ShearedLanes<S::F32x16> = Sheared::each(&self.sheared);
            let test = |blocks: Range<usize>, entering: u32, t_max: &mut [f32; WIDTH]| {
                if entering.count_ones() <= Self::FEW {
                    let mut entering = entering;
                    while entering != 0 {
                        let i = entering.trailing_zeros() as usize;
                        entering &= entering - 1;
                        if t_max[i] < 0.0 {
                            continue;
                        }
                        let mut triangles = Triangles::<S, Q> {
                            group,
                            instance: InstancePath::TOP,
                            sheared: &self.sheared[i],
                            lanes: &self.sheared[i].lanes::<{ Packet::VERTICES }, S::F32x8>(),
                            query: &mut queries[i],
                            primitives: 0,
                        };
                        if triangles.test(blocks.clone(), &mut t_max[i]) {
                            t_max[i] = -1.0;
                        }
                        primitives += triangles.primitives;
                    }
                    return;
                }
                for packet in &group.packets()[blocks] {
                    for lane in 0..packet.len() {
                        primitives += WIDTH as u64;
                        let found = packet.intersect_rays(lane, &lanes, S::F32x16::load(t_max));
                        if let Some(found) = found {
                            self.offer(group, packet, lane, &found, queries, t_max);
                        }
                    }
                }
            };
            stats.extents +=
                group.triangles().traverse_together::<S, _>(group.packets(), self.rays, &mut t_max, test);
        }
        stats.primitives += primitives;
    }

    #[inline(always)]
    fn offer<Q: Query>(
        &self,
        group: &Group,
        packet: &Packet,
        lane: usize,
        found: &LaneHits<WIDTH>,
        queries: &mut [Q; WIDTH],
        t_max: &mut [f32; WIDTH],
    ) {
        let mut hits = found.hits;
        while hits != 0 {
            let i = hits.trailing_zeros() as usize % WIDTH;
            hits &= hits - 1;
            if t_max[i] < 0.0 {
                continue;
            }
            let (sheared, numbers) = (&self.sheared[i], group.numbers());
            let Some(hit) = packet.hit(lane, found, i, sheared, numbers, InstancePath::TOP) else { continue };
            t_max[i] = if queries[i].offer(hit) { -1.0 } else { queries[i].t_max() };
        }
    }
}

/// Looks for hits on all but triangles.
#[inline(always)]
fn finish<Q: Query>(world: &World, ray: &Ray, mut query: Q, stats: &mut RayStats) -> Q::Answer {
    if !query.is_answered() && goes_somewhere(ray) {
        let mut trace = Trace { world, ray, instance: InstancePath::TOP, stats };
        world.groups[0].trace_others(&mut trace, &mut query);
    }
    query.answer()
}
