//! Light from one direction, as from the sun without its disk; the same everywhere in the scene.
//!
//! Its power is what falls on a disk that covers the scene: Φ = π·R²·L. Rays start evenly on that
//! disk. What lies outside of the scene's sphere, as parts of endless planes do, they miss.
//! Sources: [Pharr 2023 §12.3].

use super::{Emission, LightLeSample, LightLiSample, SceneSphere};
use math::{Point2, Vec3, Vector3};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// A directional light.
#[derive(Clone, Debug)]
pub struct DistantLight {
    /// Unit direction towards the light in render space.
    pub w: Vector3,
    /// Radiance (of a delta distribution in direction: irradiance on a facing surface).
    pub radiance: Emission,
    /// The extent of the scene.
    pub scene: SceneSphere,
}

impl DistantLight {
    pub(super) fn phi(&self, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.radiance.sample(lambda) * (PI * self.scene.radius * self.scene.radius)
    }

    pub(super) fn sample_li(&self, lambda: &SampledWavelengths) -> Option<LightLiSample> {
        Some(LightLiSample { l: self.radiance.sample(lambda), wi: self.w, pdf: 1.0, p: None, n: Vec3::ZERO })
    }

    pub(super) fn sample_le(
        &self,
        u: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        Some(LightLeSample {
            l: self.radiance.sample(lambda),
            ray: self.scene.ray_from(self.w, u, time),
            p: None,
            n: Vec3::ZERO,
            pdf_position: self.scene.disk_pdf(),
            pdf_direction: 1.0,
        })
    }
}
