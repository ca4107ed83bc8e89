//! The few wavelengths that a path carries, and their sampling.
//!
//! A path carries [`N`] wavelengths λ₁…λ_N with densities p(λᵢ) per nanometre. An integral over
//! wavelength, ∫ f(λ) dλ, is estimated by 1/N Σ f(λᵢ)/p(λᵢ). Each wavelength has the density p; the
//! N of them are one uniform number rotated by multiples of 1/N ("hero wavelengths"), so that they
//! are stratified over the range.
//!
//! Sources: [Wilkie 2014], [Pharr 2023 §4.5.4].

use lanes::{Each, Real};
use std::ops::Index;

use crate::sampled::{N, SampledSpectrum};

/// Shortest wavelength considered, in nanometres.
pub const LAMBDA_MIN: f32 = 360.0;

/// Longest wavelength considered, in nanometres.
pub const LAMBDA_MAX: f32 = 830.0;

/// The wavelengths of a path, in nanometres, and their sampling densities, per nanometre.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SampledWavelengths<R = f32> {
    lambda: [R; N],
    pdf: [R; N],
}

impl<R: Real> SampledWavelengths<R> {
    /// These wavelengths, with the density of each.
    #[inline(always)]
    pub fn new(lambda: [R; N], pdf: [R; N]) -> Self {
        Self { lambda, pdf }
    }

    /// The wavelengths of a lane.
    #[inline(always)]
    pub fn lane(&self, lane: usize) -> SampledWavelengths {
        SampledWavelengths::new(self.lambda.each(|v| v.lane(lane)), self.pdf.each(|v| v.lane(lane)))
    }

    /// Wavelengths sampled uniformly over the range, from `u` in [0, 1).
    #[inline(always)]
    pub fn sample_uniform(u: R) -> Self {
        Self::sample_uniform_in(u, LAMBDA_MIN, LAMBDA_MAX)
    }

    /// Wavelengths sampled uniformly over `min..max`, from `u` in [0, 1).
    #[inline(always)]
    pub fn sample_uniform_in(u: R, min: f32, max: f32) -> Self {
        let lambda = rotations(u).each(|u| R::splat(min) + u * R::splat(max - min));
        Self { lambda, pdf: [R::splat(1.0 / (max - min)); N] }
    }

    /// Wavelengths sampled so that colours have little noise, from `u` in [0, 1).
    ///
    /// Each wavelength of a path comes from another quarter of the distribution. The density makes
    /// the sum of the four estimates nearly the same for all `u`, for each of red, green and blue
    /// of sRGB: under white light its variance is less than 0.01 of its square. A density that
    /// follows the eye's response, ∝ sech²(0.0072 (λ − 538)) [Radziszewski 2009], has 0.33 for
    /// blue.
    ///
    /// tanh(0.014 (λ − 569)) is a cubic polynomial within each quarter. The numbers minimise the
    /// variances for ten smooth spectra: of equal energy, black bodies of 3000, 6500 and 20,000 K,
    /// and reflected daylight of saturated hues.
    #[inline(always)]
    pub fn sample_visible(u: R) -> Self {
        let turned = u * R::splat(N as f32);
        let quarter = turned.floor();
        let x = turned - quarter;
        // A loop, because functions of this size that are passed to others may not be inlined.
        let (mut lambda, mut pdf) = ([R::zero(); N], [R::zero(); N]);
        for i in 0..N {
            let [a, b, c, d] = [TANH_0[i], TANH_1[i], TANH_2[i], TANH_3[i]].each(R::splat);
            let tanh = ((d * x + c) * x + b) * x + a;
            let slope = (R::splat(3.0) * d * x + R::splat(2.0) * c) * x + b;
            lambda[i] = wavelength_of_tanh(tanh);
            // dλ/du = 4 dλ/dx, and that of tanh⁻¹ is 1/(1 − tanh²).
            pdf[i] = R::splat(0.25 * TANH_SCALE) * (R::one() - tanh * tanh) / slope;
        }
        Self { lambda: turned_by(quarter, lambda), pdf: turned_by(quarter, pdf) }
    }

    /// The wavelengths that pbrt-v4 samples as the eye sees them from u = 0.5, so that renderers
    /// can be compared at the same ones: those of the density ∝ sech²(0.0072 (λ − 538))
    /// [Radziszewski 2009] at 0.5, 0.75, 1 and 0.25 of its integral.
    #[inline(always)]
    pub fn fixed_visible() -> Self {
        Self { lambda: FIXED.each(R::splat), pdf: FIXED_PDF.each(R::splat) }
    }

    /// The wavelengths that pbrt-v4 samples uniformly over `min..max` from u = 0.5: at 0.5, 0.75, 1
    /// and 0.25 of the range.
    #[inline(always)]
    pub fn fixed_uniform_in(min: f32, max: f32) -> Self {
        let place = |part: f32| R::splat((max - min).mul_add(part, min).min(max));
        let pdf = R::splat(1.0 / (max - min));
        Self { lambda: [place(0.5), place(0.75), R::splat(max), place(0.25)], pdf: [pdf; N] }
    }

    /// `a` where the mask is true, else `b`.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        let pick = |a, b| SampledSpectrum::select(mask, SampledSpectrum(a), SampledSpectrum(b)).0;
        Self { lambda: pick(a.lambda, b.lambda), pdf: pick(a.pdf, b.pdf) }
    }

    /// The wavelengths in nanometres.
    #[inline(always)]
    pub fn lambda(&self) -> &[R; N] {
        &self.lambda
    }

    /// The density of each wavelength, per nanometre; zero for secondary wavelengths that were
    /// terminated.
    #[inline(always)]
    pub fn pdf(&self) -> SampledSpectrum<R> {
        SampledSpectrum(self.pdf)
    }

    /// Keeps only the first wavelength, for dispersion, and divides its density by N.
    #[inline(always)]
    pub fn terminate_secondary(&mut self) {
        let terminated = self.secondary_terminated();
        let [hero, ..] = self.pdf;
        self.pdf = [R::zero(); N];
        self.pdf[0] = R::select(terminated, hero, hero / R::splat(N as f32));
    }

    /// Whether the secondary wavelengths are terminated.
    #[inline(always)]
    pub fn secondary_terminated(&self) -> R::Mask {
        let [_, a, b, c] = self.pdf.each(|p| p.eq(R::zero()));
        a & b & c
    }
}

impl<R> Index<usize> for SampledWavelengths<R> {
    type Output = R;

    /// The `i`th wavelength in nanometres.
    #[inline(always)]
    fn index(&self, i: usize) -> &R {
        &self.lambda[i]
    }
}

/// `u` and its rotations by 1/4, 2/4 and 3/4 within [0, 1).
#[inline(always)]
fn rotations<R: Real>(u: R) -> [R; N] {
    [0.0, 0.25, 0.5, 0.75].each(|turn| {
        let rotated = u + R::splat(turn);
        R::select(rotated.ge(R::one()), rotated - R::one(), rotated)
    })
}

/// The numbers of the quarters of the distribution, beginning with that of this index.
#[inline(always)]
fn turned_by<R: Real>(quarter: R, numbers: [R; N]) -> [R; N] {
    let [a, b, c, d] = numbers;
    let by_two = quarter.ge(R::splat(2.0));
    let rest = quarter - R::select(by_two, R::splat(2.0), R::zero());
    let by_one = rest.ge(R::one());
    let [a, b] = [R::select(by_two, c, a), R::select(by_two, d, b)];
    let [c, d] = [R::select(by_two, numbers[0], c), R::select(by_two, numbers[1], d)];
    [R::select(by_one, b, a), R::select(by_one, c, b), R::select(by_one, d, c), R::select(by_one, a, d)]
}

/// The numbers of [`SampledWavelengths::fixed_visible`].
const FIXED: [f32; N] = [545.903, 616.85626, 830.0, 479.15405];
const FIXED_PDF: [f32; N] = [0.003_927_075_4, 0.002_900_074_2, 0.000_228_321_23, 0.003_309_324_7];

/// Where tanh(s (λ − c)) is zero, and s, per nanometre.
const TANH_CENTER: f32 = 569.0;
const TANH_SCALE: f32 = 0.014;

/// In each quarter of the distribution, its cubic polynomial.
const TANH_0: [f32; N] = [-0.994_268_2, -0.887_102_8, -0.482_017_2, 0.267_907_7];
const TANH_1: [f32; N] = [0.140_229_8, 0.245_945_3, 0.485_651_5, 1.059_716_2];
const TANH_2: [f32; N] = [-0.168_407_5, 0.281_516_3, 0.345_435_5, -0.854_269_8];
const TANH_3: [f32; N] = [0.135_343_1, -0.122_376, -0.081_162_2, 0.525_306_6];

#[inline(always)]
fn wavelength_of_tanh<R: Real>(tanh: R) -> R {
    let log = math::ln((R::one() + tanh) / (R::one() - tanh));
    let lambda = R::splat(TANH_CENTER) + log * R::splat(0.5 / TANH_SCALE);
    lambda.clamp(R::splat(LAMBDA_MIN), R::splat(LAMBDA_MAX))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie::xyz_from;
    use crate::{RgbColorSpace, Spectrum};
    use testkit::Chi2;

    /// The density of the sample that is this wavelength.
    fn visible_pdf(lambda: f32) -> f64 {
        let (mut low, mut high) = (0.0_f32, 1.0_f32);
        for _ in 0..30 {
            let u = 0.5 * (low + high);
            let bound = if SampledWavelengths::sample_visible(u)[0] < lambda { &mut low } else { &mut high };
            *bound = u;
        }
        SampledWavelengths::sample_visible(low).pdf()[0].into()
    }

    #[test]
    fn each_wavelength_has_its_density() {
        let chi2 = Chi2 { tests: 2 * N, ..Chi2::default() };
        let range = [LAMBDA_MIN, LAMBDA_MAX];
        for i in 0..N {
            let visible = |u| Some(SampledWavelengths::sample_visible(u)[i]);
            chi2.interval(range, visible, visible_pdf).unwrap();
            let uniform = |u| Some(SampledWavelengths::sample_uniform(u)[i]);
            chi2.interval(range, uniform, |_| SampledWavelengths::sample_uniform(0.0).pdf()[i].into())
                .unwrap();
        }
        let lambda = SampledWavelengths::sample_visible(0.7);
        for (pdf, &lambda) in lambda.pdf().0.iter().zip(lambda.lambda()) {
            assert!((f64::from(*pdf) / visible_pdf(lambda) - 1.0).abs() < 1e-4, "{lambda}");
        }
    }

    #[test]
    fn visible_wavelengths_cover_the_range_without_gaps() {
        const STEPS: u32 = 1 << 16;
        let hero = |i: u32| SampledWavelengths::sample_visible(i as f32 / STEPS as f32)[0];
        let mut before = hero(0);
        assert!((before - LAMBDA_MIN).abs() < 1e-2);
        for i in 1..STEPS {
            let lambda = hero(i);
            assert!(lambda > before && lambda < before + 2.0, "{lambda} follows {before}");
            before = lambda;
        }
        assert!(before > LAMBDA_MAX - 2.0);
    }

    #[test]
    fn colours_of_lights_are_nearly_the_same_for_all_samples() {
        const STEPS: u32 = 1 << 12;
        for light in [Spectrum::Constant(1.0), Spectrum::blackbody(2800.0), Spectrum::blackbody(6500.0)] {
            let color = |i: u32| {
                let lambda = SampledWavelengths::sample_visible((i as f32 + 0.5) / STEPS as f32);
                let xyz = xyz_from(&light.sample(&lambda), &lambda);
                RgbColorSpace::srgb().rgb_from_xyz().apply_f32([xyz.x, xyz.y, xyz.z]).map(f64::from)
            };
            let colors: Vec<[f64; 3]> = (0..STEPS).map(color).collect();
            for c in 0..3 {
                let mean = colors.iter().map(|color| color[c]).sum::<f64>() / f64::from(STEPS);
                let squares = colors.iter().map(|color| (color[c] / mean - 1.0).powi(2)).sum::<f64>();
                let variance = squares / f64::from(STEPS);
                assert!(variance < 0.03, "component {c} of {light:?}: {variance}");
            }
        }
    }

    #[test]
    fn wavelengths_are_rotations_of_the_hero() {
        let lambda = SampledWavelengths::sample_uniform(0.9);
        for (ours, expected) in lambda.lambda().iter().zip([783.0, 430.5, 548.0, 665.5]) {
            assert!((ours - expected).abs() < 1e-2);
        }
        for u in [0.0, 0.25, 0.75, 0.999_999_94] {
            for l in *SampledWavelengths::sample_visible(u).lambda() {
                assert!((LAMBDA_MIN..=LAMBDA_MAX).contains(&l));
            }
        }
    }

    #[test]
    fn fixed_wavelengths_are_those_of_the_format() {
        let fixed = SampledWavelengths::<f32>::fixed_visible();
        for (i, u) in [0.5, 0.75, 1.0, 0.25].into_iter().enumerate() {
            let lambda = 538.0 - 138.888_889 * libm::atanh(0.856_910_62 - 1.827_501_97 * u);
            let pdf = 0.003_939_804_2 / libm::cosh(0.0072 * (lambda - 538.0)).powi(2);
            assert!((f64::from(fixed[i]) - lambda).abs() < 1e-4, "{u}: {lambda}");
            assert!((f64::from(fixed.pdf()[i]) / pdf - 1.0).abs() < 1e-6, "{u}: {pdf}");
        }
        let fixed = SampledWavelengths::<f32>::fixed_uniform_in(400.0, 700.0);
        assert_eq!(*fixed.lambda(), [550.0, 625.0, 700.0, 475.0]);
        assert_eq!(fixed.pdf().0, [1.0 / 300.0; N]);
    }

    #[test]
    fn termination_divides_the_density_once() {
        let mut lambda = SampledWavelengths::sample_uniform(0.3);
        assert!(!lambda.secondary_terminated());
        let before = lambda.pdf()[0];
        for _ in 0..2 {
            lambda.terminate_secondary();
            assert!(lambda.secondary_terminated());
            assert_eq!(lambda.pdf().0, [before / 4.0, 0.0, 0.0, 0.0]);
        }
    }
}
