//! Simple path tracing: light sampling and BSDF sampling, each of which can be switched off.
//!
//! At each surface, direct light comes either from one point on one light (chosen uniformly),
//! divided by its density, or from the path hitting the light: never from both, so that no weights
//! are needed. Lights that no light sample can find, seen directly or after a specular bounce,
//! always count when hit. The path continues in a direction sampled from the BSDF, or a uniform
//! one.
//!
//! Unbiased up to its depth, with two exceptions: without light sampling, point and distant lights
//! are never hit; without BSDF sampling, smooth metal and glass are black. Source:
//! [Pharr 2023 §13.2].

use description::SimplePathDesc;
use math::{RayDifferential, Vector3};
use sampling::warp;
use scattering::{Bsdf, Bxdf, BxdfFlags, Directions, TransportMode};
use scene::light_sampler::UniformLightSampler;
use scene::{Interfaces, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::transport::path_state::{pass_through, throughput};
use crate::transport::vertex::SurfaceVertex;
use crate::{RayIntegrator, Tracer};

/// Simple path tracing.
#[derive(Clone, Copy, Debug, Default)]
pub struct SimplePath(pub SimplePathDesc);

/// The next segment of a path.
struct Onward {
    wi: Vector3,
    /// f·|cos|/pdf.
    weight: SampledSpectrum,
    specular: bool,
}

impl RayIntegrator for SimplePath {
    fn li(
        &self,
        tracer: &mut Tracer,
        mut ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let (mut l, mut beta) = (SampledSpectrum::ZERO, SampledSpectrum::ONE);
        let mut depth = 0;
        let mut specular_bounce = true;
        while !beta.is_black() {
            let count_emission = specular_bounce || !self.0.sample_lights;
            let Some((mut surface, t)) = tracer.intersect(&ray.ray) else {
                if count_emission {
                    l += beta * tracer.scene.escaped(&ray.ray, lambda);
                }
                return l;
            };
            if count_emission {
                l += beta * tracer.scene.emitted(&surface, surface.surface.wo, lambda);
            }
            let Some(bsdf) = tracer.bsdf(&mut surface, &ray, lambda) else {
                ray = pass_through(&ray, &surface, t);
                // Interfaces occlude shadow rays here, so only the path itself finds lights beyond.
                specular_bounce = true;
                continue;
            };
            if depth == self.0.max_depth {
                return l;
            }
            depth += 1;
            if self.0.sample_lights {
                l += beta * one_light(tracer, &surface, &bsdf, lambda);
            }
            let onward = if self.0.sample_bsdf {
                by_bsdf(tracer, &surface, &bsdf)
            } else {
                Some(uniform(tracer, &surface, &bsdf))
            };
            let Some(Onward { wi, weight, specular }) = onward else { return l };
            beta *= weight;
            specular_bounce = specular;
            ray = surface.spawn_ray(wi).into();
        }
        l
    }
}

/// Next-event estimation by one light, chosen uniformly.
fn one_light(
    tracer: &mut Tracer,
    surface: &SurfaceInteraction,
    bsdf: &Bsdf<Bxdf>,
    lambda: &SampledWavelengths,
) -> SampledSpectrum {
    let vertex = SurfaceVertex::new(surface, bsdf);
    let lights = UniformLightSampler::new(tracer.scene.lights());
    let Some((light, pmf)) = lights.sample(tracer.sampler.get_1d()) else {
        return SampledSpectrum::ZERO;
    };
    let u = tracer.sampler.get_2d();
    let Some(sample) = tracer.scene.sample_light(light, &vertex.context, u, lambda, false) else {
        return SampledSpectrum::ZERO;
    };
    let l = vertex.scattered(&sample);
    if l.is_black() || tracer.occluded(&vertex.shadow_ray(&sample), Interfaces::Stop) {
        return SampledSpectrum::ZERO;
    }
    l / (pmf * sample.pdf)
}

/// A direction sampled from the BSDF.
fn by_bsdf(tracer: &mut Tracer, surface: &SurfaceInteraction, bsdf: &Bsdf<Bxdf>) -> Option<Onward> {
    let (uc, u) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
    let sample = bsdf.sample_f(surface.surface.wo, uc, u, TransportMode::Radiance, Directions::All)?;
    let weight = throughput(surface.surface.shading.n, &sample);
    Some(Onward { wi: sample.wi, weight, specular: sample.flags.is_specular() })
}

/// A uniform direction, on the sides of the surface to which it scatters.
fn uniform(tracer: &mut Tracer, surface: &SurfaceInteraction, bsdf: &Bsdf<Bxdf>) -> Onward {
    let (s, u) = (&surface.surface, tracer.sampler.get_2d());
    let (mut wi, mut pdf) = (warp::sample_uniform_sphere(u), warp::uniform_sphere_pdf());
    if !bsdf.flags().contains(BxdfFlags::REFLECTION | BxdfFlags::TRANSMISSION) {
        // Directions on the other side are mirrored, which doubles the density.
        pdf *= 2.0;
        let same_side = s.wo.dot(s.n) * wi.dot(s.n) > 0.0;
        if same_side != bsdf.flags().is_reflective() {
            wi = -wi;
        }
    }
    let cos_theta = wi.dot(s.shading.n).abs();
    Onward { wi, weight: bsdf.f(s.wo, wi, TransportMode::Radiance) * (cos_theta / pdf), specular: false }
}
