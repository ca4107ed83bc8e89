//! Light that arrives anywhere on the film, from paths that begin at lights.
//!
//! Such a path does not choose its pixel: it adds its contribution c to every pixel whose filter h
//! reaches its film position p. With n paths traced, wherever they ended, the pixel's value is 1/n
//! Σ c·h(p)/∫h. That is why paths are counted apart from what they bring: most bring nothing.
//! [Pharr 2023 §5.4.4]
//!
//! Threads add to the same pixels, so each tile has a lock; the sums are exact, so the order does
//! not matter.

use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};

use math::{Bounds2, Bounds2i, Point2, Vec2};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::film::{Gate, tile_at};
use crate::{ExactSum, Filter, TILE_SIZE};

/// What has been splatted on one pixel.
type Splat = [ExactSum; 3];

/// What the splats of a film take for each of its pixels, in bytes.
pub const SPLAT_BYTES: usize = size_of::<Splat>();

/// All that has been splatted on a film; takes no memory for pixels before the first splat is
/// possible.
#[derive(Debug, Default)]
pub(crate) struct SplatSums {
    tiles: Vec<Mutex<Box<[Splat]>>>,
    paths: AtomicU64,
}

impl SplatSums {
    /// Makes room for a film of these pixels.
    pub(crate) fn make_room(&mut self, bounds: &Bounds2i) {
        if self.tiles.is_empty() {
            let grid = Grid(*bounds);
            self.tiles = (0..grid.tiles())
                .map(|tile| Mutex::new(vec![Splat::default(); grid.bounds(tile).area()].into_boxed_slice()))
                .collect();
        }
    }

    pub(crate) fn is_empty(&self) -> bool {
        self.tiles.is_empty()
    }

    pub(crate) fn paths(&self) -> u64 {
        self.paths.load(Ordering::Relaxed)
    }

    pub(crate) fn add_paths(&self, count: u64) {
        self.paths.fetch_add(count, Ordering::Relaxed);
    }

    /// One component of a tile, in units of the sums.
    pub(crate) fn sums(&self, tile: usize, component: usize) -> Vec<i128> {
        lock(&self.tiles[tile]).iter().map(|splat| splat[component].units()).collect()
    }

    /// Adds units to one component of a tile.
    pub(crate) fn add_sums(&self, tile: usize, component: usize, sums: &[i128]) {
        for (splat, &sum) in lock(&self.tiles[tile]).iter_mut().zip(sums) {
            splat[component].merge(ExactSum::from_units(sum));
        }
    }

    pub(crate) fn merge(&mut self, other: &Self, bounds: &Bounds2i) {
        if other.tiles.is_empty() {
            return;
        }
        self.make_room(bounds);
        for (tile, other) in self.tiles.iter().zip(&other.tiles) {
            for (splat, other) in lock(tile).iter_mut().zip(&*lock(other)) {
                splat.iter_mut().zip(other).for_each(|(sum, other)| sum.merge(*other));
            }
        }
        *self.paths.get_mut() += other.paths.load(Ordering::Relaxed);
    }

    /// What the paths have brought to a pixel, in sensor RGB.
    pub(crate) fn value(&self, bounds: &Bounds2i, pixel: [i32; 2]) -> [f64; 3] {
        let paths = self.paths.load(Ordering::Relaxed);
        if paths == 0 {
            return [0.0; 3];
        }
        let (tile, index) = Grid(*bounds).find(pixel);
        lock(&self.tiles[tile])[index].map(|sum| sum.value() / paths as f64)
    }
}

/// Takes splats from any number of threads.
#[derive(Clone, Copy, Debug)]
pub struct Splatter<'film> {
    pub(crate) bounds: Bounds2i,
    pub(crate) filter: &'film Filter,
    pub(crate) filter_integral: f32,
    pub(crate) gate: &'film Gate,
    pub(crate) sums: &'film SplatSums,
}

impl Splatter<'_> {
    /// Counts paths that had their chance to add splats.
    pub fn add_paths(&self, count: u64) {
        self.sums.add_paths(count);
    }

    /// All film positions (in pixels, (0, 0) being the top left corner of the whole picture) that
    /// reach a pixel which is rendered: the pixels, and around them as far as the filter goes.
    pub fn reach(&self) -> Bounds2 {
        let corner = |[x, y]: [i32; 2]| Vec2::new(x as f32, y as f32);
        // Pixels reach as far as the filter from their centres.
        let margin = self.filter.radius() - 0.5;
        Bounds2 { min: corner(self.bounds.min) - margin, max: corner(self.bounds.max) + margin }
    }

    /// Adds the light `l` of one path that arrives at a film position.
    pub fn add(&self, film: Point2, l: &SampledSpectrum, lambda: &SampledWavelengths) {
        let Some(rgb) = self.measure(l, lambda) else {
            let center = film.clamp(Vec2::splat(-1e9), Vec2::splat(1e9)).floor();
            self.gate.reject([center.x as i32, center.y as i32]);
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
            Some(rgb) if self.bounds.contains(pixel) => self.add_rgb(pixel, rgb),
            Some(_) => (),
            None => self.gate.reject(pixel),
        }
    }

    /// Of as many paths as there are pixels, one arrives at each on average.
    fn measure(&self, l: &SampledSpectrum, lambda: &SampledWavelengths) -> Option<[f64; 3]> {
        self.gate.measure(l, lambda, self.bounds.area() as f32)
    }

    fn add_rgb(&self, pixel: [i32; 2], rgb: [f64; 3]) {
        let (tile, index) = Grid(self.bounds).find(pixel);
        let mut tile = lock(&self.sums.tiles[tile]);
        for (sum, term) in tile[index].iter_mut().zip(rgb) {
            if ExactSum::can_add(term) {
                sum.add(term);
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
        let (first, last) = ((film - radius - 0.5).ceil(), (film + radius - 0.5).floor());
        let reached = Bounds2i::new(
            [first.x as i32, first.y as i32],
            [(last.x as i32).saturating_add(1), (last.y as i32).saturating_add(1)],
        );
        self.bounds.intersection(&reached)
    }
}

/// The film's pixels in tiles, as they are stored.
#[derive(Clone, Copy)]
pub(crate) struct Grid(pub(crate) Bounds2i);

impl Grid {
    pub(crate) fn columns(self) -> usize {
        (self.0.width() as usize).div_ceil(TILE_SIZE as usize)
    }

    pub(crate) fn rows(self) -> usize {
        (self.0.height() as usize).div_ceil(TILE_SIZE as usize)
    }

    fn tiles(self) -> usize {
        self.columns() * self.rows()
    }

    pub(crate) fn bounds(self, tile: usize) -> Bounds2i {
        let (row, column) = ((tile / self.columns()) as i32, (tile % self.columns()) as i32);
        tile_at(&self.0, [self.0.min[0] + column * TILE_SIZE, self.0.min[1] + row * TILE_SIZE])
    }

    /// The tile of a pixel, and the pixel's index in it.
    fn find(self, [x, y]: [i32; 2]) -> (usize, usize) {
        let (x, y) = ((x - self.0.min[0]) as usize, (y - self.0.min[1]) as usize);
        let side = TILE_SIZE as usize;
        let tile = y / side * self.columns() + x / side;
        (tile, y % side * self.bounds(tile).width() as usize + x % side)
    }
}

fn lock(tile: &Mutex<Box<[Splat]>>) -> MutexGuard<'_, Box<[Splat]>> {
    tile.lock().unwrap_or_else(PoisonError::into_inner)
}
