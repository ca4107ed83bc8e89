//! Radiance by wavelength: the buckets of a spectral film.
//!
//! A bucket has the mean of the radiance over its wavelengths. Samples have light at a few random
//! wavelengths λ of density p, so a bucket is Σ w L(λ)/p(λ) / Σ w/p(λ) over those wavelengths of
//! all samples that lie in it, w being the samples' weights. Wavelengths that a path has given up
//! have p = 0 and do not count, while the density of the one that is left is a quarter.
//!
//! Lights of unit strength have ∫ L ȳ dλ = 1 inside the renderer. Buckets are multiplied by ∫ ȳ dλ,
//! as the illuminants of colour spaces are scaled, and the sensor does not scale them.

use image::{Attribute, ImageMetadata};
use spectrum::{CIE_Y_INTEGRAL, N, SampledSpectrum, SampledWavelengths};

/// The largest number of buckets.
pub(crate) const MAX_BUCKETS: u32 = 4096;

/// Ranges of wavelengths of equal width, one after the other.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Buckets {
    count: u32,
    min: f32,
    max: f32,
}

/// Light in one bucket.
#[derive(Clone, Copy, Debug)]
pub(crate) struct InBucket {
    /// The bucket.
    pub bucket: usize,
    /// The radiance.
    pub l: f64,
    /// How much it counts: its wavelength's part of the integral over all buckets, of which the
    /// parts of all of a sample's wavelengths make one on average.
    pub share: f64,
}

impl Buckets {
    /// `count` buckets from `min` to `max` nanometres; `None` without buckets, with more than 4096,
    /// or if the range is empty.
    pub fn new(count: u32, min: f32, max: f32) -> Option<Self> {
        ((1..=MAX_BUCKETS).contains(&count) && min < max && (max - min).is_finite()).then_some(Self {
            count,
            min,
            max,
        })
    }

    /// The number of buckets.
    pub fn count(&self) -> usize {
        self.count as usize
    }

    /// The lower end of the first and the upper end of the last, in nanometres.
    pub fn range(&self) -> [f32; 2] {
        [self.min, self.max]
    }

    /// The wavelength at the centre of a bucket, in nanometres.
    fn center(&self, bucket: usize) -> f64 {
        let [min, max] = [self.min, self.max].map(f64::from);
        min + (max - min) * (bucket as f64 + 0.5) / f64::from(self.count)
    }

    /// The light of a sample in each bucket that it reaches.
    pub(crate) fn light(
        self,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
    ) -> impl Iterator<Item = InBucket> + use<> {
        let (l, pdf, lambda) = (l.0, lambda.pdf().0, *lambda.lambda());
        let width = f64::from(self.max) - f64::from(self.min);
        (0..N).filter(move |&i| pdf[i] > 0.0).filter_map(move |i| {
            let place = (f64::from(lambda[i]) - f64::from(self.min)) / width;
            // The end of the range is in the last bucket.
            let bucket = (place * f64::from(self.count)).floor().min(f64::from(self.count) - 1.0);
            (0.0..=1.0).contains(&place).then(|| InBucket {
                bucket: bucket as usize,
                l: f64::from(l[i]) * f64::from(CIE_Y_INTEGRAL),
                share: 1.0 / (N as f64 * f64::from(pdf[i]) * width),
            })
        })
    }

    /// The names of the buckets' channels: Stokes component 0 and the centre of the bucket, with a
    /// comma instead of the point, which separates layers [Fichet 2021].
    pub(crate) fn channels(self) -> impl Iterator<Item = String> {
        (0..self.count()).map(move |i| format!("S0.{}nm", format!("{:.3}", self.center(i)).replace('.', ",")))
    }

    /// Marks a picture as spectral in its header.
    pub(crate) fn describe(metadata: &mut ImageMetadata) {
        for (name, value) in [("spectralLayoutVersion", "1.0"), ("emissiveUnits", "W.m^-2.sr^-1")] {
            metadata.set(name, Attribute::Text(value.to_owned()));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_are_named_by_the_centres_of_buckets() {
        let names = |count, min, max| Buckets::new(count, min, max).unwrap().channels().collect::<Vec<_>>();
        assert_eq!(names(2, 400.0, 700.0), ["S0.475,000nm", "S0.625,000nm"]);
        assert_eq!(names(16, 360.0, 830.0)[..2], ["S0.374,688nm", "S0.404,062nm"]);
    }

    #[test]
    fn shares_of_a_sample_sum_to_one() {
        let buckets = Buckets::new(10, 400.0, 700.0).unwrap();
        let l = SampledSpectrum::splat(2.0);
        for u in [0.0, 0.1, 0.77] {
            let mut lambda = SampledWavelengths::sample_uniform_in(u, 400.0, 700.0);
            for _ in 0..2 {
                let sum: f64 = buckets.light(&l, &lambda).map(|light| light.share).sum();
                assert!((sum - 1.0).abs() < 1e-6, "{sum}");
                lambda.terminate_secondary();
            }
            assert_eq!(buckets.light(&l, &lambda).count(), 1);
        }
        let fixed = SampledWavelengths::fixed_uniform_in(400.0, 700.0);
        let reached: Vec<usize> = buckets.light(&l, &fixed).map(|light| light.bucket).collect();
        assert_eq!(reached, [5, 7, 9, 2], "the end of the range is in the last bucket");
        let outside = SampledWavelengths::sample_uniform_in(0.5, 701.0, 800.0);
        assert_eq!(buckets.light(&l, &outside).count(), 0);
    }

    #[test]
    fn impossible_buckets_are_refused() {
        for (count, min, max) in
            [(0, 400.0, 700.0), (4097, 400.0, 700.0), (4, 700.0, 700.0), (4, 400.0, f32::NAN)]
        {
            assert_eq!(Buckets::new(count, min, max), None);
        }
    }
}
