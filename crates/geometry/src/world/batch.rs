//! Many rays at once.
//!
//! Rays that run side by side pass the tree together: each box and each triangle is tested against eight rays at once.
//!
//! Other rays, alone, spend half of their time waiting for nodes and triangles to come from memory. Several pass the tree
//! in turns: each passes one node or leaf, asks for the next, and lets the others go on while that is on its way.
//!
//! Each ray finds the very hit that it would find alone.

#![allow(unsafe_code)]

use super::group::{Group, Trace, Triangles, goes_somewhere, in_order};
use super::packet::Packet;
use super::query::{Any, Nearest, Query};
use super::{Hit, InstancePath, RayStats, World};
use crate::bvh::{WIDTH, Walk};
use crate::simd::{Simd, Task, Vector};
use crate::watertight::{LaneHits, Sheared, ShearedLanes};
use math::Ray;
use std::ops::Range;

/// Rays that take turns.
const WALKS: usize = 8;

impl World {
    /// What [`World::intersect`] says of each ray and its `t_max`.
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

    /// What [`World::occluded`] says of each ray and its `t_max`.
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
        stats.rays += rays.len() as u64;
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
        let mut apart = Vec::new();
        for (first, eight) in (0..).step_by(WIDTH).zip(rays.chunks(WIDTH)) {
            match eight.try_into().ok().and_then(SideBySide::new) {
                Some(rays) => {
                    let mut queries = rays.rays.each_ref().map(&question);
                    // SAFETY: the caller promises the instructions.
                    unsafe { rays.trace::<S, Q>(world, &mut queries, stats) };
                    for (i, query) in queries.into_iter().enumerate() {
                        answers[first + i] = finish(world, &eight[i].0, query, stats);
                    }
                }
                None => apart.extend(first..first + eight.len()),
            }
        }
        // SAFETY: the caller promises the instructions.
        unsafe { take_turns::<S, Q>(world, rays, apart, question, answers, stats) };
    }
}

/// Rays that are worth being taken together.
struct SideBySide<'a> {
    rays: &'a [(Ray, f32); WIDTH],
    sheared: [Sheared; WIDTH],
}

impl<'a> SideBySide<'a> {
    /// How far apart directions may be, in parts of their length.
    const SPREAD: f32 = 0.1;

    fn new(rays: &'a [(Ray, f32); WIDTH]) -> Option<Self> {
        let lead = &rays[0].0;
        let spread = lead.d.length() * Self::SPREAD;
        let beside = |(ray, t_max): &(Ray, f32)| {
            goes_somewhere(ray)
                && *t_max >= 0.0
                && ray.o == lead.o
                && ray.d.distance(lead.d) < spread
                && ray.d.is_negative_bitmask() == lead.d.is_negative_bitmask()
        };
        if !rays.iter().all(beside) {
            return None;
        }
        let sheared = rays.each_ref().map(|(ray, _)| Sheared::new(ray));
        sheared.iter().all(|s| s.axis() == sheared[0].axis()).then_some(Self { rays, sheared })
    }

    /// # Safety
    /// The processor must have the instructions of the set.
    #[inline(always)]
    unsafe fn trace<S: Simd, Q: Query>(&self, world: &World, queries: &mut [Q; WIDTH], stats: &mut RayStats) {
        let group = &world.groups[0];
        let rays = self.rays.each_ref().map(|(ray, _)| *ray);
        let mut t_max = self.rays.each_ref().map(|(_, t_max)| *t_max);
        let mut primitives = 0;
        // SAFETY: the caller promises the instructions.
        unsafe {
            let lanes: ShearedLanes<S::Eight> = Sheared::each(&self.sheared);
            let test = |blocks: Range<usize>, t_max: &mut [f32; WIDTH]| {
                for packet in &group.packets()[blocks] {
                    for lane in 0..packet.len() {
                        primitives += WIDTH as u64;
                        let found = packet.intersect_rays(lane, &lanes, S::Eight::load(t_max));
                        if let Some(found) = found {
                            self.offer(group, packet, lane, &found, queries, t_max);
                        }
                    }
                }
            };
            stats.extents += group.triangles().traverse_together::<S>(&rays, &mut t_max, test);
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

/// # Safety
/// The processor must have the instructions of the set.
#[inline(always)]
unsafe fn take_turns<'a, S: Simd, Q: Query>(
    world: &World,
    rays: &'a [(Ray, f32)],
    indices: Vec<usize>,
    question: impl Fn(&'a (Ray, f32)) -> Q,
    answers: &mut [Q::Answer],
    stats: &mut RayStats,
) {
    let group = &world.groups[0];
    let mut waiting = indices.into_iter();
    let mut walkers: Vec<Walker<S, Q>> = Vec::with_capacity(WALKS);
    for index in waiting.by_ref().take(WALKS) {
        let ray = &rays[index].0;
        let sheared = Sheared::new(ray);
        // SAFETY: the caller promises the instructions.
        let (lanes, walk) =
            unsafe { (sheared.lanes::<{ Packet::WIDTH }, _>(), Walk::new(group.triangles(), ray)) };
        let mut walker = Walker { index, query: question(&rays[index]), sheared, lanes, walk };
        walker.start(world, ray);
        walkers.push(walker);
    }
    let mut turn = 0;
    while !walkers.is_empty() {
        turn = if turn < walkers.len() { turn } else { 0 };
        let walker = &mut walkers[turn];
        // SAFETY: the caller promises the instructions, and there is no tree but that of the group.
        if !unsafe { walker.step(world, stats) } {
            turn += 1;
            continue;
        }
        let last = walker.index;
        let query = match waiting.next() {
            Some(index) => {
                let ray = &rays[index].0;
                walker.index = index;
                walker.sheared = Sheared::new(ray);
                // SAFETY: the caller promises the instructions.
                walker.lanes = unsafe { walker.sheared.lanes::<{ Packet::WIDTH }, _>() };
                let query = std::mem::replace(&mut walker.query, question(&rays[index]));
                walker.start(world, ray);
                turn += 1;
                query
            }
            None => {
                let walker = walkers.swap_remove(turn);
                stats.extents += walker.walk.extents;
                walker.query
            }
        };
        answers[last] = finish(world, &rays[last].0, query, stats);
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
        let mut triangles =
            Triangles { group, instance: InstancePath::TOP, sheared, lanes, query, primitives: 0 };
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
        let mut trace = Trace { world, ray, instance: InstancePath::TOP, stats };
        world.groups[0].trace_others(&mut trace, &mut query);
    }
    query.answer()
}
