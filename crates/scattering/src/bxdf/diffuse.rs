//! Lambertian reflection: f = R/π on the side of `wo`, whichever side that is.
//!
//! Sampled by the cosine of `wi`, p = |cos θ_i|/π, so that every sample has the weight R. Source:
//! [Pharr 2023 §9.2].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode};
use math::{Vec2, Vector3, same_hemisphere};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::SampledSpectrum;
use std::f32::consts::FRAC_1_PI;

/// Lambertian reflection.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse {
    /// Share of light that is reflected, in [0, 1].
    pub reflectance: SampledSpectrum,
}

impl Scatter for Diffuse {
    #[inline]
    fn flags(&self) -> BxdfFlags {
        if self.reflectance.is_black() { BxdfFlags::NONE } else { BxdfFlags::DIFFUSE | BxdfFlags::REFLECTION }
    }

    #[inline]
    fn f(&self, wo: Vector3, wi: Vector3, _: TransportMode) -> SampledSpectrum {
        if same_hemisphere(wo, wi) { self.reflectance * FRAC_1_PI } else { SampledSpectrum::ZERO }
    }

    #[inline]
    fn sample_f(
        &self,
        wo: Vector3,
        _: f32,
        u: Vec2,
        _: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        if !directions.reflection() {
            return None;
        }
        let mut wi = sample_cosine_hemisphere(u);
        let pdf = cosine_hemisphere_pdf(wi.z);
        wi.z = wi.z.copysign(wo.z);
        Some(BsdfSample::new(
            self.reflectance * FRAC_1_PI,
            wi,
            pdf,
            BxdfFlags::DIFFUSE | BxdfFlags::REFLECTION,
        ))
    }

    #[inline]
    fn pdf(&self, wo: Vector3, wi: Vector3, _: TransportMode, directions: Directions) -> f32 {
        if directions.reflection() && same_hemisphere(wo, wi) {
            cosine_hemisphere_pdf(wi.z.abs())
        } else {
            0.0
        }
    }
}
