//! A medium that is the same everywhere: fog, water, milk.
//!
//! Its transmittance over the distance d is exp(−σ_t d): Beer's law. Parameters: σ_a, σ_s, a factor
//! on both (1), emission (none).

use super::{Coefficients, Majorants, MediumModel, MediumProperties, Segment};
use math::{Bounds3, Point3, Ray};
use spectrum::{SampledWavelengths, Spectrum};

/// A homogeneous medium.
#[derive(Clone, Debug)]
pub struct HomogeneousMedium {
    /// Absorption and scattering.
    pub coefficients: Coefficients,
    /// Emitted radiance, without `le_scale`; `None` where there is none.
    pub le: Option<Spectrum>,
    /// Factor on the emission.
    pub le_scale: f32,
}

impl MediumModel for HomogeneousMedium {
    fn is_emissive(&self) -> bool {
        self.le.is_some()
    }

    fn bounds(&self) -> Option<Bounds3> {
        None
    }

    fn at(&self, _p: Point3, lambda: &SampledWavelengths) -> MediumProperties {
        let mut properties = self.coefficients.at(1.0, lambda);
        if let Some(le) = &self.le {
            properties.le = le.sample(lambda) * self.le_scale;
        }
        properties
    }

    fn majorants<'a>(&'a self, _ray: &Ray, t_max: f32, lambda: &SampledWavelengths) -> Majorants<'a> {
        let majorant = self.coefficients.at(1.0, lambda).sigma_t();
        Majorants::one(Segment { t: [0.0, t_max.min(f32::MAX)], majorant })
    }
}
