//! A grid of cells over each pixel, with one sample in each; for other dimensions the cells are
//! shuffled [Pharr 2023 §8.5]. Beyond the number of cells, another grid begins.

use super::independent::pixel_rng;
use super::randomize::{pixel_hash, shuffled};
use crate::Rng;
use math::{ONE_MINUS_EPSILON, Vec2};

/// One sample in each cell of a grid over each pixel; beyond the number of cells another grid
/// begins.
#[derive(Clone, Debug)]
pub struct Stratified {
    grid: [u32; 2],
    jitter: bool,
    seed: u32,
    pixel: [i32; 2],
    index: u32,
    dimension: u32,
    rng: Rng,
}

impl Stratified {
    /// A sampler with `grid[0] · grid[1]` samples per pixel, at random positions in their cells, or
    /// at the centres.
    pub fn new(grid: [u32; 2], jitter: bool, seed: u32) -> Stratified {
        let grid = grid.map(|n| n.max(1));
        Stratified { grid, jitter, seed, pixel: [0; 2], index: 0, dimension: 0, rng: Rng::new(0, 0) }
    }

    pub(super) fn samples_per_pixel(&self) -> u32 {
        self.grid[0].saturating_mul(self.grid[1])
    }

    pub(super) fn start_pixel_sample(&mut self, pixel: [i32; 2], index: u32, dimension: u32) {
        (self.pixel, self.index, self.dimension) = (pixel, index, dimension);
        self.rng = pixel_rng(pixel, index, dimension, self.seed);
    }

    #[inline]
    pub(super) fn dimension(&self) -> u32 {
        self.dimension
    }

    pub(super) fn get_1d(&mut self) -> f32 {
        let count = self.samples_per_pixel();
        let cell = self.next_cell(1);
        self.within(cell, count)
    }

    pub(super) fn get_2d(&mut self) -> Vec2 {
        let [columns, rows] = self.grid;
        let cell = self.next_cell(2);
        let x = self.within(cell % columns, columns);
        Vec2::new(x, self.within(cell / columns, rows))
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

    fn within(&mut self, cell: u32, count: u32) -> f32 {
        let offset = if self.jitter { self.rng.uniform_f32() } else { 0.5 };
        ((cell as f32 + offset) / count as f32).min(ONE_MINUS_EPSILON)
    }
}
