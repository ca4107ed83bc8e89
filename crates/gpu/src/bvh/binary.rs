//! Wide nodes taken apart: the children of each are joined in pairs, those first whose common box
//! is smallest; and leaves, which have as many primitives as a processor tests at once, divided.

use std::ops::Range;

use geometry::{PlainChild, PlainTree};
use math::Bounds3;
use rayon::prelude::*;

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
    /// The tree with leaves of few primitives, which are brought into the order of leaves.
    /// Primitives whose box is unknown are taken to be as large as their leaf.
    pub fn new<T: Copy + Send + Sync>(
        tree: &PlainTree,
        mut primitives: &mut [T],
        bounds: impl Fn(&T) -> Option<Bounds3> + Sync,
    ) -> Self {
        let mut leaves: Vec<&PlainChild> =
            tree.nodes.iter().flatten().filter(|it| it.node.is_none()).collect();
        leaves.sort_unstable_by_key(|leaf| leaf.primitives.start);
        let all: usize = leaves.iter().map(|leaf| leaf.primitives.len()).sum();
        debug_assert_eq!(all, primitives.len(), "each primitive is in one leaf");
        let parts: Vec<&mut [T]> = leaves
            .iter()
            .map(|leaf| primitives.split_off_mut(..leaf.primitives.len()).unwrap_or_default())
            .collect();
        let divided = leaves.par_iter().zip(parts).map(|(leaf, part)| Self::of_leaf(leaf, part, &bounds));
        let divided: Vec<Self> = divided.collect();
        let mut binary = Self::default();
        if !tree.nodes.is_empty() {
            binary.join(tree, 0, &|leaf| {
                let place = leaves.partition_point(|it| it.primitives.start < leaf.primitives.start);
                &divided[place]
            });
        }
        binary
    }

    /// A tree over primitives with their boxes, which are brought into the order of leaves.
    pub fn over<T: Copy>(boxed: &mut [(Bounds3, T)]) -> Self {
        let mut binary = Self::default();
        if !boxed.is_empty() {
            binary.divide(boxed, 0);
        }
        binary
    }

    /// A leaf divided.
    fn of_leaf<T: Copy>(
        leaf: &PlainChild,
        primitives: &mut [T],
        bounds: impl Fn(&T) -> Option<Bounds3>,
    ) -> Self {
        // Of what was split by its builder, a leaf has a part.
        let inside = |primitive: &T| {
            let inside = bounds(primitive)?.intersection(leaf.bounds);
            (!inside.is_empty()).then_some(inside)
        };
        let boxed = primitives.iter().map(|it| (inside(it).unwrap_or(leaf.bounds), *it));
        let (mut binary, mut boxed) = (Self::default(), boxed.collect::<Vec<_>>());
        binary.divide(&mut boxed, leaf.primitives.start);
        primitives.iter_mut().zip(boxed).for_each(|(place, (_, primitive))| *place = primitive);
        binary
    }

    /// This tree and another one together, whose primitives come after the first `primitives` ones.
    pub fn and(mut self, other: &Self, primitives: usize) -> Self {
        let first = self.root();
        let second = self.append(other, primitives);
        if let (Some(first), Some(second)) = (first, second) {
            self.pair(first, second);
        }
        self
    }

    /// Adds the nodes of a tree whose primitives come after the first `primitives` ones; the index
    /// of its root.
    fn append(&mut self, other: &Self, primitives: usize) -> Option<usize> {
        let count = self.nodes.len();
        self.nodes.extend(other.nodes.iter().map(|node| {
            let below = match &node.below {
                Below::Nodes(halves) => Below::Nodes(halves.map(|half| half + count)),
                Below::Primitives(range) => {
                    Below::Primitives(range.start + primitives..range.end + primitives)
                }
            };
            BinaryNode { bounds: node.bounds, below }
        }));
        other.root().map(|root| root + count)
    }

    /// The root, which comes last, if there is anything.
    pub fn root(&self) -> Option<usize> {
        self.nodes.len().checked_sub(1)
    }

    /// The box of all.
    pub fn bounds(&self) -> Bounds3 {
        self.nodes.last().map_or(Bounds3::EMPTY, |root| root.bounds)
    }

    pub fn node(&self, index: usize) -> &BinaryNode {
        &self.nodes[index]
    }

    fn push(&mut self, bounds: Bounds3, below: Below) -> usize {
        self.nodes.push(BinaryNode { bounds, below });
        self.nodes.len() - 1
    }

    /// Adds a node of two; its index.
    fn pair(&mut self, first: usize, second: usize) -> usize {
        let bounds = self.nodes[first].bounds.union(self.nodes[second].bounds);
        self.push(bounds, Below::Nodes([first, second]))
    }

    /// Adds what is below a wide node, with the trees of its leaves; its index.
    fn join<'a>(
        &mut self,
        tree: &PlainTree,
        node: usize,
        of_leaf: &impl Fn(&PlainChild) -> &'a Self,
    ) -> usize {
        let children = tree.nodes[node].iter().filter_map(|child| match child.node {
            Some(node) => Some(self.join(tree, node, of_leaf)),
            None => self.append(of_leaf(child), 0),
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
            open[i] = self.pair(first, second);
        }
        open[0]
    }

    /// Adds primitives with their boxes, divided until leaves have few; the index of their root.
    /// `first` is the index of the first of them.
    fn divide<T: Copy>(&mut self, boxed: &mut [(Bounds3, T)], first: usize) -> usize {
        if boxed.len() <= MOST_PRIMITIVES {
            let bounds = boxed.iter().fold(Bounds3::EMPTY, |all, (bounds, _)| all.union(*bounds));
            return self.push(bounds, Below::Primitives(first..first + boxed.len()));
        }
        let before = cut(boxed);
        let (left, right) = boxed.split_at_mut(before);
        let middle = first + left.len();
        let halves = [self.divide(left, first), self.divide(right, middle)];
        self.pair(halves[0], halves[1])
    }
}

/// The part of primitives that is before a cut at least, and behind it, which limits the depth of
/// trees.
const LEAST_PART: usize = 8;

/// A cut in the middle is as good as one that saves less than this part.
const LEAST_GAIN: f32 = 1e-3;

/// Sorts boxes along the axis where they are cut best, by the surface area heuristic, and says how
/// many are before the cut.
fn cut<T: Copy>(boxed: &mut [(Bounds3, T)]) -> usize {
    let sort = |boxed: &mut [(Bounds3, T)], axis: usize| {
        boxed.sort_by(|a, b| a.0.centroid()[axis].total_cmp(&b.0.centroid()[axis]));
    };
    let count = boxed.len();
    let few = (count / LEAST_PART).max(1);
    let whole = boxed.iter().fold(Bounds3::EMPTY, |all, (bounds, _)| all.union(*bounds)).surface_area();
    let (mut least, mut best) = ((1.0 - LEAST_GAIN) * whole * count as f32, (0, count / 2));
    let mut costs = vec![0.0; count];
    for axis in 0..3 {
        sort(boxed, axis);
        let mut right = Bounds3::EMPTY;
        for i in (few..count).rev() {
            right = right.union(boxed[i].0);
            costs[i] = right.surface_area() * (count - i) as f32;
        }
        let mut left = Bounds3::EMPTY;
        for i in 1..=count - few {
            left = left.union(boxed[i - 1].0);
            let cost = left.surface_area() * i as f32 + costs[i];
            if i >= few && cost < least {
                (least, best) = (cost, (axis, i));
            }
        }
    }
    sort(boxed, best.0);
    best.1
}
