//! A tree of boxes over anything that has bounds.
//!
//! Four things are kept apart: how to split is [`build`]'s affair, what a node is [`node`]'s, how
//! rays pass [`traverse`]'s, and what a leaf tests is left to the caller. A leaf is a range of
//! *blocks*, each of a fixed number of primitives, so that a caller may test a block at once.
//!
//! The tree depends on the primitives alone, never on the number of threads that built it.

mod build;
mod node;
mod traverse;

use math::Bounds3;
pub(crate) use node::WIDTH;
use node::WideNode;

pub use build::BuildQuality;
pub(crate) use build::{Extent, Primitives, Reference};
pub(crate) use traverse::Leaves;

/// The most nodes above each other that a tree may have, for which rays have room to remember where
/// to return.
const MAX_DEPTH: usize = 96;

/// The tree.
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    nodes: Vec<WideNode>,
    bounds: Bounds3,
}

impl Bvh {
    /// Builds a tree, and the blocks of its leaves.
    pub fn build<P: Primitives>(primitives: &P, quality: BuildQuality) -> (Self, Vec<P::Block>) {
        let built = build::build(primitives, quality);
        assert!(built.depth <= MAX_DEPTH, "splits halve sets that are deep");
        (Self { bounds: built.bounds, nodes: built.nodes }, built.blocks)
    }

    /// New boxes for primitives that have moved. `renew` brings a block up to date and gives its
    /// box.
    pub fn refit<B: Send>(&mut self, blocks: &mut [B], renew: impl Fn(&mut B) -> Bounds3 + Sync) {
        self.bounds = build::refit(&mut self.nodes, blocks, renew);
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
