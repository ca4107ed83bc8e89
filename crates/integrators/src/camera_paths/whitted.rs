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
use sampling::Sampler;
use scattering::{Bsdf, Bxdf, Directions, TransportMode};
use scene::SurfaceInteraction;
use scene::medium::MediumId;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::transport::direct::connect_all;
use crate::transport::path_state::{pass_through, throughput};
use crate::transport::single_scattering::Scattering;
use crate::{RayIntegrator, Tracer};

/// Whitted's ray tracing.
#[derive(Clone, Copy, Debug, Default)]
pub struct Whitted(pub WhittedDesc);

/// A ray to be traced: a node of the tree.
pub(crate) struct Node {
    pub ray: RayDifferential,
    /// The medium of the ray.
    pub medium: Option<MediumId>,
    /// Path throughput.
    pub beta: SampledSpectrum,
    /// Scattering events so far.
    pub depth: u32,
}

impl Node {
    /// The reflected and the refracted ray, as far as they exist, of the surface that the ray has
    /// hit.
    pub fn children(
        &self,
        surface: &SurfaceInteraction,
        bsdf: &Bsdf<Bxdf>,
        sampler: &mut Sampler,
    ) -> [Option<Self>; 2] {
        if !bsdf.flags().is_specular() {
            return [None, None];
        }
        [Directions::Reflection, Directions::Transmission].map(|directions| {
            let (uc, u) = (sampler.get_1d(), sampler.get_2d());
            let sample = bsdf.sample_f(surface.surface.wo, uc, u, TransportMode::Radiance, directions)?;
            sample.flags.is_specular().then(|| Self {
                ray: surface.spawn_scattered(&self.ray, &sample),
                medium: surface.medium_towards(sample.wi, self.medium),
                beta: self.beta * throughput(surface, &sample),
                depth: self.depth + 1,
            })
        })
    }
}

impl RayIntegrator for Whitted {
    fn li(
        &self,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let mut l = SampledSpectrum::ZERO;
        let medium = tracer.view.medium;
        let mut next = Some(Node { ray, medium, beta: SampledSpectrum::ONE, depth: 0 });
        let (mut rest, mut connections) = (Vec::new(), Vec::new());
        while let Some(mut node) = next.take().or_else(|| rest.pop()) {
            let hit = tracer.intersect(&node.ray.ray);
            if let Some(medium) = node.medium {
                let t_max = hit.as_ref().map_or(f32::INFINITY, |(_, t)| *t);
                let is_last = node.depth == self.0.max_depth;
                let scattering = if is_last { Scattering::None } else { Scattering::Shadowed };
                l += node.beta * tracer.single_scattering(medium, &node.ray.ray, t_max, scattering, lambda);
                let Some(passed) = tracer.attenuation(medium, &node.ray.ray, t_max, &node.beta, lambda)
                else {
                    continue;
                };
                node.beta *= passed;
            }
            let Node { ray, medium, beta, depth } = node;
            let Some((mut surface, t)) = hit else {
                l += beta * tracer.scene.escaped(&ray.ray, lambda);
                continue;
            };
            l += beta * tracer.scene.emitted(&surface, surface.surface.wo, lambda);
            let Some(bsdf) = tracer.bsdf(&mut surface, &ray, lambda) else {
                let medium = surface.medium_towards(ray.ray.d, medium);
                next = Some(Node { ray: pass_through(&ray, &surface, t), medium, ..node });
                continue;
            };
            if depth == self.0.max_depth {
                continue;
            }
            let (scene, sampler) = (tracer.scene, &mut *tracer.sampler);
            connect_all(scene, sampler, &surface, &bsdf, lambda, |light| connections.push(light));
            let mut sum = SampledSpectrum::ZERO;
            for light in connections.drain(..) {
                let medium = surface.medium_towards(light.ray.d, medium);
                sum += light.arriving(medium, lambda, tracer);
            }
            l += beta * sum;
            let [reflected, refracted] = node.children(&surface, &bsdf, tracer.sampler);
            next = reflected;
            rest.extend(refracted);
        }
        l
    }
}
