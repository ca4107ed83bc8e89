//! What the algorithms share at a surface: light that comes straight from lights, and surfaces that
//! are not there to light.

use geometry::RayStats;
use math::{Point3Error, RayDifferential, Vector3, offset_ray_origin};
use sampling::Sampler;
use scattering::{Bsdf, BxdfFlags, Scatter, TransportMode, each_bxdf};
use scene::light::{LightId, LightLiSample, LightSampleContext};
use scene::{Interfaces, Scene, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};

/// What light sampling needs to know of a surface that scatters as `flags` say.
pub(crate) fn light_context(surface: &SurfaceInteraction, flags: BxdfFlags) -> LightSampleContext {
    on_its_side(surface.light_context(), surface.surface.wo, flags)
}

/// A point seen from `wo` that scatters to one side only is moved to that side by its error, lest a
/// light that passes through it be sampled from behind.
pub(crate) fn on_its_side(context: LightSampleContext, wo: Vector3, flags: BxdfFlags) -> LightSampleContext {
    let side = match (flags.is_reflective(), flags.is_transmissive()) {
        (true, false) => wo,
        (false, true) => -wo,
        _ => return context,
    };
    LightSampleContext { p: Point3Error::exact(offset_ray_origin(context.p, context.n, side)), ..context }
}

/// What a surface scatters to `wo` of light that comes straight from a light: f·|cos|·L, before
/// visibility and pdf.
pub(crate) fn scattered<B: Scatter>(
    surface: &SurfaceInteraction,
    bsdf: &Bsdf<B>,
    light: &LightLiSample,
) -> SampledSpectrum {
    let cos_theta = light.wi.dot(surface.surface.shading.n).abs();
    bsdf.f(surface.surface.wo, light.wi, TransportMode::Radiance) * light.l * cos_theta
}

/// Whether light is stopped on its way.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Shadows {
    /// By every surface.
    Cast,
    /// Never.
    Ignored,
}

/// What a surface scatters to `wo` of the light that comes straight from the lights, by one sample
/// of each.
pub(crate) fn all_lights(
    scene: &Scene,
    surface: &SurfaceInteraction,
    bsdf: &Bsdf,
    shadows: Shadows,
    lambda: &SampledWavelengths,
    sampler: &mut Sampler,
    stats: &mut RayStats,
) -> SampledSpectrum {
    if !bsdf.flags().is_non_specular() {
        return SampledSpectrum::ZERO;
    }
    let context = light_context(surface, bsdf.flags());
    each_bxdf!(bsdf.bxdf, bxdf => {
        let bsdf = Bsdf { bxdf, frame: bsdf.frame };
        let mut sum = SampledSpectrum::ZERO;
        for light in (0..scene.lights().len() as u32).map(LightId) {
            let (u, interfaces) = (sampler.get_2d(), Interfaces::before(scene.light(light)));
            let Some(sample) = scene.sample_light(light, &context, u, lambda, false) else { continue };
            let l = scattered(surface, &bsdf, &sample);
            if !l.is_black() && (shadows == Shadows::Ignored || scene.unoccluded(surface, &sample, interfaces, stats)) {
                sum += l / sample.pdf;
            }
        }
        sum
    })
}

/// The ray beyond a surface at distance `t` that does not scatter.
pub(crate) fn pass_through(ray: &RayDifferential, surface: &SurfaceInteraction, t: f32) -> RayDifferential {
    let mut differentials = ray.differentials;
    if let Some(d) = &mut differentials {
        d.rx_origin += d.rx_direction * t;
        d.ry_origin += d.ry_direction * t;
    }
    RayDifferential { ray: surface.spawn_ray(ray.ray.d), differentials }
}
