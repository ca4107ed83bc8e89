//! Top-down like [`super::balanced`], but space may be split as well: a primitive across the border
//! is then referred to from both sides, each time with a box around only its part on that side.
//! Long, slanted triangles, whose boxes are mostly empty, gain most ([Stich 2009]).
//!
//! A spatial split is tried where the boxes of the best object split overlap by more than
//! [`OVERLAP`] of the whole, and as long as there is room for more references, of which there are
//! at most twice as many as primitives. Room that a set does not need goes to its halves in
//! proportion to their numbers.

use super::balanced::{DEEPEST, PARALLEL, halve};
use super::bins::Border;
use super::pages;
use super::partition::partition;
use super::reference::{Extent, Reference};
use super::spatial::{Corners, Plane};
use super::tree::{Blocks, Grown, Inner, Planted};

/// How much overlap, as a part of the surface of everything, is worth a spatial split.
const OVERLAP: f32 = 1e-5;

/// Brings references into order, some of them more than once, and grows a tree over them.
pub(super) fn plant(mut references: Vec<Reference>, corners: &impl Corners, blocks: Blocks) -> Planted {
    let count = references.len();
    let extent = Extent::around(&references);
    references.resize((2 * count).min(u32::MAX as usize), Reference::none());
    let mut inner = pages::filled(Inner::default(), references.len());
    let builder = Builder { corners, blocks, least_overlap: OVERLAP * extent.half_area() };
    let tree = builder.grow(Set { references: &mut references, count, extent }, &mut inner, 0, 0);
    let size = tree.as_node(&inner);
    close_gaps(Planted { references, inner, root: tree.root, size })
}

/// Moves everything to the front, where some of the room was not needed.
fn close_gaps(planted: Planted) -> Planted {
    let Planted { mut references, inner, root, size } = planted;
    let mut used = 0;
    let place = |r: &Reference| {
        let here = used;
        used += !r.is_none() as u32;
        here
    };
    let places: Vec<u32> = references.iter().map(place).collect();
    let place = |border: u32| places[border as usize];
    let mut closed = pages::filled(Inner::default(), used as usize);
    for (mut node, &border) in inner.into_iter().zip(&places).filter(|(node, _)| node.is_used()) {
        node.halves = node.halves.map(place);
        closed[border as usize] = node;
    }
    let root = if root > 0 { place(root) } else { 0 };
    references.retain(|r| !r.is_none());
    Planted { references, inner: closed, root, size }
}

/// References in the first places of some room, and a box around them.
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
    /// Fills in `inner`, which is as long as the room. `first` is the index of the first reference.
    fn grow(&self, set: Set, inner: &mut [Inner], first: usize, depth: usize) -> Grown {
        let count = set.count;
        if count <= self.blocks.width() {
            set.references[count..].fill(Reference::none());
            return Grown::leaf(set.extent, count as u32, self.blocks);
        }
        let [left, right] = self.divide(set, depth);
        let middle = left.references.len();
        let (left_inner, right_inner) = inner.split_at_mut(middle);
        let left = || self.grow(left, left_inner, first, depth + 1);
        let right = || self.grow(right, right_inner, first + middle, depth + 1);
        let (left, right) = if count > PARALLEL { rayon::join(left, right) } else { (left(), right()) };
        let (grown, node) = Grown::join(&left, &right, first + middle, self.blocks);
        inner[middle] = node;
        grown
    }

    fn divide<'a>(&self, set: Set<'a>, depth: usize) -> [Set<'a>; 2] {
        let Set { references, count, extent } = set;
        let used = &mut references[..count];
        let border = if depth < DEEPEST { Border::best(used, &extent, self.blocks) } else { None };
        let Some(border) = border else {
            let (middle, extents) = halve(used);
            return share_room(references, [middle, count - middle], extents);
        };
        if border.halves[0].overlap(&border.halves[1]) > self.least_overlap
            && count < references.len()
            && let Some(plane) = Plane::best(&references[..count], &extent, self.corners, self.blocks)
            && plane.cost < border.cost
            && let Some(halves) = self.split_space(references, count, &plane)
        {
            return share_room(references, halves.map(|(count, _)| count), halves.map(|(_, extent)| extent));
        }
        let middle = partition(&mut references[..count], |r| border.is_left(r));
        share_room(references, [middle, count - middle], border.halves)
    }

    /// Brings what is on the left of a plane to the front and what is on the right behind it. What
    /// is on both sides goes to one of them alone where that is cheaper, or where there is no room
    /// left.
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

/// Moves the right half, which follows the left one, to a room of its own.
fn share_room(references: &mut [Reference], counts: [usize; 2], extents: [Extent; 2]) -> [Set<'_>; 2] {
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
