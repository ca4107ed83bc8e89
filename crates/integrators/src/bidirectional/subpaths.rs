//! Whole subpaths, told vertex by vertex, and ends of subpaths of one length alone.

use geometry::RayStats;
use sampling::Sampler;
use scene::camera::CameraRayDifferential;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::{Bidirectional, Found, Vertex, Walk};

/// What a camera subpath comes by.
pub(crate) enum OnTheWay<'a> {
    /// A light that it met by chance.
    Light(Found),
    /// A surface from which it will go on.
    Vertex(&'a Vertex),
}

impl Bidirectional<'_> {
    /// Follows a light subpath, and visits the vertices that others can be connected to.
    pub fn light_subpath(
        &self,
        time: f32,
        lambda: &SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
        mut visit: impl FnMut(&Vertex, &mut Sampler, &mut RayStats),
    ) {
        let Some(mut walk) = Walk::from_light(self, time, *lambda, sampler, stats) else { return };
        while walk.depth < self.max_depth {
            let Some(mut surface) = walk.meet(stats) else { return };
            let Some(vertex) = walk.arrive(&mut surface, sampler) else { continue };
            if vertex.is_connectible() {
                visit(&vertex, sampler, stats);
            }
            if !walk.leave(&vertex, &surface, sampler) {
                return;
            }
        }
    }

    /// Follows a camera subpath, and visits what it comes by: every vertex, and every light.
    pub fn camera_subpath(
        &self,
        camera_ray: &CameraRayDifferential,
        lambda: &SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
        visit: impl FnMut(OnTheWay, &mut Sampler, &mut RayStats),
    ) {
        self.camera_subpath_to(|_| false, camera_ray, lambda, sampler, stats, visit);
    }

    /// The same, as far as the first vertex that is an end.
    pub fn camera_subpath_to(
        &self,
        is_end: impl Fn(&Vertex) -> bool,
        camera_ray: &CameraRayDifferential,
        lambda: &SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
        mut visit: impl FnMut(OnTheWay, &mut Sampler, &mut RayStats),
    ) {
        let mut walk = Walk::from_camera(self, camera_ray, *lambda);
        let mut before: Option<Vertex> = None;
        loop {
            let Some(mut surface) = walk.meet(stats) else {
                for found in self.escaped(&walk, before.as_ref()) {
                    visit(OnTheWay::Light(found), sampler, stats);
                }
                return;
            };
            if let Some(found) = self.emitted(&walk, &surface, before.as_ref()) {
                visit(OnTheWay::Light(found), sampler, stats);
            }
            let Some(vertex) = walk.arrive(&mut surface, sampler) else { continue };
            if vertex.depth > self.max_depth {
                return;
            }
            visit(OnTheWay::Vertex(&vertex), sampler, stats);
            if is_end(&vertex) || !walk.leave(&vertex, &surface, sampler) {
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
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> Option<Vertex> {
        let mut walk = Walk::from_light(self, time, *lambda, sampler, stats)?;
        Some(walk.follow_to(depth, sampler, stats)?.0)
    }

    /// The vertex where a camera subpath scatters for the `depth`-th time, from 1.
    pub fn camera_vertex(
        &self,
        depth: u32,
        camera_ray: &CameraRayDifferential,
        lambda: &SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> Option<Vertex> {
        let mut walk = Walk::from_camera(self, camera_ray, *lambda);
        Some(walk.follow_to(depth, sampler, stats)?.0)
    }

    /// The weighted light of all lights that a camera subpath meets by chance after it has
    /// scattered `depth` times, from 1.
    pub fn lights_met(
        &self,
        depth: u32,
        camera_ray: &CameraRayDifferential,
        lambda: &SampledWavelengths,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        let mut walk = Walk::from_camera(self, camera_ray, *lambda);
        let mut l = SampledSpectrum::ZERO;
        let Some((vertex, surface)) = walk.follow_to(depth, sampler, stats) else { return l };
        if !walk.scatter(&vertex, &surface, sampler) {
            return l;
        }
        loop {
            let Some(mut surface) = walk.meet(stats) else {
                let escaped = self.escaped(&walk, Some(&vertex)).map(|found| found.weighted());
                return l + escaped.sum::<SampledSpectrum>();
            };
            if let Some(found) = self.emitted(&walk, &surface, Some(&vertex)) {
                l += found.weighted();
            }
            if walk.arrive(&mut surface, sampler).is_some() {
                return l;
            }
        }
    }
}
