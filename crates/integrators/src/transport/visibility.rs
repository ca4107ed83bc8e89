//! Shadow rays.
//!
//! A shadow ray asks whether anything stops light between two points. Surfaces of material
//! `interface` may let it pass ([`Interfaces`]). There is nothing between surfaces that would
//! attenuate light, so the answer is yes or no. After a cancellation everything is in shadow.

use geometry::SurfacePoint;
use math::Ray;
use scene::Interfaces;
use scene::light::LightLiSample;

use super::Tracer;

impl Tracer<'_> {
    /// Whether a surface stops light at 0 < t < `t_max` along the ray.
    #[inline]
    pub(crate) fn occluded(&mut self, ray: &Ray, t_max: f32, interfaces: Interfaces) -> bool {
        !self.goes_on() || self.scene.occluded(ray, t_max, interfaces, self.stats)
    }

    /// Whether the point or direction of a light sample is visible from a surface.
    #[inline]
    pub(crate) fn sees(
        &mut self,
        from: &SurfacePoint,
        sample: &LightLiSample,
        interfaces: Interfaces,
    ) -> bool {
        self.goes_on() && self.scene.unoccluded(from, sample, interfaces, self.stats)
    }
}
