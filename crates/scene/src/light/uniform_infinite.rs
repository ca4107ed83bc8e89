//! A sky of one radiance in all directions.
//!
//! Its power is what enters the sphere around the scene: Φ = 4π²·R²·L. With incomplete sampling
//! allowed it is left wholly to BSDF sampling, which covers a constant sky better than uniform
//! directions do. Rays come evenly from all directions, and start evenly on the disk that faces
//! them and covers the scene. Sources: [Pharr 2023 §12.5.1].

use super::{Emission, LightLeSample, LightLiSample, SceneSphere};
use math::{Point2, Vec3};
use sampling::warp;
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// A constant environment.
#[derive(Clone, Debug)]
pub struct UniformInfiniteLight {
    /// Radiance from every direction.
    pub radiance: Emission,
    /// The extent of the scene.
    pub scene: SceneSphere,
}

impl UniformInfiniteLight {
    pub(super) fn phi(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.radiance.sample(lambda) * (4.0 * PI * PI * self.scene.radius * self.scene.radius)
    }

    pub(super) fn le(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.radiance.sample(lambda)
    }

    pub(super) fn sample_li(
        &self,
        u: Point2,
        lambda: &SampledWavelengths,
        allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        if allow_incomplete {
            return None;
        }
        let wi = warp::sample_uniform_sphere(u);
        Some(LightLiSample {
            l: self.radiance.sample(lambda),
            wi,
            pdf: self.pdf_li(false),
            p: None,
            n: Vec3::ZERO,
        })
    }

    pub(super) fn sample_le(
        &self,
        u_position: Point2,
        u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        let LightLiSample { l, wi, pdf, n, .. } = self.sample_li(u_direction, lambda, false)?;
        Some(LightLeSample {
            l,
            ray: self.scene.ray_from(wi, u_position, time),
            p: None,
            n,
            pdf_position: self.scene.disk_pdf(),
            pdf_direction: pdf,
        })
    }

    pub(super) fn pdf_li(&self, allow_incomplete: bool) -> f32 {
        if allow_incomplete { 0.0 } else { 1.0 / (4.0 * PI) }
    }
}
