//! A path from the camera between two of its vertices.

use film::FirstEvent;
use lanes::Real;
use math::{Normal3, RayDifferential};
use sampling::Sampler;
use scattering::{BsdfSample, Directions, TransportMode};
use scene::SurfaceInteraction;
use scene::light::LightSampleContext;
use scene::medium::MediumId;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::Tracer;
use super::media::{Flight, Heroes, SpectralMis, Throughput};
use super::roulette;
use super::vertex::SurfaceVertex;

/// The state of a camera path between two vertices.
pub(crate) struct PathState {
    /// The ray to the next vertex.
    pub ray: RayDifferential,
    /// Path throughput β: the product of f·|cos|/p over the vertices. Where heroes choose
    /// collisions, p is the mean of the densities over them.
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
    /// Whether an earlier vertex was not specular.
    pub rough_before: bool,
    /// The event by which it left its first vertex, for layers of parts.
    pub first: FirstEvent,
    /// For paths that fly through media.
    pub spectral: Option<SpectralMis>,
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
    /// Samples the BSDF of a vertex for the outgoing direction; `None` without a sample.
    pub fn sample(vertex: &SurfaceVertex, sampler: &mut Sampler) -> Option<Self> {
        let SurfaceVertex { surface, bsdf, .. } = vertex;
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
            rough_before: false,
            first: FirstEvent::None,
            spectral: None,
        }
    }

    /// Passes a surface at distance `t` that does not scatter.
    pub fn pass_through(&mut self, surface: &SurfaceInteraction, t: f32) {
        self.medium = surface.medium_towards(self.ray.ray.d, self.medium);
        self.ray = pass_through(&self.ray, surface, t);
    }

    /// Leaves a vertex along a direction of its BSDF.
    pub fn scatter(&mut self, vertex: &SurfaceVertex, Scattered { sample, pdf }: &Scattered) {
        let surface = vertex.surface;
        self.beta *= throughput(surface.surface.shading.n, sample);
        self.eta_scale = eta_scale(self.eta_scale, sample);
        self.medium = surface.medium_towards(sample.wi, self.medium);
        let origin = (!sample.flags.is_specular()).then_some(vertex.context);
        self.leave(surface.spawn_scattered(&self.ray, sample), *pdf, origin);
    }

    /// Leaves a vertex along a ray, in a direction of the density `pdf`; `origin` is the vertex,
    /// unless it is specular.
    pub fn leave(&mut self, ray: RayDifferential, pdf: f32, origin: Option<LightSampleContext>) {
        self.ray = ray;
        self.rough_before |= origin.is_some();
        self.origin = origin.map(|context| Origin { context, pdf });
        if let Some(spectral) = &mut self.spectral {
            spectral.r_l = spectral.r_u / pdf;
        }
    }

    /// Flies up to `t_max` through its medium; `None` without one. The density of the ray's
    /// direction becomes that over the density with which shadow rays pass the same.
    #[inline]
    pub fn fly(&mut self, tracer: &mut Tracer, t_max: f32, lambda: &SampledWavelengths) -> Option<Flight> {
        let SpectralMis { heroes, r_u, r_l } = self.spectral.as_mut()?;
        let mut after = Throughput { beta: self.beta, r_u: *r_u, r_l: *r_l };
        let flight = tracer.fly(self.medium?, &self.ray.ray, t_max, lambda, heroes, &mut after);
        let density = heroes.mean(after.r_u);
        self.beta = after.beta / density;
        if let Some(origin) = &mut self.origin {
            origin.pdf = density / heroes.mean(after.r_l);
        }
        (*r_u, *r_l) = (after.r_u / density, after.r_l / density);
        Some(flight)
    }

    /// Goes on with the first wavelength as the only hero, after dispersion.
    pub fn keep_first(&mut self) {
        if let Some(spectral) = &mut self.spectral {
            *spectral = SpectralMis::new(Heroes::first());
        }
    }

    /// Plays Russian roulette; `false` if the path has ended.
    pub fn survives(&mut self, sampler: &mut Sampler) -> bool {
        let probability = roulette::camera_path_survival(self.beta * self.eta_scale);
        let survival = roulette::survival(self.depth, probability, sampler);
        self.beta /= survival.unwrap_or(1.0);
        survival.is_some()
    }
}

/// f·|cos|/p of a direction sampled from the BSDF of a surface with shading normal `ns`.
#[inline(always)]
pub(crate) fn throughput<R: Real>(ns: Normal3<R>, sample: &BsdfSample<R>) -> SampledSpectrum<R> {
    sample.f * (sample.wi.dot(ns).abs() / sample.pdf)
}

/// The product of η² over the refractions, after one more sample.
#[inline(always)]
pub(crate) fn eta_scale<R: Real>(before: R, sample: &BsdfSample<R>) -> R {
    R::select(sample.flags.is_transmissive(), before * (sample.eta * sample.eta), before)
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
