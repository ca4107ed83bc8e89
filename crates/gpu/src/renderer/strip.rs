//! The samples of a strip of pixels, which the device makes and the host adds to the film.

use film::{FilmTile, FirstHit, Sample};
use lanes::{InstructionSet, Kernel, MAX_LANES, Real};
use math::Bounds2i;
use rayon::prelude::*;
use scene::{ShutterSample, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::device::{Copied, Device, GpuError};
use crate::records::pixels::PixelSample;

impl PixelSample {
    /// Its wavelengths before any path terminates them.
    pub fn wavelengths(&self, view: &View) -> SampledWavelengths {
        ShutterSample::wavelengths(view, self.wavelength)
    }

    fn is_terminated(&self) -> bool {
        self.flags & 1 == 1
    }
}

/// Finds the first hit of the sample of a pixel, at the wavelengths that its path has left, for the
/// layers of a tile.
pub type FindFirstHit<'a> = dyn Fn(&FilmTile, [i32; 2], &SampledWavelengths) -> Option<FirstHit> + Sync + 'a;

/// A strip whose samples are on their way from the device.
pub(super) struct Started {
    pub strip: Bounds2i,
    pub samples: Copied,
}

impl Started {
    /// Waits for the samples, and adds them to the film after something else is done with them.
    pub fn finish(
        self,
        device: &Device,
        exposure: &mut Exposure,
        with_samples: impl FnOnce(&[PixelSample]) -> Result<(), GpuError>,
    ) -> Result<(), GpuError> {
        device.contents(&self.samples, |bytes| {
            let samples = bytemuck::cast_slice(bytes);
            with_samples(samples)?;
            exposure.add(self.strip, samples);
            Ok(())
        })?
    }
}

/// A film during a pass.
pub(super) struct Exposure<'a, 'film> {
    pub view: &'a View,
    /// The wavelengths of all samples, where they share them.
    pub lambda: Option<&'a SampledWavelengths>,
    pub first_hit: &'a FindFirstHit<'a>,
    /// The tiles that have no samples yet, row by row.
    pub tiles: Vec<FilmTile<'film>>,
    /// The rays so far.
    pub rays: u64,
}

impl Exposure<'_, '_> {
    /// Adds the samples of the next strip.
    fn add(&mut self, strip: Bounds2i, samples: &[PixelSample]) {
        let &mut Self { view, lambda, first_hit, ref mut tiles, ref mut rays } = self;
        *rays += samples.iter().map(|sample| u64::from(sample.rays)).sum::<u64>();
        let count = tiles.iter().take_while(|tile| tile.bounds().min[1] < strip.max[1]).count();
        let rest = tiles.split_off(count);
        let lanes = InstructionSet::detect();
        std::mem::replace(tiles, rest).into_par_iter().for_each(|mut tile| {
            let tile = &mut tile;
            lanes.dispatch_large(AddToTile { view, strip, samples, lambda, first_hit, tile });
        });
    }
}

/// Adds the samples of a strip to the pixels of a tile in it.
struct AddToTile<'a, 'film> {
    view: &'a View,
    strip: Bounds2i,
    samples: &'a [PixelSample],
    lambda: Option<&'a SampledWavelengths>,
    first_hit: &'a FindFirstHit<'a>,
    tile: &'a mut FilmTile<'film>,
}

impl Kernel for AddToTile<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Self { view, strip, samples, lambda: shared, first_hit: find, tile } = self;
        let has_hits = tile.wants_first_hit();
        let bounds = tile.bounds();
        let width = bounds.width() as usize;
        let row = |y: usize| {
            let [x, y] = [bounds.min[0] - strip.min[0], bounds.min[1] + y as i32 - strip.min[1]];
            let first = (y * strip.width() + x) as usize;
            &samples[first..first + width]
        };
        for y in 0..bounds.height() as usize {
            for (i, samples) in row(y).chunks(R::LANES).enumerate() {
                let first = y * width + i * R::LANES;
                if has_hits || shared.is_some() || samples.iter().any(PixelSample::is_terminated) {
                    for (x, sample) in (i * R::LANES..).zip(samples) {
                        let pixel = [bounds.min[0] + x as i32, bounds.min[1] + y as i32];
                        let mut lambda = shared.copied().unwrap_or_else(|| sample.wavelengths(view));
                        if sample.is_terminated() {
                            lambda.terminate_secondary();
                        }
                        let l = SampledSpectrum::new(sample.l);
                        let first_hit = if has_hits { find(tile, pixel, &lambda) } else { None };
                        let alpha = if first_hit.is_some() { 1.0 } else { 0.0 };
                        let radiance = Sample::new(&l, &lambda, sample.weight);
                        tile.add(pixel, &Sample { alpha, first_hit, ..radiance });
                    }
                    continue;
                }
                let mut columns = [[0.0; MAX_LANES]; 6];
                for (lane, sample) in samples.iter().enumerate() {
                    let [a, b, c, d] = sample.l;
                    let numbers = [a, b, c, d, sample.wavelength, sample.weight];
                    columns.iter_mut().zip(numbers).for_each(|(column, number)| column[lane] = number);
                }
                let [a, b, c, d, wavelength, weight] = columns.map(|column| R::load(&column));
                let lambda = ShutterSample::wavelengths(view, wavelength);
                tile.add_lanes(first, samples.len(), &SampledSpectrum([a, b, c, d]), &lambda, weight);
            }
        }
    }
}
