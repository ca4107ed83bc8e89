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

use crate::exposure::Exposure;
use crate::grid::Grid;
use crate::layer::Layout;
use crate::sum::{OwnTileSums, SUM_BYTES, can_add, reserved};
use crate::{Buckets, Filter, Parts};

/// The sums of a pixel's splats of colour: the three responses of the sensor. Those of the buckets
/// of a spectral film follow, and then those of the parts of the light, as many for each.
pub(crate) const SPLAT_SUMS: usize = 3;

/// The bytes of the colour of a pixel's splats.
pub const SPLAT_BYTES: usize = SPLAT_SUMS * SUM_BYTES;

/// The sums of all splats on a film. They take no memory before it is reserved.
#[derive(Debug, Default)]
pub(crate) struct SplatSums {
    tiles: Vec<Mutex<OwnTileSums>>,
    paths: AtomicU64,
}

impl SplatSums {
    /// Allocates memory for a film of these tiles and this number of sums per pixel; refused where
    /// there is none.
    pub(crate) fn reserve(&mut self, grid: Grid, sums: usize) -> Result<(), ImageError> {
        if self.tiles.is_empty() {
            let mut tiles = reserved(grid.tile_count())?;
            for tile in 0..grid.tile_count() {
                tiles.push(Mutex::new(OwnTileSums::new(grid.bounds(tile).area(), sums)?));
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

    /// A sum of a pixel of a tile, in units of 2⁻⁶⁴.
    pub(crate) fn units(&self, tile: usize, pixel: usize, component: usize) -> i128 {
        if self.is_empty() { 0 } else { self.tile(tile).units(pixel, component) }
    }
}

/// Takes splats from any number of threads.
#[derive(Clone, Copy, Debug)]
pub struct Splatter<'film> {
    grid: Grid,
    filter: &'film Filter,
    filter_integral: f32,
    exposure: &'film Exposure,
    buckets: Option<Buckets>,
    layout: &'film Layout,
    sums: &'film SplatSums,
}

impl<'film> Splatter<'film> {
    /// The splatter for these sums, which have memory.
    pub(crate) fn new(
        grid: Grid,
        filter: &'film Filter,
        exposure: &'film Exposure,
        buckets: Option<Buckets>,
        layout: &'film Layout,
        sums: &'film SplatSums,
    ) -> Self {
        Self { grid, filter, filter_integral: filter.integral(), exposure, buckets, layout, sums }
    }

    /// No light, for the parts of splats; `None` if no layer of the film takes them.
    pub fn new_parts(&self) -> Option<Parts> {
        self.layout.layers().has_parts().then(|| Parts::new(self.layout.groups()))
    }

    /// Counts light paths, whether or not they have added splats.
    pub fn add_paths(&self, count: u64) {
        self.sums.add_paths(count);
    }

    /// All film positions (in pixels, (0, 0) being the top left corner of the whole picture) that
    /// reach a pixel which is rendered: the pixels, and around them as far as the filter goes.
    pub fn reach(&self) -> Bounds2 {
        reach(self.grid, self.filter)
    }

    /// Adds the light `l` of one path that arrives at a film position.
    pub fn add(&self, film: Point2, l: &SampledSpectrum, lambda: &SampledWavelengths) {
        self.add_with(film, l, lambda, None);
    }

    /// The same, with the parts of this light for the layers that take them.
    pub fn add_with(
        &self,
        film: Point2,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        parts: Option<&Parts>,
    ) {
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
                self.add_terms([x, y], rgb.map(|value| weight * value));
                self.add_to_buckets([x, y], l, lambda, weight);
                if let Some(parts) = parts {
                    self.add_to_parts([x, y], l, lambda, parts, weight);
                }
            }
        }
    }

    /// Adds the light `l` of one path to a pixel alone.
    pub fn add_to_pixel(&self, pixel: [i32; 2], l: &SampledSpectrum, lambda: &SampledWavelengths) {
        match self.measure(l, lambda) {
            Some(rgb) if self.grid.0.contains(pixel) => {
                self.add_terms(pixel, rgb);
                self.add_to_buckets(pixel, l, lambda, 1.0);
            }
            Some(_) => (),
            None => self.exposure.reject(pixel),
        }
    }

    /// Of as many paths as there are pixels, one arrives at each on average.
    fn measure(&self, l: &SampledSpectrum, lambda: &SampledWavelengths) -> Option<[f64; 3]> {
        self.exposure.measure(l, lambda, self.grid.0.area() as f32)
    }

    /// Adds terms to the sums of a pixel, of which they are the first.
    fn add_terms(&self, pixel: [i32; 2], terms: [f64; SPLAT_SUMS]) {
        self.add_each(pixel, terms.into_iter().enumerate());
    }

    /// Adds light to the buckets, if there are any: its integral over each bucket's wavelengths,
    /// over the bucket's width.
    fn add_to_buckets(&self, pixel: [i32; 2], l: &SampledSpectrum, lambda: &SampledWavelengths, weight: f64) {
        let Some(buckets) = self.buckets else { return };
        let count = buckets.count() as f64;
        let light = self.exposure.in_buckets(buckets, l, lambda, self.grid.0.area() as f32);
        let terms = light.map(|light| (SPLAT_SUMS + light.bucket, weight * light.l * light.share * count));
        self.add_each(pixel, terms);
    }

    /// Adds the parts of light to the layers that take them.
    fn add_to_parts(
        &self,
        pixel: [i32; 2],
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        parts: &Parts,
        weight: f64,
    ) {
        let before = SPLAT_SUMS + self.buckets.map_or(0, |buckets| buckets.count());
        let parts = self.layout.parts().flat_map(|(layer, _)| parts.of(layer));
        let terms = parts.flat_map(|part| self.exposure.part(part, l, lambda, self.grid.0.area() as f32));
        let terms = terms.map(|term| weight * f64::from(term));
        self.add_each(pixel, terms.enumerate().map(|(i, term)| (before + i, term)));
    }

    fn add_each(&self, pixel: [i32; 2], terms: impl Iterator<Item = (usize, f64)>) {
        let (tile, index) = self.grid.find(pixel);
        let mut sums = self.sums.tile(tile);
        let mut sums = sums.open();
        for (component, term) in terms.filter(|&(_, term)| can_add(term)) {
            sums.add(index, component, term);
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

/// All film positions that reach a pixel.
pub(crate) fn reach(grid: Grid, filter: &Filter) -> Bounds2 {
    let corner = |[x, y]: [i32; 2]| Vec2::new(x as f32, y as f32);
    // Pixels reach as far as the filter from their centres.
    let margin = filter.radius() - 0.5;
    Bounds2 { min: corner(grid.0.min) - margin, max: corner(grid.0.max) + margin }
}

fn lock(tile: &Mutex<OwnTileSums>) -> MutexGuard<'_, OwnTileSums> {
    tile.lock().unwrap_or_else(PoisonError::into_inner)
}
