//! Shadow rays.
//!
//! A shadow ray tests whether a surface occludes one point from another. Surfaces of material
//! `interface` may be ignored ([`Interfaces`]). There are no media that attenuate light, so
//! visibility is 0 or 1. After a cancellation everything is in shadow.

use math::Ray;
use scene::Interfaces;
use scene::light::{LightLiSample, LightSampleContext};

use super::{Step, Tracer};

/// A shadow ray.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShadowRay<R = f32> {
    /// The ray.
    pub ray: Ray<R>,
    /// Its end, in lengths of its direction; may be infinite.
    pub t_max: R,
}

impl ShadowRay {
    /// To the point or in the direction of a light sample.
    #[inline]
    pub fn to_light(from: &LightSampleContext, sample: &LightLiSample) -> Self {
        let (ray, t_max) = sample.shadow_ray(from);
        Self { ray, t_max }
    }
}

impl Tracer<'_> {
    /// Whether a surface occludes a shadow ray.
    #[inline]
    pub(crate) fn occluded(&mut self, shadow: &ShadowRay, interfaces: Interfaces) -> bool {
        let &ShadowRay { ray, t_max } = shadow;
        let is_occluded = !self.may_trace() || self.scene.occluded(&ray, t_max, interfaces, self.stats);
        self.take_step(|_| Step::Shadow { ray, t_max, is_clear: !is_occluded });
        is_occluded
    }
}
