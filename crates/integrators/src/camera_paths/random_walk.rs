//! The simplest estimator of the light transport equation: a walk in uniform directions.
//!
//! L(p, ω_o) = L_e + ∫ f(ω_o, ω_i) L(p', −ω_i) |cos θ_i| dω_i over the whole sphere, estimated by
//! one direction of density 1/4π at each surface. Unbiased up to its depth but very noisy; delta
//! distributions (point and distant lights, smooth metal and glass) are never hit, and are missing.
//! Source: [Pharr 2023 §1.3.6].

use description::RandomWalkDesc;
use math::RayDifferential;
use sampling::warp;
use scattering::TransportMode;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::transport::path_state::pass_through;
use crate::{RayIntegrator, Tracer};

/// A walk in uniform directions.
#[derive(Clone, Copy, Debug, Default)]
pub struct RandomWalk(pub RandomWalkDesc);

impl RayIntegrator for RandomWalk {
    fn li(
        &self,
        tracer: &mut Tracer,
        mut ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let (mut l, mut beta) = (SampledSpectrum::ZERO, SampledSpectrum::ONE);
        let mut depth = 0;
        while !beta.is_black() {
            let Some((mut surface, t)) = tracer.intersect(&ray.ray) else {
                return l + beta * tracer.scene.escaped(&ray.ray, lambda);
            };
            let wo = surface.surface.wo;
            l += beta * tracer.scene.emitted(&surface, wo, lambda);
            let Some(bsdf) = tracer.bsdf(&mut surface, &ray, lambda) else {
                ray = pass_through(&ray, &surface, t);
                continue;
            };
            if depth == self.0.max_depth {
                return l;
            }
            depth += 1;
            let wi = warp::sample_uniform_sphere(tracer.sampler.get_2d());
            let cos_theta = wi.dot(surface.surface.shading.n).abs();
            beta *= bsdf.f(wo, wi, TransportMode::Radiance) * (cos_theta / warp::uniform_sphere_pdf());
            ray = surface.spawn_ray(wi).into();
        }
        l
    }
}
