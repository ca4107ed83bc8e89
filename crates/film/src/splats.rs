//! Light that arrives anywhere on the film, from paths that begin at lights.
//!
//! Such a path does not choose its pixel: its contribution c is splatted to every pixel whose
//! filter h covers its film position p. With n paths traced, wherever they ended, the pixel's value
//! is 1/n Σ c·h(p)/∫h. Paths are counted separately from their splats, because most have none.
//! [Pharr 2023 §5.4.4]
//!
//! Threads add to the same pixels, so each tile has a lock. The sums are exact, so the order of
//! threads does not matter.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use image::ImageError;
use math::{Bounds2, Bounds2i, Point2, Vec2};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::Filter;
use crate::exposure::Exposure;
use crate::grid::Grid;
use crate::sum::{OwnTileSums, SUM_BYTES, can_add, reserved};

/// The sums of a pixel's splats: the three responses of the sensor.
const SPLAT_SUMS: usize = 3;

/// The bytes of a pixel's splats.
pub const SPLAT_BYTES: usize = SPLAT_SUMS * SUM_BYTES;

/// The sums of all splats on a film. They take no memory before it is reserved.
#[derive(Debug, Default)]
pub(crate) struct SplatSums {
    tiles: Vec<Mutex<OwnTileSums>>,
    paths: AtomicU64,
}

impl SplatSums {
    /// Allocates memory for a film of these tiles; refused where there is none.
    pub(crate) fn reserve(&mut self, grid: Grid) -> Result<(), ImageError> {
        if self.tiles.is_empty() {
            let mut tiles = reserved(grid.tile_count())?;
            for tile in 0..grid.tile_count() {
                tiles.push(Mutex::new(OwnTileSums::new(grid.bounds(tile).area(), SPLAT_SUMS)?));
            }
            self.tiles = tiles;
        }
        Ok(())
    }

    /// Whether it has no memory for splats.
    pub(crate) fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    /// The number of light paths, whether or not they have added splats.
    pub(crate) fn paths(&self) -> u64 {
        self.paths.load(Ordering::Relaxed)
    }

    /// Counts light paths, whether or not they have added splats.
    pub(crate) fn add_paths(&self, count: u64) {
        self.paths.fetch_add(count, Ordering::Relaxed);
    }

    /// The sums of a tile.
    pub(crate) fn tile(&self, tile: usize) -> MutexGuard<'_, OwnTileSums> {
        lock(&self.tiles[tile])
    }

    /// Adds the splats of another film of the same pixels.
    pub(crate) fn merge(&mut self, other: &Self) {
        for (tile, other) in self.tiles.iter().zip(&other.tiles) {
            lock(tile).merge(&lock(other));
        }
        *self.paths.get_mut() += other.paths();
    }

    /// The sums of a pixel of a tile, in units of 2⁻⁶⁴.
    pub(crate) fn units(&self, tile: usize, pixel: usize) -> [i128; 3] {
        if self.is_empty() {
            return [0; 3];
        }
        let sums = self.tile(tile);
        [0, 1, 2].map(|c| sums.units(pixel, c))
    }
}

/// Takes splats from any number of threads.
#[derive(Clone, Copy, Debug)]
pub struct Splatter<'film> {
    grid: Grid,
    filter: &'film Filter,
    filter_integral: f32,
    exposure: &'film Exposure,
    sums: &'film SplatSums,
}

impl<'film> Splatter<'film> {
    /// The splatter for these sums, which have memory.
    pub(crate) fn new(
        grid: Grid,
        filter: &'film Filter,
        exposure: &'film Exposure,
        sums: &'film SplatSums,
    ) -> Self {
        Self { grid, filter, filter_integral: filter.integral(), exposure, sums }
    }

    /// Counts light paths, whether or not they have added splats.
    pub fn add_paths(&self, count: u64) {
        self.sums.add_paths(count);
    }

    /// All film positions (in pixels, (0, 0) being the top left corner of the whole picture) that
    /// reach a pixel which is rendered: the pixels, and around them as far as the filter goes.
    pub fn reach(&self) -> Bounds2 {
        let corner = |[x, y]: [i32; 2]| Vec2::new(x as f32, y as f32);
        // Pixels reach as far as the filter from their centres.
        let margin = self.filter.radius() - 0.5;
        Bounds2 { min: corner(self.grid.0.min) - margin, max: corner(self.grid.0.max) + margin }
    }

    /// Adds the light `l` of one path that arrives at a film position.
    pub fn add(&self, film: Point2, l: &SampledSpectrum, lambda: &SampledWavelengths) {
        let Some(rgb) = self.measure(l, lambda) else {
            let center = film.clamp(Vec2::splat(-1e9), Vec2::splat(1e9)).map(f32::floor);
            self.exposure.reject([center.x as i32, center.y as i32]);
            return;
        };
        let reached = self.reached(film);
        for y in reached.min[1]..reached.max[1] {
            for x in reached.min[0]..reached.max[0] {
                let offset = film - Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
                let weight = f64::from(self.filter.evaluate(offset) / self.filter_integral);
                self.add_rgb([x, y], rgb.map(|value| weight * value));
            }
        }
    }

    /// Adds the light `l` of one path to a pixel alone.
    pub fn add_to_pixel(&self, pixel: [i32; 2], l: &SampledSpectrum, lambda: &SampledWavelengths) {
        match self.measure(l, lambda) {
            Some(rgb) if self.grid.0.contains(pixel) => self.add_rgb(pixel, rgb),
            Some(_) => (),
            None => self.exposure.reject(pixel),
        }
    }

    /// Of as many paths as there are pixels, one arrives at each on average.
    fn measure(&self, l: &SampledSpectrum, lambda: &SampledWavelengths) -> Option<[f64; 3]> {
        self.exposure.measure(l, lambda, self.grid.0.area() as f32)
    }

    fn add_rgb(&self, pixel: [i32; 2], rgb: [f64; 3]) {
        let (tile, index) = self.grid.find(pixel);
        let mut sums = self.sums.tile(tile);
        let mut sums = sums.open();
        for (c, term) in rgb.into_iter().enumerate() {
            if can_add(term) {
                sums.add(index, c, term);
            }
        }
    }

    /// The pixels whose filter reaches a film position.
    fn reached(&self, film: Point2) -> Bounds2i {
        if !film.is_finite() {
            return Bounds2i::new([0, 0], [0, 0]);
        }
        let radius = self.filter.radius();
        // Pixel x has its centre at x + ½.
        let (first, last) = ((film - radius - 0.5).map(f32::ceil), (film + radius - 0.5).map(f32::floor));
        let reached = Bounds2i::new(
            [first.x as i32, first.y as i32],
            [(last.x as i32).saturating_add(1), (last.y as i32).saturating_add(1)],
        );
        self.grid.0.intersection(&reached)
    }
}

fn lock(tile: &Mutex<OwnTileSums>) -> MutexGuard<'_, OwnTileSums> {
    tile.lock().unwrap_or_else(PoisonError::into_inner)
}
