//! Wide nodes taken apart: the children of each are joined in pairs, those first whose common box
//! is smallest.

use std::ops::Range;

use geometry::PlainTree;
use math::Bounds3;

use super::MOST_PRIMITIVES;

/// A binary tree.
#[derive(Debug, Default)]
pub struct Binary {
    nodes: Vec<BinaryNode>,
}

/// A node of a binary tree.
#[derive(Debug)]
pub struct BinaryNode {
    pub bounds: Bounds3,
    pub below: Below,
}

/// What is in a node.
#[derive(Clone, Debug)]
pub enum Below {
    Nodes([usize; 2]),
    Primitives(Range<usize>),
}

impl Binary {
    /// The tree with the same leaves.
    pub fn new(tree: &PlainTree) -> Self {
        let mut binary = Self::default();
        if !tree.nodes.is_empty() {
            binary.join(tree, 0);
        }
        binary
    }

    /// This tree and another one together, whose primitives come after the first `primitives` ones.
    pub fn and(mut self, tree: &PlainTree, primitives: usize) -> Self {
        let first = self.root();
        if tree.nodes.is_empty() {
            return self;
        }
        let joined = self.nodes.len();
        let second = self.join(tree, 0);
        for node in &mut self.nodes[joined..] {
            if let Below::Primitives(range) = &mut node.below {
                *range = range.start + primitives..range.end + primitives;
            }
        }
        if let Some(first) = first {
            let bounds = self.nodes[first].bounds.union(self.nodes[second].bounds);
            self.push(bounds, Below::Nodes([first, second]));
        }
        self
    }

    /// The root, which comes last, if there is anything.
    pub fn root(&self) -> Option<usize> {
        self.nodes.len().checked_sub(1)
    }

    pub fn node(&self, index: usize) -> &BinaryNode {
        &self.nodes[index]
    }

    fn push(&mut self, bounds: Bounds3, below: Below) -> usize {
        self.nodes.push(BinaryNode { bounds, below });
        self.nodes.len() - 1
    }

    /// Adds a leaf, in halves where a reference cannot have that many primitives: so many are at
    /// one place. Its index.
    fn add_leaf(&mut self, bounds: Bounds3, primitives: Range<usize>) -> usize {
        if primitives.len() <= MOST_PRIMITIVES {
            return self.push(bounds, Below::Primitives(primitives));
        }
        let middle = primitives.start + primitives.len() / 2;
        let halves = [primitives.start..middle, middle..primitives.end];
        let halves = halves.map(|half| self.add_leaf(bounds, half));
        self.push(bounds, Below::Nodes(halves))
    }

    /// Adds what is below a wide node; its index.
    fn join(&mut self, tree: &PlainTree, node: usize) -> usize {
        let children = tree.nodes[node].iter().map(|child| match child.node {
            Some(node) => self.join(tree, node),
            None => self.add_leaf(child.bounds, child.primitives.clone()),
        });
        let mut open: Vec<usize> = children.collect();
        while open.len() > 1 {
            let area = |i: usize, j: usize| {
                let joined = self.nodes[open[i]].bounds.union(self.nodes[open[j]].bounds);
                (joined.surface_area(), i, j)
            };
            let pairs = (0..open.len()).flat_map(|j| (0..j).map(move |i| (i, j)));
            let least = pairs.map(|(i, j)| area(i, j)).min_by(|a, b| a.0.total_cmp(&b.0));
            let Some((_, i, j)) = least else { break };
            let (second, first) = (open.swap_remove(j), open[i]);
            let bounds = self.nodes[first].bounds.union(self.nodes[second].bounds);
            open[i] = self.push(bounds, Below::Nodes([first, second]));
        }
        open[0]
    }
}
