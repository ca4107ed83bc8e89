//! Top-down by the binned surface area heuristic.

use super::bins::{ObjectSplit, centroids};
use super::pages;
use super::partition::partition;
use super::reference::{Extent, Ids, Reference};
use super::tree::{BinaryTree, Blocks, InnerNode, Subtree};

/// Below this depth, which only extremely uneven sets reach, sets are split at the median.
pub(super) const DEEPEST: usize = 48;
/// Smaller sets are not split between threads.
pub(super) const PARALLEL: usize = 4096;

/// Sorts references and builds a tree over them.
///
/// The references of finished subtrees are freed while ids and inner nodes, which take as much
/// memory, are written.
pub(super) fn build(mut references: Vec<Reference>, blocks: Blocks) -> BinaryTree<Ids> {
    let mut ids = pages::zeroed(references.len());
    let mut inner = pages::zeroed(references.len());
    let extent = Extent::around(&references);
    let tree = grow(
        Part { first: 0, references: &mut references, ids: &mut ids, inner: &mut inner },
        extent,
        blocks,
        0,
    );
    let size = tree.as_node(&inner);
    BinaryTree { items: ids, inner, root: tree.root, size }
}

/// A range of the references, and where their ids and inner nodes are written, one of each per
/// reference.
struct Part<'a> {
    /// The index of the first reference.
    first: usize,
    references: &'a mut [Reference],
    ids: &'a mut [Ids],
    inner: &'a mut [InnerNode],
}

impl Part<'_> {
    fn split_at(&mut self, middle: usize) -> [Part<'_>; 2] {
        let (left, right) = self.references.split_at_mut(middle);
        let (left_ids, right_ids) = self.ids.split_at_mut(middle);
        let (left_inner, right_inner) = self.inner.split_at_mut(middle);
        [
            Part { first: self.first, references: left, ids: left_ids, inner: left_inner },
            Part { first: self.first + middle, references: right, ids: right_ids, inner: right_inner },
        ]
    }
}

/// Sorts the references of a part and writes their ids and inner nodes.
fn grow(mut part: Part<'_>, extent: Extent, blocks: Blocks, depth: usize) -> Subtree {
    let n = part.references.len();
    if n <= blocks.width() {
        part.ids.iter_mut().zip(part.references).for_each(|(ids, r)| *ids = r.ids());
        return Subtree::leaf(extent, n as u32, blocks);
    }
    let (middle, [l, r]) = divide(part.references, &extent, blocks, depth);
    let [left, right] = part.split_at(middle);
    let left = || grow(left, l, blocks, depth + 1);
    let right = || grow(right, r, blocks, depth + 1);
    let (left, right) = if n > PARALLEL { rayon::join(left, right) } else { (left(), right()) };
    if n > PARALLEL {
        pages::release(part.references);
    }
    let (subtree, node) = Subtree::join(&left, &right, part.first + middle, blocks);
    part.inner[middle] = node;
    subtree
}

/// Partitions a set; returns the length of the left half, and the boxes of both halves.
fn divide(
    references: &mut [Reference],
    extent: &Extent,
    blocks: Blocks,
    depth: usize,
) -> (usize, [Extent; 2]) {
    if depth < DEEPEST
        && let Some(border) = ObjectSplit::best(references, extent, blocks)
    {
        return (partition(references, |r| border.is_left(r)), border.halves);
    }
    halve(references)
}

/// Splits a set at the median centroid along the longest axis.
#[inline(never)]
pub(super) fn halve(references: &mut [Reference]) -> (usize, [Extent; 2]) {
    let middle = references.len() / 2;
    let axis = centroids(references).bounds().longest_axis();
    let key = |r: &Reference| (r.extent().doubled_centroid()[axis], r.geometry(), r.primitive());
    references.select_nth_unstable_by(middle, |a, b| {
        let (a, b) = (key(a), key(b));
        a.0.total_cmp(&b.0).then((a.1, a.2).cmp(&(b.1, b.2)))
    });
    let (left, right) = references.split_at(middle);
    (middle, [left, right].map(Extent::around))
}
