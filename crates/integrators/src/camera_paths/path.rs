//! Path tracing with next-event estimation, multiple importance sampling and Russian roulette.
//!
//! At each vertex a shadow ray goes to a light and a scattered ray continues the path, weighted by
//! the power heuristic (`transport/direct.rs`); from the second vertex on Russian roulette ends
//! paths of low throughput (`transport/roulette.rs`).
//!
//! Paths that enter a body go on from another point of its surface
//! (`transport/subsurface/`).
//!
//! Unbiased up to `max_depth`, except with `regularize`, which roughens surfaces after the first
//! rough bounce to find caustics with less noise. Source: [Pharr 2023 §13.4].

use description::PathDesc;
use math::RayDifferential;
use scene::{Interfaces, Scene, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::PathsFrom;
use crate::transport::direct::{Connection, DirectLighting, light_context};
use crate::transport::parts::{DIFFUSE, event_at, event_of};
use crate::transport::path_state::{PathState, Scattered};
use crate::transport::subsurface::{Exit, entered};
use crate::{Cancelled, Control, RayIntegrator, Tracer};

/// Path tracing.
#[derive(Clone, Debug)]
pub struct Path {
    pub(crate) settings: PathDesc,
    interfaces: Interfaces,
    pub(crate) direct: DirectLighting,
}

impl Path {
    /// Has no lights before [`prepare`](RayIntegrator::prepare). `interfaces` says whether
    /// interfaces occlude delta lights.
    pub fn new(settings: PathDesc, interfaces: Interfaces) -> Self {
        Self { settings, interfaces, direct: DirectLighting::none(interfaces) }
    }

    /// Takes the parts of the radiance along a ray that leaves the scene.
    fn take_escaped(&self, tracer: &mut Tracer, path: &PathState, lambda: &SampledWavelengths) {
        if tracer.takes_parts() {
            let (scene, origin) = (tracer.scene, path.origin.as_ref());
            for (light, l) in self.direct.escaped_from_each(scene, &path.ray, origin, lambda) {
                tracer.take_part(Some(light), &path.first, path.depth, path.beta * l);
            }
        }
    }

    /// Leads a path out of a body under the surface of which it has gone; returns the direct light
    /// where it leaves, and whether it goes on.
    pub(crate) fn leave_body(
        &self,
        tracer: &mut Tracer,
        path: &mut PathState,
        exit: &Exit,
        lambda: &SampledWavelengths,
    ) -> (SampledSpectrum, bool) {
        let context = light_context(&exit.surface, exit.bsdf.flags());
        let light = self.direct.sample(tracer, (&exit.surface, &context), &exit.bsdf, lambda);
        let l = light.map_or(SampledSpectrum::ZERO, |light| {
            let l = path.beta * light.l;
            tracer.take_part(Some(light.light), &path.first, path.depth, l);
            l
        });
        let scattered = Scattered::sample(&exit.surface, &exit.bsdf, tracer.sampler);
        if let Some(scattered) = &scattered {
            path.scatter(&exit.surface, context, scattered);
        }
        (l, scattered.is_some())
    }
}

impl PathsFrom for Path {
    fn li_from(
        &self,
        min_depth: u32,
        tracer: &mut Tracer,
        ray: RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> SampledSpectrum {
        let (scene, direct) = (tracer.scene, &self.direct);
        let mut l = SampledSpectrum::ZERO;
        let mut path = PathState::new(ray, 0);
        let mut rough_before = false;
        loop {
            let Some((mut surface, t)) = tracer.intersect(&path.ray.ray) else {
                if path.depth >= min_depth {
                    l += path.beta * direct.escaped(scene, &path.ray, path.origin.as_ref(), lambda);
                    self.take_escaped(tracer, &path, lambda);
                }
                return l;
            };
            if path.depth >= min_depth {
                let emitted = path.beta * direct.emitted(scene, &surface, path.origin.as_ref(), lambda);
                tracer.take_part(surface.area_light, &path.first, path.depth, emitted);
                l += emitted;
            }
            let Some(mut bsdf) = tracer.bsdf(&mut surface, &path.ray, lambda) else {
                path.pass_through(&surface, t);
                continue;
            };
            if path.depth == self.settings.max_depth {
                return l;
            }
            path.depth += 1;
            bsdf.bxdf.keep_boundary();
            bsdf.regularize(self.settings.regularize && rough_before);

            let context = light_context(&surface, bsdf.flags());
            let light = match bsdf.flags().is_non_specular() {
                true => direct.sample(tracer, (&surface, &context), &bsdf, lambda),
                false => None,
            };
            let scattered = Scattered::sample(&surface, &bsdf, tracer.sampler);
            let is_first = path.depth == 1 && tracer.takes_parts();
            if let Some(Connection { light, wi, l: found, .. }) = light {
                let found = path.beta * found;
                let first = if is_first { event_at(&bsdf, surface.surface.wo, wi) } else { path.first };
                tracer.take_part(Some(light), &first, path.depth, found);
                l += found;
            }
            let Some(scattered) = scattered else { return l };
            let body = entered(&bsdf, &surface, &scattered.sample);
            if is_first {
                path.first = match body {
                    Some(_) => DIFFUSE,
                    None => event_of(&bsdf, surface.surface.wo, &scattered.sample),
                };
            }
            rough_before |= !scattered.sample.flags.is_specular();
            if let Some(body) = body {
                let entry = (&surface, context);
                let Some(exit) = path.go_under(tracer, entry, (body, &scattered), lambda) else {
                    return l;
                };
                let (left, goes_on) = self.leave_body(tracer, &mut path, &exit, lambda);
                l += left;
                if !goes_on {
                    return l;
                }
                rough_before = true;
            } else {
                path.scatter(&surface, context, &scattered);
            }
            if !path.survives(tracer.sampler) {
                return l;
            }
        }
    }
}

impl RayIntegrator for Path {
    fn prepare(&mut self, scene: &Scene, _view: &View, control: &Control) -> Result<(), Cancelled> {
        self.direct = DirectLighting::new(scene, self.settings.light_sampler, self.interfaces, control)?;
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
