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
use lanes::{Each, Real};

/// A reflectance or transmittance, in [0, 1], one for each lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbAlbedoSpectrum<R = f32> {
    polynomial: RgbSigmoidPolynomial<R>,
}

impl<R: Real> RgbAlbedoSpectrum<R> {
    /// From RGB of a colour space, clamped to [0, 1].
    #[inline(always)]
    pub fn new(space: &RgbColorSpace, rgb: [R; 3]) -> Self {
        Self { polynomial: space.uplifting().polynomial(rgb) }
    }

    /// The value at `lambda` nanometres.
    #[inline(always)]
    pub fn at(&self, lambda: R) -> R {
        self.polynomial.at(lambda)
    }
}

impl RgbAlbedoSpectrum {
    /// The same spectrum in all lanes.
    #[inline(always)]
    pub fn splat<R: Real>(&self) -> RgbAlbedoSpectrum<R> {
        RgbAlbedoSpectrum { polynomial: self.polynomial.splat() }
    }

    /// The reflectance as a polynomial.
    pub fn polynomial(&self) -> &RgbSigmoidPolynomial {
        &self.polynomial
    }

    /// The largest value.
    pub fn max_value(&self) -> f32 {
        self.polynomial.max_value()
    }
}

/// An unbounded quantity other than light, such as an absorption coefficient, one for each lane.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct RgbUnboundedSpectrum<R = f32> {
    scale: R,
    polynomial: RgbSigmoidPolynomial<R>,
}

impl<R: Real> RgbUnboundedSpectrum<R> {
    /// From RGB of a colour space; negative components count as zero.
    #[inline(always)]
    pub fn new(space: &RgbColorSpace, rgb: [R; 3]) -> Self {
        let [r, g, b] = rgb.each(|v| v.max(R::zero()));
        let scale = R::splat(2.0) * r.max(g).max(b);
        let is_light = scale.gt(R::zero());
        let scaled = [r, g, b].each(|v| R::select(is_light, v / scale, R::zero()));
        Self { scale, polynomial: space.uplifting().polynomial(scaled) }
    }

    /// The value at `lambda` nanometres.
    #[inline(always)]
    pub fn at(&self, lambda: R) -> R {
        self.polynomial.at(lambda) * self.scale
    }
}

impl RgbUnboundedSpectrum {
    /// The same spectrum in all lanes.
    #[inline(always)]
    pub fn splat<R: Real>(&self) -> RgbUnboundedSpectrum<R> {
        RgbUnboundedSpectrum { scale: R::splat(self.scale), polynomial: self.polynomial.splat() }
    }

    /// The factor on a reflectance.
    pub fn scale(&self) -> f32 {
        self.scale
    }

    /// The reflectance as a polynomial.
    pub fn polynomial(&self) -> &RgbSigmoidPolynomial {
        &self.polynomial
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
        let factor = RgbUnboundedSpectrum::new(space, rgb.to_array());
        Self { factor, illuminant: space.shared_illuminant() }
    }

    /// The value at `lambda` nanometres.
    #[inline(always)]
    pub fn at<R: Real>(&self, lambda: R) -> R {
        self.factor.splat().at(lambda) * self.illuminant.at(lambda)
    }

    /// An upper bound of the values: the largest factor times the illuminant's maximum.
    pub fn max_value(&self) -> f32 {
        self.factor.max_value() * self.illuminant.max_value()
    }

    /// The quantity that the illuminant is multiplied by.
    pub fn factor(&self) -> &RgbUnboundedSpectrum {
        &self.factor
    }

    /// The illuminant that the RGB values are multiplied by.
    pub fn illuminant(&self) -> &Arc<DenselySampled> {
        &self.illuminant
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use testkit::{LaneFunction, lanes_agree};

    struct Uplifting(&'static RgbColorSpace);

    impl LaneFunction for Uplifting {
        #[inline(always)]
        fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
            let (rgb, lambda) = ([u[0], u[1], u[2]], u[3] * R::splat(400.0) + R::splat(380.0));
            // A quarter of the colours are nearly black.
            let factor = R::select(u[4].lt(R::splat(0.25)), R::splat(1e-3), R::splat(1.5));
            let scaled = rgb.each(|v| (v - R::splat(0.1)) * factor);
            vec![
                RgbAlbedoSpectrum::new(self.0, rgb).at(lambda),
                RgbAlbedoSpectrum::new(self.0, scaled).at(lambda),
                RgbUnboundedSpectrum::new(self.0, scaled).at(lambda),
                self.0.illuminant_at(lambda),
            ]
        }
    }

    #[test]
    fn colors_become_the_same_spectra_in_all_lanes() {
        RgbColorSpace::all().into_iter().for_each(|space| lanes_agree(&Uplifting(space), 5, 300));
    }
}
