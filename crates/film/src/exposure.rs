//! From light to the terms of a film's sums.

use std::sync::{Mutex, MutexGuard, PoisonError};

use lanes::{Each, Real};
use spectrum::{CIE_Y_INTEGRAL, RgbColorSpace, SampledSpectrum, SampledWavelengths, Spectrum, xyz_from};

use crate::buckets::InBucket;
use crate::sum::can_add;
use crate::{Buckets, PixelSensor, Rejected, Sample};

/// How light becomes terms of sums, and which samples were refused; shared by the tiles of a film.
#[derive(Debug)]
pub(crate) struct Exposure {
    pub(crate) sensor: PixelSensor,
    pub(crate) max_component_value: f32,
    color_space: &'static RgbColorSpace,
    /// The white of the colour space, of luminance 1.
    white: Spectrum,
    white_scale: f32,
    rejected: Mutex<Rejected>,
}

impl Exposure {
    pub(crate) fn new(
        sensor: PixelSensor,
        max_component_value: f32,
        color_space: &'static RgbColorSpace,
    ) -> Self {
        let white = color_space.illuminant();
        let white_scale = CIE_Y_INTEGRAL / white.to_photometric();
        let rejected = Mutex::default();
        Self { sensor, max_component_value, color_space, white, white_scale, rejected }
    }

    /// The samples that were refused.
    pub(crate) fn rejected(&self) -> MutexGuard<'_, Rejected> {
        self.rejected.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Counts a sample that is left out.
    pub(crate) fn reject(&self, at: [i32; 2]) {
        self.rejected().add(at);
    }

    /// The sensor's response to light that counts one in `samples` of a pixel, not beyond what a
    /// whole sample may have.
    #[inline(always)]
    pub(crate) fn response<R: Real>(
        &self,
        l: &SampledSpectrum<R>,
        lambda: &SampledWavelengths<R>,
        samples: f32,
    ) -> [R; 3] {
        let rgb = self.sensor.response(l, lambda);
        let factor = self.factor(rgb, samples);
        rgb.each(|c| c * factor)
    }

    /// The response to a part of light that counts one in `samples` of a pixel; it is scaled as the
    /// whole, `l`, is.
    pub(crate) fn part(
        &self,
        part: &SampledSpectrum,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        samples: f32,
    ) -> [f32; 3] {
        let factor = self.factor(self.sensor.response(l, lambda), samples);
        self.sensor.response(part, lambda).map(|c| c * factor)
    }

    /// The factor by which light of this response is scaled down to what it may have.
    #[inline(always)]
    fn factor<R: Real>(&self, [r, g, b]: [R; 3], samples: f32) -> R {
        let (largest, limit) = (r.max(g).max(b), R::splat(self.max_component_value * samples));
        R::select(largest.gt(limit), limit / largest, R::one())
    }

    /// [`response`](Self::response); `None` for light that is not finite, or too large for the
    /// sums.
    #[inline]
    pub(crate) fn measure(
        &self,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        samples: f32,
    ) -> Option<[f64; 3]> {
        let rgb = self.response(l, lambda, samples).map(f64::from);
        (l.is_finite() && rgb.into_iter().all(can_add)).then_some(rgb)
    }

    /// The weighted response to a sample, and its weight; `None` where the sums cannot take it.
    #[inline]
    pub(crate) fn terms(&self, sample: &Sample) -> Option<[f64; 4]> {
        let weight = f64::from(sample.weight);
        let part = weight / sample.l.len() as f64;
        let [r, g, b] = sample.l.iter().zip(sample.lambda).try_fold([0.0; 3], |sum, (l, lambda)| {
            let rgb = self.measure(l, lambda, 1.0)?;
            Some([0, 1, 2].map(|c: usize| sum[c] + part * rgb[c]))
        })?;
        let terms = [r, g, b, weight];
        terms.into_iter().all(can_add).then_some(terms)
    }

    /// Light that counts one in `samples` of a pixel by the buckets that it reaches, scaled as its
    /// [`response`](Self::response) is.
    pub(crate) fn in_buckets(
        &self,
        buckets: Buckets,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
        samples: f32,
    ) -> impl Iterator<Item = InBucket> + use<> {
        let factor = f64::from(self.factor(self.sensor.response(l, lambda), samples));
        buckets.light(l, lambda).map(move |light| InBucket { l: factor * light.l, ..light })
    }

    /// The colour of a reflectance under the white of the film's colour space.
    pub(crate) fn albedo(&self, albedo: &SampledSpectrum, lambda: &SampledWavelengths) -> [f32; 3] {
        let xyz = xyz_from(&(*albedo * self.white.sample(lambda)), lambda) * self.white_scale;
        self.color_space.to_rgb(xyz).to_array()
    }
}
