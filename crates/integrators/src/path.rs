//! Path tracing with next-event estimation, multiple importance sampling and Russian roulette.
//!
//! At each surface one ray goes to a light and one onwards. Light that both ways can find, of
//! densities p_l (choice of the light times its point) and p_b (BSDF) per solid angle, is counted
//! by both with the weights of the power heuristic, w_l = p_l²/(p_l² + p_b²) and w_b = 1 − w_l
//! [Veach 1997 §9.2]; what one alone can find (delta lights, specular bounces) counts fully. Lights
//! may leave directions to the BSDF (`allow_incomplete`): their density is then zero there.
//!
//! From the second bounce on a path ends with probability 1 − β_max, where β_max is the largest
//! value of β·η² and η² undoes the scaling of radiance by refractions on the way, so that what is
//! seen through glass is not cut off early.
//!
//! Unbiased up to `max_depth`, except with `regularize`, which roughens surfaces after the first
//! rough bounce to find caustics with less noise. Source: [Pharr 2023 §13.4].

use geometry::RayStats;
use math::{RayDifferential, Vector3};
use sampling::Sampler;
use scattering::{Bsdf, BsdfSample, Directions, Scatter, TransportMode, each_bxdf};
use scene::light::{LightId, LightSampleContext};
use scene::light_sampler::{LightSampler, LightSamplerKind};
use scene::{Interfaces, Scene, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::RayIntegrator;
use crate::direct::{light_context, pass_through, scattered};

/// Settings of [`Path`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PathSettings {
    /// Most scattering events; default 5.
    pub max_depth: u32,
    /// Roughen surfaces after the first rough bounce; default false.
    pub regularize: bool,
    /// How a light is chosen; by default through the tree of lights.
    pub light_sampler: LightSamplerKind,
    /// What interfaces do to the light of delta lights; by default they stop it.
    pub interfaces: Interfaces,
}

impl Default for PathSettings {
    fn default() -> Self {
        Self {
            max_depth: 5,
            regularize: false,
            light_sampler: LightSamplerKind::Bvh,
            interfaces: Interfaces::Stop,
        }
    }
}

/// Path tracing.
#[derive(Clone, Debug)]
pub struct Path {
    settings: PathSettings,
    lights: LightSampler,
}

/// The surface that a ray comes from, as light sampling sees it, and the density of the ray's
/// direction.
pub(crate) struct Origin {
    /// The surface.
    pub context: LightSampleContext,
    /// Density per solid angle.
    pub pdf: f32,
}

impl Path {
    /// Knows no lights until it is prepared for a scene.
    pub fn new(settings: PathSettings) -> Self {
        Self { settings, lights: LightSampler::default() }
    }

    /// The weight of light from `light` that a ray met along `wi`. Without an `origin` no light
    /// sample could find it.
    fn weight(&self, scene: &Scene, origin: Option<&Origin>, light: LightId, wi: Vector3) -> f32 {
        let Some(Origin { context, pdf }) = origin else { return 1.0 };
        let pmf = self.lights.pmf(context, light);
        power_heuristic(*pdf, pmf * scene.light(light).pdf_li(context, wi, true))
    }

    /// What a ray that leaves the scene brings.
    pub(crate) fn escaped(
        &self,
        scene: &Scene,
        ray: &RayDifferential,
        origin: Option<&Origin>,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let lights = scene.infinite_lights().iter();
        lights
            .map(|&id| scene.light(id).le(&ray.ray, lambda) * self.weight(scene, origin, id, ray.ray.d))
            .sum()
    }

    /// What a ray that meets an emitting surface brings.
    pub(crate) fn emitted(
        &self,
        scene: &Scene,
        surface: &SurfaceInteraction,
        origin: Option<&Origin>,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let Some(light) = surface.area_light else { return SampledSpectrum::ZERO };
        let wo = surface.surface.wo;
        let l = scene.emitted(surface, wo, lambda);
        if l.is_black() { l } else { l * self.weight(scene, origin, light, -wo) }
    }

    /// What a surface scatters to `wo` of the light from one point on one light, for all of them.
    #[doc(alias = "SampleLd")]
    pub(crate) fn sample_ld<B: Scatter>(
        &self,
        scene: &Scene,
        (surface, context): (&SurfaceInteraction, &LightSampleContext),
        bsdf: &Bsdf<B>,
        lambda: &SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        let (u, u_light) = (sampler.get_1d(), sampler.get_2d());
        let Some((light, pmf)) = self.lights.sample(context, u) else { return SampledSpectrum::ZERO };
        let Some(sample) = scene.sample_light(light, context, u_light, lambda, true) else {
            return SampledSpectrum::ZERO;
        };
        let l = scattered(surface, bsdf, &sample);
        let interfaces = match self.settings.interfaces {
            Interfaces::Stop => Interfaces::before(scene.light(light)),
            Interfaces::Pass => Interfaces::Pass,
        };
        if l.is_black() || !scene.unoccluded(surface, &sample, interfaces, stats) {
            return SampledSpectrum::ZERO;
        }
        let p_l = pmf * sample.pdf;
        if scene.light(light).is_delta() {
            return l / p_l;
        }
        let p_b = bsdf.pdf(surface.surface.wo, sample.wi, TransportMode::Radiance, Directions::All);
        l * (power_heuristic(p_l, p_b) / p_l)
    }

    /// The radiance along the ray of paths that scatter at least `min_depth` times.
    pub(crate) fn li_from(
        &self,
        min_depth: u32,
        scene: &Scene,
        mut ray: RayDifferential,
        lambda: &mut SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        let (mut l, mut beta) = (SampledSpectrum::ZERO, SampledSpectrum::ONE);
        let mut depth = 0;
        let mut eta_scale = 1.0;
        let mut rough_before = false;
        let mut origin = None;
        loop {
            let Some((mut surface, t)) = scene.intersect(&ray.ray, f32::INFINITY, stats) else {
                if depth >= min_depth {
                    l += beta * self.escaped(scene, &ray, origin.as_ref(), lambda);
                }
                return l;
            };
            if depth >= min_depth {
                l += beta * self.emitted(scene, &surface, origin.as_ref(), lambda);
            }
            let Some(mut bsdf) = scene.bsdf(&mut surface, &ray, lambda, sampler) else {
                ray = pass_through(&ray, &surface, t);
                continue;
            };
            if depth == self.settings.max_depth {
                return l;
            }
            depth += 1;
            if self.settings.regularize && rough_before {
                bsdf.regularize();
            }

            let context = light_context(&surface, bsdf.flags());
            let onward = each_bxdf!(bsdf.bxdf, bxdf => {
                let bsdf = Bsdf { bxdf, frame: bsdf.frame };
                if bsdf.flags().is_non_specular() {
                    l += beta * self.sample_ld(scene, (&surface, &context), &bsdf, lambda, sampler, stats);
                }
                sample_onward(&surface, &bsdf, sampler)
            });
            let Some((sample, pdf)) = onward else { return l };
            let cos_theta = sample.wi.dot(surface.surface.shading.n).abs();
            beta *= sample.f * (cos_theta / sample.pdf);
            let specular = sample.flags.is_specular();
            rough_before |= !specular;
            origin = (!specular).then_some(Origin { context, pdf });
            if sample.flags.is_transmissive() {
                eta_scale *= sample.eta * sample.eta;
            }
            ray = surface.spawn_scattered(&ray, &sample);

            let survival = (beta * eta_scale).max_component();
            if depth > 1 && survival < 1.0 {
                if survival <= 0.0 || sampler.get_1d() >= survival {
                    return l;
                }
                beta /= survival;
            }
        }
    }
}

impl RayIntegrator for Path {
    fn prepare(&mut self, scene: &Scene) {
        self.lights = scene.light_sampler(self.settings.light_sampler);
    }

    fn li(
        &self,
        scene: &Scene,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        self.li_from(0, scene, ray, lambda, sampler, stats)
    }
}

/// A direction of the BSDF's density, and that density.
pub(crate) fn sample_onward<B: Scatter>(
    surface: &SurfaceInteraction,
    bsdf: &Bsdf<B>,
    sampler: &mut Sampler,
) -> Option<(BsdfSample, f32)> {
    let wo = surface.surface.wo;
    let (uc, u) = (sampler.get_1d(), sampler.get_2d());
    let sample = bsdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All)?;
    let pdf = if sample.pdf_is_proportional {
        bsdf.pdf(wo, sample.wi, TransportMode::Radiance, Directions::All)
    } else {
        sample.pdf
    };
    Some((sample, pdf))
}

/// The weight of a sample of density `p` that another technique finds with density `other`.
fn power_heuristic(p: f32, other: f32) -> f32 {
    // The ratio, because squares of large densities overflow.
    let ratio = other / p;
    if p == 0.0 { 0.0 } else { 1.0 / (1.0 + ratio * ratio) }
}
