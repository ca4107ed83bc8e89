//! Where light leaves a body, by a random walk in the medium under its surface.
//!
//! The walk starts where the boundary has refracted the path to. It flies freely and is scattered
//! by the medium, and where it comes to the boundary from inside it is reflected by a smooth one,
//! or leaves. In contrast to a profile this holds for thin parts, edges and corners. The direction
//! in which it leaves is forgotten: the exit lobe spreads it as isotropic light would be, so that
//! lights can be sampled there. Under a uniform sky this is exact.
//!
//! Bodies need not be closed: a plane bounds a half space. Other materials are not seen from
//! inside. Russian roulette ends walks of low throughput, and all after [`MAX_EVENTS`].

use math::{Point3, Ray, Vec2, Vector3};
use scattering::{Interior, fr_dielectric, reflect};
use scene::SurfaceInteraction;
use spectrum::SampledSpectrum;

use super::Entry;
use crate::transport::Tracer;
use crate::transport::media::{Heroes, attenuation};

/// The number of events after which a walk ends. Only in white bodies of more than a hundred mean
/// free paths are there longer ones.
const MAX_EVENTS: u32 = 1 << 14;

/// The end of a walk.
pub(super) struct Walked {
    /// Where it leaves, seen from inside.
    pub surface: SurfaceInteraction,
    /// Its contribution over the density of the hero.
    pub value: SampledSpectrum,
    /// Its density for each wavelength as the hero, over that of the hero.
    pub density: SampledSpectrum,
    /// The probability with which it left there, and was not reflected.
    pub probability: f32,
}

impl Tracer<'_> {
    /// A walk that begins at `entry` in direction `wi`. Where it comes to the boundary it leaves
    /// with the probability with which that lets light out, but at least with `least`.
    pub(super) fn walk(
        &mut self,
        entry: &Entry,
        inside: &Interior,
        wi: Vector3,
        heroes: &Heroes,
        least: f32,
    ) -> Option<Walked> {
        let Interior { sigma_s, sigma_t, phase, eta } = *inside;
        let (mut value, mut density) = (SampledSpectrum::ONE, SampledSpectrum::ONE);
        let mut ray = Ray::spawn(entry.p, entry.n, wi, entry.time);
        let mut collisions = self.collisions();
        for _ in 0..MAX_EVENTS {
            let free = collisions.free_path(sigma_t[heroes.hero]);
            let Some((mut surface, distance)) = self.boundary(&ray, free, entry) else {
                if !(free.is_finite() && self.may_trace()) {
                    return None;
                }
                let passed = attenuation(sigma_t, free);
                let pdf = sigma_t[heroes.hero] * passed[heroes.hero];
                value *= sigma_s * passed / pdf;
                density *= sigma_t * passed / pdf;
                let survival = (value.max_component() / heroes.mean(density)).min(1.0);
                if collisions.uniform() >= survival {
                    return None;
                }
                value /= survival;
                let (wi, _) = phase.sample_p(-ray.d, Vec2::new(collisions.uniform(), collisions.uniform()));
                ray = Ray::new(ray.at(free), wi, ray.time);
                continue;
            };
            let passed = attenuation(sigma_t, distance);
            value *= passed / passed[heroes.hero];
            density *= passed / passed[heroes.hero];
            let (wo, n) = (-ray.d, surface.surface.n);
            let reflected = fr_dielectric(-wo.dot(n).abs(), eta);
            let stays = reflected.min(1.0 - least);
            if collisions.uniform() >= stays {
                surface.surface.wo = wo;
                return Some(Walked { surface, value, density, probability: 1.0 - stays });
            }
            value *= reflected / stays;
            ray = surface.spawn_ray(reflect(wo, n));
        }
        None
    }

    /// The first point of the body of `entry` that a ray meets from inside within a distance.
    fn boundary(&mut self, ray: &Ray, t_max: f32, entry: &Entry) -> Option<(SurfaceInteraction, f32)> {
        let from: Point3 = ray.o;
        let mut ray = *ray;
        loop {
            let rest = t_max - (ray.o - from).dot(ray.d);
            let (surface, _) = self.scene.intersect(&ray, rest, self.stats)?;
            if surface.material == entry.material && ray.d.dot(surface.surface.shading.n) > 0.0 {
                let distance = (surface.p() - from).dot(ray.d);
                return Some((surface, distance));
            }
            if !self.may_trace() {
                return None;
            }
            ray = surface.spawn_ray(ray.d);
        }
    }
}
