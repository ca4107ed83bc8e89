//! Lambertian reflection: f = R/π on the side of `wo`, whichever side that is.
//!
//! Sampled by the cosine of `wi`, p = |cos θ_i|/π, so that every sample has the weight R. Source:
//! [Pharr 2023 §9.2].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode};
use lanes::Real;
use math::{Vec2, Vector3, same_hemisphere};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::SampledSpectrum;
use std::f32::consts::FRAC_1_PI;

/// Lambertian reflection.
#[derive(Clone, Copy, Debug)]
pub struct Diffuse<R = f32> {
    /// Share of light that is reflected, in [0, 1].
    pub reflectance: SampledSpectrum<R>,
}

const LOBE: BxdfFlags = BxdfFlags::DIFFUSE_REFLECTION;

impl<R: Real> Scatter<R> for Diffuse<R> {
    const CHOOSES: bool = false;

    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        BxdfFlags::only_where(!self.reflectance.is_black(), LOBE)
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode) -> SampledSpectrum<R> {
        let f = self.reflectance * R::splat(FRAC_1_PI);
        SampledSpectrum::select(same_hemisphere(wo, wi), f, SampledSpectrum::zero())
    }

    #[inline(always)]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        _: R,
        u: Vec2<R>,
        _: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        if !directions.reflection() {
            return BsdfSample::invalid();
        }
        let mut wi = sample_cosine_hemisphere(u);
        let pdf = cosine_hemisphere_pdf(wi.z);
        wi.z = wi.z.copysign(wo.z);
        let f = self.reflectance * R::splat(FRAC_1_PI);
        BsdfSample::new(f, wi, pdf, BxdfFlags::splat(LOBE))
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode, directions: Directions) -> R {
        if !directions.reflection() {
            return R::zero();
        }
        R::select(same_hemisphere(wo, wi), cosine_hemisphere_pdf(wi.z.abs()), R::zero())
    }
}
