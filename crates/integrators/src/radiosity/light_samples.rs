//! Irradiance from lights, by light sampling.

use geometry::RayStats;
use math::{Ray, Vec2};
use sampling::hash_float;
use scene::light::{Light, LightId, LightLiSample, LightSampleContext};
use scene::{Interfaces, Scene};
use spectrum::SampledSpectrum;

use super::bands::{Bands, Wavelengths};

/// The irradiance of both sides of a point from a light, by light sampling.
pub(crate) fn from_light(
    scene: &Scene,
    wavelengths: &Wavelengths,
    light: LightId,
    context: &LightSampleContext,
    stats: &mut RayStats,
) -> [Bands; 2] {
    let strata = match scene.light(light).row() {
        Light::Point(_)
        | Light::Spot(_)
        | Light::Goniometric(_)
        | Light::Projection(_)
        | Light::Distant(_) => 1,
        Light::Area(_) | Light::UniformInfinite(_) | Light::ImageInfinite(_) | Light::PortalInfinite(_) => {
            LIGHT_STRATA
        }
    };
    // A random shift for each point decorrelates their shadows.
    let place = context.p.p.to_array().map(f32::to_bits);
    let shift = Vec2::new(hash_float(&place), hash_float(&[place[2], place[0], place[1]]));
    let mut sides = [Bands::ZERO; 2];
    for i in 0..strata * strata {
        let u = (Vec2::new((i % strata) as f32, (i / strata) as f32) + shift) / strata as f32;
        let Some((l, sample)) = sample_light(scene, wavelengths, light, context, u) else { continue };
        if arrives(scene, context, &sample, stats) {
            let cos_theta = sample.wi.dot(context.n);
            sides[usize::from(cos_theta < 0.0)] +=
                l * (cos_theta.abs() / (sample.pdf * (strata * strata) as f32));
        }
    }
    sides
}

/// Samples along each axis, of lights that are not delta lights.
const LIGHT_STRATA: u32 = 8;

/// A direction to a light, and its radiance at all wavelengths.
pub(crate) fn sample_light(
    scene: &Scene,
    wavelengths: &Wavelengths,
    light: LightId,
    context: &LightSampleContext,
    u: Vec2,
) -> Option<(Bands, LightLiSample)> {
    let mut found = None;
    let l = wavelengths.sample(|lambda| {
        let sample = scene.sample_light(light, context, u, lambda, false);
        found = found.or(sample);
        sample.map_or(SampledSpectrum::ZERO, |sample| sample.l)
    });
    found.map(|sample| (l, sample))
}

/// Whether the sample of a light is visible from a point.
pub(crate) fn arrives(
    scene: &Scene,
    context: &LightSampleContext,
    sample: &LightLiSample,
    stats: &mut RayStats,
) -> bool {
    let (ray, end) = match sample.p {
        Some(p) => (Ray::between(context.p, context.n, p, sample.n, context.time), Ray::SHADOW_END),
        None => (context.spawn_ray(sample.wi), f32::INFINITY),
    };
    !scene.occluded(&ray, end, Interfaces::Pass, stats)
}
