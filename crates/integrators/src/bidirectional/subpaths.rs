//! Complete subpaths, visited vertex by vertex, and the last vertices of subpaths of a given
//! length.

use scene::camera::CameraRayDifferential;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::{Arrival, Bidirectional, Found, Vertex, Walk};
use crate::transport::Tracer;

/// A vertex or light that a camera subpath hits.
pub(crate) enum Encounter<'b, 'a> {
    /// A light that it hit.
    Light(Found),
    /// A vertex.
    Vertex(&'b Vertex<'a>),
}

impl Bidirectional<'_> {
    /// Samples a light subpath, and visits the vertices that can be connected or take photons. A
    /// cancellation cuts the subpath off.
    pub fn light_subpath<'a>(
        &'a self,
        time: f32,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
        mut visit: impl FnMut(&Vertex<'a>, &mut Tracer),
    ) {
        let Some(mut walk) = Walk::from_light(self, time, *lambda, tracer) else { return };
        while walk.depth < self.max_depth || walk.is_under_surface() {
            let Arrival::At(mut interaction) = walk.intersect(tracer) else { return };
            let Some(vertex) = walk.arrive(&mut interaction, tracer) else { continue };
            if vertex.is_connectible() || vertex.takes_photons() {
                visit(&vertex, tracer);
            }
            if !walk.leave(&vertex, &interaction, tracer) {
                return;
            }
        }
    }

    /// Samples a camera subpath, and visits every vertex and every light that is hit.
    pub fn camera_subpath<'a>(
        &'a self,
        camera_ray: &CameraRayDifferential,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
        visit: impl FnMut(Encounter<'_, 'a>, &mut Tracer),
    ) {
        self.camera_subpath_to(|_| false, camera_ray, lambda, tracer, visit);
    }

    /// The same, up to the first vertex at which `is_end` is true.
    pub fn camera_subpath_to<'a>(
        &'a self,
        is_end: impl Fn(&Vertex<'a>) -> bool,
        camera_ray: &CameraRayDifferential,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
        mut visit: impl FnMut(Encounter<'_, 'a>, &mut Tracer),
    ) {
        let mut walk = Walk::from_camera(self, camera_ray, *lambda);
        let mut before: Option<Vertex> = None;
        loop {
            let arrival = walk.intersect(tracer);
            if let Some(found) = self.emitted_on_the_way(&mut walk) {
                visit(Encounter::Light(found), tracer);
            }
            let mut interaction = match arrival {
                Arrival::At(interaction) => interaction,
                Arrival::Escaped => {
                    for found in self.escaped(&walk, before.as_ref()) {
                        visit(Encounter::Light(found), tracer);
                    }
                    return;
                }
                Arrival::Lost => return,
            };
            if let Some(found) = self.emitted(&walk, &interaction, before.as_ref()) {
                visit(Encounter::Light(found), tracer);
            }
            let Some(vertex) = walk.arrive(&mut interaction, tracer) else { continue };
            if vertex.depth > self.max_depth {
                return;
            }
            visit(Encounter::Vertex(&vertex), tracer);
            if is_end(&vertex) || !walk.leave(&vertex, &interaction, tracer) {
                return;
            }
            before = Some(vertex);
        }
    }

    /// The vertex where a light subpath scatters for the `depth`-th time, from 1.
    pub fn light_vertex(
        &self,
        depth: u32,
        time: f32,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> Option<Vertex<'_>> {
        let mut walk = Walk::from_light(self, time, *lambda, tracer)?;
        Some(walk.follow_to(depth, tracer)?.0)
    }

    /// Visits the vertices where a camera subpath scatters for the `depth`-th time, from 1: one, or
    /// the two between which it goes under a surface.
    pub fn camera_vertices<'a>(
        &'a self,
        depth: u32,
        camera_ray: &CameraRayDifferential,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
        mut visit: impl FnMut(&Vertex<'a>, &mut Tracer),
    ) {
        let mut walk = Walk::from_camera(self, camera_ray, *lambda);
        let Some((vertex, interaction)) = walk.follow_to(depth, tracer) else { return };
        visit(&vertex, tracer);
        if vertex.body().is_some()
            && walk.scatter(&vertex, &interaction, tracer)
            && walk.is_under_surface()
            && let Some((exit, _)) = walk.next(tracer)
        {
            visit(&exit, tracer);
        }
    }

    /// The weighted radiance of all lights that a camera subpath hits after `depth` scattering
    /// events, from 1.
    pub fn lights_met(
        &self,
        depth: u32,
        camera_ray: &CameraRayDifferential,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let mut walk = Walk::from_camera(self, camera_ray, *lambda);
        let mut l = SampledSpectrum::ZERO;
        let Some((mut vertex, mut interaction)) = walk.follow_to(depth, tracer) else { return l };
        loop {
            if !walk.scatter(&vertex, &interaction, tracer) {
                return l;
            }
            if !walk.is_under_surface() {
                break;
            }
            let Some(exit) = walk.next(tracer) else { return l };
            (vertex, interaction) = exit;
        }
        walk.emitted = SampledSpectrum::ZERO;
        loop {
            let arrival = walk.intersect(tracer);
            l += self.emitted_on_the_way(&mut walk).map_or(SampledSpectrum::ZERO, |found| found.weighted());
            let mut interaction = match arrival {
                Arrival::At(interaction) => interaction,
                Arrival::Escaped => {
                    let escaped = self.escaped(&walk, Some(&vertex)).map(|found| found.weighted());
                    return l + escaped.sum::<SampledSpectrum>();
                }
                Arrival::Lost => return l,
            };
            if let Some(found) = self.emitted(&walk, &interaction, Some(&vertex)) {
                l += found.weighted();
            }
            if walk.arrive(&mut interaction, tracer).is_some() {
                return l;
            }
        }
    }
}
