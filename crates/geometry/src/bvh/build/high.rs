//! Top-down like [`super::balanced`], with spatial splits (SBVH): a primitive across the splitting
//! plane gets a reference on both sides, each with a box around its part on that side. Long,
//! slanted triangles, whose boxes are mostly empty, gain most ([Stich 2009]).
//!
//! A spatial split is tried where the boxes of the best object split overlap by more than
//! [`OVERLAP`] of the whole, while there is capacity for more references, of which there are at
//! most twice as many as primitives. Spare capacity of a set is shared between its halves in
//! proportion to their sizes.

use super::balanced::{DEEPEST, PARALLEL, halve};
use super::bins::ObjectSplit;
use super::pages;
use super::partition::partition;
use super::reference::{Extent, Reference};
use super::spatial::{Corners, Plane};
use super::tree::{BinaryTree, Blocks, InnerNode, Subtree};

/// The overlap above which a spatial split is tried, as a fraction of the whole surface area.
const OVERLAP: f32 = 1e-5;

/// Sorts references, some of them duplicated, and builds a tree over them.
pub(super) fn build(
    mut references: Vec<Reference>,
    corners: &impl Corners,
    blocks: Blocks,
) -> BinaryTree<Reference> {
    let count = references.len();
    let extent = Extent::around(&references);
    references.resize((2 * count).min(u32::MAX as usize), Reference::none());
    let mut inner = pages::zeroed(references.len());
    let builder = Builder { corners, blocks, least_overlap: OVERLAP * extent.half_area() };
    let tree = builder.grow(Set { references: &mut references, count, extent }, &mut inner, 0, 0);
    let size = tree.as_node(&inner);
    close_gaps(BinaryTree { items: references, inner, root: tree.root, size })
}

/// Removes unused references.
fn close_gaps(tree: BinaryTree<Reference>) -> BinaryTree<Reference> {
    let BinaryTree { items: mut references, inner, root, size } = tree;
    let mut used = 0;
    let place = |r: &Reference| {
        let here = used;
        used += !r.is_none() as u32;
        here
    };
    let places: Vec<u32> = references.iter().map(place).collect();
    let place = |border: u32| places[border as usize];
    let mut closed = pages::zeroed::<InnerNode>(used as usize);
    for (mut node, &border) in inner.into_iter().zip(&places).filter(|(node, _)| node.is_used()) {
        node.halves = node.halves.map(place);
        closed[border as usize] = node;
    }
    let root = if root > 0 { place(root) } else { 0 };
    references.retain(|r| !r.is_none());
    BinaryTree { items: references, inner: closed, root, size }
}

/// The first `count` references of a slice, which has spare capacity, and the box around them.
struct Set<'a> {
    references: &'a mut [Reference],
    count: usize,
    extent: Extent,
}

struct Builder<'a, C> {
    corners: &'a C,
    blocks: Blocks,
    least_overlap: f32,
}

impl<C: Corners> Builder<'_, C> {
    /// Fills in `inner`, which is as long as the set's slice. `first` is the index of the first
    /// reference.
    fn grow(&self, set: Set, inner: &mut [InnerNode], first: usize, depth: usize) -> Subtree {
        let count = set.count;
        if count <= self.blocks.width() {
            set.references[count..].fill(Reference::none());
            return Subtree::leaf(set.extent, count as u32, self.blocks);
        }
        let [left, right] = self.divide(set, depth);
        let middle = left.references.len();
        let (left_inner, right_inner) = inner.split_at_mut(middle);
        let left = || self.grow(left, left_inner, first, depth + 1);
        let right = || self.grow(right, right_inner, first + middle, depth + 1);
        let (left, right) = if count > PARALLEL { rayon::join(left, right) } else { (left(), right()) };
        let (subtree, node) = Subtree::join(&left, &right, first + middle, self.blocks);
        inner[middle] = node;
        subtree
    }

    fn divide<'a>(&self, set: Set<'a>, depth: usize) -> [Set<'a>; 2] {
        let Set { references, count, extent } = set;
        let used = &mut references[..count];
        let border = if depth < DEEPEST { ObjectSplit::best(used, &extent, self.blocks) } else { None };
        let Some(border) = border else {
            let (middle, extents) = halve(used);
            return share_capacity(references, [middle, count - middle], extents);
        };
        if border.halves[0].overlap(&border.halves[1]) > self.least_overlap
            && count < references.len()
            && let Some(plane) = Plane::best(&references[..count], &extent, self.corners, self.blocks)
            && plane.cost < border.cost
            && let Some(halves) = self.split_space(references, count, &plane)
        {
            return share_capacity(
                references,
                halves.map(|(count, _)| count),
                halves.map(|(_, extent)| extent),
            );
        }
        let middle = partition(&mut references[..count], |r| border.is_left(r));
        share_capacity(references, [middle, count - middle], border.halves)
    }

    /// Partitions references by a plane. One on both sides is duplicated, or goes to one side alone
    /// where that is cheaper or there is no capacity left.
    fn split_space(
        &self,
        references: &mut [Reference],
        count: usize,
        plane: &Plane,
    ) -> Option<[(usize, Extent); 2]> {
        let mut sides = [Vec::with_capacity(count), Vec::with_capacity(count)];
        let mut spare = references.len() - count;
        for r in &references[..count] {
            match plane.split(r, self.corners) {
                [Some(left), Some(right)] => match plane.one_side(r) {
                    (_, false) if spare > 0 => {
                        spare -= 1;
                        sides[0].push(left);
                        sides[1].push(right);
                    }
                    (side, _) => sides[side].push(*r),
                },
                [left, right] => {
                    sides[0].extend(left);
                    sides[1].extend(right);
                }
            }
        }
        let [left, right] = &sides;
        if left.is_empty() || right.is_empty() {
            return None;
        }
        let (left_room, right_room) = references.split_at_mut(left.len());
        left_room.copy_from_slice(left);
        right_room[..right.len()].copy_from_slice(right);
        Some(sides.map(|side| (side.len(), Extent::around(&side))))
    }
}

/// Shares the spare capacity between two halves by moving the right one back.
fn share_capacity(references: &mut [Reference], counts: [usize; 2], extents: [Extent; 2]) -> [Set<'_>; 2] {
    let [left, right] = counts;
    let spare = references.len() - left - right;
    let middle = left + (spare as u64 * left as u64 / (left + right) as u64) as usize;
    references.copy_within(left..left + right, middle);
    let (left_room, right_room) = references.split_at_mut(middle);
    [
        Set { references: left_room, count: left, extent: extents[0] },
        Set { references: right_room, count: right, extent: extents[1] },
    ]
}
