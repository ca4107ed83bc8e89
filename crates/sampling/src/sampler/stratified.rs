//! A grid of cells over each pixel, with one sample in each; for other dimensions the cells are
//! shuffled [Pharr 2023 §8.5]. Beyond the number of cells, another grid begins.

use super::address::Address;
use super::independent::Independent;
use super::randomize::{pixel_hash, shuffled};
use math::{ONE_MINUS_EPSILON, Vec2};

/// One sample in each cell of a grid over each pixel; beyond the number of cells another grid
/// begins.
#[derive(Clone, Debug)]
pub struct Stratified {
    grid: [u32; 2],
    /// Positions in cells, if they are random.
    jitter: Option<Independent>,
    seed: u32,
    pixel: [i32; 2],
    index: u32,
    dimension: u32,
}

impl Stratified {
    /// A sampler with `grid[0] · grid[1]` samples per pixel, at random positions in their cells, or
    /// at the centres.
    pub fn new(grid: [u32; 2], jitter: bool, seed: u32) -> Stratified {
        let grid = grid.map(|n| n.max(1));
        let jitter = jitter.then(|| Independent::new(1, seed));
        Stratified { grid, jitter, seed, pixel: [0; 2], index: 0, dimension: 0 }
    }

    /// Columns and rows of the grid, the seed, and the hash of it where positions are random.
    pub fn parts(&self) -> ([u32; 2], u32, Option<u32>) {
        (self.grid, self.seed, self.jitter.as_ref().map(Independent::key))
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.grid[0].saturating_mul(self.grid[1])
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        (self.pixel, self.index, self.dimension) = (pixel, index, dimension);
    }

    #[inline]
    pub(super) fn dimension(&self) -> u32 {
        self.dimension
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        let [place, _] = self.places();
        within(self.next_cell(1), place, self.samples_per_pixel())
    }

    pub(super) fn get_2d(&mut self) -> Vec2 {
        let ([columns, rows], [x, y]) = (self.grid, self.places());
        let cell = self.next_cell(2);
        Vec2::new(within(cell % columns, x, columns), within(cell / columns, y, rows))
    }

    pub(super) fn get_pixel_2d(&mut self) -> Vec2 {
        self.get_2d()
    }

    /// The cell of this sample in the next dimensions.
    fn next_cell(&mut self, dimensions: u32) -> u32 {
        let hash = pixel_hash(self.pixel, self.dimension, self.seed);
        self.dimension += dimensions;
        shuffled(self.index, self.samples_per_pixel(), hash as u32).0
    }

    /// The positions of this sample in its cells.
    fn places(&self) -> [f32; 2] {
        let address = Address::new(self.pixel, self.index, self.dimension);
        self.jitter.as_ref().map_or([0.5; 2], |jitter| jitter.at_2d(&address))
    }
}

/// The number at a place of one of `count` cells.
fn within(cell: u32, place: f32, count: u32) -> f32 {
    ((cell as f32 + place) / count as f32).min(ONE_MINUS_EPSILON)
}
