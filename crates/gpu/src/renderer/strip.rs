//! The samples of a strip of pixels, which the device makes and the host adds to the film.

use film::{FilmTile, FirstHit, Sample};
use lanes::{Kernel, MAX_LANES, Real};
use math::Bounds2i;
use scene::{ShutterSample, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::device::Copied;
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

/// Adds the samples of a strip to the pixels of a tile in it.
pub(super) struct AddToTile<'a, 'film> {
    pub view: &'a View,
    pub strip: Bounds2i,
    pub samples: &'a [PixelSample],
    /// The wavelengths of all samples, where they share them.
    pub lambda: Option<&'a SampledWavelengths>,
    pub first_hit: &'a FindFirstHit<'a>,
    pub tile: &'a mut FilmTile<'film>,
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
