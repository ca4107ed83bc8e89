//! Shadow rays.
//!
//! A shadow ray tests whether a surface occludes one point from another. Surfaces of material
//! `interface` may be ignored ([`Interfaces`]). There are no media that attenuate light, so
//! visibility is 0 or 1. After a cancellation everything is in shadow.

use geometry::SurfacePoint;
use math::Ray;
use scene::Interfaces;
use scene::light::LightLiSample;

use super::{Step, Tracer};

impl Tracer<'_> {
    /// Whether a surface occludes the ray at 0 < t < `t_max`.
    #[inline]
    pub(crate) fn occluded(&mut self, ray: &Ray, t_max: f32, interfaces: Interfaces) -> bool {
        let is_occluded = !self.may_trace() || self.scene.occluded(ray, t_max, interfaces, self.stats);
        self.take_step(|_| Step::Shadow { ray: *ray, t_max, is_clear: !is_occluded });
        is_occluded
    }

    /// Whether the point or direction of a light sample is visible from a surface.
    #[inline]
    pub(crate) fn sees(
        &mut self,
        from: &SurfacePoint,
        sample: &LightLiSample,
        interfaces: Interfaces,
    ) -> bool {
        self.may_trace() && self.scene.unoccluded(from, sample, interfaces, self.stats)
    }
}
