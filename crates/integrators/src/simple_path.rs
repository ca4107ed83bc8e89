//! Path tracing taken apart: light sampling and BSDF sampling, each of which can be switched off.
//!
//! At each surface, direct light comes either from one point on one light (chosen uniformly),
//! divided by its density, or from the path happening to meet the light: never from both, so that
//! no weights are needed. Only what no light sample can find, seen directly or after a specular
//! bounce, is always counted when met. The path goes on in a direction of the BSDF's density, or a
//! uniform one.
//!
//! Unbiased up to its depth, with two exceptions: without light sampling, point and distant lights
//! are never met; without BSDF sampling, smooth metal and glass are black.
//!
//! Settings: `max_depth`, most scattering events, default 5; `sample_lights` and `sample_bsdf`,
//! default true. Source: [Pharr 2023 §13.2].

use geometry::RayStats;
use math::{RayDifferential, Vector3};
use sampling::{Sampler, warp};
use scattering::{Bsdf, BxdfFlags, Directions, Scatter, TransportMode, each_bxdf};
use scene::light_sampler::LightSamplerKind;
use scene::{Interfaces, Scene, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::RayIntegrator;
use crate::direct::{light_context, pass_through, scattered};

/// Path tracing taken apart.
#[derive(Clone, Copy, Debug)]
pub struct SimplePath {
    /// Most scattering events.
    pub max_depth: u32,
    /// Sample a light at each surface.
    pub sample_lights: bool,
    /// Sample directions by the BSDF instead of uniformly.
    pub sample_bsdf: bool,
}

impl Default for SimplePath {
    fn default() -> Self {
        Self { max_depth: 5, sample_lights: true, sample_bsdf: true }
    }
}

/// Where a path goes on.
struct Onward {
    wi: Vector3,
    /// f·|cos|/pdf.
    weight: SampledSpectrum,
    specular: bool,
}

impl RayIntegrator for SimplePath {
    fn li(
        &self,
        scene: &Scene,
        mut ray: RayDifferential,
        lambda: &mut SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        let (mut l, mut beta) = (SampledSpectrum::ZERO, SampledSpectrum::ONE);
        let mut depth = 0;
        let mut specular_bounce = true;
        while !beta.is_black() {
            let count_emission = specular_bounce || !self.sample_lights;
            let Some((mut surface, t)) = scene.intersect(&ray.ray, f32::INFINITY, stats) else {
                if count_emission {
                    l += beta * scene.escaped(&ray.ray, lambda);
                }
                return l;
            };
            if count_emission {
                l += beta * scene.emitted(&surface, surface.surface.wo, lambda);
            }
            let Some(bsdf) = scene.bsdf(&mut surface, &ray, lambda, sampler) else {
                ray = pass_through(&ray, &surface, t);
                // No light sample gets through here: what the ray meets beyond it alone finds.
                specular_bounce = true;
                continue;
            };
            if depth == self.max_depth {
                return l;
            }
            depth += 1;
            let onward = each_bxdf!(bsdf.bxdf, bxdf => {
                let bsdf = Bsdf { bxdf, frame: bsdf.frame };
                if self.sample_lights {
                    l += beta * one_light(scene, &surface, &bsdf, lambda, sampler, stats);
                }
                if self.sample_bsdf {
                    by_bsdf(&surface, &bsdf, sampler)
                } else {
                    Some(uniform(&surface, &bsdf, sampler))
                }
            });
            let Some(Onward { wi, weight, specular }) = onward else { return l };
            beta *= weight;
            specular_bounce = specular;
            ray = surface.spawn_ray(wi).into();
        }
        l
    }
}

/// Light that comes straight from one light, for all of them.
fn one_light<B: Scatter>(
    scene: &Scene,
    surface: &SurfaceInteraction,
    bsdf: &Bsdf<B>,
    lambda: &SampledWavelengths,
    sampler: &mut Sampler,
    stats: &mut RayStats,
) -> SampledSpectrum {
    let context = light_context(surface, bsdf.flags());
    let lights = scene.light_sampler(LightSamplerKind::Uniform);
    let Some((light, pmf)) = lights.sample(&context, sampler.get_1d()) else { return SampledSpectrum::ZERO };
    let Some(sample) = scene.sample_light(light, &context, sampler.get_2d(), lambda, false) else {
        return SampledSpectrum::ZERO;
    };
    let l = scattered(surface, bsdf, &sample);
    if l.is_black() || !scene.unoccluded(surface, &sample, Interfaces::Stop, stats) {
        return SampledSpectrum::ZERO;
    }
    l / (pmf * sample.pdf)
}

/// A direction of the BSDF's density.
fn by_bsdf<B: Scatter>(
    surface: &SurfaceInteraction,
    bsdf: &Bsdf<B>,
    sampler: &mut Sampler,
) -> Option<Onward> {
    let (uc, u) = (sampler.get_1d(), sampler.get_2d());
    let sample = bsdf.sample_f(surface.surface.wo, uc, u, TransportMode::Radiance, Directions::All)?;
    let cos_theta = sample.wi.dot(surface.surface.shading.n).abs();
    let weight = sample.f * (cos_theta / sample.pdf);
    Some(Onward { wi: sample.wi, weight, specular: sample.flags.is_specular() })
}

/// A uniform direction, on those sides of the surface to which it scatters at all.
fn uniform<B: Scatter>(surface: &SurfaceInteraction, bsdf: &Bsdf<B>, sampler: &mut Sampler) -> Onward {
    let (s, u) = (&surface.surface, sampler.get_2d());
    let (mut wi, mut pdf) = (warp::sample_uniform_sphere(u), warp::uniform_sphere_pdf());
    if !bsdf.flags().contains(BxdfFlags::REFLECTION | BxdfFlags::TRANSMISSION) {
        // Directions on the other side are turned over: the density doubles.
        pdf *= 2.0;
        let same_side = s.wo.dot(s.n) * wi.dot(s.n) > 0.0;
        if same_side != bsdf.flags().is_reflective() {
            wi = -wi;
        }
    }
    let cos_theta = wi.dot(s.shading.n).abs();
    Onward { wi, weight: bsdf.f(s.wo, wi, TransportMode::Radiance) * (cos_theta / pdf), specular: false }
}
