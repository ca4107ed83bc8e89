//! Spectra made from RGB values: reflectances, unbounded quantities and emitted light.
//!
//! A reflectance is the sigmoid polynomial itself. Values beyond [0, 1] are scaled first by m =
//! 2·max(r, g, b), so that the polynomial stays in its smooth middle; light is further multiplied
//! by the colour space's illuminant, so that RGB (1, 1, 1) is its white [Pharr 2023 §4.6.6].

use std::sync::Arc;

use crate::color_space::RgbColorSpace;
use crate::dense::DenselySampled;
use crate::rgb::Rgb;
use crate::uplift::RgbSigmoidPolynomial;
use lanes::Real;

/// A reflectance or transmittance, in [0, 1].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbAlbedoSpectrum {
    polynomial: RgbSigmoidPolynomial,
}

impl RgbAlbedoSpectrum {
    /// From RGB of a colour space, clamped to [0, 1].
    pub fn new(space: &RgbColorSpace, rgb: Rgb) -> Self {
        Self { polynomial: space.to_rgb_coeffs(rgb) }
    }

    /// The value at `lambda` nanometres.
    #[inline(always)]
    pub fn at<R: Real>(&self, lambda: R) -> R {
        self.polynomial.at(lambda)
    }

    /// The largest value.
    pub fn max_value(&self) -> f32 {
        self.polynomial.max_value()
    }
}

/// An unbounded quantity other than light, such as an absorption coefficient.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbUnboundedSpectrum {
    scale: f32,
    polynomial: RgbSigmoidPolynomial,
}

impl RgbUnboundedSpectrum {
    /// From RGB of a colour space; negative components count as zero.
    pub fn new(space: &RgbColorSpace, rgb: Rgb) -> Self {
        let rgb = rgb.clamp_zero();
        let scale = 2.0 * rgb.max_component();
        let scaled = if scale > 0.0 { rgb / scale } else { Rgb::ZERO };
        Self { scale, polynomial: space.to_rgb_coeffs(scaled) }
    }

    /// The value at `lambda` nanometres.
    #[inline(always)]
    pub fn at<R: Real>(&self, lambda: R) -> R {
        self.polynomial.at(lambda) * R::splat(self.scale)
    }

    /// The largest value.
    pub fn max_value(&self) -> f32 {
        self.scale * self.polynomial.max_value()
    }
}

/// Emitted light: an unbounded quantity times the colour space's illuminant.
#[derive(Clone, Debug, PartialEq)]
pub struct RgbIlluminantSpectrum {
    factor: RgbUnboundedSpectrum,
    illuminant: Arc<DenselySampled>,
}

impl RgbIlluminantSpectrum {
    /// From RGB of a colour space; negative components count as zero.
    pub fn new(space: &RgbColorSpace, rgb: Rgb) -> Self {
        Self { factor: RgbUnboundedSpectrum::new(space, rgb), illuminant: space.shared_illuminant() }
    }

    /// The value at `lambda` nanometres.
    #[inline(always)]
    pub fn at<R: Real>(&self, lambda: R) -> R {
        self.factor.at(lambda) * self.illuminant.at(lambda)
    }

    /// An upper bound of the values: the largest factor times the illuminant's maximum.
    pub fn max_value(&self) -> f32 {
        self.factor.max_value() * self.illuminant.max_value()
    }

    /// The illuminant that the RGB values are multiplied by.
    pub fn illuminant(&self) -> &Arc<DenselySampled> {
        &self.illuminant
    }
}
