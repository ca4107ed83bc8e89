//! Ray casting: camera rays only, without shadow rays.
//!
//! L = L_e + Σ f(ω_o, ω_i) L_i |cos θ_i| / p(ω_i), one direction ω_i for each light, as if the
//! light were not occluded. Shadows, reflections, refractions and indirect light are missing;
//! smooth metal and glass are black. It shows what secondary rays add to a picture. Direct light is
//! otherwise correct: area lights are sampled over their surfaces. Source: [Appel 1968], without
//! his shadows.

use math::RayDifferential;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::transport::ShadowRay;
use crate::transport::direct::connect_all;
use crate::transport::path_state::pass_through;
use crate::transport::single_scattering::Scattering;
use crate::transport::vertex::SurfaceVertex;
use crate::{RayIntegrator, Tracer};

/// Ray casting. It has no settings.
#[derive(Clone, Copy, Debug, Default)]
pub struct RayCasting;

impl RayIntegrator for RayCasting {
    fn li(
        &self,
        tracer: &mut Tracer,
        mut ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let (mut l, mut beta) = (SampledSpectrum::ZERO, SampledSpectrum::ONE);
        let mut medium = tracer.view.medium;
        loop {
            let hit = tracer.intersect(&ray.ray);
            if let Some(medium) = medium {
                let t_max = hit.as_ref().map_or(f32::INFINITY, |(_, t)| *t);
                l += beta * tracer.single_scattering(medium, &ray.ray, t_max, Scattering::Unshadowed, lambda);
                let way = ShadowRay { ray: ray.ray, t_max };
                let Some(passed) = tracer.transmittance_within(&way, medium, &beta, lambda) else {
                    return l;
                };
                beta *= passed;
            }
            let Some((mut surface, t)) = hit else {
                return l + beta * tracer.scene.escaped(&ray.ray, lambda);
            };
            l += beta * tracer.scene.emitted(&surface, surface.surface.wo, lambda);
            match tracer.bsdf(&mut surface, &ray, lambda) {
                Some(bsdf) => {
                    let mut sum = SampledSpectrum::ZERO;
                    let vertex = SurfaceVertex::new(&surface, &bsdf);
                    connect_all(tracer.scene, tracer.sampler, &vertex, false, lambda, |light| sum += light.l);
                    return l + beta * sum;
                }
                None => {
                    medium = surface.medium_towards(ray.ray.d, medium);
                    ray = pass_through(&ray, &surface, t);
                }
            }
        }
    }
}
