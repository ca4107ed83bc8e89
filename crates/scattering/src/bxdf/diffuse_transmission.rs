//! Diffuse reflection and transmission, as by paper or a leaf: f = R/π on the side of `wo`, T/π on
//! the other.
//!
//! A side is chosen in proportion to its largest value over wavelength, a direction there by its
//! cosine. Source: [Pharr 2023 §9.2].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode};
use lanes::{Mask, Real};
use math::{Vec2, Vector3, same_hemisphere};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::SampledSpectrum;
use std::f32::consts::FRAC_1_PI;

/// Lambertian reflection and transmission. Energy is conserved if the sum of both is at most 1.
#[derive(Clone, Copy, Debug)]
pub struct DiffuseTransmission<R = f32> {
    /// Share of light that is reflected, in [0, 1].
    pub reflectance: SampledSpectrum<R>,
    /// Share of light that is transmitted, in [0, 1].
    pub transmittance: SampledSpectrum<R>,
}

impl<R: Real> DiffuseTransmission<R> {
    #[inline(always)]
    fn probability_of_reflection(&self, directions: Directions) -> (R, R::Mask) {
        let (r, t) = (self.reflectance.max_component(), self.transmittance.max_component());
        directions.probability_of_reflection(r, t)
    }
}

impl<R: Real> Scatter<R> for DiffuseTransmission<R> {
    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        BxdfFlags::only_where(!self.reflectance.is_black(), BxdfFlags::DIFFUSE_REFLECTION)
            | BxdfFlags::only_where(!self.transmittance.is_black(), BxdfFlags::DIFFUSE_TRANSMISSION)
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode) -> SampledSpectrum<R> {
        let reflects = same_hemisphere(wo, wi);
        SampledSpectrum::select(reflects, self.reflectance, self.transmittance) * R::splat(FRAC_1_PI)
    }

    #[inline(always)]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        _: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let (pr, valid) = self.probability_of_reflection(directions);
        if !valid.any() {
            return BsdfSample::invalid();
        }
        let mut wi = sample_cosine_hemisphere(u);
        let pdf = cosine_hemisphere_pdf(wi.z);
        let reflects = uc.lt(pr);
        wi.z = wi.z.copysign(R::select(reflects, wo.z, -wo.z));
        let share = SampledSpectrum::select(reflects, self.reflectance, self.transmittance);
        let probability = R::select(reflects, pr, R::one() - pr);
        let lobe =
            BxdfFlags::choose(reflects, BxdfFlags::DIFFUSE_REFLECTION, BxdfFlags::DIFFUSE_TRANSMISSION);
        let f = share * R::splat(FRAC_1_PI);
        BsdfSample { valid, ..BsdfSample::new(f, wi, pdf * probability, lobe) }
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode, directions: Directions) -> R {
        let (pr, valid) = self.probability_of_reflection(directions);
        let probability = R::select(same_hemisphere(wo, wi), pr, R::one() - pr);
        R::select(valid, probability * cosine_hemisphere_pdf(wi.z.abs()), R::zero())
    }
}
