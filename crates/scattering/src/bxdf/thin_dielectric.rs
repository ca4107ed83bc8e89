//! A smooth pane of glass, so thin that light leaves where it enters: it is reflected, or
//! transmitted without deflection.
//!
//! Light that bounces n times inside adds (1 − F)² F^(2n−1); with all bounces the pane reflects R =
//! F + (1 − F)² F/(1 − F²) = 2F/(1 + F), and transmits 1 − R. Source: [Pharr 2023 §9.5.3],
//! [Stokes 1860].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode, fr_dielectric};
use lanes::Real;
use math::{Vec2, Vec3, Vector3};
use spectrum::SampledSpectrum;

/// Two parallel smooth interfaces as one.
#[derive(Clone, Copy, Debug)]
pub struct ThinDielectric<R = f32> {
    /// Index of refraction of the pane over that of what surrounds it; > 0.
    pub eta: R,
}

impl<R: Real> Scatter<R> for ThinDielectric<R> {
    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        BxdfFlags::splat(BxdfFlags::SPECULAR_REFLECTION | BxdfFlags::SPECULAR_TRANSMISSION)
    }

    #[inline(always)]
    fn f(&self, _: Vector3<R>, _: Vector3<R>, _: TransportMode) -> SampledSpectrum<R> {
        SampledSpectrum::zero()
    }

    #[inline(always)]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        uc: R,
        _: Vec2<R>,
        _: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let fresnel = fr_dielectric(wo.z.abs(), self.eta);
        let r = fresnel * R::splat(2.0) / (R::one() + fresnel);
        let (pr, valid) = directions.probability_of_reflection(r, R::one() - r);
        let reflects = uc.lt(pr);
        let wi = Vec3::select(reflects, Vec3::new(-wo.x, -wo.y, wo.z), -wo);
        let share = R::select(reflects, r, R::one() - r);
        let probability = R::select(reflects, pr, R::one() - pr);
        let lobe =
            BxdfFlags::choose(reflects, BxdfFlags::SPECULAR_REFLECTION, BxdfFlags::SPECULAR_TRANSMISSION);
        let f = SampledSpectrum::splat(share / wi.z.abs());
        let valid = valid & wo.z.ne(R::zero());
        BsdfSample { valid, ..BsdfSample::new(f, wi, probability, lobe) }
    }

    #[inline(always)]
    fn pdf(&self, _: Vector3<R>, _: Vector3<R>, _: TransportMode, _: Directions) -> R {
        R::zero()
    }
}
