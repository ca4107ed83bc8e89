//! Path tracing through participating media.
//!
//! Between surfaces a path flies through media (`transport/media.rs`), which scatter it where they
//! choose. At each vertex, on a surface or in a medium, a shadow ray goes to a light and estimates
//! the transmittance on its way; interfaces between media do not occlude it. The two ways to find a
//! light are weighted by the balance heuristic over both and over all wavelengths by which they may
//! have been sampled (spectral MIS). From the second vertex on Russian roulette ends paths of low
//! throughput.
//!
//! Paths that enter a body go on from another point of its surface
//! (`transport/subsurface/`).
//!
//! Emission of media counts along every flight, that of paths of `max_depth` scattering events
//! included. Without light sampling (`simple-vol-path`), light is found by scattering alone.
//!
//! Unbiased up to `max_depth`. Sources: [Miller 2019]; [Pharr 2023 §14.2].

use description::PathDesc;
use film::FirstEvent;
use math::RayDifferential;
use sampling::Sampler;
use scattering::{Body, Bsdf, BsdfSample, Bxdf, Directions, TransportMode};
use scene::light::{LightId, LightSampleContext};
use scene::light_sampler::LightSampler;
use scene::medium::MediumId;
use scene::{Scene, SurfaceInteraction, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::PathsFrom;
use crate::transport::direct::{MediumVertex, light_context};
use crate::transport::media::{FlightEnd, Heroes, Throughput};
use crate::transport::parts::{DIFFUSE, event_at, event_of};
use crate::transport::path_state::{Origin, Scattered, pass_through, throughput};
use crate::transport::roulette;
use crate::transport::subsurface::entered;
use crate::{Cancelled, Control, RayIntegrator, Tracer};

/// Path tracing through media.
#[derive(Clone, Debug)]
pub struct VolPath {
    settings: PathDesc,
    /// Whether lights are sampled.
    sample_lights: bool,
    lights: LightSampler,
}

impl VolPath {
    /// Has no lights before [`prepare`](RayIntegrator::prepare).
    pub fn new(settings: PathDesc) -> Self {
        Self { settings, sample_lights: true, lights: LightSampler::default() }
    }

    /// Without light sampling.
    pub fn simple(max_depth: u32) -> Self {
        Self { sample_lights: false, ..Self::new(PathDesc { max_depth, ..PathDesc::default() }) }
    }
}

/// A path between two vertices.
struct Path {
    ray: RayDifferential,
    medium: Option<MediumId>,
    throughput: Throughput,
    heroes: Heroes,
    /// Scattering events so far.
    depth: u32,
    /// The last vertex, if light sampling there could have found what the ray hits.
    origin: Option<Origin>,
    /// The product of η² over the refractions.
    eta_scale: f32,
    /// Whether an earlier vertex was not specular.
    rough_before: bool,
    /// The event by which it left its first vertex, for layers of parts.
    first: FirstEvent,
}

/// A vertex from which lights are sampled.
enum Vertex<'a> {
    Surface(&'a SurfaceInteraction, &'a Bsdf<Bxdf<'a>>),
    Medium(&'a MediumVertex),
}

impl Path {
    fn new(ray: RayDifferential, medium: Option<MediumId>, heroes: Heroes) -> Self {
        Self {
            ray,
            medium,
            throughput: Throughput::ONE,
            heroes,
            depth: 0,
            origin: None,
            eta_scale: 1.0,
            rough_before: false,
            first: FirstEvent::None,
        }
    }

    /// Leaves a vertex along the ray, in a direction of the density `pdf`; `origin` is the vertex,
    /// unless it is specular.
    fn leave(&mut self, ray: RayDifferential, pdf: f32, origin: Option<LightSampleContext>) {
        self.ray = ray;
        self.throughput.r_l = self.throughput.r_u / pdf;
        self.rough_before |= origin.is_some();
        self.origin = origin.map(|context| Origin { context, pdf });
    }

    /// Plays Russian roulette; `false` if the path has ended.
    fn survives(&mut self, sampler: &mut Sampler) -> bool {
        let carried = self.throughput.estimate(SampledSpectrum::splat(self.eta_scale), &self.heroes);
        let survival = roulette::survival(self.depth, roulette::of_camera_path(carried), sampler);
        self.throughput.beta /= survival.unwrap_or(1.0);
        survival.is_some()
    }
}

impl VolPath {
    /// The weighted radiance of a light that the ray of a path meets.
    fn met(&self, scene: &Scene, path: &Path, light: LightId, l: SampledSpectrum) -> SampledSpectrum {
        let Throughput { beta, r_u, r_l } = path.throughput;
        match &path.origin {
            Some(Origin { context, .. }) if self.sample_lights => {
                let pdf = self.lights.pmf(context, light)
                    * scene.light(light).pdf_li(context, path.ray.ray.d, true);
                beta * l / path.heroes.mean(r_u + r_l * pdf)
            }
            _ => path.throughput.estimate(l, &path.heroes),
        }
    }

    /// The radiance of infinite lights along the ray of a path that leaves the scene.
    fn escaped(&self, tracer: &mut Tracer, path: &Path, lambda: &SampledWavelengths) -> SampledSpectrum {
        let scene = tracer.scene;
        let lights = scene.infinite_lights().iter();
        let met = lights.map(|&id| {
            let l = self.met(scene, path, id, scene.light(id).le(&path.ray.ray, lambda));
            tracer.take_part(Some(id), &path.first, path.depth, l);
            l
        });
        met.sum()
    }

    /// Next-event estimation at a vertex.
    fn direct(
        &self,
        tracer: &mut Tracer,
        path: &Path,
        vertex: Vertex,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        if !self.sample_lights {
            return SampledSpectrum::ZERO;
        }
        let scene = tracer.scene;
        let (u, u_light) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
        let context = match &vertex {
            Vertex::Surface(surface, bsdf) => light_context(surface, bsdf.flags()),
            Vertex::Medium(vertex) => vertex.context,
        };
        let black = SampledSpectrum::ZERO;
        let Some((light, pmf)) = self.lights.sample(&context, u) else { return black };
        let Some(sample) = scene.sample_light(light, &context, u_light, lambda, true) else { return black };
        let wi = sample.wi;
        let (f, pdf, medium) = match &vertex {
            Vertex::Surface(surface, bsdf) => {
                let (wo, mode) = (surface.surface.wo, TransportMode::Radiance);
                let f = bsdf.f(wo, wi, mode) * wi.dot(surface.surface.shading.n).abs();
                (f, bsdf.pdf(wo, wi, mode, Directions::All), surface.medium_towards(wi, path.medium))
            }
            Vertex::Medium(vertex) => {
                let p = vertex.phase.p(vertex.wo, wi);
                (SampledSpectrum::splat(p), p, path.medium)
            }
        };
        let l = f * sample.l;
        if l.is_black() {
            return black;
        }
        let (ray, t_max) = match &vertex {
            Vertex::Surface(surface, _) => sample.shadow_ray(&surface.surface),
            Vertex::Medium(vertex) => vertex.shadow_ray(&sample),
        };
        let Some(passage) = tracer.transmittance(&ray, t_max, medium, lambda, &path.heroes) else {
            return black;
        };
        let Throughput { beta, r_u, .. } = path.throughput;
        let by_light = r_u * passage.r_l * (pmf * sample.pdf);
        let by_scattering = if scene.light(light).is_delta() { black } else { r_u * passage.r_u * pdf };
        let l = beta * l * passage.t / path.heroes.mean(by_light + by_scattering);
        if tracer.takes_parts() {
            let first = match &vertex {
                _ if path.depth > 1 => path.first,
                Vertex::Surface(surface, bsdf) => event_at(bsdf, surface.surface.wo, wi),
                Vertex::Medium(_) => FirstEvent::Volume,
            };
            tracer.take_part(Some(light), &first, path.depth, l);
        }
        l
    }

    /// Leads a path that enters a body at `entry`, from the side of its medium, out of it again;
    /// returns the direct light where it leaves, and whether it goes on.
    fn under_surface(
        &self,
        tracer: &mut Tracer,
        path: &mut Path,
        entry: &SurfaceInteraction,
        (body, sample): (Body, &BsdfSample),
        lambda: &SampledWavelengths,
    ) -> (SampledSpectrum, bool) {
        let hero = path.heroes.hero;
        let Some(exit) = tracer.exit(entry, body, sample, &path.heroes) else {
            return (SampledSpectrum::ZERO, false);
        };
        path.throughput.beta *= exit.value / exit.density[hero];
        path.throughput.r_u *= exit.density / exit.density[hero];
        let l = self.direct(tracer, path, Vertex::Surface(&exit.surface, &exit.bsdf), lambda);
        let scattered = Scattered::sample(&exit.surface, &exit.bsdf, tracer.sampler);
        if let Some(Scattered { sample, pdf }) = &scattered {
            path.throughput.beta *= throughput(&exit.surface, sample);
            let context = light_context(&exit.surface, exit.bsdf.flags());
            path.medium = exit.surface.medium_towards(sample.wi, path.medium);
            path.leave(exit.surface.spawn_scattered(&path.ray, sample), *pdf, Some(context));
        }
        (l, scattered.is_some())
    }
}

impl PathsFrom for VolPath {
    fn li_from(
        &self,
        min_depth: u32,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let scene = tracer.scene;
        let mut l = SampledSpectrum::ZERO;
        let heroes = Heroes::any(tracer.sampler.get_1d());
        let mut path = Path::new(ray, tracer.view.medium, heroes);
        loop {
            let hit = tracer.intersect(&path.ray.ray);
            if let Some(id) = path.medium {
                let t_max = hit.as_ref().map_or(f32::INFINITY, |(_, t)| *t);
                let flight = tracer.fly(id, &path.ray.ray, t_max, lambda, &path.heroes, &mut path.throughput);
                if path.depth >= min_depth {
                    l += flight.emitted;
                    tracer.take_part(None, &path.first, path.depth, flight.emitted);
                }
                match flight.end {
                    FlightEnd::Passed => (),
                    FlightEnd::Absorbed => return l,
                    FlightEnd::Scattered { p, phase, .. } => {
                        if path.depth == self.settings.max_depth {
                            return l;
                        }
                        path.depth += 1;
                        if path.depth == 1 {
                            path.first = FirstEvent::Volume;
                        }
                        let vertex = MediumVertex::new(p, &path.ray.ray, phase);
                        l += self.direct(tracer, &path, Vertex::Medium(&vertex), lambda);
                        let (wi, pdf) = phase.sample_p(vertex.wo, tracer.sampler.get_2d());
                        path.leave(vertex.context.spawn_ray(wi).into(), pdf, Some(vertex.context));
                        if !path.survives(tracer.sampler) {
                            return l;
                        }
                        continue;
                    }
                }
            }
            let Some((mut surface, t)) = hit else {
                return if path.depth >= min_depth { l + self.escaped(tracer, &path, lambda) } else { l };
            };
            if let Some(light) = surface.area_light.filter(|_| path.depth >= min_depth) {
                let emitted = scene.emitted(&surface, surface.surface.wo, lambda);
                if !emitted.is_black() {
                    let emitted = self.met(scene, &path, light, emitted);
                    tracer.take_part(Some(light), &path.first, path.depth, emitted);
                    l += emitted;
                }
            }
            let Some(mut bsdf) = tracer.bsdf(&mut surface, &path.ray, lambda) else {
                path.medium = surface.medium_towards(path.ray.ray.d, path.medium);
                path.ray = pass_through(&path.ray, &surface, t);
                continue;
            };
            if path.depth == self.settings.max_depth {
                return l;
            }
            path.depth += 1;
            if lambda.secondary_terminated() {
                path.throughput.keep_first(&mut path.heroes);
            }
            bsdf.bxdf.keep_boundary();
            bsdf.regularize(self.settings.regularize && path.rough_before);
            if bsdf.flags().is_non_specular() {
                l += self.direct(tracer, &path, Vertex::Surface(&surface, &bsdf), lambda);
            }
            let Some(Scattered { sample, pdf }) = Scattered::sample(&surface, &bsdf, tracer.sampler) else {
                return l;
            };
            path.throughput.beta *= throughput(&surface, &sample);
            let body = entered(&bsdf, &surface, &sample);
            if path.depth == 1 && tracer.takes_parts() {
                path.first = match body {
                    Some(_) => DIFFUSE,
                    None => event_of(&bsdf, surface.surface.wo, &sample),
                };
            }
            if let Some(body) = body {
                let (left, goes_on) =
                    self.under_surface(tracer, &mut path, &surface, (body, &sample), lambda);
                l += left;
                if !goes_on {
                    return l;
                }
            } else {
                if sample.flags.is_transmissive() {
                    path.eta_scale *= sample.eta * sample.eta;
                }
                let context = (!sample.flags.is_specular()).then(|| light_context(&surface, bsdf.flags()));
                path.medium = surface.medium_towards(sample.wi, path.medium);
                path.leave(surface.spawn_scattered(&path.ray, &sample), pdf, context);
            }
            if !path.survives(tracer.sampler) {
                return l;
            }
        }
    }
}

impl RayIntegrator for VolPath {
    fn prepare(&mut self, scene: &Scene, _view: &View, control: &Control) -> Result<(), Cancelled> {
        if self.sample_lights {
            let lights = scene.light_sampler(self.settings.light_sampler, &control.cancel);
            self.lights = lights.ok_or(Cancelled)?;
        }
        Ok(())
    }

    fn li(
        &self,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        self.li_from(0, tracer, ray, lambda)
    }
}
