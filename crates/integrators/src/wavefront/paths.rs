//! The paths of a batch, in columns.

use lanes::{Int, MAX_LANES, Real};
use math::Bounds2i;
use sampling::Sampler;
use sampling::sampler::Address;
use spectrum::{N, SampledSpectrum, SampledWavelengths};

use super::columns::{Column, Columns, Rows, fill, grow};

/// What the paths of a batch have from their start to their end; a path is a row. Columns are
/// longer, so that a vector can begin at any row.
#[derive(Default)]
pub(super) struct Paths {
    count: usize,
    /// Column and row of the pixel.
    pub pixel: [Vec<u32>; 2],
    /// Weight of the sample in the pixel.
    pub filter_weight: Column,
    /// The share of the light along its camera ray that reaches the film; empty where all of it
    /// does.
    pub camera_weight: Column,
    /// The sampler's next dimension.
    pub dimension: Vec<u32>,
    /// Wavelengths, and their densities.
    pub wavelengths: Columns<{ 2 * N }>,
    /// The light so far.
    pub l: Columns<N>,
    /// Whether a rough surface scattered it before.
    pub rough_before: Vec<bool>,
}

impl Paths {
    /// The number of paths.
    pub fn len(&self) -> usize {
        self.count
    }

    /// Replaces all paths by one for each pixel of the rectangles, row by row, which have no
    /// wavelengths and weights yet.
    pub fn start(&mut self, pixels: impl Iterator<Item = Bounds2i>, with_weights: bool) {
        let [x, y] = &mut self.pixel;
        x.clear();
        y.clear();
        for Bounds2i { min, max } in pixels {
            for row in min[1]..max[1] {
                x.extend((min[0]..max[0]).map(|x| x as u32));
                y.resize(x.len(), row as u32);
            }
        }
        self.count = x.len();
        // Lanes load and store whole vectors.
        let rows = self.count + MAX_LANES;
        x.resize(rows, 0);
        y.resize(rows, 0);
        grow(&mut self.filter_weight, rows);
        fill(&mut self.camera_weight, if with_weights { rows } else { 0 }, 0.0);
        self.dimension.resize(rows, 0);
        self.wavelengths.grow(rows);
        self.l.fill(rows, 0.0);
        fill(&mut self.rough_before, rows, false);
    }

    /// The next address of the sampler of each path, at the sample of an index.
    #[inline(always)]
    pub fn address<R: Real>(&self, rows: Rows<R>, index: u32) -> Address<R::Int> {
        let [x, y] = &self.pixel;
        Address {
            pixel: [R::Int::gather(x, rows.indices), R::Int::gather(y, rows.indices)],
            index,
            dimension: R::Int::gather(&self.dimension, rows.indices),
        }
    }

    /// Lets a sampler go on with a path, at the sample of an index.
    pub fn resume(&self, sampler: &mut Sampler, row: usize, index: u32) {
        let pixel = self.pixel.each_ref().map(|column| column[row] as i32);
        sampler.start_pixel_sample(pixel, index, self.dimension[row]);
    }

    /// The wavelengths of paths in lanes.
    #[inline(always)]
    pub fn lambda_lanes<R: Real>(&self, rows: Rows<R>) -> SampledWavelengths<R> {
        let [a, b, c, d, pdf @ ..] = self.wavelengths.get(rows);
        SampledWavelengths::new([a, b, c, d], pdf)
    }

    /// The wavelengths of a path.
    pub fn lambda(&self, row: usize) -> SampledWavelengths {
        let values = self.wavelengths.row(row);
        let [lambda, pdf] = [0, N].map(|first| std::array::from_fn(|i| values[first + i]));
        SampledWavelengths::new(lambda, pdf)
    }

    /// Changes the wavelengths of a path.
    pub fn set_lambda(&mut self, row: usize, lambda: &SampledWavelengths) {
        let (values, pdf) = (lambda.lambda(), lambda.pdf());
        let values = std::array::from_fn(|i| if i < N { values[i] } else { pdf[i - N] });
        self.wavelengths.set_row(row, values);
    }

    /// Adds light to a path.
    #[inline]
    pub fn add_light(&mut self, row: usize, l: SampledSpectrum) {
        let sum = SampledSpectrum(self.l.row(row)) + l;
        self.l.set_row(row, sum.0);
    }

    /// Multiplies the light of the paths by the share of it that reaches the film.
    pub fn weigh(&mut self) {
        for (row, &weight) in self.camera_weight.iter().enumerate().take(self.count) {
            let l = SampledSpectrum(self.l.row(row)) * weight;
            self.l.set_row(row, l.0);
        }
    }
}
