//! Rays on their way through a tree.
//!
//! Towards the nearest hit, children are visited front to back: the nearest at once, the others
//! from a stack, where each waits with the distance of its box, so that it is passed over when
//! something nearer was hit in the meantime. Towards any hit, order is only a guess of where one is
//! found soon: near the origin when the ray ends somewhere, for it was made to end at what it may
//! see; where the builder put leaves with few large primitives when it does not. What waits is
//! asked for from memory at once.

#![allow(unsafe_code)]

use super::node::{Beam, Child, Slabs, WIDTH, WideNode};
use super::{Bvh, MAX_DEPTH};
use lanes::{Simd, Vector, prefetch};
use math::Ray;
use std::mem::MaybeUninit;
use std::ops::Range;

/// What stands in the leaves of a tree.
pub(crate) trait Leaves {
    /// What a block is made of.
    type Block;

    /// All blocks.
    fn blocks(&self) -> &[Self::Block];

    /// Tests blocks for hits up to `t_max`, and lowers it to the nearest. Whether to look no
    /// further.
    ///
    /// # Safety
    /// The blocks must be those of a leaf, and the processor must have the instructions that the
    /// leaves were made ready for.
    unsafe fn test(&mut self, blocks: Range<usize>, t_max: &mut f32) -> bool;
}

/// Each node on the way down leaves at most all children but one waiting, the last one perhaps all;
/// and below all lies [`Waiting::END`].
const STACK: usize = MAX_DEPTH * (WIDTH - 1) + 2;

/// A child, and above it the bits of its distance, so that what is nearer is less.
#[derive(Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
struct Waiting(u64);

impl Waiting {
    /// Not a leaf that there can be.
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

/// What waits for rays that pass together: in the last bits of the distance, a bit for each ray
/// that enters the box.
#[derive(Clone, Copy)]
struct Together(Waiting);

impl Together {
    const ALL: u32 = (1 << WIDTH) - 1;

    #[inline(always)]
    fn new(near: f32, rays: u32, child: Child) -> Self {
        Self(Waiting::new(f32::from_bits(near.to_bits() & !Self::ALL | rays), child))
    }

    #[inline(always)]
    fn rays(self) -> u32 {
        self.0.near() & Self::ALL
    }

    #[inline(always)]
    unsafe fn pop(top: &mut *mut Waiting, t_max: f32) -> Self {
        loop {
            // SAFETY: the end lies below everything, and is never passed over.
            let waiting = unsafe {
                *top = top.sub(1);
                **top
            };
            if waiting.near() & !Self::ALL <= t_max.to_bits() {
                return Self(waiting);
            }
        }
    }
}

impl Bvh {
    /// Shows `leaves` the blocks that the ray may meet up to `t_max`, the nearest first, or with
    /// `ANY` in no order of distance. Returns the number of boxes tested, and whether `leaves`
    /// broke off. The ray must be finite.
    ///
    /// # Safety
    /// The processor must have the instructions of the set.
    #[inline(always)]
    pub unsafe fn traverse<S: Simd, const ANY: bool>(
        &self,
        ray: &Ray,
        t_max: &mut f32,
        leaves: &mut impl Leaves,
    ) -> (u64, bool) {
        let mut extents = 0;
        // Negative and NaN ends leave nothing to be hit; nor has a ray without length anywhere to
        // go.
        if self.nodes.is_empty() || t_max.is_nan() || *t_max < 0.0 {
            return (extents, false);
        }
        // SAFETY: the caller promises the instructions. Children were made by `Child::node` and
        // `Child::leaf` for nodes and blocks that there are, and the tree is not deeper than what
        // the stack was measured for: `Bvh::build` saw to both.
        unsafe {
            let slabs = Slabs::<S::F32x16>::new(ray, &self.bounds);
            let nodes = self.nodes.as_ptr();
            let mut stack = [const { MaybeUninit::<Waiting>::uninit() }; STACK];
            let mut top = stack.as_mut_ptr().cast::<Waiting>();
            *top = Waiting::END;
            top = top.add(1);
            let mut next = Child::node(0);
            loop {
                while !next.is_leaf() {
                    let node = &*nodes.add(next.index());
                    extents += node.len() as u64;
                    let ahead = |child| self.prefetch(leaves.blocks(), child);
                    next = descend::<S, ANY>(node, &slabs, *t_max, &mut top, ahead);
                }
                if next == Waiting::END.child() {
                    return (extents, false);
                }
                if leaves.test(next.blocks(), t_max) {
                    return (extents, true);
                }
                next = pop(&mut top, *t_max);
            }
        }
    }

    /// Takes rays from one point through the tree together. `test` is given blocks, a bit for each
    /// ray that enters the box around them, and the end of each ray, which it may lower: below zero
    /// when the ray is to go no further. Returns the number of boxes tested. The rays must be
    /// finite and have the same signs.
    ///
    /// # Safety
    /// The processor must have the instructions of the set.
    #[inline(always)]
    pub unsafe fn traverse_together<S: Simd, B>(
        &self,
        blocks: &[B],
        rays: &[(Ray, f32); WIDTH],
        t_max: &mut [f32; WIDTH],
        mut test: impl FnMut(Range<usize>, u32, &mut [f32; WIDTH]),
    ) -> u64 {
        let mut extents = 0;
        if self.nodes.is_empty() {
            return extents;
        }
        // SAFETY: as in `traverse`.
        unsafe {
            let beam = Beam::<S::F32x16>::new(rays, &self.bounds);
            let zero = S::F32x16::splat(0.0);
            let mut furthest = t_max.iter().fold(0.0, |a: f32, &b| a.max(b));
            let mut stack = [const { MaybeUninit::<Waiting>::uninit() }; STACK];
            let mut top = stack.as_mut_ptr().cast::<Waiting>();
            push(&mut top, Waiting::END);
            let mut next = Together(Waiting::new(0.0, Child::node(0)));
            loop {
                let child = next.0.child();
                if child == Waiting::END.child() {
                    return extents;
                }
                if child.is_leaf() {
                    test(child.blocks(), next.rays(), t_max);
                    furthest = t_max.iter().fold(0.0, |a: f32, &b| a.max(b));
                } else {
                    let node = self.nodes.get_unchecked(child.index());
                    let ends = S::F32x16::load(t_max);
                    let (near, mut entered) = node.intersect_beam(&beam, S::F32x16::splat(furthest), zero);
                    extents += node.len() as u64;
                    let near = near.store();
                    let floor = top;
                    while entered != 0 {
                        let lane = entered.trailing_zeros() as usize;
                        entered &= entered - 1;
                        let (_, hits) = node.intersect_rays(lane, &beam, ends, zero);
                        extents += WIDTH as u64;
                        if hits != 0 {
                            let child = *node.children().get_unchecked(lane);
                            self.prefetch(blocks, child);
                            sink(&mut top, floor, Together::new(*near.get_unchecked(lane), hits, child).0);
                        }
                    }
                }
                next = Together::pop(&mut top, furthest);
            }
        }
    }

    /// How many lines of a node or block are asked for. What is left of a node comes while these
    /// are computed with.
    const AHEAD: usize = 3;

    /// Asks for a node or a block.
    #[inline(always)]
    fn prefetch<B>(&self, blocks: &[B], child: Child) {
        let node = self.nodes.as_ptr().wrapping_add(child.index()).cast::<u8>();
        let block = blocks.as_ptr().wrapping_add(child.blocks().start).cast::<u8>();
        let at = if child.is_leaf() { block } else { node };
        for line in 0..Self::AHEAD {
            prefetch(at.wrapping_add(64 * line));
        }
    }
}

/// Passes a node: gives the child to be visited next, and leaves others waiting.
#[inline(always)]
unsafe fn descend<S: Simd, const ANY: bool>(
    node: &WideNode,
    slabs: &Slabs<S::F32x16>,
    t_max: f32,
    top: &mut *mut Waiting,
    ahead: impl Fn(Child),
) -> Child {
    // SAFETY: who has slabs has the instructions; the caller promises a stack with room for the
    // tree.
    unsafe {
        let (near, hits) = node.intersect(slabs, S::F32x16::splat(t_max), S::F32x16::splat(0.0));
        if hits == 0 {
            pop(top, t_max)
        } else if ANY {
            choose_any(node, hits, top, ahead)
        } else {
            choose_nearest::<S>(node, near, hits, top, ahead)
        }
    }
}

#[inline(always)]
unsafe fn pop(top: &mut *mut Waiting, t_max: f32) -> Child {
    loop {
        // SAFETY: the end lies below everything, and is never passed over.
        let waiting = unsafe {
            *top = top.sub(1);
            **top
        };
        if waiting.near() <= t_max.to_bits() {
            return waiting.child();
        }
    }
}

#[inline(always)]
unsafe fn push(top: &mut *mut Waiting, waiting: Waiting) {
    // SAFETY: the stack has room for the deepest tree.
    unsafe {
        **top = waiting;
        *top = top.add(1);
    }
}

/// Pushes, and sinks below those above `floor` that are nearer.
#[inline(always)]
unsafe fn sink(top: &mut *mut Waiting, floor: *mut Waiting, waiting: Waiting) {
    // SAFETY: the stack has room for the deepest tree, and `floor` lies in it.
    unsafe {
        let mut at = *top;
        while at > floor && *at.sub(1) < waiting {
            *at = *at.sub(1);
            at = at.sub(1);
        }
        *at = waiting;
        *top = top.add(1);
    }
}

/// Takes the last child that is hit, and leaves the others waiting.
#[inline(always)]
unsafe fn choose_any(node: &WideNode, mut hits: u32, top: &mut *mut Waiting, ahead: impl Fn(Child)) -> Child {
    loop {
        // SAFETY: bits of `hits` are lanes.
        let child = unsafe { *node.children().get_unchecked(hits.trailing_zeros() as usize) };
        hits &= hits - 1;
        if hits == 0 {
            return child;
        }
        ahead(child);
        // SAFETY: a node leaves at most all children but one waiting.
        unsafe { push(top, Waiting::new(0.0, child)) };
    }
}

/// Takes the nearest child that is hit, and leaves the others waiting in order.
#[inline(always)]
unsafe fn choose_nearest<S: Simd>(
    node: &WideNode,
    near: S::F32x16,
    mut hits: u32,
    top: &mut *mut Waiting,
    ahead: impl Fn(Child),
) -> Child {
    // SAFETY: bits of `hits` are lanes.
    let child = |lane: usize| unsafe { *node.children().get_unchecked(lane) };
    let lane = hits.trailing_zeros() as usize;
    hits &= hits - 1;
    if hits == 0 {
        return child(lane);
    }
    let near = near.store();
    // SAFETY: bits of `hits` are lanes.
    let waiting = |lane: usize| unsafe { Waiting::new(*near.get_unchecked(lane), child(lane)) };
    let a = waiting(lane);
    let lane = hits.trailing_zeros() as usize;
    hits &= hits - 1;
    let b = waiting(lane);
    let (mut nearest, other) = (a.min(b), a.max(b));
    ahead(other.child());
    // SAFETY: a node leaves at most all children but one waiting.
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
            let c = waiting(lane);
            let other = c.max(nearest);
            nearest = c.min(nearest);
            ahead(other.child());
            sink(top, floor, other);
        }
    }
    nearest.child()
}
