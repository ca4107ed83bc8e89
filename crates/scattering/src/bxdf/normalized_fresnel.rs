//! The lobe by which light enters a body that scatters it under its surface: f = (1 − Fr(ωi))/(c π)
//! above the surface, where ∫ f cos θ dω = 1.
//!
//! It is one half of scattering between two points ([`Bssrdf`](crate::Bssrdf)), and therefore not
//! reciprocal by itself; it does not depend on `wo`. Source: [Pharr 2016 §11.4.2].

use super::{BsdfSample, Scatter};
use crate::{BssrdfTable, BxdfFlags, Directions, TransportMode, fr_dielectric};
use lanes::Real;
use math::{Vec2, Vector3};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::SampledSpectrum;
use std::f32::consts::FRAC_1_PI;

/// Light that enters a body, over all that does.
#[derive(Clone, Copy, Debug)]
#[doc(alias = "NormalizedFresnelBxDF")]
pub struct NormalizedFresnel<R = f32> {
    eta: R,
    /// 1/(c π).
    norm: R,
}

impl NormalizedFresnel {
    /// Through the surface of a table's media.
    pub fn new(table: &BssrdfTable) -> Self {
        Self { eta: table.eta(), norm: table.exit_norm() * FRAC_1_PI }
    }

    /// The same in all lanes.
    #[inline(always)]
    pub fn splat<R: Real>(self) -> NormalizedFresnel<R> {
        NormalizedFresnel { eta: R::splat(self.eta), norm: R::splat(self.norm) }
    }
}

impl<R: Real> Scatter<R> for NormalizedFresnel<R> {
    const CHOOSES: bool = false;

    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        BxdfFlags::splat(BxdfFlags::DIFFUSE_REFLECTION)
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode) -> SampledSpectrum<R> {
        let f = (R::one() - fr_dielectric(wi.z, self.eta)) * self.norm;
        SampledSpectrum::splat(R::select(are_above(wo, wi), f, R::zero()))
    }

    #[inline(always)]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        _: R,
        u: Vec2<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let wi = sample_cosine_hemisphere(u);
        let pdf = self.pdf(wo, wi, mode, directions);
        let lobe = BxdfFlags::splat(BxdfFlags::DIFFUSE_REFLECTION);
        let sample = BsdfSample::new(self.f(wo, wi, mode), wi, pdf, lobe);
        BsdfSample { valid: pdf.gt(R::zero()), ..sample }
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode, directions: Directions) -> R {
        if !directions.reflection() {
            return R::zero();
        }
        R::select(are_above(wo, wi), cosine_hemisphere_pdf(wi.z), R::zero())
    }
}

#[inline(always)]
fn are_above<R: Real>(wo: Vector3<R>, wi: Vector3<R>) -> R::Mask {
    wo.z.gt(R::zero()) & wi.z.gt(R::zero())
}
