//! Top-down by the surface-area heuristic over bins: good trees in little time.

use super::bins::{Border, centroids};
use super::pages;
use super::partition::partition;
use super::reference::{Extent, Reference};
use super::tree::{Blocks, Grown, Inner, Planted};

/// Below this depth, which only sets of wildly different sizes reach, halves are made equal.
pub(super) const DEEPEST: usize = 48;
/// Smaller sets are not worth another thread.
pub(super) const PARALLEL: usize = 4096;

/// Brings references into order and grows a tree over them.
pub(super) fn plant(mut references: Vec<Reference>, blocks: Blocks) -> Planted {
    let mut inner = pages::filled(Inner::default(), references.len());
    let extent = Extent::around(&references);
    let tree = grow(&mut references, &mut inner, 0, extent, blocks, 0);
    let size = tree.as_node(&inner);
    Planted { references, inner, root: tree.root, size }
}

/// Brings the references into order and fills in `inner`, which is as long. `first` is the index of
/// the first reference.
fn grow(
    references: &mut [Reference],
    inner: &mut [Inner],
    first: usize,
    extent: Extent,
    blocks: Blocks,
    depth: usize,
) -> Grown {
    let n = references.len();
    if n <= blocks.width() {
        return Grown::leaf(extent, n as u32, blocks);
    }
    let (middle, halves) = divide(references, &extent, blocks, depth);
    let (left, right) = references.split_at_mut(middle);
    let (left_inner, right_inner) = inner.split_at_mut(middle);
    let [l, r] = halves;
    let mut left = || grow(left, left_inner, first, l, blocks, depth + 1);
    let mut right = || grow(right, right_inner, first + middle, r, blocks, depth + 1);
    let (left, right) = if n > PARALLEL { rayon::join(left, right) } else { (left(), right()) };
    let (grown, node) = Grown::join(&left, &right, first + middle, blocks);
    inner[middle] = node;
    grown
}

/// Brings the left half to the front; gives its length, and the boxes of both halves.
fn divide(
    references: &mut [Reference],
    extent: &Extent,
    blocks: Blocks,
    depth: usize,
) -> (usize, [Extent; 2]) {
    if depth < DEEPEST
        && let Some(border) = Border::best(references, extent, blocks)
    {
        return (partition(references, |r| border.is_left(r)), border.halves);
    }
    halve(references)
}

/// Two halves of the same length, by centroids along the longest axis.
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
