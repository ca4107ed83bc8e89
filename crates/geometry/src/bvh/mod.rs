//! A tree of boxes over anything that has bounds.
//!
//! Three things are kept apart: how to split is [`build`]'s affair, what a node is [`node`]'s, and what a
//! leaf tests is left to the caller. A leaf is a range of *blocks*, each of a fixed number of primitives, so
//! that a caller may test a block at once.
//!
//! Children are visited front to back. The tree depends on the primitives alone, never on the number of
//! threads that built it.

mod build;
mod node;

use math::{Bounds3, Ray};
use node::{Child, Slabs, WideNode};
use rayon::prelude::*;
use std::ops::{ControlFlow, Range};

pub use build::BuildQuality;
pub(crate) use build::Reference;

/// The tree.
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    nodes: Vec<WideNode>,
    bounds: Bounds3,
}

impl Bvh {
    /// Builds over references with finite bounds; leaves hold blocks of `width` references, a power of two. `block`
    /// makes a block of its references.
    pub fn build<B: Send>(
        references: Vec<Reference>,
        quality: BuildQuality,
        width: usize,
        block: impl Fn(&[Reference]) -> B + Sync + Send,
    ) -> (Self, Vec<B>) {
        let built = build::build(references, quality, width);
        let blocks = built.blocks().map(block).collect();
        (Self { bounds: built.bounds, nodes: built.nodes }, blocks)
    }

    /// Bytes of memory taken.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    /// Calls `leaf` with the blocks that the ray may meet before `t_max`, the nearest first. `leaf` may lower
    /// `t_max`, or break off. Counts the boxes tested in `extents`. The ray must be finite.
    #[inline]
    pub fn traverse(
        &self,
        ray: &Ray,
        t_max: &mut f32,
        extents: &mut u64,
        mut leaf: impl FnMut(Range<usize>, &mut f32) -> ControlFlow<()>,
    ) -> ControlFlow<()> {
        if self.nodes.is_empty() {
            return ControlFlow::Continue(());
        }
        let slabs = Slabs::new(ray, &self.bounds);
        let mut stack = Stack::new();
        let mut next = Some(Pending { near: 0.0, child: Child { first: 0, blocks: 0 } });
        while let Some(Pending { near, child }) = next {
            if near > *t_max {
                next = stack.pop();
                continue;
            }
            if child.blocks > 0 {
                let first = child.first as usize;
                leaf(first..first + child.blocks as usize, t_max)?;
                next = stack.pop();
                continue;
            }
            let node = &self.nodes[child.first as usize];
            *extents += node.len() as u64;
            let (near, mut hits) = node.intersect(&slabs, *t_max);
            let mut taken = None::<Pending>;
            let floor = stack.len();
            while hits != 0 {
                let lane = hits.trailing_zeros() as usize;
                hits &= hits - 1;
                let this = Pending { near: near[lane], child: node.child(lane) };
                // The nearest stays in hand; the others wait in order.
                taken = match taken {
                    None => Some(this),
                    Some(held) if this.near < held.near => {
                        stack.push_above(floor, held);
                        Some(this)
                    }
                    held => {
                        stack.push_above(floor, this);
                        held
                    }
                };
            }
            next = taken.or_else(|| stack.pop());
        }
        ControlFlow::Continue(())
    }
}

#[derive(Clone, Copy)]
struct Pending {
    near: f32,
    child: Child,
}

/// What waits to be visited, the nearest on top. Few rays ever need more than the array.
struct Stack {
    array: [Pending; Stack::ARRAY],
    len: usize,
    overflow: Vec<Pending>,
}

impl Stack {
    const ARRAY: usize = 32;

    #[inline]
    fn new() -> Self {
        let nothing = Pending { near: 0.0, child: Child { first: 0, blocks: 0 } };
        Self { array: [nothing; Self::ARRAY], len: 0, overflow: Vec::new() }
    }

    #[inline]
    fn len(&self) -> usize {
        self.len
    }

    /// Pushes, and sinks the entry below those above `floor` that are nearer.
    #[inline]
    fn push_above(&mut self, floor: usize, entry: Pending) {
        if self.len == Self::ARRAY {
            self.overflow.push(entry);
            return;
        }
        let mut at = self.len;
        while at > floor && self.array[at - 1].near < entry.near {
            self.array[at] = self.array[at - 1];
            at -= 1;
        }
        self.array[at] = entry;
        self.len += 1;
    }

    #[inline]
    fn pop(&mut self) -> Option<Pending> {
        if let Some(entry) = self.overflow.pop() {
            return Some(entry);
        }
        self.len = self.len.checked_sub(1)?;
        Some(self.array[self.len])
    }
}
