//! A light at a point that shines alike into all directions: L = I / r².
//!
//! Parameters: radiant intensity I; power 4π·I. Rays leave evenly in all directions. Sources:
//! [Pharr 2023 §12.2].

use super::{Emission, LightBounds, LightLeSample, LightLiSample, LightSampleContext};
use math::{Bounds3, Point2, Point3, Point3Error, Ray, Vec3};
use sampling::warp;
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// A point light.
#[derive(Clone, Debug)]
pub struct PointLight {
    /// Position in render space.
    pub p: Point3,
    /// Radiant intensity.
    pub intensity: Emission,
}

impl PointLight {
    pub(super) fn phi(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.intensity.sample(lambda) * (4.0 * PI)
    }

    pub(super) fn sample_li(
        &self,
        context: &LightSampleContext,
        lambda: &SampledWavelengths,
    ) -> Option<LightLiSample> {
        let to_light = self.p - context.p.p;
        let distance2 = to_light.length_squared();
        (distance2 > 0.0).then(|| LightLiSample {
            l: self.intensity.sample(lambda) / distance2,
            wi: to_light / distance2.sqrt(),
            pdf: 1.0,
            p: Some(Point3Error::exact(self.p)),
            n: Vec3::ZERO,
        })
    }

    pub(super) fn sample_le(
        &self,
        u: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        Some(LightLeSample {
            l: self.intensity.sample(lambda),
            ray: Ray::new(self.p, warp::sample_uniform_sphere(u), time),
            p: Some(Point3Error::exact(self.p)),
            n: Vec3::ZERO,
            pdf_position: 1.0,
            pdf_direction: self.pdf_le(),
        })
    }

    /// Density of the direction, whichever it is.
    pub(super) fn pdf_le(&self) -> f32 {
        warp::uniform_sphere_pdf()
    }

    pub(super) fn bounds(&self) -> Option<LightBounds> {
        Some(LightBounds {
            bounds: Bounds3::new(self.p, self.p),
            w: Vec3::Z,
            phi: 4.0 * PI * self.intensity.max_value(),
            cos_theta_o: -1.0,
            cos_theta_e: 0.0,
            two_sided: false,
        })
    }
}
