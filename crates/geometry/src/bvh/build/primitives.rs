//! The primitives that trees are built over.

use super::pages;
use super::reference::{Extent, Reference};
use math::Vec3;
use rayon::prelude::*;

/// How many blocks ahead primitives are prefetched; indices that lead to them, twice as far.
pub(super) const PREFETCH_DISTANCE: usize = 8;
/// Fewer primitives are not split between threads.
const PARALLEL: usize = 4096;

/// Geometries of numbered primitives, which leaves test in blocks.
pub(crate) trait Primitives: Sync {
    /// Primitives that a leaf tests at once.
    type Block: Copy + Send + Sync;

    /// The cost of testing a block, relative to that of testing the boxes of a wide node.
    const COST: f32;

    /// The most primitives in a block: 1, 2, 4 or 8.
    fn width(&self) -> usize;

    /// Each geometry and its number of primitives.
    fn geometries(&self) -> Vec<(u32, usize)>;

    /// The box of a primitive; `None` for one that is not finite, which is left out.
    fn extent(&self, geometry: u32, primitive: u32) -> Option<Extent>;

    /// The corners of a triangle; `None` for other primitives.
    fn corners(&self, _geometry: u32, _primitive: u32) -> Option<[Vec3; 3]> {
        None
    }

    /// Prefetches what [`Primitives::prefetch`] will read.
    fn prefetch_indices(&self, _geometry: u32, _primitive: u32) {}

    /// Prefetches a primitive that will soon be put into a block.
    fn prefetch(&self, _geometry: u32, _primitive: u32) {}

    /// Makes a block of the first of some primitives, given by their ids; returns the number that
    /// fits into it, and the box around these. The rest gets blocks of its own.
    fn block(&self, primitives: &[Reference]) -> (Self::Block, usize, Extent);
}

/// The most that [`Primitives::width`] may be.
pub(super) const MAX_WIDTH: usize = 8;

/// Consecutive numbers for the primitives of all geometries.
pub(super) struct Numbering {
    /// Geometries that have primitives, and the number of the first primitive of each.
    firsts: Vec<(u32, usize)>,
    len: usize,
}

impl Numbering {
    pub fn of(primitives: &impl Primitives) -> Self {
        let (mut firsts, mut len) = (Vec::new(), 0);
        for (geometry, count) in primitives.geometries().into_iter().filter(|&(_, count)| count > 0) {
            firsts.push((geometry, len));
            len += count;
        }
        Self { firsts, len }
    }

    /// Geometry and primitive of a number.
    #[inline]
    pub fn id(&self, number: usize) -> (u32, u32) {
        let later = self.firsts.partition_point(|&(_, first)| first <= number);
        let (geometry, first) = self.firsts[later - 1];
        (geometry, (number - first) as u32)
    }

    /// Each geometry, the number of its first primitive, and its number of primitives.
    fn geometries(&self) -> impl Iterator<Item = (u32, usize, usize)> {
        let ends = self.firsts.iter().skip(1).map(|&(_, first)| first).chain([self.len]);
        self.firsts.iter().zip(ends).map(|(&(geometry, first), end)| (geometry, first, end - first))
    }

    /// Maps number, geometry, primitive and box of each primitive.
    pub fn map<T: Send>(
        &self,
        primitives: &impl Primitives,
        make: impl Fn(usize, u32, u32, Option<Extent>) -> T + Sync,
    ) -> Vec<T> {
        let mut list = pages::with_capacity(self.len);
        for (geometry, first, len) in self.geometries() {
            let make = |i: usize| {
                let primitive = i as u32;
                make(first + i, geometry, primitive, primitives.extent(geometry, primitive))
            };
            match len {
                0..PARALLEL => list.extend((0..len).map(make)),
                _ => list.par_extend((0..len).into_par_iter().map(make)),
            }
        }
        list
    }

    /// The bounds of the doubled centroids.
    pub fn centroids(&self, primitives: &impl Primitives) -> Extent {
        let mut all = Extent::EMPTY;
        for (geometry, _, len) in self.geometries() {
            let centroid = |i: usize| {
                let extent = primitives.extent(geometry, i as u32);
                extent.map_or(Extent::EMPTY, |extent| Extent::point(extent.doubled_centroid()))
            };
            all = all.union(match len {
                0..PARALLEL => (0..len).map(centroid).fold(Extent::EMPTY, Extent::union),
                _ => (0..len).into_par_iter().map(centroid).reduce(|| Extent::EMPTY, Extent::union),
            });
        }
        all
    }
}
