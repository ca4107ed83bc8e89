//! Collapsing the binary tree into wide nodes.
//!
//! Nodes are written in depth-first order, the blocks of the leaves in the order of the references.
//! The sizes of subtrees are known beforehand, so that threads can write to parts of one array.
//!
//! The children of a node are ordered for rays that look for any hit, which visit the last one
//! first: by the probability of a hit in a box that the ray enters, over the expected cost of the
//! traversal there ([Ize & Hansen 2011]). For a leaf the probability is the ratio of the areas of
//! the primitives' boxes and of its own, and the cost that of its blocks; for a node both follow
//! from the children, each of which is entered with the probability of the ratio of areas.

use super::pages;
use super::reference::{Extent, Reference};
use super::tree::{BinaryTree, Blocks, Cut, InnerNode, Size};
use crate::bvh::node::{Child, WIDTH, WideNode};
use math::Bounds3;
use rayon::prelude::*;
use std::ops::Range;

/// Smaller ranges are not split between threads.
const PARALLEL: u32 = 4096;

/// A finished tree and the blocks of its leaves.
pub(crate) struct Built<B> {
    pub nodes: Vec<WideNode>,
    pub bounds: Bounds3,
    /// The number of levels of nodes.
    pub depth: usize,
    /// In the order of the leaves.
    pub blocks: Vec<B>,
}

/// Wide nodes, and the range of references of each block.
pub(super) struct Wide {
    pub nodes: Vec<WideNode>,
    pub blocks: Vec<Range<u32>>,
    pub extent: Extent,
    /// The number of levels of nodes.
    pub depth: usize,
}

/// Collapses a binary tree.
pub(super) fn widen(tree: &BinaryTree, blocks: Blocks) -> Wide {
    let BinaryTree { references, inner, root, size } = tree;
    if references.is_empty() {
        return Wide { nodes: Vec::new(), blocks: Vec::new(), extent: Extent::EMPTY, depth: 0 };
    }
    let whole = Branch { range: 0..references.len() as u32, root: *root };
    let mut nodes = pages::filled(WideNode::EMPTY, size.nodes as usize);
    let mut list = pages::filled(0..0, size.blocks as usize);
    let part = Part { nodes: &mut nodes, first_node: 0, blocks: &mut list, first_block: 0 };
    let Summary { extent, depth, .. } = Writer { references, inner, blocks }.write(&whole, part);
    Wide { nodes, blocks: list, extent, depth }
}

/// A range of references, and where it is split; 0 for a leaf.
#[derive(Clone, Default)]
struct Branch {
    range: Range<u32>,
    root: u32,
}

impl Branch {
    fn len(&self) -> u32 {
        self.range.end - self.range.start
    }
}

/// The children of a wide node, in the order of the references.
#[derive(Default)]
struct Branches {
    list: [Branch; WIDTH],
    len: usize,
}

impl Branches {
    fn below(inner: &[InnerNode], node: &Branch) -> Self {
        let mut branches = Self::default();
        match node.root {
            0 => branches.push(node.clone()),
            root => branches.open(inner, node, inner[root as usize].open()),
        }
        branches
    }

    fn open(&mut self, inner: &[InnerNode], node: &Branch, shares: [usize; 2]) {
        let border = node.root;
        let ranges = [node.range.start..border, border..node.range.end];
        let halves = inner[border as usize].halves;
        for ((range, root), share) in ranges.into_iter().zip(halves).zip(shares) {
            let half = Branch { range, root };
            match root {
                0 => self.push(half),
                _ => match inner[root as usize].cut(share) {
                    Cut::Leaf => self.push(Branch { root: 0, ..half }),
                    Cut::Node => self.push(half),
                    Cut::Opened(shares) => self.open(inner, &half, shares),
                },
            }
        }
    }

    fn push(&mut self, branch: Branch) {
        self.list[self.len] = branch;
        self.len += 1;
    }

    fn list(&self) -> &[Branch] {
        &self.list[..self.len]
    }
}

/// The part of the arrays that a subtree is written to.
struct Part<'a> {
    nodes: &'a mut [WideNode],
    first_node: u32,
    blocks: &'a mut [Range<u32>],
    first_block: u32,
}

impl Part<'_> {
    /// Takes a part of a size from the front.
    fn take(&mut self, size: Size) -> Self {
        let (nodes, later_nodes) = std::mem::take(&mut self.nodes).split_at_mut(size.nodes as usize);
        let (blocks, later_blocks) = std::mem::take(&mut self.blocks).split_at_mut(size.blocks as usize);
        let taken = Self { nodes, blocks, ..*self };
        self.nodes = later_nodes;
        self.blocks = later_blocks;
        self.first_node += size.nodes;
        self.first_block += size.blocks;
        taken
    }
}

/// Facts about a subtree that has been written.
#[derive(Clone, Copy)]
struct Summary {
    extent: Extent,
    /// The number of levels of nodes.
    depth: usize,
    /// The probability that a ray through the box hits something, and the expected cost of the
    /// traversal.
    probability: f32,
    cost: f32,
}

impl Summary {
    const EMPTY: Self = Self { extent: Extent::EMPTY, depth: 0, probability: 0.0, cost: 0.0 };

    fn leaf(references: &[Reference], cost: f32) -> Self {
        let extent = Extent::around(references);
        let area: f32 = references.iter().map(|r| r.extent().half_area()).sum();
        Self { extent, depth: 0, probability: area_ratio(area, &extent), cost }
    }

    /// A node over children, which are visited from the last to the first.
    fn node(children: &[(Self, Child)]) -> Self {
        let extent = children.iter().fold(Extent::EMPTY, |all, (child, _)| all.union(child.extent));
        let depth = 1 + children.iter().map(|(child, _)| child.depth).max().unwrap_or(0);
        let (mut unhit, mut cost) = (1.0, 1.0);
        for (child, _) in children.iter().rev() {
            let entered = area_ratio(child.extent.half_area(), &extent);
            cost += unhit * entered * child.cost;
            unhit *= 1.0 - entered * child.probability;
        }
        Self { extent, depth, probability: 1.0 - unhit, cost }
    }

    fn priority(&self) -> f32 {
        self.probability / self.cost
    }
}

/// The fraction of rays through a box that meet a convex surface in it.
fn area_ratio(half_area: f32, extent: &Extent) -> f32 {
    let ratio = half_area / extent.half_area();
    // A box without area, or one too large for floats, may be hit with any probability.
    if ratio <= 1.0 { ratio } else { 1.0 }
}

struct Writer<'a> {
    references: &'a [Reference],
    inner: &'a [InnerNode],
    blocks: Blocks,
}

impl Writer<'_> {
    /// Writes a node and all below it.
    fn write(&self, node: &Branch, mut part: Part) -> Summary {
        let branches = Branches::below(self.inner, node);
        let here = part.take(Size { nodes: 1, blocks: 0 });
        let mut children = [(Summary::EMPTY, Child::EMPTY); WIDTH];
        let children = &mut children[..branches.len];
        let mut for_others = Vec::new();
        for (branch, (written, child)) in branches.list().iter().zip(&mut *children) {
            if branch.root == 0 {
                (*written, *child) = self.write_leaf(branch, &mut part);
                continue;
            }
            let mine = part.take(self.inner[branch.root as usize].as_node());
            *child = Child::node(mine.first_node as usize);
            match node.len() > PARALLEL {
                true => for_others.push((written, branch, mine)),
                false => *written = self.write(branch, mine),
            }
        }
        if !for_others.is_empty() {
            let write =
                |(written, branch, mine): (&mut Summary, &Branch, Part)| *written = self.write(branch, mine);
            for_others.into_par_iter().for_each(write);
        }
        children.sort_by(|(a, _), (b, _)| a.priority().total_cmp(&b.priority()));
        let mut wide = WideNode::EMPTY;
        children.iter().for_each(|(below, child)| wide.push(&below.extent.bounds(), *child));
        here.nodes[0] = wide;
        Summary::node(children)
    }

    /// Writes the blocks of a leaf.
    fn write_leaf(&self, leaf: &Branch, part: &mut Part) -> (Summary, Child) {
        let count = self.blocks.count(leaf.len());
        let mine = part.take(Size { nodes: 0, blocks: count });
        let starts = leaf.range.clone().step_by(self.blocks.width());
        for (block, start) in mine.blocks.iter_mut().zip(starts) {
            *block = start..(start + self.blocks.width() as u32).min(leaf.range.end);
        }
        let references = &self.references[leaf.range.start as usize..leaf.range.end as usize];
        (
            Summary::leaf(references, self.blocks.cost(count)),
            Child::leaf(mine.first_block as usize, count as usize),
        )
    }
}
