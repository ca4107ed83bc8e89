//! A bounding volume hierarchy over primitives of any kind.
//!
//! [`build`] makes the tree, [`node`] has its nodes, and [`traverse`] traverses it; the caller
//! tests the leaves. A leaf is a range of *blocks*, each of a fixed number of primitives that are
//! tested at once.
//!
//! The tree depends on the primitives alone, not on the number of threads that build it.

mod build;
mod node;
mod packet;
mod traverse;

use math::Bounds3;
use node::WideNode;
pub(crate) use node::{Child, RaySlabs, WIDTH};
pub(crate) use packet::Packet;

pub use build::BuildQuality;
pub(crate) use build::{Extent, Primitives, Reference};
pub(crate) use traverse::{Leaves, PacketLeaves};

/// The maximum depth of a tree, which bounds the traversal stack.
const MAX_DEPTH: usize = 96;

/// A bounding volume hierarchy.
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    nodes: Vec<WideNode>,
    bounds: Bounds3,
}

impl Bvh {
    /// Builds a tree, and the blocks of its leaves.
    pub fn build<P: Primitives>(primitives: &P, quality: BuildQuality) -> (Self, Vec<P::Block>) {
        let built = build::build(primitives, quality);
        assert!(built.depth <= MAX_DEPTH, "deep sets are split at the median");
        (Self { bounds: built.bounds, nodes: built.nodes }, built.blocks)
    }

    /// Updates all boxes after primitives have moved. `reload` updates a block and returns its box.
    pub fn refit<B: Send>(&mut self, blocks: &mut [B], reload: impl Fn(&mut B) -> Bounds3 + Sync) {
        self.bounds = build::refit(&mut self.nodes, blocks, reload);
    }

    /// Bytes of memory.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.nodes)
    }

    /// The nodes, of which the first is the root.
    pub fn nodes(&self) -> &[WideNode] {
        &self.nodes
    }

    /// The area of the boxes of all children, to which the number of boxes that a ray enters is
    /// proportional.
    pub fn area(&self) -> f64 {
        let boxes = self.nodes.iter().flat_map(WideNode::boxes);
        boxes.map(|(bounds, _)| f64::from(bounds.surface_area())).sum()
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }
}
