//! By Morton codes (LBVH): fast to build, slower to trace.
//!
//! The interleaved bits of a centroid's quantised coordinates are its position on a Z-order curve.
//! Primitives are sorted along the curve, and a range of them is split where its highest differing
//! bit changes: between the halves of an octree cell ([Lauterbach 2009]). The smallest ranges are
//! cut into full blocks. The tree is built over these blocks, so that primitives are loaded three
//! times: for the bounds of their centroids, their codes and their blocks.

use super::balanced::PARALLEL;
use super::overflow::Overflow;
use super::pages;
use super::primitives::{MAX_WIDTH, Numbering, PREFETCH_DISTANCE, Primitives};
use super::reference::{Extent, Reference};
use super::tree::{BinaryTree, Blocks, InnerNode, Subtree};
use super::widen::{Boxes, Built, Leaves, Wide, widen};
use math::Vec4;
use rayon::prelude::*;

/// Bits of a code, a third of them for each axis.
const BITS: u32 = 30;
/// Bits of a digit of the radix sort.
const DIGIT: u32 = 10;
/// Keys that a thread sorts at a time.
const PART: usize = 1 << 16;
/// Ranges of at most this many blocks are cut into full ones.
const FULL_BLOCKS: usize = 4;
/// Ranges of at most this many blocks become a leaf.
const LEAF_BLOCKS: usize = 2;

/// Makes blocks, and builds a tree over them: each reference is a block.
pub(super) fn build<P: Primitives>(primitives: &P) -> Built<P::Block> {
    let numbering = Numbering::of(primitives);
    let keys = sorted_keys(primitives, &numbering);
    let starts = starts(&keys, 0, primitives.width());
    let start = |block: usize| starts.get(block).map_or(keys.len(), |&start| start as usize);
    let members = |block| {
        let keys = &keys[start(block)..start(block + 1)];
        keys.iter().map(|key| numbering.id((key >> BITS) as usize))
    };
    let overflow = Overflow::new();
    let block = |block: usize| {
        members(block + 2 * PREFETCH_DISTANCE)
            .for_each(|(geometry, primitive)| primitives.prefetch_indices(geometry, primitive));
        members(block + PREFETCH_DISTANCE)
            .for_each(|(geometry, primitive)| primitives.prefetch(geometry, primitive));
        let mut references = [Reference::none(); MAX_WIDTH];
        for (reference, (geometry, primitive)) in references.iter_mut().zip(members(block)) {
            *reference = Reference::new(Extent::EMPTY, geometry, primitive);
        }
        let members = &references[..members(block).len()];
        let (made, extent) = overflow.block(primitives, block, members);
        (Reference::new(extent, 0, block as u32), made)
    };
    let (mut references, mut blocks) =
        (pages::with_capacity(starts.len()), overflow.with_capacity(starts.len()));
    let made = (0..starts.len()).into_par_iter().with_min_len(PARALLEL / 4).map(block);
    made.unzip_into_vecs(&mut references, &mut blocks);
    let codes: Vec<_> = starts.iter().map(|&start| code(keys[start as usize])).collect();
    let mut inner = pages::zeroed(references.len());
    let single = Blocks::of(1, P::COST);
    let tree = grow(&codes, &references, &mut inner, 0, single);
    let size = tree.as_node(&inner);
    let tree = BinaryTree { items: references, inner, root: tree.root, size };
    let Wide { mut nodes, extent, depth } = widen(tree, single, &mut Vec::new(), &Made);
    let blocks = overflow.resolve(blocks, &mut nodes);
    Built { nodes, bounds: extent.bounds(), depth, blocks }
}

/// Leaves whose blocks exist already: each reference is one.
struct Made;

impl Leaves<Reference, ()> for Made {
    fn block(&self, _: &[Reference], _: usize, _: usize) {}

    fn boxes(&self, blocks: &[Reference]) -> Boxes {
        Boxes::of(blocks.iter().map(Reference::extent))
    }
}

/// The code of a key.
fn code(key: u64) -> u32 {
    key as u32 & ((1 << BITS) - 1)
}

/// All primitives in the order of their codes: the code in the low bits, the number of the
/// primitive above.
fn sorted_keys(primitives: &impl Primitives, numbering: &Numbering) -> Vec<u64> {
    const NOTHING: u64 = u64::MAX;
    let coder = Coder::new(&numbering.centroids(primitives));
    let mut keys = numbering.map(primitives, |number, _, _, extent| match extent {
        Some(extent) => (number as u64) << BITS | coder.of(&extent) as u64,
        None => NOTHING,
    });
    if keys.contains(&NOTHING) {
        keys.retain(|&key| key != NOTHING);
    }
    let mut sorted = pages::filled(0, keys.len());
    for shift in (0..BITS).step_by(DIGIT as usize) {
        sort_by_digit(&keys, &mut sorted, shift);
        std::mem::swap(&mut keys, &mut sorted);
    }
    keys
}

/// One pass of a radix sort, stable.
fn sort_by_digit(keys: &[u64], sorted: &mut [u64], shift: u32) {
    const DIGITS: usize = 1 << DIGIT;
    let digit = |key: u64| (key >> shift) as usize % DIGITS;
    let count = |part: &[u64]| {
        let mut counts = vec![0; DIGITS];
        part.iter().for_each(|&key| counts[digit(key)] += 1);
        counts
    };
    let counts: Vec<Vec<usize>> = keys.par_chunks(PART).map(count).collect();
    // Each part of the keys has an output range of its own for each digit.
    let mut outputs: Vec<Vec<&mut [u64]>> = counts.iter().map(|_| Vec::with_capacity(DIGITS)).collect();
    let mut rest = sorted;
    for digit in 0..DIGITS {
        for (counts, outputs) in counts.iter().zip(&mut outputs) {
            let output;
            (output, rest) = std::mem::take(&mut rest).split_at_mut(counts[digit]);
            outputs.push(output);
        }
    }
    keys.par_chunks(PART).zip(outputs).for_each(|(part, mut outputs)| {
        let mut used = vec![0; DIGITS];
        for &key in part {
            let digit = digit(key);
            outputs[digit][used[digit]] = key;
            used[digit] += 1;
        }
    });
}

/// Turns centroids into codes.
struct Coder {
    min: Vec4,
    scale: f32,
}

impl Coder {
    /// For doubled centroids in a box, whose longest side becomes the side of the octree.
    fn new(centroids: &Extent) -> Self {
        let side = (centroids.high() - centroids.low()).truncate().max_element();
        let scale = ((1 << (BITS / 3)) - 1) as f32 / side;
        Self { min: centroids.low(), scale: if scale.is_finite() { scale } else { 0.0 } }
    }

    #[inline]
    fn of(&self, extent: &Extent) -> u32 {
        /// Adding a number below 2²² rounds it into the low bits of the sum.
        const ROUND: Vec4 = Vec4::splat(12_582_912.0);
        let at = (extent.doubled_centroid() - self.min) * self.scale + ROUND;
        let [x, y, z, _] = at.to_array().map(|at| spread(at.to_bits()));
        x << 2 | y << 1 | z
    }
}

/// Spreads the low ten bits to every third bit.
#[inline]
fn spread(x: u32) -> u32 {
    let x = x & 0x3ff;
    let x = (x | x << 16) & 0x030000ff;
    let x = (x | x << 8) & 0x0300f00f;
    let x = (x | x << 4) & 0x030c30c3;
    (x | x << 2) & 0x09249249
}

/// The first key of each block. `first` is the index of the first key.
fn starts(keys: &[u64], first: usize, width: usize) -> Vec<u32> {
    if keys.len() <= PART {
        let mut list = Vec::with_capacity(keys.len() / width * 3 / 2);
        add_starts(keys, first, width, &mut list);
        return list;
    }
    let (left, right) = keys.split_at(middle(keys, code));
    let right = || starts(right, first + left.len(), width);
    let (mut list, right) = rayon::join(|| starts(left, first, width), right);
    list.extend(right);
    list
}

fn add_starts(keys: &[u64], first: usize, width: usize, list: &mut Vec<u32>) {
    if keys.len() <= FULL_BLOCKS * width {
        list.extend((first..first + keys.len()).step_by(width).map(|start| start as u32));
        return;
    }
    let (left, right) = keys.split_at(middle(keys, code));
    add_starts(left, first, width, list);
    add_starts(right, first + left.len(), width, list);
}

/// The index where the right half of a range begins.
fn middle<T: Copy>(range: &[T], code: impl Fn(T) -> u32) -> usize {
    let (first, last) = (code(range[0]), code(range[range.len() - 1]));
    if first == last {
        return range.len() / 2;
    }
    let highest = (first ^ last).ilog2();
    range.partition_point(|&key| code(key) >> highest == first >> highest)
}

/// Builds a tree over blocks, whose first primitives have `codes`, and fills in `inner`. `first` is
/// the index of the first block.
fn grow(
    codes: &[u32],
    blocks: &[Reference],
    inner: &mut [InnerNode],
    first: usize,
    single: Blocks,
) -> Subtree {
    let n = blocks.len();
    if n <= LEAF_BLOCKS {
        let extent = blocks.iter().fold(Extent::EMPTY, |all, block| all.union(block.extent()));
        return Subtree::leaf(extent, n as u32, single);
    }
    let middle = middle(codes, |code| code);
    let (left_codes, right_codes) = codes.split_at(middle);
    let (left_blocks, right_blocks) = blocks.split_at(middle);
    let (left_inner, right_inner) = inner.split_at_mut(middle);
    let mut left = || grow(left_codes, left_blocks, left_inner, first, single);
    let mut right = || grow(right_codes, right_blocks, right_inner, first + middle, single);
    let (left, right) = if n > PARALLEL { rayon::join(left, right) } else { (left(), right()) };
    let (subtree, node) = Subtree::join(&left, &right, first + middle, single);
    inner[middle] = node;
    subtree
}
