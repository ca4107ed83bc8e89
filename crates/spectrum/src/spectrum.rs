//! Functions of wavelength in scenes: [`Spectrum`].

use std::sync::Arc;

use crate::blackbody::Blackbody;
use crate::cie::{self, integrate};
use crate::color_space::RgbColorSpace;
use crate::dense::DenselySampled;
use crate::measured::measured;
use crate::piecewise::{PiecewiseLinear, SpectrumError};
use crate::rgb::{Rgb, Xyz};
use crate::rgb_spectrum::{RgbAlbedoSpectrum, RgbIlluminantSpectrum, RgbUnboundedSpectrum};
use crate::sampled::SampledSpectrum;
use crate::wavelengths::SampledWavelengths;
use lanes::Real;
use math::map_lanes;

/// A function of wavelength in nanometres. Cheap to clone: tables are shared.
#[derive(Clone, Debug, PartialEq)]
pub enum Spectrum {
    /// The same at all wavelengths.
    Constant(f32),
    /// Piecewise linear between given wavelengths.
    PiecewiseLinear(Arc<PiecewiseLinear>),
    /// A value each nanometre.
    DenselySampled(Arc<DenselySampled>),
    /// A blackbody, normalized to the maximum 1.
    Blackbody(Blackbody),
    /// A reflectance from RGB.
    RgbAlbedo(RgbAlbedoSpectrum),
    /// An unbounded quantity from RGB.
    RgbUnbounded(RgbUnboundedSpectrum),
    /// Light from RGB.
    RgbIlluminant(RgbIlluminantSpectrum),
}

impl Spectrum {
    /// Zero at all wavelengths.
    pub const ZERO: Self = Self::Constant(0.0);

    /// From pairs of wavelength and value, linear between; wavelengths strictly increasing.
    pub fn from_pairs(pairs: &[(f32, f32)]) -> Result<Self, SpectrumError> {
        Ok(PiecewiseLinear::from_pairs(pairs)?.into())
    }

    /// A blackbody of `temperature` kelvin whose largest value is 1.
    pub fn blackbody(temperature: f32) -> Self {
        Self::Blackbody(Blackbody::new(temperature))
    }

    /// A reflectance from RGB.
    pub fn rgb_albedo(space: &RgbColorSpace, rgb: Rgb) -> Self {
        Self::RgbAlbedo(RgbAlbedoSpectrum::new(space, rgb.to_array()))
    }

    /// An unbounded quantity from RGB.
    pub fn rgb_unbounded(space: &RgbColorSpace, rgb: Rgb) -> Self {
        Self::RgbUnbounded(RgbUnboundedSpectrum::new(space, rgb.to_array()))
    }

    /// Light from RGB.
    pub fn rgb_illuminant(space: &RgbColorSpace, rgb: Rgb) -> Self {
        Self::RgbIlluminant(RgbIlluminantSpectrum::new(space, rgb))
    }

    /// The value at `lambda` nanometres.
    #[inline(always)]
    pub fn at<R: Real>(&self, lambda: R) -> R {
        match self {
            Self::Constant(value) => R::splat(*value),
            Self::PiecewiseLinear(s) => s.at(lambda),
            Self::DenselySampled(s) => s.at(lambda),
            Self::Blackbody(s) => map_lanes(lambda, |l| s.at(l)),
            Self::RgbAlbedo(s) => s.splat().at(lambda),
            Self::RgbUnbounded(s) => s.splat().at(lambda),
            Self::RgbIlluminant(s) => s.at(lambda),
        }
    }

    /// The values at sampled wavelengths.
    #[inline(always)]
    pub fn sample<R: Real>(&self, lambda: &SampledWavelengths<R>) -> SampledSpectrum<R> {
        // A loop instead of a closure: closures of this size would be called, not inlined.
        macro_rules! each {
            ($l:ident => $value:expr) => {{
                let mut values = *lambda.lambda();
                for value in &mut values {
                    let $l = *value;
                    *value = $value;
                }
                SampledSpectrum(values)
            }};
        }
        match self {
            Self::Constant(value) => SampledSpectrum::splat(R::splat(*value)),
            Self::PiecewiseLinear(s) => each!(l => s.at(l)),
            Self::DenselySampled(s) => each!(l => s.at(l)),
            Self::Blackbody(s) => each!(l => map_lanes(l, |l| s.at(l))),
            Self::RgbAlbedo(s) => each!(l => s.splat().at(l)),
            Self::RgbUnbounded(s) => each!(l => s.splat().at(l)),
            Self::RgbIlluminant(s) => each!(l => s.at(l)),
        }
    }

    /// An upper bound of the values, tight for most kinds.
    pub fn max_value(&self) -> f32 {
        match self {
            Self::Constant(value) => *value,
            Self::PiecewiseLinear(s) => s.max_value(),
            Self::DenselySampled(s) => s.max_value(),
            Self::Blackbody(s) => s.max_value(),
            Self::RgbAlbedo(s) => s.max_value(),
            Self::RgbUnbounded(s) => s.max_value(),
            Self::RgbIlluminant(s) => s.max_value(),
        }
    }

    /// The colour of light with this spectrum.
    pub fn to_xyz(&self) -> Xyz {
        cie::integrate_xyz(|lambda| self.at(lambda))
    }

    /// ∫ f(λ) ȳ(λ) dλ, by which lights of given power or illuminance are scaled. For light from RGB
    /// it is that of the illuminant, so that the RGB values remain factors.
    pub fn to_photometric(&self) -> f32 {
        let y_bar = &cie::matching_functions().y;
        match self {
            Self::RgbIlluminant(s) => integrate(|lambda| s.illuminant().at(lambda) * y_bar.at(lambda)),
            _ => integrate(|lambda| self.at(lambda) * y_bar.at(lambda)),
        }
    }

    /// The values at integer nanometres, for fast evaluation.
    pub fn to_dense(&self) -> Self {
        match self {
            Self::Constant(_) | Self::DenselySampled(_) => self.clone(),
            _ => DenselySampled::from_fn(|lambda| self.at(lambda)).into(),
        }
    }
}

impl RgbColorSpace {
    /// The light that is white in this space, with unit luminance.
    pub fn illuminant(&self) -> Spectrum {
        Spectrum::DenselySampled(self.shared_illuminant())
    }
}

impl From<f32> for Spectrum {
    fn from(value: f32) -> Self {
        Self::Constant(value)
    }
}

impl From<PiecewiseLinear> for Spectrum {
    fn from(spectrum: PiecewiseLinear) -> Self {
        Self::PiecewiseLinear(Arc::new(spectrum))
    }
}

impl From<DenselySampled> for Spectrum {
    fn from(spectrum: DenselySampled) -> Self {
        Self::DenselySampled(Arc::new(spectrum))
    }
}

/// The measured spectrum called `name`, one of [`names`](crate::names).
pub fn named(name: &str) -> Option<Spectrum> {
    measured(name).map(Spectrum::PiecewiseLinear)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::cie::CIE_Y_INTEGRAL;
    use testkit::{LaneFunction, lanes_agree};

    #[test]
    fn equal_energy_has_luminance_one() {
        let xyz = Spectrum::Constant(1.0).to_xyz();
        assert!((xyz.y - 1.0).abs() < 1e-5);
        assert!((Spectrum::Constant(2.0).to_photometric() - 2.0 * CIE_Y_INTEGRAL).abs() < 1e-3);
    }

    #[test]
    fn photometry_of_rgb_light_is_that_of_the_illuminant() {
        let space = RgbColorSpace::srgb();
        let light = Spectrum::rgb_illuminant(space, Rgb::new(7.0, 0.5, 0.1));
        assert!((light.to_photometric() - CIE_Y_INTEGRAL).abs() < 1e-3);
    }

    #[test]
    fn dense_values_are_at_integer_nanometres() {
        let spectrum = Spectrum::blackbody(3000.0);
        let dense = spectrum.to_dense();
        for lambda in [360.0, 500.0, 830.0] {
            assert_eq!(dense.at(lambda), spectrum.at(lambda));
        }
        let lambda = SampledWavelengths::sample_uniform(0.3);
        assert_eq!(spectrum.sample(&lambda)[2], spectrum.at(lambda[2]));
    }

    struct Spectra(Vec<Spectrum>);

    impl LaneFunction for Spectra {
        #[inline(always)]
        fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
            let visible = SampledWavelengths::sample_visible(u[0]);
            // Beyond the range of wavelengths at both ends.
            let uniform = SampledWavelengths::sample_uniform_in(u[0], 300.0, 900.0);
            let mut terminated = visible;
            terminated.terminate_secondary();
            let lambda = SampledWavelengths::select(u[1].lt(u[0]), visible, uniform);
            let mut results: Vec<R> = terminated.pdf().0.to_vec();
            results.extend([*visible.lambda(), visible.pdf().0, uniform.pdf().0].concat());
            results.extend(self.0.iter().flat_map(|s| s.sample(&lambda).0));
            results
        }
    }

    #[test]
    fn spectra_do_not_depend_on_the_number_of_lanes() {
        let (space, rgb) = (RgbColorSpace::srgb(), Rgb::new(0.2, 0.9, 0.4));
        let steps = [(400.0, 1.0), (480.0, 0.2), (500.0, 3.0), (520.0, 0.0), (700.0, 2.0)];
        lanes_agree(
            &Spectra(vec![
                Spectrum::Constant(0.3),
                Spectrum::from_pairs(&steps).unwrap(),
                Spectrum::from_pairs(&steps[..1]).unwrap(),
                Spectrum::from_pairs(&steps).unwrap().to_dense(),
                Spectrum::blackbody(4000.0),
                Spectrum::rgb_albedo(space, rgb),
                Spectrum::rgb_unbounded(space, rgb),
                Spectrum::rgb_illuminant(space, rgb),
            ]),
            2,
            300,
        );
    }
}
