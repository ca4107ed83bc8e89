//! Traversal.
//!
//! For the nearest hit, children are visited front to back: the nearest at once, the others from a
//! stack, where each has the distance of its box, so that it is skipped when a nearer hit has been
//! found. For any hit, the order is a heuristic: by distance where the ray is a segment, since such
//! rays test the visibility of a point; where it is unbounded, the order of the builder, which puts
//! children with large primitives last, where they are visited first. Children on the stack are
//! prefetched.

#![allow(unsafe_code)]

use super::node::{Child, RaySlabs, WIDTH, WideNode};
use super::packet::{Packet, PacketSlabs};
use super::{Bvh, MAX_DEPTH};
use lanes::{Simd, Vector, prefetch};
use math::Ray;
use std::mem::MaybeUninit;
use std::ops::Range;

/// The tests of leaves.
pub(crate) trait Leaves {
    /// Primitives that are tested at once.
    type Block;

    /// All blocks.
    fn blocks(&self) -> &[Self::Block];

    /// Tests blocks for hits before `t_max`, and lowers it to the nearest; returns whether to stop.
    ///
    /// # Safety
    /// The blocks must be those of a leaf, and the processor must have the instruction set that the
    /// leaves were prepared for.
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool;
}

/// The tests of leaves by the rays of a packet.
pub(crate) trait PacketLeaves {
    /// Primitives that are tested at once.
    type Block;

    /// All blocks.
    fn blocks(&self) -> &[Self::Block];

    /// Tests blocks against the rays of the bits in `entering`, each before its end in `t_max`,
    /// which it lowers: below zero to stop the ray.
    ///
    /// # Safety
    /// As for [`Leaves::test`].
    unsafe fn test(&mut self, blocks: Range<usize>, entering: u32, t_max: &mut [f32; WIDTH]);
}

/// Each level of nodes pushes at most all children but one, the last one perhaps all; the bottom of
/// the stack is [`StackEntry::END`].
const STACK: usize = MAX_DEPTH * (WIDTH - 1) + 2;

/// A child in the low bits, and its distance in the high bits, so that entries compare by distance.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct StackEntry(u64);

impl StackEntry {
    /// The bottom of the stack: no valid leaf.
    const END: Self = Self(u32::MAX as u64);

    #[inline(always)]
    fn new(near: f32, child: Child) -> Self {
        Self((near.to_bits() as u64) << 32 | child.0 as u64)
    }

    #[inline(always)]
    fn near(self) -> u32 {
        (self.0 >> 32) as u32
    }

    #[inline(always)]
    fn child(self) -> Child {
        Child(self.0 as u32)
    }
}

/// An entry for a ray packet: in the low bits of the distance, a bit for each ray that enters the
/// box.
#[derive(Clone, Copy)]
struct PacketEntry(StackEntry);

impl PacketEntry {
    const ALL: u32 = (1 << WIDTH) - 1;

    #[inline(always)]
    fn new(near: f32, rays: u32, child: Child) -> Self {
        Self(StackEntry::new(f32::from_bits(near.to_bits() & !Self::ALL | rays), child))
    }

    #[inline(always)]
    fn rays(self) -> u32 {
        self.0.near() & Self::ALL
    }

    #[inline(always)]
    unsafe fn pop(top: &mut *mut StackEntry, t_max: f32) -> Self {
        loop {
            // SAFETY: the end is the bottom of the stack, and is never skipped.
            let entry = unsafe {
                *top = top.sub(1);
                **top
            };
            if entry.near() & !Self::ALL <= t_max.to_bits() {
                return Self(entry);
            }
        }
    }
}

impl Bvh {
    /// Prepares a ray for traversal.
    #[inline(always)]
    pub fn prepare(&self, ray: &Ray) -> RaySlabs<f32> {
        RaySlabs::new(ray, &self.bounds)
    }

    /// Passes `leaves` the blocks that the ray may meet before `t_max`, the nearest first, or with
    /// `ANY` in the order of the builder. Returns the number of boxes tested, and whether `leaves`
    /// stopped. The ray must be finite.
    ///
    /// # Safety
    /// The processor must have the instruction set.
    #[inline(always)]
    pub unsafe fn traverse<S: Simd, const ANY: bool>(
        &self,
        ray: &RaySlabs<f32>,
        t_max: &mut f32,
        leaves: &mut impl Leaves,
    ) -> (u64, bool) {
        let mut extents = 0;
        // A negative or NaN `t_max` admits no hit.
        if self.nodes.is_empty() || t_max.is_nan() || *t_max < 0.0 {
            return (extents, false);
        }
        // SAFETY: the caller promises the instruction set. Children are valid nodes and ranges of
        // blocks, and the tree is not deeper than the stack allows: `Bvh::build` ensures both.
        unsafe {
            let slabs = ray.lanes::<S::F32x16>();
            let nodes = self.nodes.as_ptr();
            let mut stack = [const { MaybeUninit::<StackEntry>::uninit() }; STACK];
            let mut top = stack.as_mut_ptr().cast::<StackEntry>();
            *top = StackEntry::END;
            top = top.add(1);
            let mut next = Child::node(0);
            loop {
                while !next.is_leaf() {
                    let node = &*nodes.add(next.index());
                    extents += WIDTH as u64;
                    let prefetch_child = |child| self.prefetch(leaves.blocks(), child);
                    next = descend::<S, ANY>(node, &slabs, *t_max, &mut top, prefetch_child);
                }
                if next == StackEntry::END.child() {
                    return (extents, false);
                }
                if leaves.test(next.blocks(), t_max) {
                    return (extents, true);
                }
                next = pop(&mut top, *t_max);
            }
        }
    }

    /// Traverses the tree with a packet of rays. Passes `leaves` the blocks that any ray may meet
    /// before its end in `t_max`. Returns the number of boxes tested. The rays must be finite, and
    /// their directions must have the same signs.
    ///
    /// # Safety
    /// The processor must have the instruction set.
    #[inline(always)]
    pub unsafe fn traverse_packet<S: Simd>(
        &self,
        packet: &Packet,
        t_max: &mut [f32; WIDTH],
        leaves: &mut impl PacketLeaves,
    ) -> u64 {
        let mut extents = 0;
        if self.nodes.is_empty() {
            return extents;
        }
        // SAFETY: as in `traverse`.
        unsafe {
            let packet = PacketSlabs::<S::F32x16>::new(packet, &self.bounds);
            let zero = S::F32x16::splat(0.0);
            let mut furthest = largest(t_max);
            let mut stack = [const { MaybeUninit::<StackEntry>::uninit() }; STACK];
            let mut top = stack.as_mut_ptr().cast::<StackEntry>();
            push(&mut top, StackEntry::END);
            let mut next = PacketEntry(StackEntry::new(0.0, Child::node(0)));
            loop {
                let child = next.0.child();
                if child == StackEntry::END.child() {
                    return extents;
                }
                if child.is_leaf() {
                    leaves.test(child.blocks(), next.rays(), t_max);
                    furthest = largest(t_max);
                } else {
                    let node = self.nodes.get_unchecked(child.index());
                    let ends = S::F32x16::load(t_max);
                    let (near, mut entered) =
                        node.intersect_packet(&packet, S::F32x16::splat(furthest), zero);
                    extents += WIDTH as u64;
                    let near = near.store();
                    let floor = top;
                    while entered != 0 {
                        let lane = entered.trailing_zeros() as usize;
                        entered &= entered - 1;
                        let (_, hits) = node.intersect_rays(lane, &packet, ends, zero);
                        extents += WIDTH as u64;
                        if hits != 0 {
                            let child = *node.children().get_unchecked(lane);
                            self.prefetch(leaves.blocks(), child);
                            insert(
                                &mut top,
                                floor,
                                PacketEntry::new(*near.get_unchecked(lane), hits, child).0,
                            );
                        }
                    }
                }
                next = PacketEntry::pop(&mut top, furthest);
            }
        }
    }

    /// How many cache lines of a node or block are prefetched. The rest of a node is loaded while
    /// these are computed with.
    const PREFETCH_LINES: usize = 3;

    /// Prefetches a node or a block.
    #[inline(always)]
    fn prefetch<B>(&self, blocks: &[B], child: Child) {
        let node = self.nodes.as_ptr().wrapping_add(child.index()).cast::<u8>();
        let block = blocks.as_ptr().wrapping_add(child.blocks().start).cast::<u8>();
        let at = if child.is_leaf() { block } else { node };
        for line in 0..Self::PREFETCH_LINES {
            prefetch(at.wrapping_add(64 * line));
        }
    }
}

/// The largest end of a packet's rays; zero if all have stopped.
#[inline(always)]
fn largest(t_max: &[f32; WIDTH]) -> f32 {
    let mut t_max = *t_max;
    let mut half = WIDTH / 2;
    while half > 0 {
        for i in 0..half {
            t_max[i] = if t_max[i] > t_max[i + half] { t_max[i] } else { t_max[i + half] };
        }
        half /= 2;
    }
    if t_max[0] > 0.0 { t_max[0] } else { 0.0 }
}

/// Tests the children of a node: returns the one to visit next, and pushes the others.
#[inline(always)]
unsafe fn descend<S: Simd, const ANY: bool>(
    node: &WideNode,
    slabs: &RaySlabs<S::F32x16>,
    t_max: f32,
    top: &mut *mut StackEntry,
    prefetch_child: impl Fn(Child),
) -> Child {
    // SAFETY: `slabs` is the proof of the instruction set; the caller promises a stack with
    // capacity for the tree.
    unsafe {
        let (near, hits) = node.intersect(slabs, S::F32x16::splat(t_max), S::F32x16::splat(0.0));
        if hits == 0 {
            pop(top, t_max)
        } else if ANY {
            choose_any(node, hits, top, prefetch_child)
        } else {
            choose_nearest::<S>(node, near, hits, top, prefetch_child)
        }
    }
}

#[inline(always)]
unsafe fn pop(top: &mut *mut StackEntry, t_max: f32) -> Child {
    loop {
        // SAFETY: the end is the bottom of the stack, and is never skipped.
        let entry = unsafe {
            *top = top.sub(1);
            **top
        };
        if entry.near() <= t_max.to_bits() {
            return entry.child();
        }
    }
}

#[inline(always)]
unsafe fn push(top: &mut *mut StackEntry, entry: StackEntry) {
    // SAFETY: the stack has capacity for the deepest tree.
    unsafe {
        **top = entry;
        *top = top.add(1);
    }
}

/// Inserts an entry below those above `floor` that are nearer.
#[inline(always)]
unsafe fn insert(top: &mut *mut StackEntry, floor: *mut StackEntry, entry: StackEntry) {
    // SAFETY: the stack has capacity for the deepest tree, and `floor` is in it.
    unsafe {
        let mut at = *top;
        while at > floor && *at.sub(1) < entry {
            *at = *at.sub(1);
            at = at.sub(1);
        }
        *at = entry;
        *top = top.add(1);
    }
}

/// Takes the last child that is hit, and pushes the others.
#[inline(always)]
unsafe fn choose_any(
    node: &WideNode,
    mut hits: u32,
    top: &mut *mut StackEntry,
    prefetch_child: impl Fn(Child),
) -> Child {
    loop {
        // SAFETY: bits of `hits` are lanes.
        let child = unsafe { *node.children().get_unchecked(hits.trailing_zeros() as usize) };
        hits &= hits - 1;
        if hits == 0 {
            return child;
        }
        prefetch_child(child);
        // SAFETY: a node pushes at most all children but one.
        unsafe { push(top, StackEntry::new(0.0, child)) };
    }
}

/// The distances of all children in one cache line, so that reading one need not wait until all
/// are written.
#[repr(C, align(64))]
struct CacheLine([f32; WIDTH]);

/// Takes the nearest child that is hit, and pushes the others in order.
#[inline(always)]
unsafe fn choose_nearest<S: Simd>(
    node: &WideNode,
    near: S::F32x16,
    mut hits: u32,
    top: &mut *mut StackEntry,
    prefetch_child: impl Fn(Child),
) -> Child {
    // SAFETY: bits of `hits` are lanes.
    let child = |lane: usize| unsafe { *node.children().get_unchecked(lane) };
    let lane = hits.trailing_zeros() as usize;
    hits &= hits - 1;
    if hits == 0 {
        return child(lane);
    }
    let near = CacheLine(near.store());
    // SAFETY: bits of `hits` are lanes.
    let entry = |lane: usize| unsafe { StackEntry::new(*near.0.get_unchecked(lane), child(lane)) };
    let a = entry(lane);
    let lane = hits.trailing_zeros() as usize;
    hits &= hits - 1;
    let b = entry(lane);
    let (mut nearest, other) = (a.min(b), a.max(b));
    prefetch_child(other.child());
    // SAFETY: a node pushes at most all children but one.
    unsafe {
        if hits == 0 {
            push(top, other);
            return nearest.child();
        }
        let floor = *top;
        push(top, other);
        while hits != 0 {
            let lane = hits.trailing_zeros() as usize;
            hits &= hits - 1;
            let c = entry(lane);
            let other = c.max(nearest);
            nearest = c.min(nearest);
            prefetch_child(other.child());
            insert(top, floor, other);
        }
    }
    nearest.child()
}
