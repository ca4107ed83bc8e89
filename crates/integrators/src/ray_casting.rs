//! Ray casting: what the camera's own rays show, and nothing more.
//!
//! L = L_e + Σ f(ω_o, ω_i) L_i |cos θ_i| / p(ω_i), one direction ω_i for each light, as if nothing
//! stood between the surface and the light. Shadows, reflections, refractions and indirect light
//! are missing; smooth metal and glass are black. It shows what a picture lacks without secondary
//! rays. Light is otherwise right: area lights are sampled over their surfaces. Source:
//! [Appel 1968], without his shadows.

use geometry::RayStats;
use math::RayDifferential;
use sampling::Sampler;
use scene::Scene;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::RayIntegrator;
use crate::direct::{Shadows, all_lights, pass_through};

/// Ray casting. It has no settings.
#[derive(Clone, Copy, Debug, Default)]
pub struct RayCasting;

impl RayIntegrator for RayCasting {
    fn li(
        &self,
        scene: &Scene,
        mut ray: RayDifferential,
        lambda: &mut SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        let mut l = SampledSpectrum::ZERO;
        loop {
            let Some((mut surface, t)) = scene.intersect(&ray.ray, f32::INFINITY, stats) else {
                return l + scene.escaped(&ray.ray, lambda);
            };
            l += scene.emitted(&surface, surface.surface.wo, lambda);
            match scene.bsdf(&mut surface, &ray, lambda, sampler) {
                Some(bsdf) => {
                    return l + all_lights(scene, &surface, &bsdf, Shadows::Ignored, lambda, sampler, stats);
                }
                None => ray = pass_through(&ray, &surface, t),
            }
        }
    }
}
