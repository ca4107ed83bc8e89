//! What camera rays gather from the photon maps.
//!
//! At a surface that is not purely specular the light that arrives falls into three:
//!
//! | light that comes | is found |
//! |---|---|
//! | straight from a light | by a light sample, weighed against the ray that goes on ([`Path`]) |
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

use geometry::RayStats;
use math::{RayDifferential, Vec2};
use sampling::Sampler;
use scattering::{Bsdf, BsdfSample, Directions, TransportMode, each_bxdf};
use scene::{Scene, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::{Maps, PhotonMappingSettings, Reach};
use crate::bidirectional::hero_only;
use crate::direct::{light_context, pass_through};
use crate::path::{Origin, Path, sample_onward};
use crate::photon::Photon;
use crate::photon_map::{Neighbourhood, PhotonMap};

/// Photons count where the cosine between their surface's normal and the point's is at least this.
const SAME_SURFACE: f32 = 0.7;

/// Gathers light along rays.
pub(super) struct Gather<'a> {
    pub scene: &'a Scene,
    /// What finds direct light.
    pub path: &'a Path,
    pub maps: &'a Maps,
    pub settings: &'a PhotonMappingSettings,
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
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        self.follow(ray, *lambda, (Quest::Light, 0), sampler, stats)
    }

    /// What a ray brings that leaves the scattering event number `depth`.
    fn follow(
        &self,
        mut ray: RayDifferential,
        mut lambda: SampledWavelengths,
        (mut quest, mut depth): (Quest, u32),
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        let (mut l, mut beta) = (SampledSpectrum::ZERO, SampledSpectrum::ONE);
        let mut eta_scale = 1.0;
        let mut origin: Option<Origin> = None;
        // Whether a caustic map has already told of lights that the ray meets, unless it does so at
        // once.
        let mut lamps_are_known = quest == Quest::Reflected;
        loop {
            let shows_lamps = !lamps_are_known || origin.is_some();
            let Some((mut surface, t)) = self.scene.intersect(&ray.ray, f32::INFINITY, stats) else {
                if shows_lamps {
                    l += known(beta * self.path.escaped(self.scene, &ray, origin.as_ref(), &lambda), &lambda);
                }
                return l;
            };
            if shows_lamps {
                l += known(beta * self.path.emitted(self.scene, &surface, origin.as_ref(), &lambda), &lambda);
            }
            let Some(bsdf) = self.scene.bsdf(&mut surface, &ray, &mut lambda, sampler) else {
                ray = pass_through(&ray, &surface, t);
                continue;
            };
            if quest == Quest::Lamps || depth == self.settings.max_depth {
                return l;
            }
            depth += 1;

            let flags = bsdf.flags();
            let context = light_context(&surface, flags);
            let onward = each_bxdf!(bsdf.bxdf, bxdf => {
                let bsdf = Bsdf { bxdf, frame: bsdf.frame };
                if quest == Quest::Light && flags.is_non_specular() {
                    let direct = self.path.sample_ld(self.scene, (&surface, &context), &bsdf, &lambda, sampler, stats);
                    l += known(beta * direct, &lambda);
                }
                sample_onward(&surface, &bsdf, sampler)
            });
            if flags.is_non_specular() {
                let place = Place { surface: &surface, bsdf: &bsdf, depth, lambda: &lambda };
                if quest == Quest::Reflected {
                    l += beta * self.reflected(&self.maps.global, &place);
                } else {
                    l += beta * self.reflected(&self.maps.caustic, &place);
                    if flags.is_diffuse() {
                        l += beta * self.indirect(&ray, &place, sampler, stats);
                    }
                }
            }

            let Some((sample, pdf)) = onward else { return l };
            if sample.flags.is_specular() {
                origin = None;
                // What comes along a specular lobe is in no map of the surface.
                lamps_are_known &= !flags.is_non_specular();
            } else {
                if quest == Quest::Reflected {
                    return l;
                }
                if flags.is_diffuse() {
                    quest = Quest::Lamps;
                }
                origin = Some(Origin { context, pdf });
                lamps_are_known = true;
            }
            beta *= throughput(&surface, &sample);
            if sample.flags.is_transmissive() {
                eta_scale *= sample.eta * sample.eta;
            }
            ray = surface.spawn_scattered(&ray, &sample);

            let survival = (beta * eta_scale).max_component();
            if depth > 1 && survival < 1.0 {
                if survival <= 0.0 || sampler.get_1d() >= survival {
                    return l;
                }
                beta /= survival;
            }
        }
    }

    /// Light that other surfaces have scattered: what is reflected of it.
    fn indirect(
        &self,
        ray: &RayDifferential,
        place: &Place,
        sampler: &mut Sampler,
        stats: &mut RayStats,
    ) -> SampledSpectrum {
        let count = self.settings.gather;
        if place.depth == self.settings.max_depth {
            return SampledSpectrum::ZERO;
        }
        if count == 0 {
            return self.reflected(&self.maps.global, place);
        }
        let Place { surface, bsdf, depth, lambda } = *place;
        let (uc, u) = (sampler.get_1d(), sampler.get_2d());
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
            let l = self.follow(ray, *lambda, (Quest::Reflected, depth), sampler, stats);
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

/// f·|cos|/pdf of a sample.
fn throughput(surface: &SurfaceInteraction, sample: &BsdfSample) -> SampledSpectrum {
    sample.f * (sample.wi.dot(surface.surface.shading.n).abs() / sample.pdf)
}

/// Light as it is at all wavelengths that the ray began with, of which dispersion may have left the
/// first.
fn known(l: SampledSpectrum, lambda: &SampledWavelengths) -> SampledSpectrum {
    if lambda.secondary_terminated() { hero_only(l) } else { l }
}
