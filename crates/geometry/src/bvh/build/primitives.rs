//! What trees are built over.

use super::pages;
use super::reference::{Extent, Reference};
use math::Vec3;
use rayon::prelude::*;

/// Fewer primitives are not worth another thread.
const PARALLEL: usize = 4096;

/// Geometries of numbered primitives, which leaves test in blocks.
pub(crate) trait Primitives: Sync {
    /// What a leaf tests at once.
    type Block: Copy + Send + Sync;

    /// What the test of a block costs, where that of a wide node's boxes costs 1.
    const COST: f32;

    /// The most primitives in a block: 1, 2, 4 or 8.
    fn width(&self) -> usize;

    /// Each geometry, and how many primitives it has.
    fn geometries(&self) -> Vec<(u32, usize)>;

    /// The box of a primitive. Those that are not finite have none, and are left out.
    fn extent(&self, geometry: u32, primitive: u32) -> Option<Extent>;

    /// The corners of what is a triangle.
    fn corners(&self, _geometry: u32, _primitive: u32) -> Option<[Vec3; 3]> {
        None
    }

    /// Asks for what [`Primitives::prefetch`] must read, soon to be read.
    fn prefetch_indices(&self, _geometry: u32, _primitive: u32) {}

    /// Asks for a primitive, soon to be put into a block.
    fn prefetch(&self, _geometry: u32, _primitive: u32) {}

    /// Makes a block; gives how many of the primitives, of which only the ids count, have found
    /// room in it, and the box around these. Those that have not will have blocks of their own.
    fn block(&self, primitives: &[Reference]) -> (Self::Block, usize, Extent);
}

/// The most that [`Primitives::width`] may be.
pub(super) const MAX_WIDTH: usize = 8;

/// Gives the primitives of all geometries numbers, one geometry after the other.
pub(super) struct Numbering {
    /// Geometries that have primitives, and the number of the first one.
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

    /// Each geometry, the number of its first primitive, and how many there are.
    fn geometries(&self) -> impl Iterator<Item = (u32, usize, usize)> {
        let ends = self.firsts.iter().skip(1).map(|&(_, first)| first).chain([self.len]);
        self.firsts.iter().zip(ends).map(|(&(geometry, first), end)| (geometry, first, end - first))
    }

    /// Makes something of each number, the geometry, the primitive and its box.
    pub fn map<T: Send>(
        &self,
        primitives: &impl Primitives,
        make: impl Fn(usize, u32, u32, Option<Extent>) -> T + Sync,
    ) -> Vec<T> {
        let mut list = pages::room(self.len);
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

    /// The range of the doubled centroids.
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
