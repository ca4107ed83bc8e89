//! Light from one direction, the same everywhere in the scene.
//!
//! Its power is the flux through a disk that covers the scene: Φ = π·R²·L. Emitted rays start
//! uniformly on that disk. They miss geometry outside of the scene's sphere, such as parts of
//! infinite planes. Sources: [Pharr 2023 §12.3].

use super::{Emission, LightLeSample, LightLiSample, LightModel, LightPart, LightSampleContext, SceneSphere};
use math::{AnimatedTransform, Point2, Ray, Vec3, Vector3};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::PI;

/// A directional light.
#[derive(Clone, Debug)]
pub struct DistantLight {
    /// Unit direction towards the light in render space; in the light's own space if it moves.
    pub w: Vector3,
    /// From the light's own space to render space; `None` for a light at rest.
    pub motion: Option<Box<AnimatedTransform>>,
    /// Radiance (of a delta distribution in direction: irradiance on a perpendicular surface).
    pub radiance: Emission,
    /// The bounding sphere of the scene.
    pub scene: SceneSphere,
}

impl DistantLight {
    /// The unit direction towards the light in render space at a shutter time.
    pub fn direction(&self, time: f32) -> Vector3 {
        let moved = |motion: &AnimatedTransform| motion.at(time).vector(self.w).normalize_or(self.w);
        self.motion.as_deref().map_or(self.w, moved)
    }
}

impl LightModel for DistantLight {
    fn is_delta(&self) -> bool {
        true
    }

    fn is_distant(&self) -> bool {
        true
    }

    fn phi(&self, _part: &LightPart, lambda: &SampledWavelengths) -> SampledSpectrum {
        self.radiance.sample(lambda) * (PI * self.scene.radius * self.scene.radius)
    }

    fn sample_li(
        &self,
        _part: &LightPart,
        context: &LightSampleContext,
        _u: Point2,
        lambda: &SampledWavelengths,
        _allow_incomplete: bool,
    ) -> Option<LightLiSample> {
        let wi = self.direction(context.time);
        Some(LightLiSample { l: self.radiance.sample(lambda), wi, pdf: 1.0, p: None, n: Vec3::ZERO })
    }

    fn sample_le(
        &self,
        _part: &LightPart,
        u_position: Point2,
        _u_direction: Point2,
        time: f32,
        lambda: &SampledWavelengths,
    ) -> Option<LightLeSample> {
        Some(LightLeSample {
            l: self.radiance.sample(lambda),
            ray: self.scene.ray_from(self.direction(time), u_position, time),
            p: None,
            n: Vec3::ZERO,
            pdf_position: self.scene.disk_pdf(),
            pdf_direction: 1.0,
        })
    }

    fn pdf_le_infinite(&self, ray: &Ray) -> (f32, f32) {
        (self.scene.pdf_facing_disk(ray), 0.0)
    }
}
