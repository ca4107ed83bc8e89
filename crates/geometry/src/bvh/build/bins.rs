//! The surface-area heuristic over bins.
//!
//! A ray that hits a box hits a box inside of it with the ratio of their surface areas as
//! probability. Splitting a set into L and R is therefore expected to cost A(L)·blocks(L) +
//! A(R)·blocks(R). Centroids are sorted into bins along all three axes, and every border between
//! bins is tried ([Wald 2007]; [Pharr 2023 §7.3]). Minimum, maximum and count do not depend on
//! order, so that any number of threads may fill bins.

use super::reference::{Extent, Reference, in_parts};
use super::tree::Blocks;
use lanes::Each;
use math::Vec4;

/// Where bins lie: the range of the centroids, cut into intervals along each axis.
#[derive(Clone, Copy)]
pub(super) struct Grid {
    min: Vec4,
    scale: Vec4,
    mask: u32,
}

impl Grid {
    /// Adding a number below 2²² rounds it into the low bits of the sum.
    const ROUND: Vec4 = Vec4::splat(12_582_912.0);

    /// A grid over the range of doubled centroids; `bins` is a power of two.
    fn new(centroids: &Extent, bins: usize) -> Self {
        let scale = (bins - 1) as f32 / (centroids.high() - centroids.low());
        // Where all centroids are the same, all go into one bin.
        let scale = Vec4::select(scale.is_finite_mask(), scale, Vec4::ZERO);
        // The lanes w hold ids, which are mostly denormal as floats and slow to multiply: they
        // become −1.
        let mut min = centroids.low();
        min.w = 1.0;
        Self { min, scale, mask: bins as u32 - 1 }
    }

    /// The bins along the three axes.
    #[inline]
    fn bins(&self, r: &Reference) -> [u32; 4] {
        let at = (r.extent().doubled_centroid() - self.min) * self.scale + Self::ROUND;
        at.to_array().each(|at| at.to_bits() & self.mask)
    }
}

/// Reading this many references costs more than sorting them into bins.
const LARGE_SET: usize = 1 << 14;

/// A border between bins to split at.
#[derive(Clone, Copy)]
pub(super) struct ObjectSplit {
    grid: Grid,
    axis: usize,
    /// The first bin of the right half.
    bin: u32,
    pub cost: f32,
    /// The boxes of both halves.
    pub halves: [Extent; 2],
}

impl ObjectSplit {
    /// The cheapest border with primitives on both sides, of a set in the box `extent`.
    pub fn best(references: &[Reference], extent: &Extent, blocks: Blocks) -> Option<Self> {
        // Where there are many bins and primitives, the box is nearly the range of the centroids.
        let in_box = match references.len() {
            LARGE_SET.. => Bins::<32>::best(references, &extent.doubled(), blocks),
            _ => None,
        };
        in_box.or_else(|| {
            let range = centroids(references);
            match references.len() {
                0..64 => Bins::<8>::best(references, &range, blocks),
                64..1024 => Bins::<16>::best(references, &range, blocks),
                _ => Bins::<32>::best(references, &range, blocks),
            }
        })
    }

    #[inline]
    pub fn is_left(&self, r: &Reference) -> bool {
        self.grid.bins(r)[self.axis] < self.bin
    }
}

/// The range of the doubled centroids.
pub(super) fn centroids(references: &[Reference]) -> Extent {
    let serial = |part: &[Reference]| {
        part.iter().fold(Extent::EMPTY, |all, r| all.union(Extent::point(r.extent().doubled_centroid())))
    };
    in_parts(references, serial, Extent::union)
}

/// The boxes and counts of the bins along each axis.
struct Bins<const B: usize> {
    boxes: [[Extent; B]; 3],
    counts: [[u32; B]; 3],
}

impl<const B: usize> Bins<B> {
    const EMPTY: Self = Self { boxes: [[Extent::EMPTY; B]; 3], counts: [[0; B]; 3] };

    #[inline(never)]
    fn best(references: &[Reference], range: &Extent, blocks: Blocks) -> Option<ObjectSplit> {
        let grid = Grid::new(range, B);
        in_parts(references, |part| Self::of(part, &grid), Self::merge).cheapest(grid, blocks)
    }

    #[inline]
    fn of(references: &[Reference], grid: &Grid) -> Self {
        let mut bins = Self::EMPTY;
        for r in references {
            let at = grid.bins(r);
            for (axis, bin) in at.into_iter().take(3).enumerate() {
                let bin = bin as usize % B;
                bins.boxes[axis][bin] = bins.boxes[axis][bin].union(r.extent());
                bins.counts[axis][bin] += 1;
            }
        }
        bins
    }

    fn merge(mut self, other: Self) -> Self {
        for axis in 0..3 {
            for bin in 0..B {
                self.boxes[axis][bin] = self.boxes[axis][bin].union(other.boxes[axis][bin]);
                self.counts[axis][bin] += other.counts[axis][bin];
            }
        }
        self
    }

    #[inline]
    fn cheapest(&self, grid: Grid, blocks: Blocks) -> Option<ObjectSplit> {
        let cost = |extent: &Extent, count: u32| extent.half_area() * blocks.count(count) as f32;
        let mut best = (f32::INFINITY, 0, 0);
        for axis in 0..3 {
            let (boxes, counts) = (&self.boxes[axis], &self.counts[axis]);
            let mut right_cost = [0f32; B];
            let (mut right, mut count) = (Extent::EMPTY, 0);
            for i in (1..B).rev() {
                right = right.union(boxes[i]);
                count += counts[i];
                right_cost[i] = cost(&right, count);
            }
            let (mut left, mut count) = (Extent::EMPTY, 0);
            for i in 1..B {
                left = left.union(boxes[i - 1]);
                count += counts[i - 1];
                // NaN, of an empty side or an area beyond floats, is never cheaper.
                let this = cost(&left, count) + right_cost[i];
                if this < best.0 {
                    best = (this, axis, i);
                }
            }
        }
        let (cost, axis, bin) = best;
        let side = |boxes: &[Extent]| boxes.iter().fold(Extent::EMPTY, |all, &b| all.union(b));
        let halves = [side(&self.boxes[axis][..bin]), side(&self.boxes[axis][bin..])];
        (cost < f32::INFINITY).then_some(ObjectSplit { grid, axis, bin: bin as u32, cost, halves })
    }
}
