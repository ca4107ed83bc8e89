//! A tree of boxes over anything that has bounds.
//!
//! Four things are kept apart: how to split is [`split`]'s affair, what a node is [`node`]'s, how rays pass
//! [`traverse`]'s, and what a leaf tests is left to the caller. A leaf is a range of *blocks*, each of a fixed
//! number of primitives, so that a caller may test a block at once. [`Bvh::order`] says which primitive stands
//! at each place.
//!
//! The tree depends on the primitives alone, never on the number of threads that built it.

mod node;
mod split;
mod traverse;

use math::Bounds3;
use node::WideNode;

pub(crate) use split::Primitive;
pub(crate) use traverse::Leaves;

/// The most nodes above each other that a tree may have, for which rays have room to remember where to return.
const MAX_DEPTH: usize = 96;

/// The tree.
#[derive(Clone, Debug)]
pub(crate) struct Bvh {
    nodes: Vec<WideNode>,
    order: Vec<Option<u32>>,
    bounds: Bounds3,
}

impl Bvh {
    /// Builds over primitives with finite bounds; leaves hold blocks of `block` primitives.
    pub fn build(mut primitives: Vec<Primitive>, block: usize) -> Self {
        let mut bvh = Self { nodes: Vec::new(), order: Vec::new(), bounds: Bounds3::EMPTY };
        if primitives.is_empty() {
            return bvh;
        }
        let tree = split::split(&mut primitives, block);
        bvh.bounds = tree.bounds();
        bvh.nodes.push(WideNode::EMPTY);
        let depth = node::widen(&tree, &primitives, block, &mut bvh.nodes, &mut bvh.order, 0);
        assert!(depth <= MAX_DEPTH, "splits halve sets that are deep");
        bvh
    }

    /// Which primitive stands at each place of the blocks; `None` fills up a block.
    pub fn order(&self) -> &[Option<u32>] {
        &self.order
    }

    /// The box around everything.
    pub fn bounds(&self) -> Bounds3 {
        self.bounds
    }
}
