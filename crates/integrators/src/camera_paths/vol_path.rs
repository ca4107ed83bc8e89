//! Path tracing through participating media.
//!
//! Between surfaces a path flies through media (`transport/media.rs`), which scatter it where they
//! choose. At each vertex, on a surface or in a medium, a shadow ray goes to a light and estimates
//! the transmittance on its way; interfaces between media do not occlude it. The two ways to find a
//! light are weighted by the power heuristic, with densities that are means over the wavelengths by
//! which each may have been sampled (spectral MIS). From the second vertex on Russian roulette ends
//! paths of low throughput. Without media all is as in `path.rs`.
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
use geometry::SurfacePoint;
use math::{Point3, RayDifferential};
use sampling::Sampler;
use scattering::{Body, Bsdf, BsdfSample, Bxdf, Directions, HenyeyGreenstein, TransportMode};
use scene::light::{LightPoint, LightRef, LightSampleContext};
use scene::medium::MediumId;
use scene::{Interfaces, Scene, SurfaceInteraction, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::{Path, PathsFrom};
use crate::transport::direct::{MediumVertex, light_context, power_heuristic};
use crate::transport::media::{Arrival, FlightEnd, Heroes, Throughput};
use crate::transport::parts::{DIFFUSE, event_at, event_of};
use crate::transport::path_state::{Scattered, pass_through, throughput};
use crate::transport::roulette;
use crate::transport::subsurface::entered;
use crate::{Cancelled, Control, RayIntegrator, Tracer};

/// Path tracing through media.
#[derive(Clone, Debug)]
pub struct VolPath {
    /// The same in empty space.
    pub(crate) in_vacuum: Path,
    /// Whether lights are sampled.
    sample_lights: bool,
}

impl VolPath {
    /// Has no lights before [`prepare`](RayIntegrator::prepare).
    pub fn new(settings: PathDesc) -> Self {
        Self { in_vacuum: Path::new(settings, Interfaces::Pass), sample_lights: true }
    }

    /// Without light sampling.
    pub fn simple(max_depth: u32) -> Self {
        Self { sample_lights: false, ..Self::new(PathDesc { max_depth, ..PathDesc::default() }) }
    }
}

/// A path between two vertices.
pub(crate) struct PathInMedia {
    pub ray: RayDifferential,
    pub medium: Option<MediumId>,
    pub throughput: Throughput,
    pub heroes: Heroes,
    /// Scattering events so far.
    pub depth: u32,
    /// The last vertex, if light sampling there could have found what the ray hits.
    pub origin: Option<LightSampleContext>,
    /// The product of η² over the refractions.
    pub eta_scale: f32,
    /// Whether an earlier vertex was not specular.
    pub rough_before: bool,
    /// The event by which it left its first vertex, for layers of parts.
    pub first: FirstEvent,
}

/// A vertex from which lights are sampled.
enum Vertex<'a> {
    Surface(&'a SurfaceInteraction, &'a Bsdf<Bxdf<'a>>),
    Medium(&'a MediumVertex),
}

/// The end of a path's flight through its medium.
pub(crate) enum Flown {
    /// It has passed the medium to the end of its ray.
    Passed,
    /// It is scattered here.
    Scattered(Point3, HenyeyGreenstein),
    /// It has ended.
    Ended,
}

impl PathInMedia {
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
        self.origin = origin;
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
    fn settings(&self) -> &PathDesc {
        &self.in_vacuum.settings
    }

    /// The weighted radiance `l` of a light that the ray of a path hits at `point`.
    fn met(
        &self,
        path: &PathInMedia,
        light: LightRef,
        point: LightPoint,
        l: SampledSpectrum,
    ) -> SampledSpectrum {
        let l = path.throughput.estimate(l, &path.heroes);
        match &path.origin {
            Some(context) if self.sample_lights => {
                let Throughput { r_u, r_l, .. } = path.throughput;
                let pdf = self.in_vacuum.direct.lights().pmf(context, light.id())
                    * light.pdf_li(context, path.ray.ray.d, point, true);
                l * power_heuristic(path.heroes.mean(r_u), path.heroes.mean(r_l) * pdf)
            }
            _ => l,
        }
    }

    /// The radiance of infinite lights along the ray of a path that leaves the scene.
    fn escaped(
        &self,
        tracer: &mut Tracer,
        path: &PathInMedia,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let scene = tracer.scene;
        let lights = scene.infinite_lights().iter();
        let met = lights.map(|&id| {
            let light = scene.light(id);
            let l = self.met(path, light, None, light.le(&path.ray.ray, lambda));
            tracer.take_part(Some(id), &path.first, path.depth, l);
            l
        });
        met.sum()
    }

    /// The emission of a surface that a path has hit.
    pub(crate) fn emitted(
        &self,
        tracer: &mut Tracer,
        path: &PathInMedia,
        surface: &SurfaceInteraction,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let Some(light) = surface.area_light else { return SampledSpectrum::ZERO };
        let SurfacePoint { p, n, wo, .. } = surface.surface;
        let l = tracer.scene.emitted(surface, wo, lambda);
        if l.is_black() {
            return l;
        }
        let l = self.met(path, tracer.scene.light(light), Some((p.p, n)), l);
        tracer.take_part(Some(light), &path.first, path.depth, l);
        l
    }

    /// Next-event estimation at a vertex.
    fn direct(
        &self,
        tracer: &mut Tracer,
        path: &PathInMedia,
        vertex: Vertex,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        if !self.sample_lights {
            return SampledSpectrum::ZERO;
        }
        let scene = tracer.scene;
        let (u, u_light) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
        let numbers = tracer.two_numbers();
        let context = match &vertex {
            Vertex::Surface(surface, bsdf) => light_context(surface, bsdf.flags()),
            Vertex::Medium(vertex) => vertex.context,
        };
        let black = SampledSpectrum::ZERO;
        let Some((light, pmf)) = self.in_vacuum.direct.lights().sample(&context, u) else { return black };
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
        let Some(passage) = tracer.transmittance((&ray, t_max), medium, lambda, &path.heroes, numbers) else {
            return black;
        };
        let Throughput { beta, r_u, .. } = path.throughput;
        let p_l = pmf * sample.pdf;
        let ratio = if scene.light(light).is_delta() { 0.0 } else { pdf / p_l };
        let l = Arrival { l: beta * l / p_l, r_u, ratio }.through(&passage, &path.heroes);
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

    /// Lets a path fly through its medium, up to `t_max`; returns the light on the way, that of
    /// paths of fewer than `min_depth` scattering events left out.
    pub(crate) fn fly(
        &self,
        min_depth: u32,
        tracer: &mut Tracer,
        path: &mut PathInMedia,
        t_max: f32,
        lambda: &SampledWavelengths,
    ) -> (SampledSpectrum, Flown) {
        let black = SampledSpectrum::ZERO;
        let Some(medium) = path.medium else { return (black, Flown::Passed) };
        let flight = tracer.fly(medium, &path.ray.ray, t_max, lambda, &path.heroes, &mut path.throughput);
        let l = if path.depth >= min_depth { flight.emitted } else { black };
        tracer.take_part(None, &path.first, path.depth, l);
        let is_last = path.depth == self.settings().max_depth;
        match flight.end {
            FlightEnd::Passed => (l, Flown::Passed),
            FlightEnd::Scattered { p, phase, .. } if !is_last => (l, Flown::Scattered(p, phase)),
            FlightEnd::Scattered { .. } | FlightEnd::Absorbed => (l, Flown::Ended),
        }
    }

    /// Scatters a path in a medium; returns the direct light, and whether it goes on.
    fn scatter_in_medium(
        &self,
        tracer: &mut Tracer,
        path: &mut PathInMedia,
        (p, phase): (Point3, HenyeyGreenstein),
        lambda: &SampledWavelengths,
    ) -> (SampledSpectrum, bool) {
        path.depth += 1;
        if path.depth == 1 {
            path.first = FirstEvent::Volume;
        }
        let vertex = MediumVertex::new(p, &path.ray.ray, phase);
        let l = self.direct(tracer, path, Vertex::Medium(&vertex), lambda);
        let (wi, pdf) = phase.sample_p(vertex.wo, tracer.sampler.get_2d());
        path.leave(vertex.context.spawn_ray(wi).into(), pdf, Some(vertex.context));
        (l, path.survives(tracer.sampler))
    }

    /// Scatters a path at a surface that it has hit at distance `t`; returns the direct light, and
    /// whether it goes on.
    pub(crate) fn scatter(
        &self,
        tracer: &mut Tracer,
        path: &mut PathInMedia,
        (mut surface, t): (SurfaceInteraction, f32),
        lambda: &mut SampledWavelengths,
    ) -> (SampledSpectrum, bool) {
        let mut l = SampledSpectrum::ZERO;
        let Some(mut bsdf) = tracer.bsdf(&mut surface, &path.ray, lambda) else {
            path.medium = surface.medium_towards(path.ray.ray.d, path.medium);
            path.ray = pass_through(&path.ray, &surface, t);
            return (l, true);
        };
        if path.depth == self.settings().max_depth {
            return (l, false);
        }
        path.depth += 1;
        if lambda.secondary_terminated() {
            path.throughput.keep_first(&mut path.heroes);
        }
        bsdf.bxdf.keep_boundary();
        bsdf.regularize(self.settings().regularize && path.rough_before);
        if bsdf.flags().is_non_specular() {
            l += self.direct(tracer, path, Vertex::Surface(&surface, &bsdf), lambda);
        }
        let Some(Scattered { sample, pdf }) = Scattered::sample(&surface, &bsdf, tracer.sampler) else {
            return (l, false);
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
            let (left, goes_on) = self.under_surface(tracer, path, &surface, (body, &sample), lambda);
            l += left;
            if !goes_on {
                return (l, false);
            }
        } else {
            if sample.flags.is_transmissive() {
                path.eta_scale *= sample.eta * sample.eta;
            }
            let context = (!sample.flags.is_specular()).then(|| light_context(&surface, bsdf.flags()));
            path.medium = surface.medium_towards(sample.wi, path.medium);
            path.leave(surface.spawn_scattered(&path.ray, &sample), pdf, context);
        }
        (l, path.survives(tracer.sampler))
    }

    /// Leads a path that enters a body at `entry`, from the side of its medium, out of it again;
    /// returns the direct light where it leaves, and whether it goes on.
    fn under_surface(
        &self,
        tracer: &mut Tracer,
        path: &mut PathInMedia,
        entry: &SurfaceInteraction,
        (body, sample): (Body, &BsdfSample),
        lambda: &SampledWavelengths,
    ) -> (SampledSpectrum, bool) {
        let hero = path.heroes.hero;
        let Some(exit) = tracer.exit(&entry.into(), body, sample.wi, &path.heroes) else {
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
        let mut l = SampledSpectrum::ZERO;
        let heroes = Heroes::any(tracer.sampler.get_1d());
        let mut path = PathInMedia::new(ray, tracer.view.medium, heroes);
        loop {
            let hit = tracer.intersect(&path.ray.ray);
            let t_max = hit.as_ref().map_or(f32::INFINITY, |(_, t)| *t);
            let (light, flown) = self.fly(min_depth, tracer, &mut path, t_max, lambda);
            l += light;
            match flown {
                Flown::Passed => (),
                Flown::Scattered(p, phase) => {
                    let (light, goes_on) = self.scatter_in_medium(tracer, &mut path, (p, phase), lambda);
                    l += light;
                    if !goes_on {
                        return l;
                    }
                    continue;
                }
                Flown::Ended => return l,
            }
            let Some((surface, t)) = hit else {
                return if path.depth >= min_depth { l + self.escaped(tracer, &path, lambda) } else { l };
            };
            if path.depth >= min_depth {
                l += self.emitted(tracer, &path, &surface, lambda);
            }
            let (light, goes_on) = self.scatter(tracer, &mut path, (surface, t), lambda);
            l += light;
            if !goes_on {
                return l;
            }
        }
    }
}

impl RayIntegrator for VolPath {
    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        if self.sample_lights { self.in_vacuum.prepare(scene, view, control) } else { Ok(()) }
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
