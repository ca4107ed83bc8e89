//! The binary tree that every builder makes, and the cheapest way to collapse it into wide nodes.
//!
//! The leaves of the tree are an array of references; each inner node divides a range of them in
//! two. An index can be a border only once, so that an inner node is stored at the index of its
//! border, and threads that work on different ranges write to different parts of one array.
//!
//! A wide node replaces a connected part of the binary tree with at most [`WIDTH`] branches. The
//! parts that are cheapest to trace are found from the leaves upwards: the cost C(n, i) of
//! representing what is below n by at most i children of some wide node is C(n, 1) = min(A·c·blocks
//! (if that is a leaf), A + min_k C(l, k) + C(r, WIDTH − k)), C(n, i) = min(C(n, i − 1), min_k C(l,
//! k) + C(r, i − k)) with the area A of its box and the cost c of a block, where the test of a wide
//! node costs 1 ([Ylitie et al. 2017 §3.1]).

#![allow(unsafe_code)]

use super::pages::Zeroable;
use super::reference::Extent;
use crate::bvh::node::WIDTH;

/// The most blocks of a leaf.
const MAX_LEAF_BLOCKS: u32 = 4;

/// The number of primitives in a block, a power of two, and the cost of testing one.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Blocks {
    log2: u32,
    cost: f32,
}

impl Blocks {
    pub fn of(width: usize, cost: f32) -> Self {
        Self { log2: width.ilog2(), cost }
    }

    pub fn width(&self) -> usize {
        1 << self.log2
    }

    /// The cost of testing a number of blocks.
    #[inline]
    pub fn cost(&self, blocks: u32) -> f32 {
        blocks as f32 * self.cost
    }

    /// The number of blocks for a number of primitives.
    #[inline]
    pub fn count(&self, primitives: u32) -> u32 {
        (primitives + (1 << self.log2) - 1) >> self.log2
    }
}

/// An inner node of the binary tree. It is stored where its right half begins.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct InnerNode {
    /// The borders that divide the halves; 0 for a half that is not divided.
    pub halves: [u32; 2],
    /// Four bits for each number of branches i ≥ 2: the number for the left half, 0 if i − 1
    /// branches are as cheap. A branch of a wide node never has all of its branches: the last bits
    /// are the number for the left half of a wide node here. Bit 0 is set if one branch here is a
    /// leaf.
    plan: u64,
    /// The size of the collapsed tree below this if it becomes a wide node.
    pub below: Size,
}

// SAFETY: all fields are integers.
unsafe impl Zeroable for InnerNode {}

/// The size of a collapsed tree.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Size {
    pub nodes: u32,
    pub blocks: u32,
}

impl Size {
    pub fn plus(self, other: Self) -> Self {
        Self { nodes: self.nodes + other.nodes, blocks: self.blocks + other.blocks }
    }
}

/// What a binary node becomes.
pub(super) enum Cut {
    Leaf,
    Node,
    /// The numbers of branches of the left and right half.
    Opened([usize; 2]),
}

impl InnerNode {
    /// What this node becomes when it may take `branches`.
    #[inline]
    pub fn cut(&self, mut branches: usize) -> Cut {
        while branches > 1 {
            let left = (self.plan >> (4 * (branches - 1))) as usize & 15;
            if left > 0 {
                return Cut::Opened([left, branches - left]);
            }
            branches -= 1;
        }
        if self.plan & 1 == 1 { Cut::Leaf } else { Cut::Node }
    }

    /// Whether a node is stored here.
    pub fn is_used(&self) -> bool {
        self.plan != 0
    }

    /// The numbers of branches of both halves if this is a wide node.
    #[inline]
    pub fn open(&self) -> [usize; 2] {
        let left = (self.plan >> (4 * (WIDTH - 1))) as usize;
        [left, WIDTH - left]
    }

    /// The size of the collapsed tree if this is a wide node.
    pub fn as_node(&self) -> Size {
        Size { nodes: self.below.nodes + 1, ..self.below }
    }
}

/// Sorted primitives, and the binary tree over them.
pub(super) struct BinaryTree<T> {
    /// References, or ids alone.
    pub items: Vec<T>,
    pub inner: Vec<InnerNode>,
    /// The border of the root; 0 for a leaf.
    pub root: u32,
    /// The size of the collapsed tree, which has at least one wide node.
    pub size: Size,
}

/// The binary tree over a range of references.
#[derive(Clone, Copy)]
pub(super) struct Subtree {
    /// The border of its root; 0 for a leaf.
    pub root: u32,
    pub count: u32,
    pub extent: Extent,
    /// C(n, i + 1) at index i; the last is unused, as a branch of a wide node never has all of its
    /// branches.
    cost: [f32; WIDTH],
    /// The size of the collapsed tree with i + 1 branches.
    size: [Size; WIDTH],
}

impl Subtree {
    pub fn leaf(extent: Extent, count: u32, blocks: Blocks) -> Self {
        let cost = extent.half_area() * blocks.cost(blocks.count(count));
        let size = Size { nodes: 0, blocks: blocks.count(count) };
        Self { root: 0, count, extent, cost: [cost; WIDTH], size: [size; WIDTH] }
    }

    /// Joins two neighbours at `border`.
    pub fn join(left: &Self, right: &Self, border: usize, blocks: Blocks) -> (Self, InnerNode) {
        let extent = left.extent.union(right.extent);
        let count = left.count + right.count;
        let (shared_cost, left_shares) = share(left, right);
        let size_of = |left_share: u32, branches: usize| {
            left.size[left_share as usize - 1].plus(right.size[branches - left_share as usize - 1])
        };
        let below = size_of(left_shares[WIDTH - 1], WIDTH);
        let mut plan = u64::from(left_shares[WIDTH - 1]) << (4 * (WIDTH - 1));
        let as_node = extent.half_area() + shared_cost[WIDTH - 1];
        let as_leaf = extent.half_area() * blocks.cost(blocks.count(count));
        let is_leaf = blocks.count(count) <= MAX_LEAF_BLOCKS && as_leaf <= as_node;
        let (one, one_size) = if is_leaf {
            plan |= 1;
            (as_leaf, Size { nodes: 0, blocks: blocks.count(count) })
        } else {
            (as_node, Size { nodes: below.nodes + 1, ..below })
        };
        let mut cost = [one; WIDTH];
        let mut size = [one_size; WIDTH];
        for i in 1..WIDTH - 1 {
            let (opened, left_share) = (shared_cost[i], left_shares[i]);
            if opened > cost[i - 1] {
                (cost[i], size[i]) = (cost[i - 1], size[i - 1]);
            } else {
                plan |= u64::from(left_share) << (4 * i);
                (cost[i], size[i]) = (opened, size_of(left_share, i + 1));
            }
        }
        let inner = InnerNode { halves: [left.root, right.root], plan, below };
        (Self { root: border as u32, count, extent, cost, size }, inner)
    }

    /// The size of the collapsed tree under a wide node here.
    pub fn as_node(&self, inner: &[InnerNode]) -> Size {
        match self.root {
            0 => Size { nodes: 1, ..self.size[0] },
            root => inner[root as usize].as_node(),
        }
    }
}

/// At index i − 1: the cost of sharing i branches between two neighbours, and the number for the
/// left.
fn share(left: &Subtree, right: &Subtree) -> ([f32; WIDTH], [u32; WIDTH]) {
    // What is one branch anyway gets one.
    let mut cost = [f32::INFINITY; WIDTH];
    if left.root == 0 {
        cost[1..].copy_from_slice(&right.cost[..WIDTH - 1]);
        return (cost.map(|cost| left.cost[0] + cost), [1; WIDTH]);
    }
    if right.root == 0 {
        cost[1..].copy_from_slice(&left.cost[..WIDTH - 1]);
        return (cost.map(|cost| cost + right.cost[0]), std::array::from_fn(|i| (i as u32).max(1)));
    }
    // All i at a time, so that this becomes vector code without a branch: the right half has no
    // cost for less than one branch.
    let mut right_cost = [f32::INFINITY; 2 * WIDTH];
    right_cost[WIDTH..].copy_from_slice(&right.cost);
    let mut left_shares = [1; WIDTH];
    for k in 1..WIDTH {
        for i in 0..WIDTH {
            let shared = left.cost[k - 1] + right_cost[WIDTH + i - k];
            let is_less = shared < cost[i];
            cost[i] = if is_less { shared } else { cost[i] };
            left_shares[i] = if is_less { k as u32 } else { left_shares[i] };
        }
    }
    (cost, left_shares)
}
