//! A medium whose density is given on a regular grid over a box.
//!
//! Coefficients are those at density 1 times the density. It emits with the same spectrum
//! everywhere, or as a blackbody of the temperature given on the grid; either times a factor that
//! may be given on a grid, too.

use super::{
    Coefficients, Grid, MajorantGrid, Majorants, MediumModel, MediumProperties, Placement, Temperature,
};
use math::{Bounds3, Point3, Ray};
use spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

/// A medium of which the density is given on a grid.
#[derive(Clone, Debug)]
pub struct UniformGridMedium {
    /// Position of its box.
    pub placement: Placement,
    /// Absorption and scattering at density 1.
    pub coefficients: Coefficients,
    /// Densities, at least 0.
    pub density: Grid<f32>,
    /// Bounds of the densities.
    pub majorants: MajorantGrid,
    /// Emission, if there is any.
    pub emission: Option<GridEmission>,
}

/// Emission that varies over a grid.
#[derive(Clone, Debug)]
pub struct GridEmission {
    /// What emits.
    pub source: EmissionSource,
    /// Factor for the whole.
    pub scale: f32,
    /// Factor on a grid.
    pub factor: Grid<f32>,
}

/// The radiance that a medium emits, without its factors.
#[derive(Clone, Debug)]
pub enum EmissionSource {
    /// The same spectrum everywhere.
    Spectrum(Spectrum),
    /// That of blackbodies, whose temperatures are given on a grid.
    Temperature(Grid<f32>, Temperature),
}

impl GridEmission {
    fn at(&self, p: Point3, lambda: &SampledWavelengths) -> SampledSpectrum {
        let factor = self.scale * self.factor.value(p);
        let le = match &self.source {
            EmissionSource::Spectrum(le) => le.sample(lambda),
            EmissionSource::Temperature(values, temperature) => temperature.le(values.value(p), lambda),
        };
        le * factor
    }
}

impl MediumModel for UniformGridMedium {
    fn is_emissive(&self) -> bool {
        self.emission.is_some()
    }

    fn bounds(&self) -> Option<Bounds3> {
        Some(self.placement.bounds())
    }

    fn at(&self, p: Point3, lambda: &SampledWavelengths) -> MediumProperties {
        let Some(p) = self.placement.point(p) else { return MediumProperties::default() };
        let mut properties = self.coefficients.at(self.density.value(p), lambda);
        if let Some(emission) = &self.emission {
            properties.le = emission.at(p, lambda);
        }
        properties
    }

    fn majorants<'a>(&'a self, ray: &Ray, t_max: f32, lambda: &SampledWavelengths) -> Majorants<'a> {
        self.majorants.along(&self.placement, ray, t_max, self.coefficients.at(1.0, lambda).sigma_t())
    }
}
