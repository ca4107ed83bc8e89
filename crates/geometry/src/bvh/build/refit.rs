//! Refitting: new boxes for a tree whose primitives have moved.
//!
//! Blocks are reloaded in the order of memory, then nodes are updated from the leaves upwards:
//! [`super::widen`] writes nodes in depth-first order.

use super::reference::Extent;
use crate::bvh::node::WideNode;
use math::Bounds3;
use rayon::prelude::*;
use std::cmp::Reverse;

/// Fewer blocks or nodes are not split between threads.
const PARALLEL: usize = 256;

/// Updates the boxes of all nodes. `reload` updates a block and returns its box.
pub(crate) fn refit<B: Send>(
    nodes: &mut [WideNode],
    blocks: &mut [B],
    reload: impl Fn(&mut B) -> Bounds3 + Sync,
) -> Bounds3 {
    let reload = |block: &mut B| Extent::from(&reload(block));
    let blocks: Vec<_> = blocks.par_iter_mut().with_min_len(PARALLEL).map(reload).collect();
    refit_subtree(nodes, 0, &blocks);
    nodes.first().map_or(Bounds3::EMPTY, WideNode::bounds)
}

/// Updates the boxes of a subtree, whose root is the node `first` of the tree.
fn refit_subtree(nodes: &mut [WideNode], first: usize, blocks: &[Extent]) {
    if nodes.len() <= PARALLEL {
        (0..nodes.len()).rev().for_each(|node| refit_node(&mut nodes[node..], first + node, blocks));
        return;
    }
    let mut below: Vec<_> = nodes[0].children().iter().filter(|c| !c.is_leaf()).map(|c| c.index()).collect();
    below.sort_unstable_by_key(|&child| Reverse(child));
    let mut rest = &mut *nodes;
    let mut subtrees = Vec::new();
    for child in below {
        let (earlier, subtree) = rest.split_at_mut(child - first);
        subtrees.push((subtree, child));
        rest = earlier;
    }
    subtrees.into_par_iter().for_each(|(subtree, child)| refit_subtree(subtree, child, blocks));
    refit_node(nodes, first, blocks);
}

/// Updates the boxes of the first of some nodes, which is the node `first` of the tree.
fn refit_node(nodes: &mut [WideNode], first: usize, blocks: &[Extent]) {
    for lane in 0..nodes[0].len() {
        let child = nodes[0].children()[lane];
        let bounds = match child.is_leaf() {
            true => blocks[child.blocks()].iter().copied().fold(Extent::EMPTY, Extent::union).bounds(),
            false => nodes[child.index() - first].bounds(),
        };
        nodes[0].set_bounds(lane, &bounds);
    }
}
