//! How primitives are divided: top-down, by a binned surface-area heuristic.
//!
//! A ray that meets a box meets a box inside of it with the probability of their ratio of surfaces. The
//! expected cost of splitting a set S into L and R is therefore   c_box + (A(L)·blocks(L) + A(R)·blocks(R)) /
//! A(S), against blocks(S) for a leaf. Centroids are sorted into bins along all three axes, and every border
//! between bins is tried ([Wald 2007]; [Pharr 2023 §7.3]). Minimum, maximum and count do not depend on order,
//! so that bins may be filled and halves be split by any number of threads.

use math::{Bounds3, Point3, Vec3};
use rayon::prelude::*;
use std::ops::Range;

const BINS: usize = 16;
/// The cost of testing one box, where testing a block of primitives costs 1.
const BOX_COST: f32 = 0.5;
/// Leaves above this many blocks are split whatever it costs.
const LARGEST_LEAF: usize = 4;
/// Below this depth, which only sets of wildly different sizes reach, halves are made equal.
const DEEPEST: usize = 48;
/// Smaller sets are not worth another thread.
const PARALLEL_SPLIT: usize = 4096;
const PARALLEL_BINS: usize = 1 << 16;

/// Something with bounds.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Primitive {
    pub bounds: Bounds3,
    pub index: u32,
}

impl Primitive {
    #[inline]
    fn centroid(&self) -> Point3 {
        self.bounds.min * 0.5 + self.bounds.max * 0.5
    }
}

/// A binary tree over ranges of the primitives, in the order in which [`split`] leaves them.
pub(crate) enum Tree {
    Leaf { bounds: Bounds3, range: Range<usize> },
    Inner { bounds: Bounds3, children: Box<[Tree; 2]> },
}

impl Tree {
    pub fn bounds(&self) -> Bounds3 {
        match self {
            Self::Leaf { bounds, .. } | Self::Inner { bounds, .. } => *bounds,
        }
    }
}

/// Divides at least one primitive.
pub(crate) fn split(primitives: &mut [Primitive], block: usize) -> Tree {
    Splitter { block }.split(primitives, 0, 0)
}

struct Splitter {
    block: usize,
}

impl Splitter {
    fn blocks(&self, primitives: usize) -> f32 {
        primitives.div_ceil(self.block) as f32
    }

    fn split(&self, primitives: &mut [Primitive], first: usize, depth: usize) -> Tree {
        let Extent { bounds, centroids } = Extent::of(primitives);
        let n = primitives.len();
        let leaf = || Tree::Leaf { bounds, range: first..first + n };
        if n == 1 {
            return leaf();
        }
        let best = if depth < DEEPEST { self.best_border(primitives, &bounds, &centroids) } else { None };
        let leaf_cost = self.blocks(n);
        let may_be_leaf = n <= self.block * LARGEST_LEAF;
        let middle = match best {
            Some(border) if !may_be_leaf || border.cost < leaf_cost => {
                partition(primitives, |p| border.is_left(p))
            }
            _ if may_be_leaf => return leaf(),
            _ => {
                let axis = centroids.longest_axis();
                let key = |p: &Primitive| (p.centroid()[axis], p.index);
                primitives.select_nth_unstable_by(n / 2, |a, b| {
                    let (a, b) = (key(a), key(b));
                    a.0.total_cmp(&b.0).then(a.1.cmp(&b.1))
                });
                n / 2
            }
        };
        let (left, right) = primitives.split_at_mut(middle);
        let mut left = || self.split(left, first, depth + 1);
        let mut right = || self.split(right, first + middle, depth + 1);
        let (left, right) = if n > PARALLEL_SPLIT { rayon::join(left, right) } else { (left(), right()) };
        Tree::Inner { bounds, children: Box::new([left, right]) }
    }

    /// The cheapest border with primitives on both sides.
    fn best_border(&self, primitives: &[Primitive], bounds: &Bounds3, centroids: &Bounds3) -> Option<Border> {
        let scale = (BINS as f32 / centroids.diagonal()) * (1.0 - 1e-6);
        let bins = Bins::of(primitives, centroids.min, scale);
        let inverse_area = 1.0 / bounds.surface_area();
        let mut best: Option<Border> = None;
        for axis in (0..3).filter(|&axis| scale[axis].is_finite()) {
            let bins = &bins.0[axis];
            let mut right_cost = [0f32; BINS];
            let mut right = Bin::EMPTY;
            for i in (1..BINS).rev() {
                right = right.merge(bins[i]);
                right_cost[i] = if right.count == 0 { f32::NAN } else { self.cost(&right) };
            }
            let mut left = Bin::EMPTY;
            for i in 1..BINS {
                left = left.merge(bins[i - 1]);
                if left.count == 0 {
                    continue;
                }
                let cost = BOX_COST + (self.cost(&left) + right_cost[i]) * inverse_area;
                // NaN, of an empty right side or an area beyond floats, is never cheaper.
                if cost < best.as_ref().map_or(f32::INFINITY, |b| b.cost) {
                    best = Some(Border { axis, bin: i, cost, min: centroids.min, scale });
                }
            }
        }
        best
    }

    fn cost(&self, bin: &Bin) -> f32 {
        bin.bounds.surface_area() * self.blocks(bin.count)
    }
}

/// Bounds of a set and of its centroids.
struct Extent {
    bounds: Bounds3,
    centroids: Bounds3,
}

impl Extent {
    fn of(primitives: &[Primitive]) -> Self {
        let serial = |part: &[Primitive]| {
            part.iter().fold(Self { bounds: Bounds3::EMPTY, centroids: Bounds3::EMPTY }, |all, p| Self {
                bounds: all.bounds.union(p.bounds),
                centroids: all.centroids.union_point(p.centroid()),
            })
        };
        in_parts(primitives, serial, |a, b| Self {
            bounds: a.bounds.union(b.bounds),
            centroids: a.centroids.union(b.centroids),
        })
    }
}

/// A place to split at: before bin `bin` along `axis`.
struct Border {
    axis: usize,
    bin: usize,
    cost: f32,
    min: Point3,
    scale: Vec3,
}

impl Border {
    fn is_left(&self, p: &Primitive) -> bool {
        bin_of(p.centroid(), self.min, self.scale)[self.axis] < self.bin
    }
}

#[inline]
fn bin_of(p: Point3, min: Point3, scale: Vec3) -> [usize; 3] {
    let at = (p - min) * scale;
    [at.x, at.y, at.z].map(|x| (x as usize).min(BINS - 1))
}

#[derive(Clone, Copy)]
struct Bin {
    bounds: Bounds3,
    count: usize,
}

impl Bin {
    const EMPTY: Self = Self { bounds: Bounds3::EMPTY, count: 0 };

    #[inline]
    fn merge(self, other: Self) -> Self {
        Self { bounds: self.bounds.union(other.bounds), count: self.count + other.count }
    }
}

struct Bins([[Bin; BINS]; 3]);

impl Bins {
    fn of(primitives: &[Primitive], min: Point3, scale: Vec3) -> Self {
        let serial = |part: &[Primitive]| {
            let mut bins = [[Bin::EMPTY; BINS]; 3];
            for p in part {
                let one = Bin { bounds: p.bounds, count: 1 };
                for (bins, bin) in bins.iter_mut().zip(bin_of(p.centroid(), min, scale)) {
                    bins[bin] = bins[bin].merge(one);
                }
            }
            Self(bins)
        };
        in_parts(primitives, serial, |mut a, b| {
            for (a, b) in a.0.iter_mut().flatten().zip(b.0.iter().flatten()) {
                *a = a.merge(*b);
            }
            a
        })
    }
}

/// Folds a large set in parts, by many threads. The result does not depend on the parts as long as `merge` is
/// associative.
fn in_parts<T: Send>(
    primitives: &[Primitive],
    serial: impl Fn(&[Primitive]) -> T + Sync + Send,
    merge: impl Fn(T, T) -> T + Sync + Send,
) -> T {
    if primitives.len() < PARALLEL_BINS {
        return serial(primitives);
    }
    primitives.par_chunks(PARALLEL_BINS / 4).map(&serial).reduce_with(merge).unwrap_or_else(|| serial(&[]))
}

/// Brings those for which `is_left` holds to the front; returns their number.
fn partition(primitives: &mut [Primitive], is_left: impl Fn(&Primitive) -> bool) -> usize {
    let mut middle = 0;
    for i in 0..primitives.len() {
        if is_left(&primitives[i]) {
            primitives.swap(i, middle);
            middle += 1;
        }
    }
    middle
}
