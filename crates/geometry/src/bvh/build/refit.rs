//! New boxes for a tree whose primitives have moved.
//!
//! The order of nodes and blocks is the one in which [`super::widen`] wrote them: a subtree is one range of
//! either, and begins where the one before it ends.

use super::reference::Extent;
use crate::bvh::node::{Child, WideNode};
use math::Bounds3;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::ops::Range;

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

/// A subtree: all of its nodes, the root first, and all of its blocks. One without nodes is a leaf.
struct Part<'a, B> {
    nodes: &'a mut [WideNode],
    first_node: usize,
    blocks: &'a mut [B],
    first_block: usize,
}

impl<B: Send> Part<'_, B> {
    fn refit(mut self, renew: &(impl Fn(&mut B) -> Bounds3 + Sync)) -> Extent {
        match self.nodes.len() {
            0 => self.refit_leaf(self.first_block..self.first_block + self.blocks.len(), renew),
            1..=PARALLEL => self.refit_node(self.first_node, renew),
            _ => self.refit_in_parallel(renew),
        }
    }

    fn refit_leaf(&mut self, blocks: Range<usize>, renew: &impl Fn(&mut B) -> Bounds3) -> Extent {
        let blocks = &mut self.blocks[blocks.start - self.first_block..blocks.end - self.first_block];
        blocks.iter_mut().map(|block| Extent::from(&renew(block))).fold(Extent::EMPTY, Extent::union)
    }

    fn refit_node(&mut self, index: usize, renew: &impl Fn(&mut B) -> Bounds3) -> Extent {
        let node = index - self.first_node;
        let mut all = Extent::EMPTY;
        for lane in 0..self.nodes[node].len() {
            let child = self.nodes[node].children()[lane];
            let extent = match child.is_leaf() {
                true => self.refit_leaf(child.blocks(), renew),
                false => self.refit_node(child.index(), renew),
            };
            self.nodes[node].set_bounds(lane, &extent.bounds());
            all = all.union(extent);
        }
        all
    }

    fn refit_in_parallel(mut self, renew: &(impl Fn(&mut B) -> Bounds3 + Sync)) -> Extent {
        let place = |(lane, &child)| (self.first_block_of(child), lane, child);
        let root = &self.nodes[0];
        let mut children: Vec<_> = root.children()[..root.len()].iter().enumerate().map(place).collect();
        children.sort_unstable_by_key(|&(first_block, ..)| Reverse(first_block));
        let parts: Vec<_> = children
            .into_iter()
            .map(|(first_block, lane, child)| {
                let first_node =
                    if child.is_leaf() { self.first_node + self.nodes.len() } else { child.index() };
                (lane, self.split_off(first_node, first_block))
            })
            .collect();
        let refit = |(lane, part): (usize, Part<B>)| (lane, part.refit(renew));
        let extents: Vec<_> = parts.into_par_iter().map(refit).collect();
        let mut all = Extent::EMPTY;
        for (lane, extent) in extents {
            self.nodes[0].set_bounds(lane, &extent.bounds());
            all = all.union(extent);
        }
        all
    }

    /// Where the blocks below a child begin.
    fn first_block_of(&self, mut child: Child) -> usize {
        let mut first = usize::MAX;
        while !child.is_leaf() {
            let node = &self.nodes[child.index() - self.first_node];
            let children = &node.children()[..node.len()];
            let (leaves, nodes): (Vec<Child>, Vec<Child>) =
                children.iter().partition(|child| child.is_leaf());
            first = leaves.iter().map(|leaf| leaf.blocks().start).fold(first, usize::min);
            match nodes.into_iter().min_by_key(|node| node.index()) {
                Some(node) => child = node,
                None => return first,
            }
        }
        first.min(child.blocks().start)
    }
}

impl<'a, B> Part<'a, B> {
    /// Takes what begins with a node and a block.
    fn split_off(&mut self, first_node: usize, first_block: usize) -> Part<'a, B> {
        let (earlier_nodes, nodes) =
            std::mem::take(&mut self.nodes).split_at_mut(first_node - self.first_node);
        let (earlier_blocks, blocks) =
            std::mem::take(&mut self.blocks).split_at_mut(first_block - self.first_block);
        (self.nodes, self.blocks) = (earlier_nodes, earlier_blocks);
        Part { nodes, first_node, blocks, first_block }
    }
}
