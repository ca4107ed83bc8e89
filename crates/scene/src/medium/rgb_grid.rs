//! A medium whose coefficients and emission are colours on a regular grid over a box.
//!
//! Each colour becomes a spectrum, and the spectra are interpolated. A grid that is missing stands
//! for the coefficient 1. Parameters: grids of σ_a and σ_s, a factor on both (1), a grid of
//! emission (none) with its factor (1).

use super::{Grid, MajorantGrid, Majorants, MediumModel, MediumProperties, Placement};
use math::{Bounds3, Point3, Ray};
use spectrum::{RgbColorSpace, RgbUnboundedSpectrum, SampledSpectrum, SampledWavelengths};

/// A medium of which colours are given on grids.
#[derive(Clone, Debug)]
pub struct RgbGridMedium {
    /// Position of its box.
    pub placement: Placement,
    /// Absorption, without `scale`; `None` is 1 everywhere.
    pub sigma_a: Option<Grid<RgbUnboundedSpectrum>>,
    /// Scattering, without `scale`; `None` is 1 everywhere.
    pub sigma_s: Option<Grid<RgbUnboundedSpectrum>>,
    /// Factor on both.
    pub scale: f32,
    /// Bounds of the extinction, without `scale`.
    pub majorants: MajorantGrid,
    /// Emission, to be multiplied by the illuminant of `space` and by `le_scale`.
    pub le: Option<Grid<RgbUnboundedSpectrum>>,
    /// Factor on the emission.
    pub le_scale: f32,
    /// The colour space of the emission.
    pub space: &'static RgbColorSpace,
}

fn value(
    grid: &Option<Grid<RgbUnboundedSpectrum>>,
    p: Point3,
    lambda: &SampledWavelengths,
) -> SampledSpectrum {
    let Some(grid) = grid else { return SampledSpectrum::ONE };
    grid.lookup(p, SampledSpectrum::ZERO, |spectrum| SampledSpectrum(lambda.lambda().map(|l| spectrum.at(l))))
}

impl MediumModel for RgbGridMedium {
    fn is_emissive(&self) -> bool {
        self.le.is_some()
    }

    fn bounds(&self) -> Option<Bounds3> {
        Some(self.placement.bounds())
    }

    fn at(&self, p: Point3, lambda: &SampledWavelengths) -> MediumProperties {
        let Some(p) = self.placement.point(p) else { return MediumProperties::default() };
        let le = if self.le.is_some() {
            let illuminant = SampledSpectrum(lambda.lambda().map(|l| self.space.illuminant_at(l)));
            value(&self.le, p, lambda) * illuminant * self.le_scale
        } else {
            SampledSpectrum::ZERO
        };
        MediumProperties {
            sigma_a: value(&self.sigma_a, p, lambda) * self.scale,
            sigma_s: value(&self.sigma_s, p, lambda) * self.scale,
            le,
        }
    }

    fn majorants<'a>(&'a self, ray: &Ray, t_max: f32, _lambda: &SampledWavelengths) -> Majorants<'a> {
        self.majorants.along(&self.placement, ray, t_max, SampledSpectrum::splat(self.scale))
    }
}
