//! From the binary tree to wide nodes.
//!
//! Nodes are written parent first, then the subtrees one after another, each as a whole; the blocks
//! of the leaves are written in the order of the references. The sizes of subtrees are known
//! before, so that threads can write to parts of one array.
//!
//! The children of a node are ordered by what they promise to a ray that looks for any hit, which
//! begins with the last: the chance of a hit in a box that the ray enters, over the expected cost
//! of the search there ([Ize & Hansen 2011]). In a leaf the chance is the ratio of the surfaces of
//! the primitives' boxes and of its own, and the cost its blocks; in a node, both follow from those
//! of the children, each of which is entered with the probability of the ratio of surfaces.

use super::pages;
use super::reference::{Extent, Reference};
use super::tree::{Blocks, Cut, Inner, Planted, Size};
use crate::bvh::node::{Child, WIDTH, WideNode};
use rayon::prelude::*;
use std::ops::Range;

/// Smaller ranges are not worth another thread.
const PARALLEL: u32 = 4096;

/// Wide nodes, and which references make each block.
pub(super) struct Wide {
    pub nodes: Vec<WideNode>,
    pub blocks: Vec<Range<u32>>,
    pub extent: Extent,
    /// How many nodes are above each other.
    pub depth: usize,
}

/// Cuts a binary tree.
pub(super) fn widen(planted: &Planted, blocks: Blocks) -> Wide {
    let Planted { references, inner, root, size } = planted;
    if references.is_empty() {
        return Wide { nodes: Vec::new(), blocks: Vec::new(), extent: Extent::EMPTY, depth: 0 };
    }
    let whole = Branch { range: 0..references.len() as u32, root: *root };
    let mut nodes = pages::filled(WideNode::EMPTY, size.nodes as usize);
    let mut list = pages::filled(0..0, size.blocks as usize);
    let part = Part { nodes: &mut nodes, first_node: 0, blocks: &mut list, first_block: 0 };
    let Written { extent, depth, .. } = Writer { references, inner, blocks }.write(&whole, part);
    Wide { nodes, blocks: list, extent, depth }
}

/// A range of references, and the border that divides it; 0 for a leaf.
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

/// What stands below a wide node, in the order of the references.
#[derive(Default)]
struct Branches {
    list: [Branch; WIDTH],
    len: usize,
}

impl Branches {
    fn below(inner: &[Inner], node: &Branch) -> Self {
        let mut branches = Self::default();
        match node.root {
            0 => branches.push(node.clone()),
            root => branches.open(inner, node, inner[root as usize].open()),
        }
        branches
    }

    fn open(&mut self, inner: &[Inner], node: &Branch, shares: [usize; 2]) {
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

/// The part of the arrays that a subtree goes to.
struct Part<'a> {
    nodes: &'a mut [WideNode],
    first_node: u32,
    blocks: &'a mut [Range<u32>],
    first_block: u32,
}

impl Part<'_> {
    /// Takes so much from the front.
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

/// What is known of a subtree once it is written.
#[derive(Clone, Copy)]
struct Written {
    extent: Extent,
    /// How many nodes are above each other.
    depth: usize,
    /// How probably a ray through the box hits something, and what it costs to know.
    chance: f32,
    cost: f32,
}

impl Written {
    const NOTHING: Self = Self { extent: Extent::EMPTY, depth: 0, chance: 0.0, cost: 0.0 };

    fn leaf(references: &[Reference], cost: f32) -> Self {
        let extent = Extent::around(references);
        let area: f32 = references.iter().map(|r| r.extent().half_area()).sum();
        Self { extent, depth: 0, chance: share(area, &extent), cost }
    }

    /// A node over children, the one to be visited first last.
    fn node(children: &[(Self, Child)]) -> Self {
        let extent = children.iter().fold(Extent::EMPTY, |all, (child, _)| all.union(child.extent));
        let depth = 1 + children.iter().map(|(child, _)| child.depth).max().unwrap_or(0);
        let (mut missed, mut cost) = (1.0, 1.0);
        for (child, _) in children.iter().rev() {
            let entered = share(child.extent.half_area(), &extent);
            cost += missed * entered * child.cost;
            missed *= 1.0 - entered * child.chance;
        }
        Self { extent, depth, chance: 1.0 - missed, cost }
    }

    fn promise(&self) -> f32 {
        self.chance / self.cost
    }
}

/// The part of rays through a box that pass a surface in it.
fn share(half_area: f32, extent: &Extent) -> f32 {
    let share = half_area / extent.half_area();
    // Of what has no surface, or none that floats can hold, nothing is known.
    if share <= 1.0 { share } else { 1.0 }
}

struct Writer<'a> {
    references: &'a [Reference],
    inner: &'a [Inner],
    blocks: Blocks,
}

impl Writer<'_> {
    /// Writes a node and all below it.
    fn write(&self, node: &Branch, mut part: Part) -> Written {
        let branches = Branches::below(self.inner, node);
        let here = part.take(Size { nodes: 1, blocks: 0 });
        let mut children = [(Written::NOTHING, Child::NOTHING); WIDTH];
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
                |(written, branch, mine): (&mut Written, &Branch, Part)| *written = self.write(branch, mine);
            for_others.into_par_iter().for_each(write);
        }
        children.sort_by(|(a, _), (b, _)| a.promise().total_cmp(&b.promise()));
        let mut wide = WideNode::EMPTY;
        children.iter().for_each(|(below, child)| wide.push(&below.extent.bounds(), *child));
        here.nodes[0] = wide;
        Written::node(children)
    }

    /// Writes the blocks of a leaf.
    fn write_leaf(&self, leaf: &Branch, part: &mut Part) -> (Written, Child) {
        let count = self.blocks.count(leaf.len());
        let mine = part.take(Size { nodes: 0, blocks: count });
        let starts = leaf.range.clone().step_by(self.blocks.width());
        for (block, start) in mine.blocks.iter_mut().zip(starts) {
            *block = start..(start + self.blocks.width() as u32).min(leaf.range.end);
        }
        let references = &self.references[leaf.range.start as usize..leaf.range.end as usize];
        (
            Written::leaf(references, self.blocks.cost(count)),
            Child::leaf(mine.first_block as usize, count as usize),
        )
    }
}
