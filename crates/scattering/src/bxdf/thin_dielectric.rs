//! A smooth pane of glass, so thin that light leaves where it enters: it is reflected, or
//! transmitted without deflection.
//!
//! Light that bounces n times inside adds (1 − F)² F^(2n−1); with all bounces the pane reflects R =
//! F + (1 − F)² F/(1 − F²) = 2F/(1 + F), and transmits 1 − R. Source: [Pharr 2023 §9.5.3],
//! [Stokes 1860].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode, fr_dielectric};
use math::{Vec2, Vec3, Vector3};
use spectrum::SampledSpectrum;

/// Two parallel smooth interfaces as one.
#[derive(Clone, Copy, Debug)]
pub struct ThinDielectric {
    /// Index of refraction of the pane over that of what surrounds it; > 0.
    pub eta: f32,
}

impl Scatter for ThinDielectric {
    #[inline]
    fn flags(&self) -> BxdfFlags {
        BxdfFlags::SPECULAR | BxdfFlags::REFLECTION | BxdfFlags::TRANSMISSION
    }

    #[inline]
    fn f(&self, _: Vector3, _: Vector3, _: TransportMode) -> SampledSpectrum {
        SampledSpectrum::ZERO
    }

    #[inline]
    fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        _: Vec2,
        _: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        if wo.z == 0.0 {
            return None;
        }
        let fresnel = fr_dielectric(wo.z.abs(), self.eta);
        let r = 2.0 * fresnel / (1.0 + fresnel);
        let pr = directions.probability_of_reflection(r, 1.0 - r)?;
        let (wi, share, probability, lobe) = if uc < pr {
            (Vec3::new(-wo.x, -wo.y, wo.z), r, pr, BxdfFlags::REFLECTION)
        } else {
            (-wo, 1.0 - r, 1.0 - pr, BxdfFlags::TRANSMISSION)
        };
        let f = SampledSpectrum::splat(share / wi.z.abs());
        Some(BsdfSample::new(f, wi, probability, BxdfFlags::SPECULAR | lobe))
    }

    #[inline]
    fn pdf(&self, _: Vector3, _: Vector3, _: TransportMode, _: Directions) -> f32 {
        0.0
    }
}
