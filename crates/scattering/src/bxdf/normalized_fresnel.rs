//! The lobe by which light enters a body that scatters it under its surface: f = (1 − Fr(ωi))/(c π)
//! above the surface, where ∫ f cos θ dω = 1.
//!
//! It is one half of scattering between two points ([`Bssrdf`](crate::Bssrdf)), and therefore not
//! reciprocal by itself; it does not depend on `wo`. Source: [Pharr 2016 §11.4.2].

use super::{BsdfSample, Scatter};
use crate::{BssrdfTable, BxdfFlags, Directions, TransportMode, fr_dielectric};
use math::{Vec2, Vector3};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::SampledSpectrum;
use std::f32::consts::FRAC_1_PI;

/// Light that enters a body, over all that does.
#[derive(Clone, Copy, Debug)]
#[doc(alias = "NormalizedFresnelBxDF")]
pub struct NormalizedFresnel {
    eta: f32,
    /// 1/(c π).
    norm: f32,
}

impl NormalizedFresnel {
    /// Through the surface of a table's media.
    pub fn new(table: &BssrdfTable) -> Self {
        Self { eta: table.eta(), norm: table.exit_norm() * FRAC_1_PI }
    }
}

impl Scatter for NormalizedFresnel {
    fn flags(&self) -> BxdfFlags {
        BxdfFlags::DIFFUSE_REFLECTION
    }

    #[inline]
    fn f(&self, wo: Vector3, wi: Vector3, _: TransportMode) -> SampledSpectrum {
        let is_above = wo.z > 0.0 && wi.z > 0.0;
        SampledSpectrum::splat(if is_above { (1.0 - fr_dielectric(wi.z, self.eta)) * self.norm } else { 0.0 })
    }

    #[inline]
    fn sample_f(
        &self,
        wo: Vector3,
        _: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample {
        let wi = sample_cosine_hemisphere(u);
        let pdf = self.pdf(wo, wi, mode, directions);
        let sample = BsdfSample::new(self.f(wo, wi, mode), wi, pdf, BxdfFlags::DIFFUSE_REFLECTION);
        BsdfSample { valid: pdf > 0.0, ..sample }
    }

    #[inline]
    fn pdf(&self, wo: Vector3, wi: Vector3, _: TransportMode, directions: Directions) -> f32 {
        let is_above = wo.z > 0.0 && wi.z > 0.0 && directions.reflection();
        if is_above { cosine_hemisphere_pdf(wi.z) } else { 0.0 }
    }
}
