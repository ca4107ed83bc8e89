//! What camera rays gather from the photon maps.
//!
//! At a surface that is not purely specular the light that arrives falls into three:
//!
//! | light that comes | is found |
//! |---|---|
//! | straight from a light | by a light sample, weighted against the ray that goes on ([`DirectLighting`]) |
//! | from a light through specular surfaces alone | in the caustic map |
//! | from other surfaces that are not purely specular | in the global map if there is a diffuse lobe; else by the ray that goes on |
//!
//! A ray goes on in any case, along a direction of the BSDF. What it may bring follows from the
//! table: after a diffuse surface only a light that it meets at once; after a glossy one all but
//! lights behind specular surfaces; after a specular one whatever was still to be found before. So
//! each path of light is counted once.
//!
//! With a final gather, the global map holds photons of all kinds and is looked at one surface
//! later: rays leave the diffuse surface along directions of its BSDF, and where each meets a
//! surface that is not purely specular the map tells all that it reflects.

use description::PhotonMappingDesc;
use math::{RayDifferential, Vec2};
use scattering::{Bsdf, Directions, TransportMode, each_bxdf};
use scene::SurfaceInteraction;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::{Maps, Reach};
use crate::bidirectional::hero_only;
use crate::photons::photon::Photon;
use crate::photons::photon_map::{Neighbourhood, PhotonMap};
use crate::transport::Tracer;
use crate::transport::direct::{DirectLighting, light_context};
use crate::transport::path_state::{PathState, Scattered, throughput};

/// Photons count where the cosine between their surface's normal and the point's is at least this.
const SAME_SURFACE: f32 = 0.7;

/// Gathers light along rays.
pub(super) struct Gather<'a> {
    /// What finds direct light.
    pub direct: &'a DirectLighting,
    pub maps: &'a Maps,
    pub settings: &'a PhotonMappingDesc,
    pub neighbourhood: Neighbourhood,
    pub reach: &'a Reach,
}

/// What is still to be found along a ray.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Quest {
    /// What every surface sends.
    Light,
    /// What the next surface with photons reflects, as the global map tells it.
    Reflected,
    /// What lights that it meets at once send.
    Lamps,
}

/// Where photons are looked for.
#[derive(Clone, Copy)]
struct Place<'a> {
    surface: &'a SurfaceInteraction,
    bsdf: &'a Bsdf,
    /// Scattering events from the camera, the one here included.
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
        self.follow(ray, *lambda, (Quest::Light, 0), tracer)
    }

    /// What a ray brings that leaves the scattering event number `depth`.
    fn follow(
        &self,
        ray: RayDifferential,
        mut lambda: SampledWavelengths,
        (mut quest, depth): (Quest, u32),
        tracer: &mut Tracer,
    ) -> SampledSpectrum {
        let (scene, direct) = (tracer.scene, self.direct);
        let mut l = SampledSpectrum::ZERO;
        let mut path = PathState::new(ray, depth);
        // Whether a caustic map has already told of lights that the ray meets, unless it does so at
        // once.
        let mut lamps_are_known = quest == Quest::Reflected;
        loop {
            let shows_lamps = !lamps_are_known || path.origin.is_some();
            let Some((mut surface, t)) = tracer.intersect(&path.ray.ray) else {
                if shows_lamps {
                    let escaped = direct.escaped(scene, &path.ray, path.origin.as_ref(), &lambda);
                    l += known(path.beta * escaped, &lambda);
                }
                return l;
            };
            if shows_lamps {
                let emitted = direct.emitted(scene, &surface, path.origin.as_ref(), &lambda);
                l += known(path.beta * emitted, &lambda);
            }
            let Some(bsdf) = tracer.bsdf(&mut surface, &path.ray, &mut lambda) else {
                path.pass_through(&surface, t);
                continue;
            };
            if quest == Quest::Lamps || path.depth == self.settings.max_depth {
                return l;
            }
            path.depth += 1;

            let flags = bsdf.flags();
            let context = light_context(&surface, flags);
            let scattered = each_bxdf!(bsdf.bxdf, bxdf => {
                let bsdf = Bsdf { bxdf, frame: bsdf.frame };
                if quest == Quest::Light && flags.is_non_specular() {
                    let direct = direct.sample(tracer, (&surface, &context), &bsdf, &lambda);
                    l += known(path.beta * direct, &lambda);
                }
                Scattered::sample(&surface, &bsdf, tracer.sampler)
            });
            if flags.is_non_specular() {
                let place = Place { surface: &surface, bsdf: &bsdf, depth: path.depth, lambda: &lambda };
                if quest == Quest::Reflected {
                    l += path.beta * self.reflected(&self.maps.global, &place);
                } else {
                    l += path.beta * self.reflected(&self.maps.caustic, &place);
                    if flags.is_diffuse() {
                        l += path.beta * self.indirect(&path.ray, &place, tracer);
                    }
                }
            }

            let Some(scattered) = scattered else { return l };
            if scattered.sample.flags.is_specular() {
                // What comes along a specular lobe is in no map of the surface.
                lamps_are_known &= !flags.is_non_specular();
            } else {
                if quest == Quest::Reflected {
                    return l;
                }
                if flags.is_diffuse() {
                    quest = Quest::Lamps;
                }
                lamps_are_known = true;
            }
            path.scatter(&surface, context, &scattered);
            if !path.survives(tracer.sampler) {
                return l;
            }
        }
    }

    /// Light that other surfaces have scattered: what is reflected of it.
    fn indirect(&self, ray: &RayDifferential, place: &Place, tracer: &mut Tracer) -> SampledSpectrum {
        let count = self.settings.gather;
        if place.depth == self.settings.max_depth {
            return SampledSpectrum::ZERO;
        }
        if count == 0 {
            return self.reflected(&self.maps.global, place);
        }
        let Place { surface, bsdf, depth, lambda } = *place;
        let (uc, u) = (tracer.sampler.get_1d(), tracer.sampler.get_2d());
        let mut sum = SampledSpectrum::ZERO;
        for i in 0..count {
            // A lattice that is moved about: evenly spread in both coordinates.
            let step = i as f32 * GOLDEN;
            let u = Vec2::new((i as f32 + u.x) / count as f32, (u.y + step).fract());
            let uc = (uc + step).fract();
            let wo = surface.surface.wo;
            let Some(sample) = bsdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All) else {
                continue;
            };
            if sample.flags.is_specular() {
                continue;
            }
            let ray = surface.spawn_scattered(ray, &sample);
            let l = self.follow(ray, *lambda, (Quest::Reflected, depth), tracer);
            sum += throughput(surface, &sample) * l;
        }
        sum / count as f32
    }

    /// What is reflected of the light that a map's photons have brought.
    fn reflected(&self, map: &PhotonMap, place: &Place) -> SampledSpectrum {
        let &Place { surface, bsdf, depth, lambda } = place;
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
            // Power has been through the cosine of the surface, light is scattered by that of the
            // shading.
            let cosines = (photon.wi.dot(s.shading.n) / photon.wi.dot(s.n)).abs();
            let l = bsdf.f(s.wo, photon.wi, TransportMode::Radiance) * photon.beta * cosines;
            if terminated || photon.hero_only { hero_only(l) } else { l }
        };
        let Some((l, radius)) = map.density(s.p.p, &self.neighbourhood, accept, weigh) else {
            return SampledSpectrum::ZERO;
        };
        self.reach.add(radius);
        l
    }
}

/// The fractional part of the golden ratio.
const GOLDEN: f32 = 0.618_034;

/// Light as it is at all wavelengths that the ray began with, of which dispersion may have left the
/// first.
fn known(l: SampledSpectrum, lambda: &SampledWavelengths) -> SampledSpectrum {
    if lambda.secondary_terminated() { hero_only(l) } else { l }
}
