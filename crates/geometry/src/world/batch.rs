//! Many rays at once.
//!
//! A ray alone spends half of its time waiting for nodes and triangles to come from memory. Here several rays pass the
//! tree in turns: each passes one node or leaf, asks for the next, and lets the others go on while that is on its way.
//! Each finds the very hit that it would find alone.

#![allow(unsafe_code)]

use super::group::{Trace, Triangles, goes_somewhere, in_order};
use super::packet::Packet;
use super::query::{Any, Nearest, Query};
use super::{Hit, RayStats, World};
use crate::bvh::Walk;
use crate::simd::{Simd, Task};
use crate::watertight::{Sheared, ShearedLanes};
use math::Ray;

/// Rays under way at a time.
const WALKS: usize = 8;

impl World {
    /// What [`World::intersect`] says of each ray and its `t_max`, but sooner.
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

    /// What [`World::occluded`] says of each ray and its `t_max`, but sooner.
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
        stats.rays += rays.len() as u64;
        // SAFETY: worlds are only given sets that the processor has.
        unsafe { self.instruction_set.run(Batch { world: self, rays, question, answers, stats }) }
    }
}

struct Batch<'a, 'b, Q: Query, F> {
    world: &'b World,
    rays: &'a [(Ray, f32)],
    question: F,
    answers: &'b mut [Q::Answer],
    stats: &'b mut RayStats,
}

/// A ray under way.
struct Walker<S: Simd, Q> {
    /// Which of the batch.
    index: usize,
    query: Q,
    sheared: Sheared,
    lanes: ShearedLanes<S::Four>,
    walk: Walk<S>,
}

impl<'a, Q: Query, F: Fn(&'a (Ray, f32)) -> Q> Task for Batch<'a, '_, Q, F> {
    type Output = ();

    #[inline(always)]
    unsafe fn run<S: Simd>(self) {
        let Self { world, rays, question, answers, stats } = self;
        let group = &world.groups[0];
        let mut walkers: Vec<Walker<S, Q>> = Vec::with_capacity(WALKS);
        for index in 0..WALKS.min(rays.len()) {
            let ray = &rays[index].0;
            let sheared = Sheared::new(ray);
            // SAFETY: the caller promises the instructions.
            let (lanes, walk) = unsafe { (sheared.lanes::<{ Packet::WIDTH }, _>(), Walk::new(group.triangles(), ray)) };
            let mut walker = Walker { index, query: question(&rays[index]), sheared, lanes, walk };
            walker.start(world, ray);
            walkers.push(walker);
        }
        let mut waiting = walkers.len()..rays.len();
        let mut turn = 0;
        while !walkers.is_empty() {
            turn = if turn < walkers.len() { turn } else { 0 };
            let walker = &mut walkers[turn];
            // SAFETY: the caller promises the instructions, and there is no tree but that of the group.
            if !unsafe { walker.step(world, stats) } {
                turn += 1;
                continue;
            }
            let next = waiting.next();
            let query = match next {
                Some(index) => std::mem::replace(&mut walker.query, question(&rays[index])),
                None => {
                    let walker = walkers.swap_remove(turn);
                    stats.extents += walker.walk.extents;
                    answers[walker.index] = finish(world, &rays[walker.index].0, walker.query, stats);
                    continue;
                }
            };
            answers[walker.index] = finish(world, &rays[walker.index].0, query, stats);
            if let Some(index) = next {
                let ray = &rays[index].0;
                walker.index = index;
                walker.sheared = Sheared::new(ray);
                // SAFETY: the caller promises the instructions.
                walker.lanes = unsafe { walker.sheared.lanes::<{ Packet::WIDTH }, _>() };
                walker.start(world, ray);
                turn += 1;
            }
        }
    }
}

impl<S: Simd, Q: Query> Walker<S, Q> {
    #[inline(always)]
    fn start(&mut self, world: &World, ray: &Ray) {
        if goes_somewhere(ray) {
            let t_max = self.query.t_max();
            self.walk.start(world.groups[0].triangles(), ray, t_max, in_order::<Q>(t_max));
        }
    }

    /// Passes one node or leaf. Whether that was the last.
    ///
    /// # Safety
    /// The walk must be in the tree of the top group.
    #[inline(always)]
    unsafe fn step(&mut self, world: &World, stats: &mut RayStats) -> bool {
        let group = &world.groups[0];
        let Self { query, sheared, lanes, walk, .. } = self;
        let mut triangles = Triangles { group, instance: None, sheared, lanes, query, primitives: 0 };
        // SAFETY: as the caller promises.
        let over = unsafe { walk.step(group.triangles(), &mut triangles) };
        stats.primitives += triangles.primitives;
        over
    }
}

/// Looks for hits on all but triangles.
#[inline(always)]
fn finish<Q: Query>(world: &World, ray: &Ray, mut query: Q, stats: &mut RayStats) -> Q::Answer {
    if !query.is_answered() && goes_somewhere(ray) {
        let mut trace = Trace { world, ray, instance: None, stats };
        world.groups[0].trace_others(&mut trace, &mut query);
    }
    query.answer()
}
