//! A sky with the same radiance in all directions.
//!
//! Its power is what enters the sphere around the scene: Φ = 4π²·R²·L. With incomplete sampling
//! allowed it is never sampled: BSDF sampling finds a constant sky better than uniform directions
//! do. Emitted rays are uniform in direction, and start uniformly on the disk that is perpendicular
//! to them and covers the scene. Sources: [Pharr 2023 §12.5.1].

use super::{
    Emission, LightLeSample, LightLiSample, LightModel, LightPart, LightPoint, LightSampleContext,
    SceneSphere,
};
use lanes::Real;
use math::{Point2, Ray, Vec3, Vector3};
use sampling::warp;
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// A constant environment.
#[derive(Clone, Debug)]
pub struct UniformInfiniteLight {
    /// Radiance from every direction.
    pub radiance: Emission,
    /// The bounding sphere of the scene.
    pub scene: SceneSphere,
}

impl UniformInfiniteLight {
    /// Directions chosen by `u`: radiance, direction and density per solid angle.
    #[inline(always)]
    pub fn sample<R: Real>(
        &self,
        u: Point2<R>,
        lambda: &SampledWavelengths<R>,
    ) -> (SampledSpectrum<R>, Vector3<R>, R) {
        (self.radiance.sample(lambda), warp::sample_uniform_sphere(u), R::splat(Self::pdf(false)))
    }

    fn pdf(allow_incomplete: bool) -> f32 {
        if allow_incomplete { 0.0 } else { 1.0 / (4.0 * PI) }
    }
}

impl LightModel for UniformInfiniteLight {
    fn is_delta(&self) -> bool {
        false
    }

    fn is_infinite(&self) -> bool {
        true
    }

    fn phi(&self, _part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.radiance.sample(lambda) * (4.0 * PI * PI * self.scene.radius * self.scene.radius)
    }

    fn le(&self, _ray: &Ray, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.radiance.sample(lambda)
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        _context: &LightSampleContext,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        if allow_incomplete {
            return None;
        }
        let (l, wi, pdf) = self.sample(u, lambda);
        Some(LightLiSample { l, wi, pdf, p: None, n: Vec3::ZERO })
    }

    fn pdf_li(
        &self,
        _part: &LightPart,
        _context: &LightSampleContext,
        _wi: Vector3,
        _point: LightPoint,
        allow_incomplete: bool,
    ) -> f32 {
        Self::pdf(allow_incomplete)
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        Some(LightLeSample {
            l: self.radiance.sample(lambda),
            ray: self.scene.ray_from(warp::sample_uniform_sphere(u_direction), u_position, time),
            p: None,
            n: Vec3::ZERO,
            pdf_position: self.scene.disk_pdf(),
            pdf_direction: Self::pdf(false),
        })
    }

    fn pdf_le_infinite(&self, ray: &Ray) -> (f32, f32) {
        (self.scene.pdf_facing_disk(ray), Self::pdf(false))
    }
}
