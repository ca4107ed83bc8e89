//! The film: takes samples of light, in any order and from any number of threads, and gives a
//! picture.
//!
//! A pixel is Σ wᵢ cᵢ / Σ wᵢ over its samples, c being the sensor's response to a sample's light
//! and w its filter weight. All sums are exact, so that threads, tiles and merges never change a
//! bit. Samples that are not finite, or are too large for the sums, are left out with their weight,
//! and counted.
//!
//! Sums are stored tile by tile, so that each tile is a contiguous slice that one thread can fill.
//! A pixel takes [`PIXEL_BYTES`] for its colour, 12 bytes for each further sum (a layer has one for
//! each of its numbers, and two serve all layers of first hits; a bucket of a spectral film has
//! two), once there are splats [`SPLAT_BYTES`] for their colour and for each part of the light, and
//! 12 bytes for each bucket, and about [`ID_BYTES`] for each identifier in it.

use std::sync::Arc;

use description::GBufferSpace;
use image::{ImageError, require_memory};
use math::{Bounds2, Bounds2i};
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths};

use crate::exposure::Exposure;
use crate::grid::Grid;
use crate::layer::Layout;
use crate::splats::{SPLAT_SUMS, SplatSums, reach};
use crate::sum::{SUM_BYTES, Sums, maps, reserved, zeros};
use crate::tile::{FilmTile, IdSums, TileData};
use crate::{Buckets, Filter, Layer, LayerSet, PixelSensor, Rejected, SPLAT_BYTES, Sample, Splatter};

/// The sums of a pixel's colour: red, green, blue and weight.
const COLOR_SUMS: usize = 4;

/// The bytes of a pixel's colour: four sums and the number of samples.
pub const PIXEL_BYTES: usize = COLOR_SUMS * SUM_BYTES + size_of::<u32>();

/// The sums of a bucket: light and weight.
const BUCKET_SUMS: usize = 2;

/// The bytes of an identifier in a pixel, about: maps grow as identifiers are found.
const ID_BYTES: usize = 60;

/// The settings of a film.
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
    /// The sensor, which turns light into numbers.
    pub sensor: PixelSensor,
    /// Samples are scaled down so that no sensor response exceeds this.
    pub max_component_value: f32,
    /// The colour space of the picture.
    pub color_space: &'static RgbColorSpace,
    /// The picture has half floats.
    pub half_floats: bool,
    /// The layers beside the colour.
    pub layers: LayerSet,
    /// The buckets of a spectral film, which has radiance by wavelength beside the colour.
    pub buckets: Option<Buckets>,
    /// The space of a geometry buffer, whose layers have the format's names.
    pub gbuffer: Option<GBufferSpace>,
    /// The names of the groups of lights; none without their layer.
    pub light_groups: Arc<[String]>,
}

/// A film.
#[derive(Debug)]
pub struct Film {
    full_resolution: [i32; 2],
    pub(crate) grid: Grid,
    diagonal: f32,
    filter: Filter,
    pub(crate) exposure: Exposure,
    color_space: &'static RgbColorSpace,
    half_floats: bool,
    pub(crate) layout: Layout,
    /// Red, green, blue and weight of each pixel; none in films of splats alone.
    pub(crate) color: Sums,
    pub(crate) counts: Vec<u32>,
    /// The sums of the layers.
    pub(crate) data: Sums,
    pub(crate) buckets: Option<Buckets>,
    /// Light and weight of each bucket; none in films of splats alone.
    pub(crate) spectrum: Sums,
    pub(crate) gbuffer: Option<GBufferSpace>,
    pub(crate) light_groups: Arc<[String]>,
    /// Weights of the identifiers of [`Layer::IDS`], for each tile; none without their layers.
    pub(crate) ids: [Vec<IdSums>; Layer::IDS.len()],
    pub(crate) splats: SplatSums,
}

impl Film {
    /// A film without light. Refused if there is no pixel to render, or more than fit in memory.
    pub fn new(settings: FilmSettings) -> Result<Self, ImageError> {
        Self::with_colors(settings, COLOR_SUMS)
    }

    /// A film for splats alone, which takes [`SPLAT_BYTES`] for each pixel; it has no tiles.
    pub(crate) fn of_splats(settings: FilmSettings) -> Result<Self, ImageError> {
        let (layers, light_groups) = (LayerSet::NONE, Arc::default());
        Self::with_colors(FilmSettings { layers, light_groups, ..settings }, 0)
    }

    fn with_colors(settings: FilmSettings, color_sums: usize) -> Result<Self, ImageError> {
        let FilmSettings { full_resolution, pixel_bounds: bounds, color_space, layers, .. } = settings;
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
        let (grid, layout) = (Grid(bounds), Layout::new(layers, settings.light_groups.len()));
        let no_memory = |_| no_memory(grid);
        let buckets = settings.buckets.filter(|_| color_sums > 0);
        let bucket_sums = buckets.map_or(0, |buckets| BUCKET_SUMS * buckets.count());
        let ids = |layer| maps(if layers.has(layer) { grid.tile_count() } else { 0 }).map_err(no_memory);
        let film = Self {
            full_resolution,
            grid,
            diagonal: settings.diagonal,
            filter: settings.filter,
            exposure: Exposure::new(settings.sensor, settings.max_component_value, color_space),
            color_space,
            half_floats: settings.half_floats,
            layout,
            color: Sums::new(grid, color_sums).map_err(no_memory)?,
            counts: zeros(if color_sums > 0 { bounds.area() } else { 0 }).map_err(no_memory)?,
            data: Sums::new(grid, layout.count()).map_err(no_memory)?,
            buckets: settings.buckets,
            spectrum: Sums::new(grid, bucket_sums).map_err(no_memory)?,
            gbuffer: settings.gbuffer,
            light_groups: settings.light_groups,
            ids: [ids(Layer::IDS[0])?, ids(Layer::IDS[1])?, ids(Layer::IDS[2])?],
            splats: SplatSums::default(),
        };
        // Most pixels will have one identifier per layer.
        let id_layers = Layer::IDS.into_iter().filter(|&layer| layers.has(layer)).count();
        require_memory(ID_BYTES * id_layers * bounds.area()).map_err(no_memory)?;
        Ok(film)
    }

    /// Its settings.
    pub fn settings(&self) -> FilmSettings {
        FilmSettings {
            full_resolution: self.full_resolution,
            pixel_bounds: self.grid.0,
            diagonal: self.diagonal,
            filter: self.filter.clone(),
            sensor: self.exposure.sensor.clone(),
            max_component_value: self.exposure.max_component_value,
            color_space: self.color_space,
            half_floats: self.half_floats,
            layers: self.layout.layers(),
            buckets: self.buckets,
            gbuffer: self.gbuffer,
            light_groups: self.light_groups.clone(),
        }
    }

    /// A film with the same pixels and settings, without light; refused where there is no memory
    /// for it.
    pub fn blank(&self) -> Result<Self, ImageError> {
        Self::new(self.settings())
    }

    /// A film with the same pixels for splats alone, which takes [`SPLAT_BYTES`] for each pixel; it
    /// has no tiles. Refused where there is no memory for it.
    pub fn for_splats(&self) -> Result<Self, ImageError> {
        let mut film = Self::of_splats(self.settings())?;
        film.reserve_splats()?;
        Ok(film)
    }

    /// Width and height of the whole image in pixels.
    pub fn full_resolution(&self) -> [i32; 2] {
        self.full_resolution
    }

    /// The pixels to render.
    pub fn pixel_bounds(&self) -> Bounds2i {
        self.grid.0
    }

    /// The film positions that light paths reach: [`Splatter::reach`].
    pub fn reach(&self) -> Bounds2 {
        reach(self.grid, &self.filter)
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

    /// Whether the picture has half floats.
    pub(crate) fn half_floats(&self) -> bool {
        self.half_floats
    }

    /// The identifiers of a layer.
    pub(crate) fn ids_of(&self, layer: Layer) -> &[IdSums] {
        let index = Layer::IDS.iter().position(|&of| of == layer);
        index.map_or(&[], |index| &self.ids[index])
    }

    /// The buckets of a spectral film.
    pub fn buckets(&self) -> Option<Buckets> {
        self.buckets
    }

    /// The names of the groups of lights of its layer.
    pub fn light_groups(&self) -> &[String] {
        &self.light_groups
    }

    /// The layers beside the colour.
    pub fn layers(&self) -> LayerSet {
        self.layout.layers()
    }

    /// Adds a sample to a pixel.
    ///
    /// # Panics
    /// If the pixel is not to be rendered, or the film is for splats alone.
    pub fn add(&mut self, pixel: [i32; 2], sample: &Sample) {
        let (tile, _) = self.grid.find(pixel);
        self.tile(tile).add(pixel, sample);
    }

    /// Adds a sample of radiance `l` alone to a pixel.
    ///
    /// # Panics
    /// If the pixel is not to be rendered, or the film is for splats alone.
    pub fn add_sample(
        &mut self,
        pixel: [i32; 2],
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        weight: f32,
    ) {
        self.add(pixel, &Sample::new(l, lambda, weight));
    }

    fn tile(&mut self, tile: usize) -> FilmTile<'_> {
        let range = self.grid.range(tile);
        let ids = self.ids.each_mut().map(|ids| ids.get_mut(tile));
        let data = (self.layout.layers() != LayerSet::NONE).then(|| TileData {
            layout: &self.layout,
            sums: (self.layout.count() > 0).then(|| self.data.tile(tile, range.clone())),
            ids,
        });
        let spectrum = &mut self.spectrum;
        FilmTile {
            bounds: self.grid.bounds(tile),
            exposure: &self.exposure,
            color: self.color.tile(tile, range.clone()),
            spectrum: self.buckets.map(|buckets| (buckets, spectrum.tile(tile, range.clone()))),
            counts: &mut self.counts[range],
            data,
            is_touched: true,
        }
    }

    /// The film cut into tiles, at most [`TILE_SIZE`](crate::TILE_SIZE) pixels wide and high, that
    /// different threads can fill; refused where there is no memory for the list of them.
    pub fn tiles_mut(&mut self) -> Result<Vec<FilmTile<'_>>, ImageError> {
        Ok(self.cut()?.0)
    }

    /// [`Film::tiles_mut`], and a splatter for light that arrives anywhere; refused where there is
    /// no memory for splats, which may be [reserved](Self::reserve_splats) before.
    pub fn tiles_and_splatter(&mut self) -> Result<(Vec<FilmTile<'_>>, Splatter<'_>), ImageError> {
        self.reserve_splats()?;
        self.cut()
    }

    fn cut(&mut self) -> Result<(Vec<FilmTile<'_>>, Splatter<'_>), ImageError> {
        let (grid, exposure, layout) = (self.grid, &self.exposure, &self.layout);
        let mut rest = &mut self.counts[..];
        let (mut data, mut spectrum) = (self.data.tiles(grid), self.spectrum.tiles(grid));
        let buckets = self.buckets;
        let mut ids = self.ids.each_mut().map(|ids| ids.iter_mut());
        let mut tiles = reserved(grid.tile_count()).map_err(|_| no_memory(grid))?;
        tiles.extend(self.color.tiles(grid).enumerate().map(|(tile, color)| {
            let bounds = grid.bounds(tile);
            let (counts, others) = std::mem::take(&mut rest).split_at_mut(bounds.area());
            rest = others;
            let data = (layout.layers() != LayerSet::NONE).then(|| TileData {
                layout,
                sums: data.next(),
                ids: ids.each_mut().map(Iterator::next),
            });
            let spectrum = buckets.zip(spectrum.next());
            FilmTile { bounds, exposure, color, counts, data, spectrum, is_touched: false }
        }));
        Ok((tiles, Splatter::new(grid, &self.filter, exposure, buckets, layout, &self.splats)))
    }

    /// Allocates the memory of splats; refused where there is none.
    pub fn reserve_splats(&mut self) -> Result<(), ImageError> {
        let buckets = self.buckets.map_or(0, |buckets| buckets.count());
        let sums = SPLAT_SUMS * (1 + self.layout.part_count()) + buckets;
        self.splats.reserve(self.grid, sums).map_err(|_| no_memory(self.grid))
    }

    /// Adds the sums of another film of the same pixels and settings; refused
    /// where the other film has splats and there is no memory for them.
    ///
    /// # Panics
    /// If the other film has other pixels, layers, groups of lights or buckets.
    pub fn merge(&mut self, other: &Self) -> Result<(), ImageError> {
        assert_eq!(self.grid.0, other.grid.0, "films of the same pixels can be merged");
        assert_eq!(self.layers(), other.layers(), "films of the same layers can be merged");
        assert_eq!(self.light_groups, other.light_groups, "films of the same lights can be merged");
        assert_eq!(self.buckets, other.buckets, "films of the same buckets can be merged");
        if !other.splats.is_empty() {
            self.reserve_splats()?;
            self.splats.merge(&other.splats);
        }
        self.color.merge(&other.color, self.grid);
        self.data.merge(&other.data, self.grid);
        self.spectrum.merge(&other.spectrum, self.grid);
        for (count, other) in self.counts.iter_mut().zip(&other.counts) {
            *count = count.saturating_add(*other);
        }
        for (ids, other) in self.ids.iter_mut().flatten().zip(other.ids.iter().flatten()) {
            other.iter().for_each(|(&key, &weight)| *ids.entry(key).or_insert(0) += weight);
        }
        let rejected = other.rejected();
        self.exposure.rejected().merge(&rejected);
        Ok(())
    }

    /// The number of samples added.
    pub fn sample_count(&self) -> u64 {
        self.counts.iter().map(|&count| u64::from(count)).sum()
    }

    /// The number of samples added to a pixel.
    ///
    /// # Panics
    /// If the pixel is not to be rendered.
    pub fn pixel_sample_count(&self, pixel: [i32; 2]) -> u64 {
        let (tile, index) = self.grid.find(pixel);
        self.counts[self.grid.range(tile).start + index].into()
    }

    /// The samples that were refused.
    pub fn rejected(&self) -> Rejected {
        self.exposure.rejected().clone()
    }

    /// Counts samples as refused.
    pub(crate) fn add_rejected(&mut self, rejected: &Rejected) {
        self.exposure.rejected().merge(rejected);
    }

    /// The bytes per pixel of a film with these settings, with or without colours and splats, and
    /// without identifiers.
    pub(crate) fn pixel_bytes(settings: &FilmSettings, color: bool, splats: bool) -> u64 {
        let buckets = settings.buckets.map_or(0, |buckets| buckets.count() * SUM_BYTES);
        let layout = Layout::new(settings.layers, settings.light_groups.len());
        let data = layout.count() * SUM_BYTES;
        let color = if color { PIXEL_BYTES + BUCKET_SUMS * buckets } else { 0 };
        let splats = if splats { SPLAT_BYTES * (1 + layout.part_count()) + buckets } else { 0 };
        (color + data + splats) as u64
    }
}

fn no_memory(Grid(bounds): Grid) -> ImageError {
    ImageError::Limits(format!("no memory for a film of {} × {} pixels", bounds.width(), bounds.height()))
}
