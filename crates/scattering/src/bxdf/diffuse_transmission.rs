//! Diffuse reflection and transmission, as by paper or a leaf: f = R/π on the side of `wo`, T/π on
//! the other.
//!
//! A side is chosen in proportion to its largest value over wavelength, a direction there by its
//! cosine. Source: [Pharr 2023 §9.2].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode};
use math::{Vec2, Vector3, same_hemisphere};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::SampledSpectrum;
use std::f32::consts::FRAC_1_PI;

/// Lambertian reflection and transmission. Energy is conserved if the sum of both is at most 1.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseTransmission {
    /// Share of light that is reflected, in [0, 1].
    pub reflectance: SampledSpectrum,
    /// Share of light that is transmitted, in [0, 1].
    pub transmittance: SampledSpectrum,
}

impl DiffuseTransmission {
    #[inline]
    fn probability_of_reflection(&self, directions: Directions) -> Option<f32> {
        let (r, t) = (self.reflectance.max_component(), self.transmittance.max_component());
        directions.probability_of_reflection(r, t)
    }
}

impl Scatter for DiffuseTransmission {
    #[inline]
    fn flags(&self) -> BxdfFlags {
        let mut flags = BxdfFlags::NONE;
        if !self.reflectance.is_black() {
            flags |= BxdfFlags::DIFFUSE | BxdfFlags::REFLECTION;
        }
        if !self.transmittance.is_black() {
            flags |= BxdfFlags::DIFFUSE | BxdfFlags::TRANSMISSION;
        }
        flags
    }

    #[inline]
    fn f(&self, wo: Vector3, wi: Vector3, _: TransportMode) -> SampledSpectrum {
        let share = if same_hemisphere(wo, wi) { self.reflectance } else { self.transmittance };
        share * FRAC_1_PI
    }

    #[inline]
    fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        _: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        let pr = self.probability_of_reflection(directions)?;
        let mut wi = sample_cosine_hemisphere(u);
        let pdf = cosine_hemisphere_pdf(wi.z);
        let (side, share, probability, lobe) = if uc < pr {
            (wo.z, self.reflectance, pr, BxdfFlags::REFLECTION)
        } else {
            (-wo.z, self.transmittance, 1.0 - pr, BxdfFlags::TRANSMISSION)
        };
        wi.z = wi.z.copysign(side);
        Some(BsdfSample::new(share * FRAC_1_PI, wi, pdf * probability, BxdfFlags::DIFFUSE | lobe))
    }

    #[inline]
    fn pdf(&self, wo: Vector3, wi: Vector3, _: TransportMode, directions: Directions) -> f32 {
        let Some(pr) = self.probability_of_reflection(directions) else { return 0.0 };
        let probability = if same_hemisphere(wo, wi) { pr } else { 1.0 - pr };
        probability * cosine_hemisphere_pdf(wi.z.abs())
    }
}
