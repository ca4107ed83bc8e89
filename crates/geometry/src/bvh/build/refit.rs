//! New boxes for a tree whose primitives have moved.
//!
//! The order of nodes and blocks is the one in which [`super::widen`] wrote them: a subtree is one range of
//! either, and begins where the one before it ends.

use super::reference::Extent;
use crate::bvh::node::{Child, WideNode};
use math::Bounds3;
use rayon::prelude::*;

/// Smaller subtrees are not worth another thread.
const PARALLEL: usize = 256;

/// Gives all nodes new boxes, from the leaves upwards. `renew` brings a block up to date and gives its box.
pub(crate) fn refit<B: Send>(
    nodes: &mut [WideNode],
    blocks: &mut [B],
    renew: &(impl Fn(&mut B) -> Bounds3 + Sync),
) -> Bounds3 {
    match nodes.is_empty() {
        true => Bounds3::EMPTY,
        false => Part { nodes, first_node: 0, blocks, first_block: 0 }.refit(renew).bounds(),
    }
}

/// A subtree: all of its nodes, the root first, and all of its blocks.
struct Part<'a, B> {
    nodes: &'a mut [WideNode],
    first_node: usize,
    blocks: &'a mut [B],
    first_block: usize,
}

impl<'a, B: Send> Part<'a, B> {
    fn refit(mut self, renew: &(impl Fn(&mut B) -> Bounds3 + Sync)) -> Extent {
        let parallel = self.nodes.len() > PARALLEL;
        let root = self.take(self.first_node + 1, self.first_block).nodes;
        let node = &mut root[0];
        let children = in_order(node);
        let mut all = Extent::EMPTY;
        let mut set = |lane, extent: Extent| {
            node.set_bounds(lane, &extent.bounds());
            all = all.union(extent);
        };
        let mut below = Vec::new();
        for (i, &(lane, child)) in children.iter().enumerate() {
            if child.is_leaf() {
                let leaf = self.take(self.first_node, child.blocks().end);
                let boxes = leaf.blocks.iter_mut().map(|block| Extent::from(&renew(block)));
                set(lane, boxes.fold(Extent::EMPTY, Extent::union));
                continue;
            }
            let part = match children.get(i + 1) {
                Some(&(_, next)) => {
                    let end = self.first_block_of(next);
                    self.take(next.index(), end)
                }
                None => self.take(self.first_node + self.nodes.len(), self.first_block + self.blocks.len()),
            };
            match parallel {
                true => below.push((lane, part)),
                false => set(lane, part.refit(renew)),
            }
        }
        let extents: Vec<_> = below.into_par_iter().map(|(lane, part)| (lane, part.refit(renew))).collect();
        extents.into_iter().for_each(|(lane, extent)| set(lane, extent));
        all
    }

    /// Where the blocks below a child begin.
    fn first_block_of(&self, mut child: Child) -> usize {
        while !child.is_leaf() {
            let node = &self.nodes[child.index() - self.first_node];
            let children = node.children()[..node.len()].iter();
            child = children.copied().min_by_key(place).expect("invariant: a node has children");
        }
        child.blocks().start
    }

    /// Takes the front, up to a node and a block.
    fn take(&mut self, node: usize, block: usize) -> Part<'a, B> {
        let (nodes, later_nodes) = std::mem::take(&mut self.nodes).split_at_mut(node - self.first_node);
        let (blocks, later_blocks) = std::mem::take(&mut self.blocks).split_at_mut(block - self.first_block);
        let taken = Part { nodes, blocks, ..*self };
        *self = Part { nodes: later_nodes, first_node: node, blocks: later_blocks, first_block: block };
        taken
    }
}

/// The children of a node with their lanes, in the order in which they were written.
fn in_order(node: &WideNode) -> Vec<(usize, Child)> {
    let mut children: Vec<_> = node.children()[..node.len()].iter().copied().enumerate().collect();
    children.sort_by_key(|(_, child)| place(child));
    children
}

/// Where a child is: leaves come first, each kind in the order of its indices.
fn place(child: &Child) -> (bool, usize) {
    match child.is_leaf() {
        true => (false, child.blocks().start),
        false => (true, child.index()),
    }
}
