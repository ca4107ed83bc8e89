//! The paths of a batch, in columns.

use lanes::{Each, Int, MAX_LANES, Real};
use math::Bounds2i;
use sampling::Sampler;
use sampling::sampler::Address;
use spectrum::{N, SampledSpectrum, SampledWavelengths};

use super::float_columns::{FloatColumn, fill, grow};
use super::indices::PathIndices;
use super::spectrum_column::SpectrumColumn;
use crate::transport::media::Heroes;

/// What the paths of a batch have from their start to their end; a path is a row. Columns are
/// longer, so that a vector can begin at any row.
#[derive(Default)]
pub(super) struct PathColumns {
    count: usize,
    /// Column and row of the pixel.
    pixels: Vec<[u32; 2]>,
    /// Weight of the sample in the pixel.
    pub filter_weight: FloatColumn,
    /// The share of the light along its camera ray that reaches the film; empty where all of it
    /// does.
    pub camera_weight: FloatColumn,
    /// The sampler's next dimension.
    pub dimension: Vec<u32>,
    /// Wavelengths, and their densities.
    wavelengths: [SpectrumColumn; 2],
    /// The light so far.
    pub l: SpectrumColumn,
    /// Whether a rough surface scattered it before.
    pub rough_before: Vec<bool>,
    /// The wavelengths that choose collisions with media, if there are any.
    heroes: Vec<u32>,
}

impl PathColumns {
    /// The number of paths.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Replaces all paths by one for each pixel of the rectangles that takes one, row by row, which
    /// have no wavelengths and weights yet.
    pub fn start(
        &mut self,
        pixels: impl Iterator<Item = Bounds2i>,
        takes: impl Fn([i32; 2]) -> bool,
        with_weights: bool,
        with_media: bool,
    ) {
        self.pixels.clear();
        for Bounds2i { min, max } in pixels {
            for y in min[1]..max[1] {
                let row = (min[0]..max[0]).filter(|&x| takes([x, y]));
                self.pixels.extend(row.map(|x| [x as u32, y as u32]));
            }
        }
        self.count = self.pixels.len();
        // Lanes load and store whole vectors.
        let rows = self.count + MAX_LANES;
        self.pixels.resize(rows, [0; 2]);
        grow(&mut self.filter_weight, rows);
        fill(&mut self.camera_weight, if with_weights { rows } else { 0 }, 0.0);
        self.dimension.resize(rows, 0);
        self.wavelengths.iter_mut().for_each(|numbers| numbers.grow(rows));
        self.l.fill(rows, 0.0);
        fill(&mut self.rough_before, rows, false);
        self.heroes.resize(if with_media { rows } else { 0 }, 0);
    }

    /// The next address of the sampler of each path, at the sample of an index.
    #[inline(always)]
    pub fn address<R: Real>(&self, rows: PathIndices<R>, index: u32) -> Address<R::Int> {
        Address {
            pixel: R::Int::gather_rows(self.pixels.as_flattened(), rows.indices.shl(1)),
            index,
            dimension: R::Int::gather(&self.dimension, rows.indices),
        }
    }

    /// The end of the rows, from `first` on, whose pixels are in a rectangle.
    pub fn end_of(&self, pixels: Bounds2i, first: usize) -> usize {
        (first..self.count).find(|&row| !pixels.contains(self.pixel(row))).unwrap_or(self.count)
    }

    /// The pixel of a path.
    #[inline]
    pub fn pixel(&self, row: usize) -> [i32; 2] {
        self.pixels[row].each(|x| x as i32)
    }

    /// The pixels of successive paths.
    #[inline(always)]
    pub fn pixels<I: Int>(&self, first: usize) -> [I; 2] {
        I::gather_rows(self.pixels[first..].as_flattened(), I::from_fn(|lane| 2 * lane as u32))
    }

    /// Lets a sampler go on with a path, at the sample of an index.
    #[inline]
    pub fn resume(&self, sampler: &mut Sampler, row: usize, index: u32) {
        sampler.start_pixel_sample(self.pixel(row), index, self.dimension[row]);
    }

    /// The wavelengths of paths in lanes.
    #[inline(always)]
    pub fn lambda_lanes<R: Real>(&self, rows: PathIndices<R>) -> SampledWavelengths<R> {
        let [lambda, pdf] = &self.wavelengths;
        SampledWavelengths::new(lambda.get(rows).0, pdf.get(rows).0)
    }

    /// The wavelengths of successive paths.
    #[inline(always)]
    pub fn wavelengths<R: Real>(&self, first: usize) -> SampledWavelengths<R> {
        let [lambda, pdf] = &self.wavelengths;
        SampledWavelengths::new(lambda.load(first).0, pdf.load(first).0)
    }

    /// Changes the wavelengths of successive paths.
    #[inline(always)]
    pub fn set_wavelengths<R: Real>(&mut self, first: usize, wavelengths: &SampledWavelengths<R>) {
        let [lambda, pdf] = &mut self.wavelengths;
        lambda.store(first, SampledSpectrum(*wavelengths.lambda()));
        pdf.store(first, wavelengths.pdf());
    }

    /// The wavelengths of a path.
    #[inline]
    pub fn lambda(&self, row: usize) -> SampledWavelengths {
        let [lambda, pdf] = &self.wavelengths;
        SampledWavelengths::new(lambda.row(row).0, pdf.row(row).0)
    }

    /// Changes the wavelengths of a path.
    #[inline]
    pub fn set_lambda(&mut self, row: usize, wavelengths: &SampledWavelengths) {
        let [lambda, pdf] = &mut self.wavelengths;
        lambda.set_row(row, SampledSpectrum(*wavelengths.lambda()));
        pdf.set_row(row, wavelengths.pdf());
    }

    /// Chooses the heroes of successive paths.
    #[inline(always)]
    pub fn choose_heroes<R: Real>(&mut self, first: usize, u: R) {
        let number = (u * R::splat(N as f32)).min(R::splat((N - 1) as f32));
        number.to_int().store(&mut self.heroes[first..]);
    }

    /// The wavelengths of a path that choose collisions with media.
    #[inline]
    pub fn heroes(&self, row: usize) -> Heroes {
        if self.lambda(row).secondary_terminated() {
            Heroes::first()
        } else {
            Heroes::any_as(self.heroes[row] as usize)
        }
    }

    /// Adds light to a path.
    #[inline]
    pub fn add_light(&mut self, row: usize, l: SampledSpectrum) {
        self.l.set_row(row, self.l.row(row) + l);
    }

    /// Multiplies the light of the paths by the share of it that reaches the film.
    pub fn weigh(&mut self) {
        for (row, &weight) in self.camera_weight.iter().enumerate().take(self.count) {
            self.l.set_row(row, self.l.row(row) * weight);
        }
    }
}
