//! A tree of boxes over anything that has bounds.
//!
//! Four things are kept apart: how to split is [`build`]'s affair, what a node is [`node`]'s, how rays pass
//! [`traverse`]'s, and what a leaf tests is left to the caller. A leaf is a range of *blocks*, each of a fixed
//! number of primitives, so that a caller may test a block at once.
//!
//! The tree depends on the primitives alone, never on the number of threads that built it.

mod build;
mod node;
mod traverse;

use math::Bounds3;
pub(crate) use node::WIDTH;
use node::WideNode;
use rayon::prelude::*;

pub use build::BuildQuality;
use build::Corners;
pub(crate) use build::Reference;
pub(crate) use traverse::Leaves;

/// The most nodes above each other that a tree may have, for which rays have room to remember where to return.
const MAX_DEPTH: usize = 96;

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
        corners: impl Corners,
        block: impl Fn(&[Reference]) -> B + Sync + Send,
    ) -> (Self, Vec<B>) {
        let built = build::build(references, quality, width, corners);
        assert!(built.depth <= MAX_DEPTH, "splits halve sets that are deep");
        let blocks = built.blocks().map(block).collect();
        (Self { bounds: built.bounds, nodes: built.nodes }, blocks)
    }

    /// New boxes for primitives that have moved. `renew` brings a block up to date and gives its box.
    pub fn refit<B: Send>(&mut self, blocks: &mut [B], renew: impl Fn(&mut B) -> Bounds3 + Sync) {
        self.bounds = build::refit(&mut self.nodes, blocks, &renew);
    }

    /// Bytes of memory taken.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }
}
