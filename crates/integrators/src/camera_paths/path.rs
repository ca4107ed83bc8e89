//! Path tracing with next-event estimation, multiple importance sampling and Russian roulette.
//!
//! At each vertex a shadow ray goes to a light and a scattered ray continues the path, weighted by
//! the power heuristic (`transport/direct.rs`); from the second vertex on Russian roulette ends
//! paths of low throughput (`transport/roulette.rs`). Paths that enter a body go on from another
//! point of its surface (`transport/subsurface/`).
//!
//! In scenes with media paths fly from surface to surface (`medium_vertices.rs`), and shadow rays
//! estimate the transmittance on their way. Densities are then means over the wavelengths by which
//! each may have been sampled: spectral MIS (`transport/media/`). `path` leaves media out, as
//! pbrt-v4 does. Without light sampling (`simple-vol-path`), light is found by scattering alone.
//!
//! Unbiased up to `max_depth`, except with `regularize`, which roughens surfaces after the first
//! rough bounce to find caustics with less noise. Sources: [Pharr 2023 §13.4, §14.2];
//! [Miller 2019].

use description::PathDesc;
use film::FirstEvent;
use math::RayDifferential;
use scene::{Interfaces, Scene, SurfaceInteraction, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::transport::direct::{Connection, DirectLighting};
use crate::transport::media::{Arrival, FlightEnd, Heroes, SpectralMis};
use crate::transport::parts::{DIFFUSE, event_of};
use crate::transport::path_state::{PathState, Scattered};
use crate::transport::subsurface::entered;
use crate::transport::vertex::{SurfaceVertex, Vertex};
use crate::{Cancelled, Control, RayIntegrator, Tracer};

/// Path tracing, in vacuum and through participating media.
#[derive(Clone, Debug)]
pub struct Path {
    pub(crate) settings: PathDesc,
    interfaces: Interfaces,
    sample_lights: bool,
    pub(crate) direct: DirectLighting,
}

impl Path {
    /// Has no lights before [`prepare`](RayIntegrator::prepare). Where interfaces stop shadow rays
    /// of delta lights, it is pbrt-v4's path tracer, which leaves media out; else paths go through
    /// media.
    pub fn new(settings: PathDesc, interfaces: Interfaces) -> Self {
        Self { settings, interfaces, sample_lights: true, direct: DirectLighting::none(interfaces) }
    }

    /// Path tracing through media, without light sampling.
    pub fn without_light_sampling(max_depth: u32) -> Self {
        let settings = PathDesc { max_depth, ..PathDesc::default() };
        Self { sample_lights: false, ..Self::new(settings, Interfaces::Pass) }
    }

    /// Whether paths in a scene fly through media. Without light sampling they choose heroes in
    /// any scene.
    pub(crate) fn flies_in(&self, scene: &Scene) -> bool {
        self.interfaces == Interfaces::Pass && !(self.sample_lights && scene.media().is_empty())
    }

    /// The radiance along the ray of paths that scatter at least `min_depth` times.
    pub(crate) fn li_from(
        &self,
        min_depth: u32,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let mut l = SampledSpectrum::ZERO;
        let mut path = PathState::new(ray, 0);
        if self.flies_in(tracer.scene) {
            path.medium = tracer.view.medium;
            path.spectral = Some(SpectralMis::new(Heroes::any(tracer.sampler.get_1d())));
        }
        loop {
            let hit = tracer.intersect(&path.ray.ray);
            let t_max = hit.as_ref().map_or(f32::INFINITY, |(_, t)| *t);
            let counts = path.depth >= min_depth;
            let (emitted, end) = self.fly(tracer, &mut path, t_max, lambda, counts);
            l += emitted;
            let (light, goes_on) = match (end, hit) {
                (FlightEnd::Absorbed, _) => return l,
                (FlightEnd::Scattered { p, phase, .. }, _) => {
                    self.scatter_in_medium(tracer, &mut path, p, phase, lambda)
                }
                (FlightEnd::Passed, None) if counts => return l + self.escaped(tracer, &path, lambda),
                (FlightEnd::Passed, None) => return l,
                (FlightEnd::Passed, Some((surface, t))) => {
                    if counts {
                        l += self.emitted(tracer, &path, &surface, lambda);
                    }
                    self.scatter(tracer, &mut path, surface, t, lambda)
                }
            };
            l += light;
            if !goes_on {
                return l;
            }
        }
    }

    /// The radiance of infinite lights along the ray of a path that leaves the scene.
    fn escaped(&self, tracer: &mut Tracer, path: &PathState, lambda: &SampledWavelengths) -> SampledSpectrum {
        let lights = self.direct.escaped_from_each(tracer.scene, &path.ray, path.origin.as_ref(), lambda);
        let mut sum = SampledSpectrum::ZERO;
        for (light, l) in lights {
            tracer.take_part(Some(light), &path.first, path.depth, path.beta * l);
            sum += l;
        }
        path.beta * sum
    }

    /// The emission of a surface that a path has hit.
    pub(crate) fn emitted(
        &self,
        tracer: &mut Tracer,
        path: &PathState,
        surface: &SurfaceInteraction,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let l = path.beta * self.direct.emitted(tracer.scene, surface, path.origin.as_ref(), lambda);
        tracer.take_part(surface.area_light, &path.first, path.depth, l);
        l
    }

    /// Scatters a path at a surface that it has hit at distance `t`; returns the direct light, and
    /// whether it goes on.
    pub(crate) fn scatter(
        &self,
        tracer: &mut Tracer,
        path: &mut PathState,
        mut surface: SurfaceInteraction,
        t: f32,
        lambda: &mut SampledWavelengths,
    ) -> (SampledSpectrum, bool) {
        let mut l = SampledSpectrum::ZERO;
        let Some(mut bsdf) = tracer.bsdf(&mut surface, &path.ray, lambda) else {
            path.pass_through(&surface, t);
            return (l, true);
        };
        if path.depth == self.settings.max_depth {
            return (l, false);
        }
        path.depth += 1;
        if lambda.secondary_terminated() {
            path.keep_first();
        }
        bsdf.bxdf.keep_boundary();
        bsdf.regularize(self.settings.regularize && path.rough_before);

        let vertex = SurfaceVertex::new(&surface, &bsdf);
        if bsdf.flags().is_non_specular() {
            l += self.direct(tracer, path, &Vertex::Surface(&vertex), lambda);
        }
        let Some(scattered) = Scattered::sample(&vertex, tracer.sampler) else { return (l, false) };
        let body = entered(&bsdf, &surface, &scattered.sample);
        if path.depth == 1 && tracer.takes_parts() {
            path.first = match body {
                Some(_) => DIFFUSE,
                None => event_of(&bsdf, surface.surface.wo, &scattered.sample),
            };
        }
        if let Some(body) = body {
            let Some(exit) = path.go_under(tracer, &vertex, body, &scattered, lambda) else {
                return (l, false);
            };
            let vertex = SurfaceVertex::new(&exit.surface, &exit.bsdf);
            l += self.direct(tracer, path, &Vertex::Surface(&vertex), lambda);
            let Some(scattered) = Scattered::sample(&vertex, tracer.sampler) else { return (l, false) };
            path.scatter(&vertex, &scattered);
        } else {
            path.scatter(&vertex, &scattered);
        }
        (l, self.goes_on(tracer, path))
    }

    /// Next-event estimation at a vertex.
    pub(super) fn direct(
        &self,
        tracer: &mut Tracer,
        path: &PathState,
        vertex: &Vertex,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let black = SampledSpectrum::ZERO;
        if !self.sample_lights {
            return black;
        }
        let connection = self.direct.connect(tracer, vertex, lambda);
        let numbers = path.spectral.map_or([0.0; 2], |_| tracer.two_numbers());
        let Some(light) = connection else { return black };
        let l = match path.spectral {
            Some(SpectralMis { heroes, r_u, .. }) => {
                let medium = vertex.medium_towards(light.wi, path.medium);
                match tracer.passage(&light.shadow, medium, lambda, &heroes, numbers) {
                    Some(passage) => {
                        let Connection { l, ratio, .. } = light;
                        Arrival { l: path.beta * l, r_u, ratio }.through(&passage, &heroes)
                    }
                    None => return black,
                }
            }
            None if tracer.occluded(&light.shadow, light.interfaces) => return black,
            None => path.beta * light.weighted(),
        };
        if tracer.takes_parts() {
            let first = match path.first {
                FirstEvent::None => vertex.event(light.wi),
                first => first,
            };
            tracer.take_part(Some(light.light), &first, path.depth, l);
        }
        l
    }

    /// Lets a path that has been scattered go on, or end by Russian roulette.
    pub(super) fn goes_on(&self, tracer: &mut Tracer, path: &mut PathState) -> bool {
        if !self.sample_lights {
            path.origin = None;
        }
        path.survives(tracer.sampler)
    }
}

impl RayIntegrator for Path {
    fn prepare(&mut self, scene: &Scene, _view: &View, control: &Control) -> Result<(), Cancelled> {
        if self.sample_lights {
            self.direct = DirectLighting::new(scene, self.settings.light_sampler, self.interfaces, control)?;
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
