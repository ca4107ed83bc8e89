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

#![allow(unsafe_code)]

use super::pages::{self, Zeroable};
use super::reference::Extent;
use super::tree::{BinaryTree, Blocks, Cut, InnerNode, Size};
use crate::bvh::node::{Child, WIDTH, WideNode};
use math::Bounds3;
use rayon::prelude::*;
use std::marker::PhantomData;
use std::mem::MaybeUninit;
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

/// Wide nodes.
pub(super) struct Wide {
    pub nodes: Vec<WideNode>,
    pub extent: Extent,
    /// The number of levels of nodes.
    pub depth: usize,
}

/// Makes the blocks of leaves.
pub(super) trait Leaves<T, B>: Sync {
    /// Makes the block with this index of the first `len` items. More may follow, of which the next
    /// blocks will be made.
    fn block(&self, items: &[T], len: usize, index: usize) -> B;

    /// The boxes of primitives of a leaf.
    fn boxes(&self, items: &[T]) -> Boxes;
}

/// The boxes of a leaf's primitives: the box around them, and the sum of half their areas.
pub(super) struct Boxes {
    extent: Extent,
    half_area: f32,
}

impl Boxes {
    #[inline(always)]
    pub fn of(extents: impl Iterator<Item = Extent>) -> Self {
        let start = Self { extent: Extent::EMPTY, half_area: 0.0 };
        extents.fold(start, |all, extent| Self {
            extent: all.extent.union(extent),
            half_area: all.half_area + extent.half_area(),
        })
    }
}

/// Collapses a binary tree. The blocks of its leaves are appended to `list`, which is empty and has
/// capacity for them. Items and binary nodes are freed while nodes and blocks are written.
pub(super) fn widen<T: Zeroable + Send + Sync, B: Send>(
    tree: BinaryTree<T>,
    blocks: Blocks,
    list: &mut Vec<B>,
    leaves: &impl Leaves<T, B>,
) -> Wide {
    let BinaryTree { mut items, mut inner, root, size } = tree;
    if items.is_empty() {
        return Wide { nodes: Vec::new(), extent: Extent::EMPTY, depth: 0 };
    }
    let whole = Branch { range: 0..items.len() as u32, root };
    let mut nodes = pages::filled(WideNode::EMPTY, size.nodes as usize);
    let spare = &mut list.spare_capacity_mut()[..size.blocks as usize];
    let part = Part { nodes: &mut nodes, first_node: 0, blocks: spare, first_block: 0 };
    let binary = Binary { items: &mut items, inner: &mut inner, first: 0 };
    let Summary { extent, depth, .. } =
        Writer { blocks, leaves, of: PhantomData }.write(&whole, binary, part);
    // SAFETY: all are written: a node divides all of its blocks ([`finish`] asserts it) among nodes
    // and leaves, and a leaf writes each of its own.
    unsafe { list.set_len(size.blocks as usize) };
    Wide { nodes, extent, depth }
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
    fn below<T>(tree: &View<T>, node: &Branch) -> Self {
        let mut branches = Self::default();
        match node.root {
            0 => branches.push(node.clone()),
            root => branches.open(tree, node, tree.node(root).open()),
        }
        branches
    }

    fn open<T>(&mut self, tree: &View<T>, node: &Branch, shares: [usize; 2]) {
        let border = node.root;
        let ranges = [node.range.start..border, border..node.range.end];
        let halves = tree.node(border).halves;
        for ((range, root), share) in ranges.into_iter().zip(halves).zip(shares) {
            let half = Branch { range, root };
            match root {
                0 => self.push(half),
                _ => match tree.node(root).cut(share) {
                    Cut::Leaf => self.push(Branch { root: 0, ..half }),
                    Cut::Node => self.push(half),
                    Cut::Opened(shares) => self.open(tree, &half, shares),
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

/// A part of a binary tree: items, the inner nodes at their indices, and the index of the first.
struct Binary<'a, T> {
    items: &'a mut [T],
    inner: &'a mut [InnerNode],
    first: u32,
}

impl<'a, T> Binary<'a, T> {
    /// Takes a number of items from the front.
    fn take(&mut self, len: u32) -> Self {
        let (items, later_items) = std::mem::take(&mut self.items).split_at_mut(len as usize);
        let (inner, later_inner) = std::mem::take(&mut self.inner).split_at_mut(len as usize);
        let taken = Self { items, inner, ..*self };
        *self = Self { items: later_items, inner: later_inner, first: self.first + len };
        taken
    }

    fn view(&self) -> View<'_, T> {
        View { items: self.items, inner: self.inner, first: self.first }
    }
}

/// A shared borrow of a [`Binary`].
struct View<'a, T> {
    items: &'a [T],
    inner: &'a [InnerNode],
    first: u32,
}

impl<T> View<'_, T> {
    fn node(&self, border: u32) -> &InnerNode {
        &self.inner[(border - self.first) as usize]
    }
}

/// The part of the arrays that a subtree is written to.
struct Part<'a, B> {
    nodes: &'a mut [WideNode],
    first_node: u32,
    blocks: &'a mut [MaybeUninit<B>],
    first_block: u32,
}

impl<B> Part<'_, B> {
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

    fn leaf(Boxes { extent, half_area }: Boxes, cost: f32) -> Self {
        Self { extent, depth: 0, probability: area_ratio(half_area, &extent), cost }
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

struct Writer<'a, L, T, B> {
    blocks: Blocks,
    leaves: &'a L,
    of: PhantomData<fn(T, B)>,
}

impl<L: Leaves<T, B>, T: Zeroable + Send + Sync, B: Send> Writer<'_, L, T, B> {
    /// Writes a node and all below it, and frees its part of the binary tree.
    fn write(&self, node: &Branch, tree: Binary<T>, mut part: Part<B>) -> Summary {
        if node.len() <= PARALLEL {
            return self.write_serially(node, &tree.view(), part);
        }
        let branches = Branches::below(&tree.view(), node);
        let here = part.take(Size { nodes: 1, blocks: 0 });
        let mut children = [(Summary::EMPTY, Child::EMPTY); WIDTH];
        let children = &mut children[..branches.len];
        let mut rest = Binary { items: &mut *tree.items, inner: &mut *tree.inner, first: tree.first };
        let mut below = Vec::new();
        for (branch, (written, child)) in branches.list().iter().zip(&mut *children) {
            let tree = rest.take(branch.len());
            if branch.root == 0 {
                (*written, *child) = self.write_leaf(branch, &tree.view(), &mut part);
            } else {
                let mine = part.take(tree.view().node(branch.root).as_node());
                *child = Child::node(mine.first_node as usize);
                below.push((written, branch, tree, mine));
            }
        }
        below
            .into_par_iter()
            .for_each(|(written, branch, tree, mine)| *written = self.write(branch, tree, mine));
        pages::release(tree.items);
        pages::release(tree.inner);
        finish(here, children, &part)
    }

    fn write_serially(&self, node: &Branch, tree: &View<T>, mut part: Part<B>) -> Summary {
        let branches = Branches::below(tree, node);
        let here = part.take(Size { nodes: 1, blocks: 0 });
        let mut children = [(Summary::EMPTY, Child::EMPTY); WIDTH];
        let children = &mut children[..branches.len];
        for (branch, (written, child)) in branches.list().iter().zip(&mut *children) {
            if branch.root == 0 {
                (*written, *child) = self.write_leaf(branch, tree, &mut part);
            } else {
                let mine = part.take(tree.node(branch.root).as_node());
                *child = Child::node(mine.first_node as usize);
                *written = self.write_serially(branch, tree, mine);
            }
        }
        finish(here, children, &part)
    }

    /// Writes the blocks of a leaf.
    fn write_leaf(&self, leaf: &Branch, tree: &View<T>, part: &mut Part<B>) -> (Summary, Child) {
        let count = self.blocks.count(leaf.len());
        let mine = part.take(Size { nodes: 0, blocks: count });
        let items = &tree.items[(leaf.range.start - tree.first) as usize..];
        let (len, width, first) = (leaf.len() as usize, self.blocks.width(), mine.first_block as usize);
        for (i, block) in mine.blocks.iter_mut().enumerate() {
            let start = i * width;
            block.write(self.leaves.block(&items[start..], width.min(len - start), first + i));
        }
        let boxes = self.leaves.boxes(&items[..len]);
        (Summary::leaf(boxes, self.blocks.cost(count)), Child::leaf(first, count as usize))
    }
}

/// Writes a node over children. `rest` is the part that these left unwritten: nothing.
fn finish<B>(here: Part<B>, children: &mut [(Summary, Child)], rest: &Part<B>) -> Summary {
    assert!(rest.blocks.is_empty(), "each block belongs to a leaf");
    children.sort_by(|(a, _), (b, _)| a.priority().total_cmp(&b.priority()));
    let mut wide = WideNode::EMPTY;
    children.iter().for_each(|(below, child)| wide.push(&below.extent.bounds(), *child));
    here.nodes[0] = wide;
    Summary::node(children)
}
