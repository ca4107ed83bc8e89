//! The film: samples of light go in, in any order and from any number of threads; a picture comes
//! out.
//!
//! A pixel is Σ wᵢ cᵢ / Σ wᵢ over its samples, c being the sensor's response to a sample's light
//! and w its filter weight. Both sums are [`ExactSum`]s, so that threads, tiles and merges never
//! change a bit. Samples that are not numbers, or are too large for the sums, are left out with
//! their weight, and counted.
//!
//! Pixels are stored tile by tile, so that each tile is a contiguous slice that one thread can
//! fill.

use std::collections::BTreeSet;
use std::slice::from_ref;
use std::sync::{Mutex, MutexGuard, PoisonError};

use image::{Chromaticities, Image, ImageError, ImageMetadata, Window};
use math::Bounds2i;
use spectrum::{Rgb, RgbColorSpace, SampledSpectrum, SampledWavelengths};

use crate::splats::{Grid, SplatSums};
use crate::{ExactSum, Filter, PixelSensor, Splatter};

/// Side of a tile in pixels.
pub const TILE_SIZE: i32 = 16;

/// How many pixels [`Rejected`] remembers.
pub const MAX_REJECTED_PIXELS: usize = 16;

/// What a film is made of.
#[derive(Clone, Debug)]
pub struct FilmSettings {
    /// Width and height of the whole image in pixels.
    pub full_resolution: [i32; 2],
    /// The pixels to render.
    pub pixel_bounds: Bounds2i,
    /// Diagonal of the film in metres.
    pub diagonal: f32,
    /// The pixel filter.
    pub filter: Filter,
    /// How light becomes numbers.
    pub sensor: PixelSensor,
    /// Samples are scaled down so that no sensor response exceeds this.
    pub max_component_value: f32,
    /// The colour space of the picture.
    pub color_space: &'static RgbColorSpace,
    /// The picture has half floats.
    pub half_floats: bool,
}

/// The samples that a film refused.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Rejected {
    /// How many.
    pub count: u64,
    /// The pixels, as (row, column), of at most [`MAX_REJECTED_PIXELS`] of them: the first ones in
    /// reading order.
    pixels: BTreeSet<(i32, i32)>,
}

impl Rejected {
    fn add(&mut self, [x, y]: [i32; 2]) {
        self.count += 1;
        self.remember((y, x));
    }

    fn remember(&mut self, pixel: (i32, i32)) {
        self.pixels.insert(pixel);
        if self.pixels.len() > MAX_REJECTED_PIXELS {
            self.pixels.pop_last();
        }
    }

    fn merge(&mut self, other: &Self) {
        self.count += other.count;
        other.pixels.iter().for_each(|&pixel| self.remember(pixel));
    }

    /// Their pixels in reading order, at most [`MAX_REJECTED_PIXELS`].
    pub fn pixels(&self) -> impl Iterator<Item = [i32; 2]> + '_ {
        self.pixels.iter().map(|&(y, x)| [x, y])
    }
}

/// What has come in at one pixel.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Pixel {
    rgb: [ExactSum; 3],
    weight: ExactSum,
    samples: u64,
}

impl Pixel {
    fn merge(&mut self, other: &Self) {
        (0..3).for_each(|c| self.rgb[c].merge(other.rgb[c]));
        self.weight.merge(other.weight);
        self.samples += other.samples;
    }

    /// Red, green, blue, weight, samples.
    fn component(&self, component: usize) -> i128 {
        match component {
            0..3 => self.rgb[component].units(),
            3 => self.weight.units(),
            _ => self.samples.into(),
        }
    }

    fn add_component(&mut self, component: usize, value: i128) -> Result<(), String> {
        match component {
            0..3 => self.rgb[component].merge(ExactSum::from_units(value)),
            3 => self.weight.merge(ExactSum::from_units(value)),
            _ => {
                let count = u64::try_from(value).ok().and_then(|count| self.samples.checked_add(count));
                self.samples = count.ok_or_else(|| format!("{value} samples"))?;
            }
        }
        Ok(())
    }

    /// The mean sensor response; black before the first sample.
    fn mean(&self) -> [f64; 3] {
        let weight = self.weight.value();
        if weight == 0.0 { [0.0; 3] } else { self.rgb.map(|sum| sum.value() / weight) }
    }
}

/// Measures samples: what tiles of a film share.
#[derive(Debug)]
pub(crate) struct Gate {
    sensor: PixelSensor,
    max_component_value: f32,
    rejected: Mutex<Rejected>,
}

impl Gate {
    fn rejected(&self) -> MutexGuard<'_, Rejected> {
        self.rejected.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The sensor's response to light that counts one in `samples` of a pixel, not beyond what a
    /// whole sample may have; `None` for light that is no number.
    pub(crate) fn measure(
        &self,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        samples: f32,
    ) -> Option<[f64; 3]> {
        let mut rgb = self.sensor.to_sensor_rgb(l, lambda);
        let (largest, limit) = (rgb.max_component(), self.max_component_value * samples);
        if largest > limit {
            rgb *= limit / largest;
        }
        let rgb = rgb.to_array().map(f64::from);
        (l.is_finite() && rgb.into_iter().all(ExactSum::can_add)).then_some(rgb)
    }

    /// Counts a sample that is left out.
    pub(crate) fn reject(&self, at: [i32; 2]) {
        self.rejected().add(at);
    }

    /// Adds a sample of equal parts, each with wavelengths of its own.
    fn add(
        &self,
        at: [i32; 2],
        pixel: &mut Pixel,
        l: &[SampledSpectrum],
        lambda: &[SampledWavelengths],
        weight: f32,
    ) {
        let weight = f64::from(weight);
        let part = weight / l.len() as f64;
        let terms = l.iter().zip(lambda).try_fold([0.0; 3], |sum, (l, lambda)| {
            let rgb = self.measure(l, lambda, 1.0)?;
            Some([0, 1, 2].map(|c: usize| sum[c] + part * rgb[c]))
        });
        match terms {
            Some(terms) if terms.into_iter().chain([weight]).all(ExactSum::can_add) => {
                pixel.rgb.iter_mut().zip(terms).for_each(|(sum, term)| sum.add(term));
                pixel.weight.add(weight);
                pixel.samples += 1;
            }
            _ => self.reject(at),
        }
    }
}

/// The layers of a film's pixels: samples of radiance, and splats.
const SAMPLES: &str = "samples";
const SPLATS: &str = "splats";

/// A film.
#[derive(Debug)]
pub struct Film {
    full_resolution: [i32; 2],
    bounds: Bounds2i,
    diagonal: f32,
    filter: Filter,
    gate: Gate,
    color_space: &'static RgbColorSpace,
    half_floats: bool,
    pixels: Vec<Pixel>,
    splats: SplatSums,
}

impl Film {
    /// A film without light. Refused if there is no pixel to render, or more than memory has room
    /// for.
    pub fn new(settings: FilmSettings) -> Result<Self, ImageError> {
        let FilmSettings { full_resolution, pixel_bounds: bounds, diagonal, filter, sensor, .. } = settings;
        let full = Bounds2i::new([0, 0], full_resolution);
        if bounds.area() == 0 || bounds.intersection(&full) != bounds {
            return Err(ImageError::Invalid(format!(
                "no pixels to render: x {}..{}, y {}..{} of {} × {}",
                bounds.min[0],
                bounds.max[0],
                bounds.min[1],
                bounds.max[1],
                full_resolution[0],
                full_resolution[1]
            )));
        }
        let mut pixels = Vec::new();
        if pixels.try_reserve_exact(bounds.area()).is_err() {
            return Err(ImageError::Limits(format!(
                "no memory for {} × {} pixels",
                bounds.width(),
                bounds.height()
            )));
        }
        pixels.resize(bounds.area(), Pixel::default());
        let gate =
            Gate { sensor, max_component_value: settings.max_component_value, rejected: Mutex::default() };
        let (color_space, half_floats) = (settings.color_space, settings.half_floats);
        let splats = SplatSums::default();
        Ok(Self { full_resolution, bounds, diagonal, filter, gate, color_space, half_floats, pixels, splats })
    }

    /// A film with the same pixels and settings, without light.
    pub fn blank(&self) -> Self {
        let gate = Gate {
            sensor: self.gate.sensor.clone(),
            max_component_value: self.gate.max_component_value,
            rejected: Mutex::default(),
        };
        let pixels = vec![Pixel::default(); self.pixels.len()];
        Self { filter: self.filter.clone(), gate, pixels, splats: SplatSums::default(), ..*self }
    }

    /// A [`blank`](Self::blank) film for splats alone, which takes
    /// [`SPLAT_BYTES`](crate::SPLAT_BYTES) for each pixel; it has no tiles.
    pub fn for_splats(&self) -> Self {
        Self { pixels: Vec::new(), ..self.blank() }
    }

    /// What it was made of.
    pub fn settings(&self) -> FilmSettings {
        FilmSettings {
            full_resolution: self.full_resolution,
            pixel_bounds: self.bounds,
            diagonal: self.diagonal,
            filter: self.filter.clone(),
            sensor: self.gate.sensor.clone(),
            max_component_value: self.gate.max_component_value,
            color_space: self.color_space,
            half_floats: self.half_floats,
        }
    }

    /// A film with these of the layers that [`Self::layer_names`] tells.
    pub(crate) fn with_layers(settings: FilmSettings, layers: &[&str]) -> Result<Self, ImageError> {
        let mut film = Self::new(settings)?;
        if !layers.contains(&SAMPLES) {
            film.pixels = Vec::new();
        }
        if layers.contains(&SPLATS) {
            film.splats.make_room(&film.bounds);
        }
        Ok(film)
    }

    /// The bytes that [`Self::with_layers`] takes, or what is wrong with the layers.
    pub(crate) fn bytes_of(settings: &FilmSettings, layers: &[&str]) -> Result<u64, String> {
        let layer_bytes = |layer: &&str| match *layer {
            SAMPLES => Ok(size_of::<Pixel>() as u64),
            SPLATS => Ok(crate::SPLAT_BYTES as u64),
            other => Err(format!("an unknown layer `{other}`")),
        };
        let bytes: u64 = layers.iter().map(layer_bytes).sum::<Result<_, _>>()?;
        Ok(settings.pixel_bounds.area() as u64 * bytes)
    }

    /// The layers that the film has.
    pub(crate) fn layer_names(&self) -> Vec<&'static str> {
        let samples = (!self.pixels.is_empty()).then_some(SAMPLES);
        samples.into_iter().chain((!self.splats.is_empty()).then_some(SPLATS)).collect()
    }

    fn sample_components(&self) -> usize {
        if self.pixels.is_empty() { 0 } else { 5 }
    }

    /// How many numbers its layers have for a pixel.
    pub(crate) fn component_count(&self) -> usize {
        self.sample_components() + if self.splats.is_empty() { 0 } else { 3 }
    }

    /// The numbers of one component of a tile, pixel by pixel.
    pub(crate) fn sums(&self, tile: usize, component: usize) -> Vec<i128> {
        match component.checked_sub(self.sample_components()) {
            Some(component) => self.splats.sums(tile, component),
            None => {
                self.pixels[self.tile_range(tile)].iter().map(|pixel| pixel.component(component)).collect()
            }
        }
    }

    /// Adds to the numbers of one component of a tile.
    pub(crate) fn add_sums(&mut self, tile: usize, component: usize, sums: &[i128]) -> Result<(), String> {
        if let Some(component) = component.checked_sub(self.sample_components()) {
            self.splats.add_sums(tile, component, sums);
            return Ok(());
        }
        let range = self.tile_range(tile);
        for (pixel, &sum) in self.pixels[range].iter_mut().zip(sums) {
            pixel.add_component(component, sum)?;
        }
        Ok(())
    }

    fn tile_range(&self, tile: usize) -> std::ops::Range<usize> {
        let tile = Grid(self.bounds).bounds(tile);
        let start = self.index(tile.min);
        start..start + tile.area()
    }

    /// How many rows of tiles it has.
    pub(crate) fn tile_rows(&self) -> usize {
        Grid(self.bounds).rows()
    }

    /// The tiles of a row.
    pub(crate) fn tiles_of_row(&self, row: usize) -> std::ops::Range<usize> {
        let columns = Grid(self.bounds).columns();
        row * columns..(row + 1) * columns
    }

    /// How many pixels a tile has.
    pub(crate) fn tile_area(&self, tile: usize) -> usize {
        Grid(self.bounds).bounds(tile).area()
    }

    /// How many paths had their chance to add splats.
    pub(crate) fn path_count(&self) -> u64 {
        self.splats.paths()
    }

    /// Counts paths that had their chance to add splats.
    pub(crate) fn add_path_count(&mut self, paths: u64) {
        self.splats.add_paths(paths);
    }

    /// Counts refused samples of which some were at these pixels.
    pub(crate) fn add_rejected(&mut self, count: u64, pixels: impl IntoIterator<Item = [i32; 2]>) {
        let pixels = pixels.into_iter().map(|[x, y]| (y, x)).collect();
        self.gate.rejected().merge(&Rejected { count, pixels });
    }

    /// Width and height of the whole image in pixels.
    pub fn full_resolution(&self) -> [i32; 2] {
        self.full_resolution
    }

    /// The pixels to render.
    pub fn pixel_bounds(&self) -> Bounds2i {
        self.bounds
    }

    /// Diagonal of the film in metres.
    pub fn diagonal(&self) -> f32 {
        self.diagonal
    }

    /// The pixel filter.
    pub fn filter(&self) -> &Filter {
        &self.filter
    }

    /// The colour space of the picture.
    pub fn color_space(&self) -> &'static RgbColorSpace {
        self.color_space
    }

    /// Wavelengths for a path, from `u` in [0, 1).
    pub fn sample_wavelengths(&self, u: f32) -> SampledWavelengths {
        SampledWavelengths::sample_visible(u)
    }

    /// Adds a sample of radiance `l` to a pixel.
    ///
    /// # Panics
    /// If the pixel is not to be rendered.
    pub fn add_sample(
        &mut self,
        pixel: [i32; 2],
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        weight: f32,
    ) {
        let index = self.index(pixel);
        self.gate.add(pixel, &mut self.pixels[index], from_ref(l), from_ref(lambda), weight);
    }

    /// The film cut into tiles, at most [`TILE_SIZE`] pixels wide and high, that different threads
    /// can fill.
    pub fn tiles_mut(&mut self) -> Vec<FilmTile<'_>> {
        tiles(&self.bounds, &mut self.pixels, &self.gate)
    }

    /// [`Film::tiles_mut`], and what takes light that arrives anywhere.
    pub fn tiles_and_splatter(&mut self) -> (Vec<FilmTile<'_>>, Splatter<'_>) {
        self.splats.make_room(&self.bounds);
        let splatter = Splatter {
            bounds: self.bounds,
            filter: &self.filter,
            filter_integral: self.filter.integral(),
            gate: &self.gate,
            sums: &self.splats,
        };
        (tiles(&self.bounds, &mut self.pixels, &self.gate), splatter)
    }

    /// Adds everything that has come in at another film of the same pixels and settings.
    ///
    /// # Panics
    /// If the other film has other pixels.
    pub fn merge(&mut self, other: &Self) {
        assert_eq!(self.bounds, other.bounds, "films of the same pixels can be merged");
        self.pixels.iter_mut().zip(&other.pixels).for_each(|(pixel, other)| pixel.merge(other));
        self.splats.merge(&other.splats, &self.bounds);
        let rejected = other.rejected();
        self.gate.rejected().merge(&rejected);
    }

    /// How many samples have come in.
    pub fn sample_count(&self) -> u64 {
        self.pixels.iter().map(|pixel| pixel.samples).sum()
    }

    /// How many samples have come in at a pixel.
    ///
    /// # Panics
    /// If the pixel is not to be rendered.
    pub fn pixel_sample_count(&self, pixel: [i32; 2]) -> u64 {
        self.pixels[self.index(pixel)].samples
    }

    /// The samples that were refused.
    pub fn rejected(&self) -> Rejected {
        self.gate.rejected().clone()
    }

    /// The picture as it stands: linear R, G and B in the film's colour space.
    pub fn develop(&self) -> Image {
        let output_from_sensor = self.color_space.rgb_from_xyz() * self.gate.sensor.xyz_from_sensor_rgb();
        let [x0, y0] = self.bounds.min;
        let (width, height) = (self.bounds.width() as u32, self.bounds.height() as u32);
        let image = Image::from_fn(width, height, ["R", "G", "B"], |x, y| {
            let at = [x0 + x as i32, y0 + y as i32];
            let mean = self.pixels.get(self.index(at)).map_or([0.0; 3], Pixel::mean);
            let splat = self.splats.value(&self.bounds, at);
            let response = [0, 1, 2].map(|c| mean[c] + splat[c]);
            let rgb = Rgb::from(output_from_sensor.apply(response).map(|c| c as f32));
            if self.half_floats { rgb.clamp(-MAX_HALF, MAX_HALF) } else { rgb }.to_array()
        });
        let mut image = if self.half_floats { image.to_f16() } else { image };
        let [red, green, blue] = self.color_space.primaries();
        image.metadata = ImageMetadata {
            chromaticities: Some(Chromaticities { red, green, blue, white: self.color_space.white() }),
            data_window: Some(Window { min: self.bounds.min, max: self.bounds.max }),
            display_window: Some(Window { min: [0, 0], max: self.full_resolution }),
            ..ImageMetadata::default()
        };
        image
    }

    /// Where a pixel is stored: whole rows of tiles, then whole tiles, then rows of its tile come
    /// before it.
    fn index(&self, pixel: [i32; 2]) -> usize {
        assert!(self.bounds.contains(pixel), "{pixel:?} is not rendered");
        let corner = |axis: usize| {
            let offset = pixel[axis] - self.bounds.min[axis];
            pixel[axis] - offset % TILE_SIZE
        };
        let tile = tile_at(&self.bounds, [corner(0), corner(1)]);
        let rows_above = (tile.min[1] - self.bounds.min[1]) as usize;
        let columns_left = (tile.min[0] - self.bounds.min[0]) as usize;
        rows_above * self.bounds.width() as usize
            + columns_left * tile.height() as usize
            + index_in(&tile, pixel)
    }
}

fn tiles<'film>(bounds: &Bounds2i, pixels: &'film mut [Pixel], gate: &'film Gate) -> Vec<FilmTile<'film>> {
    let mut tiles = Vec::new();
    if pixels.is_empty() {
        return tiles;
    }
    let mut rest = pixels;
    for y in (bounds.min[1]..bounds.max[1]).step_by(TILE_SIZE as usize) {
        for x in (bounds.min[0]..bounds.max[0]).step_by(TILE_SIZE as usize) {
            let bounds = tile_at(bounds, [x, y]);
            let (pixels, others) = std::mem::take(&mut rest).split_at_mut(bounds.area());
            tiles.push(FilmTile { bounds, pixels, gate });
            rest = others;
        }
    }
    tiles
}

/// The largest finite half float.
const MAX_HALF: f32 = 65504.0;

/// The tile with this corner.
pub(crate) fn tile_at(bounds: &Bounds2i, min: [i32; 2]) -> Bounds2i {
    Bounds2i::new(min, [0, 1].map(|axis: usize| bounds.max[axis].min(min[axis] + TILE_SIZE)))
}

fn index_in(tile: &Bounds2i, [x, y]: [i32; 2]) -> usize {
    (y - tile.min[1]) as usize * tile.width() as usize + (x - tile.min[0]) as usize
}

/// A part of a film that one thread fills.
#[derive(Debug)]
pub struct FilmTile<'film> {
    bounds: Bounds2i,
    pixels: &'film mut [Pixel],
    gate: &'film Gate,
}

impl FilmTile<'_> {
    /// Its pixels.
    pub fn bounds(&self) -> Bounds2i {
        self.bounds
    }

    /// Adds a sample of radiance `l` to a pixel.
    ///
    /// # Panics
    /// If the pixel is not in the tile.
    pub fn add_sample(
        &mut self,
        pixel: [i32; 2],
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        weight: f32,
    ) {
        self.add_groups(pixel, from_ref(l), from_ref(lambda), weight);
    }

    /// Adds one sample of radiance to a pixel that is known at several groups of wavelengths, which
    /// count alike.
    ///
    /// # Panics
    /// If the pixel is not in the tile.
    pub fn add_groups(
        &mut self,
        pixel: [i32; 2],
        l: &[SampledSpectrum],
        lambda: &[SampledWavelengths],
        weight: f32,
    ) {
        assert!(self.bounds.contains(pixel), "{pixel:?} is not in the tile");
        let index = index_in(&self.bounds, pixel);
        self.gate.add(pixel, &mut self.pixels[index], l, lambda, weight);
    }
}
