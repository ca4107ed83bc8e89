//! What the layers of parts need to know of a path: its first event.

use film::FirstEvent;
use math::Vector3;
use scattering::{Bsdf, BsdfSample, Bxdf, TransportMode};
use scene::Scene;
use scene::light::LightId;
use spectrum::SampledSpectrum;

/// Light that comes out of the depth of a body.
pub(crate) const DIFFUSE: FirstEvent = FirstEvent::Reflection { diffuse: SampledSpectrum::ONE };

/// The group of a light; that of light from a medium is the first.
pub(crate) fn group_of(scene: &Scene, light: Option<LightId>) -> usize {
    light.map_or(0, |light| scene.light(light).group())
}

/// The event by which a surface scatters light from `wi` to `wo`, unless it is specular.
pub(crate) fn event_at(bsdf: &Bsdf<Bxdf>, wo: Vector3, wi: Vector3) -> FirstEvent {
    let [wo, wi] = [wo, wi].map(|w| bsdf.render_to_local(w));
    event(wo, wi, || bsdf.bxdf.diffuse_share(wo, wi, TransportMode::Radiance))
}

/// The event of a sample, in render space.
pub(crate) fn event_of(bsdf: &Bsdf<Bxdf>, wo: Vector3, sample: &BsdfSample) -> FirstEvent {
    let [wo, wi] = [wo, sample.wi].map(|w| bsdf.render_to_local(w));
    let sample = BsdfSample { wi, ..*sample };
    event(wo, wi, || bsdf.bxdf.diffuse_share_of(wo, &sample, TransportMode::Radiance))
}

/// The event for two directions in the local frame, with the share that is diffuse of a reflection.
fn event(wo: Vector3, wi: Vector3, diffuse: impl FnOnce() -> SampledSpectrum) -> FirstEvent {
    match wo.z * wi.z < 0.0 {
        true => FirstEvent::Transmission,
        false => FirstEvent::Reflection { diffuse: diffuse() },
    }
}
