//! Spectra with a value at each whole nanometre of the range of wavelengths.

use crate::wavelengths::{LAMBDA_MAX, LAMBDA_MIN};
use lanes::Real;

/// Number of whole nanometres in the range.
pub(crate) const COUNT: usize = (LAMBDA_MAX - LAMBDA_MIN) as usize + 1;

/// A spectrum with a value at each nanometre from 360 to 830, constant around each, zero outside.
#[derive(Clone, Debug, PartialEq)]
pub struct DenselySampled {
    values: Box<[f32; COUNT]>,
}

impl DenselySampled {
    /// From a function of wavelength in nanometres.
    pub fn from_fn(mut f: impl FnMut(f32) -> f32) -> Self {
        Self { values: Box::new(std::array::from_fn(|i| f(LAMBDA_MIN + i as f32))) }
    }

    /// The value at the whole nanometre nearest to `lambda`.
    #[inline(always)]
    pub fn at<R: Real>(&self, lambda: R) -> R {
        let offset = lambda - R::splat(LAMBDA_MIN - 0.5);
        let inside = offset.ge(R::zero()) & offset.lt(R::splat(COUNT as f32));
        let index = R::select(inside, offset, R::zero()).to_int();
        R::select(inside, R::gather(&self.values[..], index), R::zero())
    }

    /// The values at 360, 361, … 830 nanometres.
    pub fn values(&self) -> &[f32] {
        &self.values[..]
    }

    /// The largest value.
    pub fn max_value(&self) -> f32 {
        self.values.iter().copied().fold(f32::NEG_INFINITY, f32::max)
    }

    /// The same spectrum times `factor`.
    pub fn scaled(mut self, factor: f32) -> Self {
        self.values.iter_mut().for_each(|v| *v *= factor);
        self
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_are_those_of_the_nearest_nanometre() {
        let spectrum = DenselySampled::from_fn(|lambda| lambda);
        for (lambda, value) in [
            (360.0, 360.0),
            (359.6, 360.0),
            (500.49, 500.0),
            (500.5, 501.0),
            (830.4, 830.0),
            (831.0, 0.0),
            (359.0, 0.0),
        ] {
            assert_eq!(spectrum.at(lambda), value);
        }
        assert_eq!(spectrum.at(f32::NAN), 0.0);
        assert_eq!(spectrum.max_value(), 830.0);
        assert_eq!(spectrum.values().len(), 471);
    }
}
