//! A path from the camera between two of its vertices.

use film::FirstEvent;
use math::RayDifferential;
use sampling::Sampler;
use scattering::{Bsdf, BsdfSample, Bxdf, Directions, TransportMode};
use scene::SurfaceInteraction;
use scene::light::LightSampleContext;
use scene::medium::MediumId;
use spectrum::SampledSpectrum;

use super::roulette;

/// The state of a camera path between two vertices.
pub(crate) struct PathState {
    /// The ray to the next vertex.
    pub ray: RayDifferential,
    /// Path throughput β: the product of f·|cos|/p over the vertices.
    pub beta: SampledSpectrum,
    /// Scattering events so far.
    pub depth: u32,
    /// The last scattering event, unless it was specular.
    pub origin: Option<Origin>,
    /// The medium of the ray, for algorithms that know media.
    pub medium: Option<MediumId>,
    /// The product of η² over the refractions: β times this is without the scaling of radiance by
    /// refraction.
    pub eta_scale: f32,
    /// The event by which it left its first vertex, for layers of parts.
    pub first: FirstEvent,
}

/// The vertex that a ray starts at, as a context of light sampling, and the density of the ray's
/// direction.
pub(crate) struct Origin {
    /// The vertex.
    pub context: LightSampleContext,
    /// Density per solid angle.
    pub pdf: f32,
}

/// A direction sampled from a BSDF.
pub(crate) struct Scattered {
    pub sample: BsdfSample,
    /// Density per solid angle, also where that of the sample is only proportional to its value.
    pub pdf: f32,
}

impl Scattered {
    /// Samples the BSDF for the outgoing direction of `surface`; `None` without a sample.
    pub fn sample(surface: &SurfaceInteraction, bsdf: &Bsdf<Bxdf>, sampler: &mut Sampler) -> Option<Self> {
        let wo = surface.surface.wo;
        let (uc, u) = (sampler.get_1d(), sampler.get_2d());
        let sample = bsdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All)?;
        let pdf = if sample.pdf_is_proportional {
            bsdf.pdf(wo, sample.wi, TransportMode::Radiance, Directions::All)
        } else {
            sample.pdf
        };
        Some(Self { sample, pdf })
    }
}

impl PathState {
    /// A path of throughput 1 whose ray leaves scattering event number `depth`; 0 is the camera.
    pub fn new(ray: RayDifferential, depth: u32) -> Self {
        Self {
            ray,
            beta: SampledSpectrum::ONE,
            depth,
            origin: None,
            medium: None,
            eta_scale: 1.0,
            first: FirstEvent::None,
        }
    }

    /// Passes a surface at distance `t` that does not scatter.
    pub fn pass_through(&mut self, surface: &SurfaceInteraction, t: f32) {
        self.medium = surface.medium_towards(self.ray.ray.d, self.medium);
        self.ray = pass_through(&self.ray, surface, t);
    }

    /// Leaves a vertex, whose light sampling context is given, along a direction of its BSDF.
    pub fn scatter(
        &mut self,
        surface: &SurfaceInteraction,
        context: LightSampleContext,
        Scattered { sample, pdf }: &Scattered,
    ) {
        self.beta *= throughput(surface, sample);
        self.origin = (!sample.flags.is_specular()).then_some(Origin { context, pdf: *pdf });
        if sample.flags.is_transmissive() {
            self.eta_scale *= sample.eta * sample.eta;
        }
        self.medium = surface.medium_towards(sample.wi, self.medium);
        self.ray = surface.spawn_scattered(&self.ray, sample);
    }

    /// Plays Russian roulette; `false` if the path has ended.
    pub fn survives(&mut self, sampler: &mut Sampler) -> bool {
        let probability = roulette::of_camera_path(self.beta * self.eta_scale);
        let survival = roulette::survival(self.depth, probability, sampler);
        self.beta /= survival.unwrap_or(1.0);
        survival.is_some()
    }
}

/// f·|cos|/p of a direction sampled from a BSDF.
pub(crate) fn throughput(surface: &SurfaceInteraction, sample: &BsdfSample) -> SampledSpectrum {
    sample.f * (sample.wi.dot(surface.surface.shading.n).abs() / sample.pdf)
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
