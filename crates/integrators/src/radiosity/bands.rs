//! Spectra at fixed wavelengths.
//!
//! A radiosity solution is computed once for all pixels, so that it has fixed wavelengths:
//! [`BANDS`] of them, λ_i = P⁻¹((i + s)/BANDS), where P is the distribution from which paths
//! sample their wavelengths ([`ShutterSample::wavelengths`]). The sensor's integral ∫ L(λ) c̄(λ)
//! dλ becomes the rectangle rule under that substitution, Σ L(λ_i) c̄(λ_i) / p(λ_i) / BANDS. With
//! 32 bands, the error is mostly due to the steps of the sensor's tables, of a nanometre each, and
//! depends on s: half a per cent for s = ½, a quarter of a per cent at most in X, Y and Z of
//! daylight, of coloured daylight and of the lamp of the measured Cornell box for s = 0.56. Every
//! sample then has all wavelengths, without the noise of random ones.

use scene::{ShutterSample, View};
use spectrum::{N, SampledSpectrum, SampledWavelengths, xyz_from};
use std::ops::{Add, AddAssign, Mul};

/// Number of groups of [`N`] wavelengths.
const GROUPS: usize = 8;

/// Number of wavelengths.
pub(crate) const BANDS: usize = GROUPS * N;

/// The offset s of a wavelength in its stratum of the distribution.
const PLACE: f32 = 0.56;

/// A quantity at all wavelengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(crate) struct Bands([SampledSpectrum; GROUPS]);

impl Bands {
    pub const ZERO: Self = Self([SampledSpectrum::ZERO; GROUPS]);

    /// The same value at all wavelengths.
    pub fn splat(value: f32) -> Self {
        Self([SampledSpectrum::splat(value); GROUPS])
    }

    /// Whether it is zero at all wavelengths.
    pub fn is_black(&self) -> bool {
        self.0.iter().all(|group| group.is_black())
    }

    /// The quantity at each group of wavelengths.
    pub fn groups(&self) -> &[SampledSpectrum] {
        &self.0
    }

    /// The mean over the wavelengths.
    pub fn mean(&self) -> f32 {
        self.0.iter().map(|group| group.average()).sum::<f32>() / GROUPS as f32
    }

    /// The lesser of the two at each wavelength.
    pub fn min(self, other: Self) -> Self {
        self.zip(other, SampledSpectrum::min)
    }

    /// The larger of the two at each wavelength.
    pub fn max(self, other: Self) -> Self {
        self.zip(other, SampledSpectrum::max)
    }

    /// The quotient by `whole` at each wavelength, clamped to [0, 1]; 0 where `whole` is 0.
    pub fn part_of(self, whole: Self) -> Self {
        self.zip(whole, SampledSpectrum::safe_div).max(Self::ZERO).min(Self::splat(1.0))
    }

    fn zip(self, other: Self, f: impl Fn(SampledSpectrum, SampledSpectrum) -> SampledSpectrum) -> Self {
        Self(std::array::from_fn(|i| f(self.0[i], other.0[i])))
    }
}

impl Add for Bands {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        self.zip(other, |a, b| a + b)
    }
}

impl AddAssign for Bands {
    fn add_assign(&mut self, other: Self) {
        *self = *self + other;
    }
}

impl Mul for Bands {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        self.zip(other, |a, b| a * b)
    }
}

impl Mul<f32> for Bands {
    type Output = Self;

    fn mul(self, factor: f32) -> Self {
        Self(self.0.map(|group| group * factor))
    }
}

impl std::iter::Sum for Bands {
    fn sum<I: Iterator<Item = Self>>(terms: I) -> Self {
        terms.fold(Self::ZERO, Add::add)
    }
}

/// The wavelengths, in groups of as many as a path has.
#[derive(Clone, Debug)]
pub(crate) struct Wavelengths {
    groups: [SampledWavelengths; GROUPS],
    /// The weight of each value in X + Y + Z.
    weights: Bands,
}

impl Wavelengths {
    /// All wavelengths; without jitter, those that all samples of paths share.
    pub fn new(view: &View) -> Self {
        let place = |i: usize| (i as f32 + PLACE) / BANDS as f32;
        Self::from_groups(std::array::from_fn(|i| ShutterSample::wavelengths(view, place(i))))
    }

    fn from_groups(groups: [SampledWavelengths; GROUPS]) -> Self {
        let weight = |lambda: &SampledWavelengths, i: usize| {
            let unit = SampledSpectrum::new(std::array::from_fn(|j| if i == j { 1.0 } else { 0.0 }));
            let xyz = xyz_from(&unit, lambda);
            (xyz.x + xyz.y + xyz.z) / GROUPS as f32
        };
        let weights =
            groups.each_ref().map(|lambda| SampledSpectrum::new(std::array::from_fn(|i| weight(lambda, i))));
        Self { groups, weights: Bands(weights) }
    }

    /// The groups of wavelengths.
    pub fn groups(&self) -> &[SampledWavelengths] {
        &self.groups
    }

    /// Evaluates a quantity at all wavelengths.
    pub fn sample(&self, mut f: impl FnMut(&SampledWavelengths) -> SampledSpectrum) -> Bands {
        Bands(self.groups.each_ref().map(&mut f))
    }

    /// The same for a pair of quantities; `None` if `f` returns `None`.
    pub fn sample_pair(
        &self,
        mut f: impl FnMut(&SampledWavelengths) -> Option<[SampledSpectrum; 2]>,
    ) -> Option<[Bands; 2]> {
        let mut pair = [Bands::ZERO; 2];
        for (i, lambda) in self.groups.iter().enumerate() {
            let [a, b] = f(lambda)?;
            (pair[0].0[i], pair[1].0[i]) = (a, b);
        }
        Some(pair)
    }

    /// X + Y + Z, up to a constant: brightness that is positive for all colours.
    pub fn brightness(&self, bands: &Bands) -> f32 {
        (*bands * self.weights).0.iter().map(|group| group.average()).sum::<f32>() * N as f32
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
mod tests {
    use super::*;
    use spectrum::{PiecewiseLinear, Rgb, RgbColorSpace, Spectrum};

    /// X, Y and Z of a spectrum at groups of wavelengths.
    fn xyz(spectrum: &Spectrum, groups: &[SampledWavelengths]) -> [f64; 3] {
        let values = groups.iter().map(|lambda| xyz_from(&spectrum.sample(lambda), lambda));
        let sum = values.fold([0.0; 3], |sum, xyz| {
            [sum[0] + f64::from(xyz.x), sum[1] + f64::from(xyz.y), sum[2] + f64::from(xyz.z)]
        });
        sum.map(|x| x / groups.len() as f64)
    }

    fn visible() -> Wavelengths {
        let place = |i: usize| (i as f32 + PLACE) / BANDS as f32;
        Wavelengths::from_groups(std::array::from_fn(|i| SampledWavelengths::sample_visible(place(i))))
    }

    #[test]
    fn bands_integrate_to_the_colours_of_spectra() {
        let srgb = RgbColorSpace::srgb();
        let lamp = [400.0, 0.0, 500.0, 8.0, 600.0, 15.6, 700.0, 18.4];
        let spectra = [
            srgb.illuminant(),
            RgbColorSpace::aces2065_1().illuminant(),
            Spectrum::rgb_illuminant(srgb, Rgb::new(0.9, 0.2, 0.05)),
            PiecewiseLinear::from_interleaved(&lamp).unwrap().into(),
        ];
        let many: Vec<_> = (0..1 << 14)
            .map(|i| SampledWavelengths::sample_visible((i as f32 + 0.5) / (1 << 14) as f32))
            .collect();
        for spectrum in spectra {
            let (found, exact) = (xyz(&spectrum, visible().groups()), xyz(&spectrum, &many));
            for (found, exact) in found.into_iter().zip(exact) {
                assert!((found / exact - 1.0).abs() < 2.5e-3, "{found}, not {exact}");
            }
        }
    }

    #[test]
    fn brightness_is_proportional_to_the_sum_of_xyz() {
        let wavelengths = visible();
        let light = RgbColorSpace::srgb().illuminant();
        let bands = wavelengths.sample(|lambda| light.sample(lambda));
        let expected: f64 = xyz(&light, wavelengths.groups()).iter().sum();
        let found = f64::from(wavelengths.brightness(&bands));
        assert!((found / expected - 1.0).abs() < 1e-5, "{found}, not {expected}");
    }
}
