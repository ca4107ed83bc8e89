//! By Morton codes: a tree in a fraction of the time, which costs more to trace.
//!
//! The bits of a centroid's quantised coordinates, interleaved, are its place on a curve that visits space
//! octant by octant. Primitives are sorted along the curve, and a range of them is divided where the highest
//! bit changes that does so in it: between the halves of an octree's cell ([Lauterbach 2009]). The
//! smallest ranges are divided so that blocks are full.

use super::balanced::PARALLEL;
use super::bins::centroids;
use super::reference::{Extent, Reference};
use super::tree::{Blocks, Grown, Inner, Planted};
use math::Vec4;
use rayon::prelude::*;

/// Bits of a code, a third of them for each axis.
const BITS: u32 = 30;
/// Bits sorted by at a time.
const DIGIT: u32 = 10;
/// How many keys a thread sorts into digits at a time.
const PART: usize = 1 << 16;
/// Ranges of so many blocks are divided between blocks, and of so many are not divided.
const FULL_BLOCKS: u32 = 4;
const LEAF_BLOCKS: usize = 2;

/// Brings references into order and grows a tree over them.
pub(super) fn plant(references: Vec<Reference>, blocks: Blocks) -> Planted {
    let keys = sorted_keys(&references);
    let references: Vec<_> = keys.par_iter().map(|key| references[(key >> BITS) as usize]).collect();
    let mut inner = vec![Inner::default(); references.len()];
    let tree = grow(&references, &keys, &mut inner, 0, blocks);
    Planted { references, inner, tree }
}

/// In the order of their codes: the code in the low bits, the index of the reference above.
fn sorted_keys(references: &[Reference]) -> Vec<u64> {
    let code = Coder::new(&centroids(references));
    let mut keys: Vec<u64> = references
        .par_iter()
        .enumerate()
        .with_min_len(PARALLEL)
        .map(|(i, r)| (i as u64) << BITS | code.of(r) as u64)
        .collect();
    let mut sorted = vec![0; keys.len()];
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
    // Each part of the keys has a place of its own for each digit.
    let mut places: Vec<Vec<&mut [u64]>> = counts.iter().map(|_| Vec::with_capacity(DIGITS)).collect();
    let mut rest = sorted;
    for digit in 0..DIGITS {
        for (counts, places) in counts.iter().zip(&mut places) {
            let place;
            (place, rest) = std::mem::take(&mut rest).split_at_mut(counts[digit]);
            places.push(place);
        }
    }
    keys.par_chunks(PART).zip(places).for_each(|(part, mut places)| {
        let mut used = vec![0; DIGITS];
        for &key in part {
            let digit = digit(key);
            places[digit][used[digit]] = key;
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

    fn of(&self, r: &Reference) -> u32 {
        let at = (r.extent().doubled_centroid() - self.min).truncate() * self.scale;
        spread(at.x as u32) << 2 | spread(at.y as u32) << 1 | spread(at.z as u32)
    }
}

/// Puts two zeros between the bits of a number of ten.
fn spread(x: u32) -> u32 {
    let x = x.min(0x3ff);
    let x = (x | x << 16) & 0x030000ff;
    let x = (x | x << 8) & 0x0300f00f;
    let x = (x | x << 4) & 0x030c30c3;
    (x | x << 2) & 0x09249249
}

/// `first` is the index of the first reference.
fn grow(references: &[Reference], keys: &[u64], inner: &mut [Inner], first: usize, blocks: Blocks) -> Grown {
    let n = keys.len();
    if n <= LEAF_BLOCKS * blocks.width() {
        return Grown::leaf(Extent::around(references), n as u32, blocks);
    }
    let middle = middle(keys, blocks);
    let (left_references, right_references) = references.split_at(middle);
    let (left_keys, right_keys) = keys.split_at(middle);
    let (left_inner, right_inner) = inner.split_at_mut(middle);
    let mut left = || grow(left_references, left_keys, left_inner, first, blocks);
    let mut right = || grow(right_references, right_keys, right_inner, first + middle, blocks);
    let (left, right) = if n > PARALLEL { rayon::join(left, right) } else { (left(), right()) };
    let (grown, node) = Grown::join(&left, &right, first + middle, blocks);
    inner[middle] = node;
    grown
}

/// Where the right half of a range begins.
fn middle(keys: &[u64], blocks: Blocks) -> usize {
    let code = |key: u64| key as u32 & ((1 << BITS) - 1);
    let (first, last) = (code(keys[0]), code(keys[keys.len() - 1]));
    let count = blocks.count(keys.len() as u32);
    if count <= FULL_BLOCKS || first == last {
        return (count / 2) as usize * blocks.width();
    }
    let highest = (first ^ last).ilog2();
    keys.partition_point(|&key| code(key) >> highest == first >> highest)
}
