//! Radiance of camera paths, gathered from the photon maps.
//!
//! At a surface that is not purely specular, incident light has three parts:
//!
//! | incident light | estimated |
//! |---|---|
//! | direct | by next-event estimation, weighted against the scattered ray ([`DirectLighting`]) |
//! | from a light through specular surfaces alone | in the caustic map |
//! | from other surfaces that are not purely specular | in the global map if there is a diffuse lobe; else by the scattered ray |
//!
//! A ray is scattered in any case, along a direction of the BSDF. The table determines the light
//! that it may contribute: after a diffuse surface only emission at the next hit; after a glossy
//! one everything but lights behind specular surfaces; after a specular one the same as before. So
//! each light path is counted once.
//!
//! A point in a medium that scatters the path is treated as a diffuse surface is, with photons in
//! the ball around it and the phase function in place of the BSDF.
//!
//! A ray that goes under the surface of a body scatters as at a diffuse surface where it leaves it.
//!
//! With a final gather, the global map holds photons of all kinds and is looked up one surface
//! later: rays leave the diffuse surface along directions of its BSDF, and at the next surface that
//! is not purely specular the map estimates all reflected radiance.

use std::sync::atomic::{AtomicU64, Ordering};

use description::PhotonMappingDesc;
use math::{Normal3, Point3, RayDifferential, Vec2};
use scattering::{Directions, HenyeyGreenstein, TransportMode};
use scene::SurfaceInteraction;
use spectrum::{SampledSpectrum, SampledWavelengths};

use crate::bidirectional::hero_only;
use crate::photons::photon::Photon;
use crate::photons::photon_map::{Neighbourhood, PhotonMap, Space};
use crate::transport::Tracer;
use crate::transport::direct::DirectLighting;
use crate::transport::media::FlightEnd;
use crate::transport::path_state::{Origin, PathState, Scattered, throughput};
use crate::transport::subsurface::entered;
use crate::transport::vertex::{MediumVertex, SurfaceVertex, Vertex};

/// Photons count if the cosine between their normal and that of the gather point is at least this.
const SAME_SURFACE: f32 = 0.7;

/// The photons of a pass.
#[derive(Debug, Default)]
pub(super) struct PhotonMaps {
    pub caustic: PhotonMap,
    pub global: PhotonMap,
}

/// The mean of the radii of estimates, which does not depend on the order of threads.
#[derive(Debug)]
pub(super) struct MeanRadius {
    pub largest: f32,
    sum: AtomicU64,
    count: AtomicU64,
}

impl MeanRadius {
    /// The unit as a fraction of the largest radius. Sums of integers do not depend on their order.
    const UNIT: f32 = 1.0 / 4096.0;

    pub fn new(largest: f32) -> Self {
        Self { largest, sum: AtomicU64::new(0), count: AtomicU64::new(0) }
    }

    fn add(&self, radius: f32) {
        self.sum.fetch_add((radius / (self.largest * Self::UNIT)) as u64, Ordering::Relaxed);
        self.count.fetch_add(1, Ordering::Relaxed);
    }

    pub fn mean(&self) -> f64 {
        let (sum, count) = (self.sum.load(Ordering::Relaxed), self.count.load(Ordering::Relaxed));
        sum as f64 / count.max(1) as f64 * f64::from(self.largest * Self::UNIT)
    }
}

/// Gathers light along rays.
pub(super) struct Gather<'a> {
    /// Next-event estimation.
    pub direct: &'a DirectLighting,
    pub maps: &'a PhotonMaps,
    pub settings: &'a PhotonMappingDesc,
    pub neighbourhood: Neighbourhood,
    pub mean_radius: &'a MeanRadius,
}

/// The light that a ray may still contribute.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Sought {
    /// All radiance.
    Radiance,
    /// Reflected radiance of the next surface with photons, from the global map.
    Reflected,
    /// Emission at the next hit.
    Emission,
}

/// A path that gathers light.
struct Search {
    path: PathState,
    lambda: SampledWavelengths,
    sought: Sought,
    /// Whether the caustic map has the emission that the ray finds, if it was scattered specularly.
    is_mapped: bool,
    /// The light so far.
    l: SampledSpectrum,
}

impl Search {
    /// Whether emission at the end of the ray counts: all that the map does not have, and after a
    /// vertex that is not specular, where light sampling finds it, too, and it is weighted.
    fn counts_emission(&self) -> bool {
        !self.is_mapped || self.path.origin.is_some()
    }

    /// Leaves a surface along a scattered ray; `false` if the path ends there.
    fn leave(&mut self, vertex: &SurfaceVertex, scattered: &Scattered, tracer: &mut Tracer) -> bool {
        let Search { path, sought, is_mapped, .. } = self;
        let flags = vertex.bsdf.flags();
        if scattered.sample.flags.is_specular() {
            // The photon maps do not include light for specular lobes.
            *is_mapped &= !flags.is_non_specular();
        } else {
            if *sought == Sought::Reflected {
                return false;
            }
            if flags.is_diffuse() {
                *sought = Sought::Emission;
            }
            *is_mapped = true;
        }
        path.scatter(vertex, scattered);
        path.survives(tracer.sampler)
    }

    /// Adds the radiance of lights that the ray has found.
    fn add_emission(&mut self, l: SampledSpectrum) {
        self.l += known(self.path.beta * l, &self.lambda);
    }
}

impl Gather<'_> {
    /// The radiance along a camera ray, at the wavelengths of the photons.
    pub fn li(
        &self,
        ray: RayDifferential,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let path = PathState { medium: tracer.view.medium, ..PathState::new(ray, 0) };
        self.follow(path, *lambda, Sought::Radiance, tracer)
    }

    /// The radiance that a path finds.
    fn follow(
        &self,
        path: PathState,
        lambda: SampledWavelengths,
        sought: Sought,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let is_mapped = sought == Sought::Reflected;
        let mut search = Search { path, lambda, sought, is_mapped, l: SampledSpectrum::ZERO };
        while self.goes_on(&mut search, tracer) {}
        search.l
    }

    /// Leads a path along its ray, and scatters it at the end; `false` if it ends there.
    fn goes_on(&self, search: &mut Search, tracer: &mut Tracer) -> bool {
        let hit = tracer.intersect(&search.path.ray.ray);
        let t_max = hit.as_ref().map_or(f32::INFINITY, |(_, t)| *t);
        match (self.fly(search, t_max, tracer), hit) {
            (FlightEnd::Absorbed, _) => false,
            (FlightEnd::Scattered { p, phase, .. }, _) => self.scatter_in_medium(search, p, phase, tracer),
            (FlightEnd::Passed, Some((surface, t))) => self.scatter(search, surface, t, tracer),
            (FlightEnd::Passed, None) => {
                if search.counts_emission() {
                    let Search { path, lambda, .. } = &*search;
                    let l = self.direct.escaped(tracer.scene, &path.ray, path.origin.as_ref(), lambda);
                    search.add_emission(l);
                }
                false
            }
        }
    }

    /// Flies through the medium of the ray; the end is never a vertex beyond what is sought.
    fn fly(&self, search: &mut Search, t_max: f32, tracer: &mut Tracer) -> FlightEnd {
        let Search { path, lambda, sought, l, .. } = search;
        let Some(medium) = path.medium else { return FlightEnd::Passed };
        let flight = tracer.fly_alone(medium, &path.ray.ray, t_max, lambda, &mut path.beta);
        // At a diffuse surface the photon maps have the light that media emit.
        if *sought != Sought::Emission {
            *l += known(flight.emitted, lambda);
        }
        match flight.end {
            FlightEnd::Scattered { .. } if self.is_last(search) => FlightEnd::Absorbed,
            end => end,
        }
    }

    /// Whether a path scatters no more.
    fn is_last(&self, search: &Search) -> bool {
        search.sought == Sought::Emission || search.path.depth == self.settings.max_depth
    }

    /// Scatters a path in a medium; `false` if it ends there.
    fn scatter_in_medium(
        &self,
        search: &mut Search,
        p: Point3,
        phase: HenyeyGreenstein,
        tracer: &mut Tracer,
    ) -> bool {
        let Search { path, lambda, sought, is_mapped, l } = search;
        path.depth += 1;
        let vertex = MediumVertex::new(p, &path.ray.ray, phase);
        if *sought == Sought::Reflected {
            *l += path.beta * self.scattered(&self.maps.global, &vertex, path.depth, lambda);
            return false;
        }
        *l += self.medium_vertex(&vertex, path, lambda, tracer);
        // The scattered ray finds emission, as behind a diffuse surface.
        (*sought, *is_mapped) = (Sought::Emission, true);
        let (wi, pdf) = phase.sample_p(vertex.wo, tracer.sampler.get_2d());
        path.ray = vertex.context.spawn_ray(wi).into();
        path.origin = Some(Origin { context: vertex.context, pdf });
        true
    }

    /// Scatters a path at a surface that it has hit at distance `t`; `false` if it ends there.
    fn scatter(
        &self,
        search: &mut Search,
        mut surface: SurfaceInteraction,
        t: f32,
        tracer: &mut Tracer,
    ) -> bool {
        if search.counts_emission() {
            let Search { path, lambda, .. } = &*search;
            let l = self.direct.emitted(tracer.scene, &surface, path.origin.as_ref(), lambda);
            search.add_emission(l);
        }
        let Search { path, lambda, .. } = search;
        let Some(mut bsdf) = tracer.bsdf(&mut surface, &path.ray, lambda) else {
            path.pass_through(&surface, t);
            return true;
        };
        if self.is_last(search) {
            return false;
        }
        search.path.depth += 1;
        bsdf.bxdf.keep_boundary();
        let vertex = SurfaceVertex::new(&surface, &bsdf);
        let Some(scattered) = self.at_surface(search, &vertex, tracer) else { return false };
        let Some(body) = entered(&bsdf, &surface, &scattered.sample) else {
            return search.leave(&vertex, &scattered, tracer);
        };
        let Search { path, lambda, .. } = search;
        let Some(exit) = path.go_under(tracer, &vertex, body, &scattered, lambda) else { return false };
        let vertex = SurfaceVertex::new(&exit.surface, &exit.bsdf);
        let Some(scattered) = self.at_surface(search, &vertex, tracer) else { return false };
        search.leave(&vertex, &scattered, tracer)
    }

    /// Adds the light that a surface scatters along the path, except what the scattered ray finds;
    /// gives this ray.
    fn at_surface(
        &self,
        search: &mut Search,
        vertex: &SurfaceVertex,
        tracer: &mut Tracer,
    ) -> Option<Scattered> {
        let &mut Search { ref path, ref lambda, sought, .. } = search;
        let flags = vertex.bsdf.flags();
        let mut l = SampledSpectrum::ZERO;
        if sought == Sought::Radiance
            && flags.is_non_specular()
            && let Some(light) = self.direct.connect(tracer, &Vertex::Surface(vertex), lambda)
        {
            let medium = vertex.surface.medium_towards(light.shadow.ray.d, path.medium);
            l += known(path.beta * light.arriving(medium, lambda, tracer), lambda);
        }
        let scattered = Scattered::sample(vertex, tracer.sampler);
        if flags.is_non_specular() {
            if sought == Sought::Reflected {
                l += path.beta * self.reflected(&self.maps.global, vertex, path.depth, lambda);
            } else {
                l += path.beta * self.reflected(&self.maps.caustic, vertex, path.depth, lambda);
                if flags.is_diffuse() {
                    l += path.beta * self.indirect(path, vertex, lambda, tracer);
                }
            }
        }
        search.l += l;
        scattered
    }

    /// The light that a point in a medium scatters along the path, except emission that the
    /// scattered ray finds.
    fn medium_vertex(
        &self,
        vertex: &MediumVertex,
        path: &PathState,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let mut l = SampledSpectrum::ZERO;
        if let Some(light) = self.direct.connect(tracer, &Vertex::Medium(vertex), lambda) {
            l += known(path.beta * light.arriving(path.medium, lambda, tracer), lambda);
        }
        l += path.beta * self.scattered(&self.maps.caustic, vertex, path.depth, lambda);
        let count = self.settings.gather;
        if path.depth == self.settings.max_depth {
            return l;
        }
        if count == 0 {
            return l + path.beta * self.scattered(&self.maps.global, vertex, path.depth, lambda);
        }
        let u = tracer.sampler.get_2d();
        let mut sum = SampledSpectrum::ZERO;
        for i in 0..count {
            let (wi, _) = vertex.phase.sample_p(vertex.wo, lattice_point(i, count, u));
            let ray = vertex.context.spawn_ray(wi).into();
            let onward = PathState { medium: path.medium, ..PathState::new(ray, path.depth) };
            sum += self.follow(onward, *lambda, Sought::Reflected, tracer);
        }
        l + path.beta * sum / count as f32
    }

    /// Light of the photons of a map that a point in a medium scatters.
    fn scattered(
        &self,
        map: &PhotonMap,
        vertex: &MediumVertex,
        depth: u32,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let deepest = self.settings.max_depth + 1 - depth;
        let accept = |photon: &Photon| photon.depth <= deepest && photon.n == Normal3::ZERO;
        let terminated = lambda.secondary_terminated();
        let weigh = |photon: &Photon| {
            let l = photon.beta * vertex.phase.p(vertex.wo, photon.wi);
            hero_only(l, terminated || photon.hero_only)
        };
        let p = vertex.context.p.p;
        let Some((l, radius)) = map.density(p, &self.neighbourhood, Space::Ball, accept, weigh) else {
            return SampledSpectrum::ZERO;
        };
        self.mean_radius.add(radius);
        l
    }

    /// Reflected indirect light.
    fn indirect(
        &self,
        path: &PathState,
        vertex: &SurfaceVertex,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let count = self.settings.gather;
        if path.depth == self.settings.max_depth {
            return SampledSpectrum::ZERO;
        }
        if count == 0 {
            return self.reflected(&self.maps.global, vertex, path.depth, lambda);
        }
        let SurfaceVertex { surface, bsdf, .. } = vertex;
        let (uc, u) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
        let mut sum = SampledSpectrum::ZERO;
        for i in 0..count {
            let u = lattice_point(i, count, u);
            let uc = (uc + i as f32 * GOLDEN).fract();
            let wo = surface.surface.wo;
            let Some(sample) = bsdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All) else {
                continue;
            };
            if sample.flags.is_specular() {
                continue;
            }
            let ray = surface.spawn_scattered(&path.ray, &sample);
            let medium = surface.medium_towards(sample.wi, path.medium);
            let onward = PathState { medium, ..PathState::new(ray, path.depth) };
            let l = self.follow(onward, *lambda, Sought::Reflected, tracer);
            sum += throughput(surface.surface.shading.n, &sample) * l;
        }
        sum / count as f32
    }

    /// Reflected light of the photons of a map.
    fn reflected(
        &self,
        map: &PhotonMap,
        SurfaceVertex { surface, bsdf, .. }: &SurfaceVertex,
        depth: u32,
        lambda: &SampledWavelengths,
    ) -> SampledSpectrum {
        let s = &surface.surface;
        let deepest = self.settings.max_depth + 1 - depth;
        let transmissive = bsdf.flags().is_transmissive();
        let side = s.wo.dot(s.n);
        let accept = |photon: &Photon| {
            photon.depth <= deepest
                && photon.n.dot(s.n).abs() >= SAME_SURFACE
                && (transmissive || photon.wi.dot(s.n) * side > 0.0)
        };
        let terminated = lambda.secondary_terminated();
        let weigh = |photon: &Photon| {
            // Power includes the cosine to the geometric normal; scattering has that to the shading
            // normal.
            let cosines = (photon.wi.dot(s.shading.n) / photon.wi.dot(s.n)).abs();
            let l = bsdf.f(s.wo, photon.wi, TransportMode::Radiance) * photon.beta * cosines;
            hero_only(l, terminated || photon.hero_only)
        };
        let Some((l, radius)) = map.density(s.p.p, &self.neighbourhood, Space::Disk, accept, weigh) else {
            return SampledSpectrum::ZERO;
        };
        self.mean_radius.add(radius);
        l
    }
}

/// The fractional part of the golden ratio.
const GOLDEN: f32 = 0.618_034;

/// Point `i` of `count` of a rank-1 lattice shifted by `u`.
fn lattice_point(i: u32, count: u32, u: Vec2) -> Vec2 {
    Vec2::new((i as f32 + u.x) / count as f32, (u.y + i as f32 * GOLDEN).fract())
}

/// Radiance at all wavelengths that the ray began with, of which dispersion may have terminated all
/// but the first.
fn known(l: SampledSpectrum, lambda: &SampledWavelengths) -> SampledSpectrum {
    hero_only(l, lambda.secondary_terminated())
}
