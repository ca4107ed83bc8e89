//! Spectral values at the few wavelengths that a path carries, and the sampling of these
//! wavelengths.
//!
//! A path carries [`N`] wavelengths λ₁…λ_N with densities p(λᵢ) per nanometre. An integral over
//! wavelength, ∫ f(λ) dλ, is estimated by 1/N Σ f(λᵢ)/p(λᵢ). Each wavelength has the density p; the
//! N of them are one uniform number rotated by multiples of 1/N ("hero wavelengths"), so that they
//! are stratified over the range.
//!
//! Sources: [Wilkie 2014], [Pharr 2023 §4.5.4]; the density proportional to sech² that follows the
//! eye's response is from [Radziszewski 2009].

use lanes::{Each, Real};
use std::ops::{Add, AddAssign, Div, DivAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

/// Number of wavelengths that a path carries.
pub const N: usize = 4;

/// Shortest wavelength considered, in nanometres.
pub const LAMBDA_MIN: f32 = 360.0;

/// Longest wavelength considered, in nanometres.
pub const LAMBDA_MAX: f32 = 830.0;

/// A function of wavelength known at the [`N`] wavelengths of a [`SampledWavelengths`].
///
/// Arithmetic is per wavelength. The values are meaningless without their wavelengths.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SampledSpectrum<R = f32>(pub [R; N]);

impl SampledSpectrum {
    /// Zero at every wavelength.
    pub const ZERO: Self = Self([0.0; N]);

    /// One at every wavelength.
    pub const ONE: Self = Self([1.0; N]);

    /// The exponential of each value.
    #[inline]
    pub fn exp(self) -> Self {
        self.map(lanes::exp)
    }

    /// Each value to an integer power.
    #[inline]
    pub fn powi(self, exponent: i32) -> Self {
        self.map(|v| v.powi(exponent))
    }

    /// Each value to a real power.
    #[inline]
    pub fn powf(self, exponent: f32) -> Self {
        self.map(|v| lanes::pow(v, exponent))
    }
}

impl<R: Real> SampledSpectrum<R> {
    /// From one value per wavelength.
    #[inline(always)]
    pub const fn new(values: [R; N]) -> Self {
        Self(values)
    }

    /// The same value at every wavelength.
    #[inline(always)]
    pub const fn splat(value: R) -> Self {
        Self([value; N])
    }

    /// Zero at every wavelength.
    #[inline(always)]
    pub fn zero() -> Self {
        Self::splat(R::zero())
    }

    /// The same spectrum in all lanes.
    #[inline(always)]
    pub fn broadcast(s: SampledSpectrum) -> Self {
        Self(s.0.each(R::splat))
    }

    /// `a` where the mask is true, else `b`.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        a.zip(b, |a, b| R::select(mask, a, b))
    }

    /// Applies `f` to each value.
    #[inline(always)]
    pub fn map(self, f: impl FnMut(R) -> R) -> Self {
        Self(self.0.each(f))
    }

    /// Applies `f` to each pair of values.
    #[inline(always)]
    pub fn zip(self, other: Self, mut f: impl FnMut(R, R) -> R) -> Self {
        let ([a, b, c, d], [p, q, r, s]) = (self.0, other.0);
        Self([f(a, p), f(b, q), f(c, r), f(d, s)])
    }

    /// The largest value.
    #[inline(always)]
    pub fn max_component(self) -> R {
        let [a, b, c, d] = self.0;
        d.max(c.max(b.max(a.max(R::splat(f32::NEG_INFINITY)))))
    }

    /// The smallest value.
    #[inline(always)]
    pub fn min_component(self) -> R {
        let [a, b, c, d] = self.0;
        d.min(c.min(b.min(a.min(R::splat(f32::INFINITY)))))
    }

    /// The smaller of both at each wavelength.
    #[inline(always)]
    pub fn min(self, other: Self) -> Self {
        self.zip(other, R::min)
    }

    /// The larger of both at each wavelength.
    #[inline(always)]
    pub fn max(self, other: Self) -> Self {
        self.zip(other, R::max)
    }

    /// The mean of the values.
    #[inline(always)]
    pub fn average(self) -> R {
        let [a, b, c, d] = self.0;
        (a + b + c + d) / R::splat(N as f32)
    }

    /// Whether every value is zero.
    #[inline(always)]
    pub fn is_black(self) -> R::Mask {
        let [a, b, c, d] = self.0.each(|v| v.eq(R::zero()));
        a & b & c & d
    }

    /// Whether all values are finite.
    #[inline(always)]
    pub fn is_finite(self) -> R::Mask {
        let [a, b, c, d] = self.0.each(|v| v.abs().lt(R::splat(f32::INFINITY)));
        a & b & c & d
    }

    /// The square root of each value.
    #[inline(always)]
    pub fn sqrt(self) -> Self {
        self.map(R::sqrt)
    }

    /// Each value between `low` and `high`.
    #[inline(always)]
    pub fn clamp(self, low: R, high: R) -> Self {
        self.map(|v| v.clamp(low, high))
    }

    /// Negative values become zero.
    #[inline(always)]
    pub fn clamp_zero(self) -> Self {
        self.map(|v| v.max(R::zero()))
    }

    /// The quotient where the divisor is not zero, zero elsewhere.
    #[inline(always)]
    pub fn safe_div(self, divisor: Self) -> Self {
        self.zip(divisor, |a, b| R::select(b.eq(R::zero()), R::zero(), a / b))
    }

    /// (1 − t)·`self` + t·`other`.
    #[inline(always)]
    pub fn lerp(self, other: Self, t: R) -> Self {
        self * (R::one() - t) + other * t
    }
}

impl From<f32> for SampledSpectrum {
    #[inline]
    fn from(value: f32) -> Self {
        Self::splat(value)
    }
}

impl<R> Index<usize> for SampledSpectrum<R> {
    type Output = R;

    #[inline(always)]
    fn index(&self, i: usize) -> &R {
        &self.0[i]
    }
}

impl<R> IndexMut<usize> for SampledSpectrum<R> {
    #[inline(always)]
    fn index_mut(&mut self, i: usize) -> &mut R {
        &mut self.0[i]
    }
}

impl<R: Real> Neg for SampledSpectrum<R> {
    type Output = Self;

    #[inline(always)]
    fn neg(self) -> Self {
        self.map(|v| -v)
    }
}

impl std::iter::Sum for SampledSpectrum {
    fn sum<I: Iterator<Item = Self>>(values: I) -> Self {
        values.fold(Self::ZERO, |a, b| a + b)
    }
}

impl std::iter::Product for SampledSpectrum {
    fn product<I: Iterator<Item = Self>>(values: I) -> Self {
        values.fold(Self::ONE, |a, b| a * b)
    }
}

/// Implements one operator between spectra, between a spectrum and a number, and its assigning
/// form.
macro_rules! operator {
    ($trait:ident $method:ident $assign_trait:ident $assign_method:ident $op:tt) => {
        impl<R: Real> $trait for SampledSpectrum<R> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: Self) -> Self {
                self.zip(other, |a, b| a $op b)
            }
        }

        impl<R: Real> $trait<R> for SampledSpectrum<R> {
            type Output = Self;

            #[inline(always)]
            fn $method(self, other: R) -> Self {
                self.map(|a| a $op other)
            }
        }

        impl $trait<SampledSpectrum> for f32 {
            type Output = SampledSpectrum;

            #[inline(always)]
            fn $method(self, other: SampledSpectrum) -> SampledSpectrum {
                other.map(|b| self $op b)
            }
        }

        impl<R: Real> $assign_trait for SampledSpectrum<R> {
            #[inline(always)]
            fn $assign_method(&mut self, other: Self) {
                *self = *self $op other;
            }
        }

        impl<R: Real> $assign_trait<R> for SampledSpectrum<R> {
            #[inline(always)]
            fn $assign_method(&mut self, other: R) {
                *self = *self $op other;
            }
        }
    };
}

operator!(Add add AddAssign add_assign +);
operator!(Sub sub SubAssign sub_assign -);
operator!(Mul mul MulAssign mul_assign *);
operator!(Div div DivAssign div_assign /);

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

    /// Wavelengths sampled about in proportion to the eye's response, from `u` in [0, 1).
    #[inline(always)]
    pub fn sample_visible(u: R) -> Self {
        // A loop, because functions of this size that are passed to others may not be inlined.
        let (mut lambda, mut pdf) = (rotations(u), [R::zero(); N]);
        for i in 0..N {
            let tanh = visible_tanh(lambda[i]);
            lambda[i] = wavelength_of_tanh(tanh);
            // sech² = 1 − tanh²
            pdf[i] = R::splat(VISIBLE_PEAK) * (R::one() - tanh * tanh);
        }
        Self { lambda, pdf }
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

/// A wavelength with the density of [`visible_wavelength_pdf`].
#[inline(always)]
pub fn sample_visible_wavelength<R: Real>(u: R) -> R {
    wavelength_of_tanh(visible_tanh(u))
}

/// The largest density of [`visible_wavelength_pdf`].
const VISIBLE_PEAK: f32 = 0.003_939_804;

/// tanh(0.0072 (538 − λ)) of the wavelength that `u` samples.
#[inline(always)]
fn visible_tanh<R: Real>(u: R) -> R {
    R::splat(0.856_910_62) - u * R::splat(1.827_502)
}

#[inline(always)]
fn wavelength_of_tanh<R: Real>(tanh: R) -> R {
    let log = math::ln((R::one() + tanh) / (R::one() - tanh));
    (R::splat(538.0) - log * R::splat(69.444_44)).clamp(R::splat(LAMBDA_MIN), R::splat(LAMBDA_MAX))
}

/// p(λ) ∝ sech²(0.0072 (λ − 538)) on the range of wavelengths, per nanometre.
#[inline(always)]
pub fn visible_wavelength_pdf<R: Real>(lambda: R) -> R {
    let inside = lambda.ge(R::splat(LAMBDA_MIN)) & lambda.le(R::splat(LAMBDA_MAX));
    // sech² x = 4e²ˣ / (1 + e²ˣ)²
    let e = math::exp((lambda - R::splat(538.0)) * R::splat(0.0144));
    let pdf = e * R::splat(4.0 * VISIBLE_PEAK) / ((e + R::one()) * (e + R::one()));
    R::select(inside, pdf, R::zero())
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::Chi2;

    #[test]
    fn the_visible_density_is_zero_outside_the_range() {
        assert_eq!(visible_wavelength_pdf(359.9), 0.0);
        assert_eq!(visible_wavelength_pdf(830.1), 0.0);
        assert_eq!(SampledWavelengths::sample_visible(0.0)[0].round(), LAMBDA_MIN);
    }

    #[test]
    fn each_wavelength_has_its_density() {
        let chi2 = Chi2 { tests: 2 * N, ..Chi2::default() };
        let range = [LAMBDA_MIN, LAMBDA_MAX];
        for i in 0..N {
            let visible = |u| Some(SampledWavelengths::sample_visible(u)[i]);
            chi2.interval(range, visible, |lambda| visible_wavelength_pdf(lambda).into()).unwrap();
            let uniform = |u| Some(SampledWavelengths::sample_uniform(u)[i]);
            chi2.interval(range, uniform, |_| SampledWavelengths::sample_uniform(0.0).pdf()[i].into())
                .unwrap();
        }
        let lambda = SampledWavelengths::sample_visible(0.7);
        for (pdf, &lambda) in lambda.pdf().0.iter().zip(lambda.lambda()) {
            assert!((pdf / visible_wavelength_pdf(lambda) - 1.0).abs() < 1e-5, "{lambda}");
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
                assert!((LAMBDA_MIN..=LAMBDA_MAX).contains(&l) && visible_wavelength_pdf(l) > 0.0);
            }
        }
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

    #[test]
    fn arithmetic_is_per_wavelength() {
        let a = SampledSpectrum::new([1.0, 2.0, 3.0, 4.0]);
        let b = SampledSpectrum::new([2.0, 0.0, 1.0, -4.0]);
        assert_eq!((a + b).0, [3.0, 2.0, 4.0, 0.0]);
        assert_eq!((2.0 - a * 0.5).0, [1.5, 1.0, 0.5, 0.0]);
        assert_eq!(a.safe_div(b).0, [0.5, 0.0, 3.0, -1.0]);
        assert_eq!(b.clamp_zero().0, [2.0, 0.0, 1.0, 0.0]);
        assert_eq!((b.max_component(), b.min_component(), a.average()), (2.0, -4.0, 2.5));
        assert_eq!(a.lerp(b, 0.5).0, [1.5, 1.0, 2.0, 0.0]);
        assert!(SampledSpectrum::ZERO.is_black() && !b.is_black());
        assert!(!SampledSpectrum::new([0.0, f32::NAN, 0.0, 0.0]).is_finite());
        assert_eq!([a, b].into_iter().sum::<SampledSpectrum>(), a + b);
    }
}
