//! Whitted's ray tracing: shadows, perfect reflection and refraction.
//!
//! At each surface, L = L_e + Σ_lights f L_i V |cos θ_i| / p + k_r L(reflected) + k_t L(refracted):
//! a shadow ray to one point of every light (point lights need no more, area lights show soft
//! shadows as samples grow), and both directions of a smooth mirror, metal or glass. Rough surfaces
//! scatter direct light only, so that indirect light and caustics are missing. The tree of rays
//! grows as 2^depth in glass.
//!
//! With a `max_depth` of 1, mirrors are black. Source: [Whitted 1980].

use description::WhittedDesc;
use math::RayDifferential;
use scattering::{Directions, TransportMode};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::transport::direct::{Shadows, all_lights};
use crate::transport::path_state::pass_through;
use crate::{RayIntegrator, Tracer};

/// Whitted's ray tracing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Whitted(pub WhittedDesc);

/// A ray to be traced.
struct Pending {
    ray: RayDifferential,
    beta: SampledSpectrum,
    depth: u32,
}

impl RayIntegrator for Whitted {
    fn li(
        &self,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let mut l = SampledSpectrum::ZERO;
        let mut rest = Vec::new();
        let mut next = Some(Pending { ray, beta: SampledSpectrum::ONE, depth: 0 });
        while let Some(Pending { ray, beta, depth }) = next.take().or_else(|| rest.pop()) {
            let Some((mut surface, t)) = tracer.intersect(&ray.ray) else {
                l += beta * tracer.scene.escaped(&ray.ray, lambda);
                continue;
            };
            l += beta * tracer.scene.emitted(&surface, surface.surface.wo, lambda);
            let Some(bsdf) = tracer.bsdf(&mut surface, &ray, lambda) else {
                next = Some(Pending { ray: pass_through(&ray, &surface, t), beta, depth });
                continue;
            };
            if depth == self.0.max_depth {
                continue;
            }
            l += beta * all_lights(tracer, &surface, &bsdf, Shadows::Cast, lambda);
            if !bsdf.flags().is_specular() {
                continue;
            }
            for directions in [Directions::Reflection, Directions::Transmission] {
                let (uc, u) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
                let sample = bsdf.sample_f(surface.surface.wo, uc, u, TransportMode::Radiance, directions);
                let Some(sample) = sample.filter(|sample| sample.flags.is_specular()) else { continue };
                let cos_theta = sample.wi.dot(surface.surface.shading.n).abs();
                let scattered = Pending {
                    ray: surface.spawn_scattered(&ray, &sample),
                    beta: beta * sample.f * (cos_theta / sample.pdf),
                    depth: depth + 1,
                };
                rest.extend(next.replace(scattered));
            }
        }
        l
    }
}
