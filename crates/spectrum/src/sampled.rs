//! Spectral values at the few wavelengths that a path carries.

use lanes::{Each, Real};
use std::ops::{Add, AddAssign, Div, DivAssign, Index, IndexMut, Mul, MulAssign, Neg, Sub, SubAssign};

/// Number of wavelengths that a path carries.
pub const N: usize = 4;

/// A function of wavelength known at the [`N`] wavelengths of a path
/// ([`SampledWavelengths`](crate::SampledWavelengths)).
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

#[cfg(test)]
mod tests {
    use super::*;

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
