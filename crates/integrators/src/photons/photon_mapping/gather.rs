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
use math::{Normal3, RayDifferential, Vec2};
use scattering::{Directions, TransportMode};
use scene::medium::MediumId;
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

/// A point at which photons are looked up.
#[derive(Clone, Copy)]
struct GatherPoint<'a> {
    vertex: &'a SurfaceVertex<'a>,
    /// Scattering events from the camera, this one included.
    depth: u32,
    lambda: &'a SampledWavelengths,
}

impl Gather<'_> {
    /// The radiance along a camera ray, at the wavelengths of the photons.
    pub fn li(
        &self,
        ray: RayDifferential,
        lambda: &SampledWavelengths,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let medium = tracer.view.medium;
        self.follow(ray, medium, *lambda, Sought::Radiance, 0, tracer)
    }

    /// The radiance along a ray in a medium that leaves scattering event number `depth`.
    fn follow(
        &self,
        ray: RayDifferential,
        medium: Option<MediumId>,
        mut lambda: SampledWavelengths,
        mut sought: Sought,
        depth: u32,
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let (scene, direct) = (tracer.scene, self.direct);
        let mut l = SampledSpectrum::ZERO;
        let mut path = PathState { medium, ..PathState::new(ray, depth) };
        // Whether the caustic map has the emission that the ray finds beyond specular surfaces.
        let mut emission_is_known = sought == Sought::Reflected;
        loop {
            let counts_emission = !emission_is_known || path.origin.is_some();
            let hit = tracer.intersect(&path.ray.ray);
            if let Some(id) = path.medium {
                let t_max = hit.as_ref().map_or(f32::INFINITY, |(_, t)| *t);
                let flight = tracer.fly_alone(id, &path.ray.ray, t_max, &lambda, &mut path.beta);
                // At a diffuse surface the photon maps have the light that media emit.
                if sought != Sought::Emission {
                    l += known(flight.emitted, &lambda);
                }
                match flight.end {
                    FlightEnd::Passed => (),
                    FlightEnd::Absorbed => return l,
                    FlightEnd::Scattered { p, phase, .. } => {
                        if sought == Sought::Emission || path.depth == self.settings.max_depth {
                            return l;
                        }
                        path.depth += 1;
                        let vertex = MediumVertex::new(p, &path.ray.ray, phase);
                        if sought == Sought::Reflected {
                            let scattered = self.scattered(&self.maps.global, &vertex, path.depth, &lambda);
                            return l + path.beta * scattered;
                        }
                        l += self.medium_vertex(&vertex, &path, &lambda, tracer);
                        // The scattered ray finds emission, as behind a diffuse surface.
                        sought = Sought::Emission;
                        emission_is_known = true;
                        let (wi, pdf) = phase.sample_p(vertex.wo, tracer.sampler.get_2d());
                        path.ray = vertex.context.spawn_ray(wi).into();
                        path.origin = Some(Origin { context: vertex.context, pdf });
                        continue;
                    }
                }
            }
            let Some((mut surface, t)) = hit else {
                if counts_emission {
                    let escaped = direct.escaped(scene, &path.ray, path.origin.as_ref(), &lambda);
                    l += known(path.beta * escaped, &lambda);
                }
                return l;
            };
            if counts_emission {
                let emitted = direct.emitted(scene, &surface, path.origin.as_ref(), &lambda);
                l += known(path.beta * emitted, &lambda);
            }
            let Some(mut bsdf) = tracer.bsdf(&mut surface, &path.ray, &mut lambda) else {
                path.pass_through(&surface, t);
                continue;
            };
            if sought == Sought::Emission || path.depth == self.settings.max_depth {
                return l;
            }
            path.depth += 1;

            bsdf.bxdf.keep_boundary();
            let mut vertex = SurfaceVertex::new(&surface, &bsdf);
            let point = GatherPoint { vertex: &vertex, depth: path.depth, lambda: &lambda };
            let (found, scattered) = self.at_surface(&path, &point, sought, tracer);
            l += found;
            let Some(mut scattered) = scattered else { return l };
            let exit;
            if let Some(body) = entered(&bsdf, &surface, &scattered.sample) {
                let Some(left) = path.go_under(tracer, &vertex, body, &scattered, &lambda) else {
                    return l;
                };
                exit = left;
                vertex = SurfaceVertex::new(&exit.surface, &exit.bsdf);
                let point = GatherPoint { vertex: &vertex, depth: path.depth, lambda: &lambda };
                let (found, again) = self.at_surface(&path, &point, sought, tracer);
                l += found;
                let Some(again) = again else { return l };
                scattered = again;
            }
            let flags = vertex.bsdf.flags();
            if scattered.sample.flags.is_specular() {
                // The photon maps do not include light for specular lobes.
                emission_is_known &= !flags.is_non_specular();
            } else {
                if sought == Sought::Reflected {
                    return l;
                }
                if flags.is_diffuse() {
                    sought = Sought::Emission;
                }
                emission_is_known = true;
            }
            path.scatter(&vertex, &scattered);
            if !path.survives(tracer.sampler) {
                return l;
            }
        }
    }

    /// The light that a surface scatters along the path, except what the scattered ray finds, and
    /// this ray.
    fn at_surface(
        &self,
        path: &PathState,
        point: &GatherPoint,
        sought: Sought,
        tracer: &mut Tracer,
    ) -> (SampledSpectrum, Option<Scattered>) {
        let &GatherPoint { vertex, lambda, .. } = point;
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
                l += path.beta * self.reflected(&self.maps.global, point);
            } else {
                l += path.beta * self.reflected(&self.maps.caustic, point);
                if flags.is_diffuse() {
                    l += path.beta * self.indirect(path, point, tracer);
                }
            }
        }
        (l, scattered)
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
            sum += self.follow(ray, path.medium, *lambda, Sought::Reflected, path.depth, tracer);
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
    fn indirect(&self, path: &PathState, point: &GatherPoint, tracer: &mut Tracer) -> SampledSpectrum {
        let count = self.settings.gather;
        if point.depth == self.settings.max_depth {
            return SampledSpectrum::ZERO;
        }
        if count == 0 {
            return self.reflected(&self.maps.global, point);
        }
        let &GatherPoint { vertex: SurfaceVertex { surface, bsdf, .. }, depth, lambda } = point;
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
            let l = self.follow(ray, medium, *lambda, Sought::Reflected, depth, tracer);
            sum += throughput(surface, &sample) * l;
        }
        sum / count as f32
    }

    /// Reflected light of the photons of a map.
    fn reflected(&self, map: &PhotonMap, point: &GatherPoint) -> SampledSpectrum {
        let &GatherPoint { vertex: SurfaceVertex { surface, bsdf, .. }, depth, lambda } = point;
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
