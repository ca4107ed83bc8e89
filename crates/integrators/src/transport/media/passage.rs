//! The passage of shadow rays through media, and their transmittance.

use math::Ray;
use scene::Interfaces;
use scene::medium::MediumId;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::{Collisions, Heroes, attenuation};
use crate::transport::{ShadowRay, Step, Tracer};

/// The transmittance below which ratio tracking ends at random.
const FAINT: f32 = 0.05;

/// The passage of a shadow ray: its transmittance, and the densities of what has been passed.
#[derive(Clone, Copy)]
pub(crate) struct Passage {
    /// Transmittance over the density of ratio tracking of the hero.
    pub t: SampledSpectrum,
    /// The density of a flight along the ray over the same.
    pub r_u: SampledSpectrum,
    /// The density of ratio tracking at each wavelength over the same.
    pub r_l: SampledSpectrum,
}

impl Passage {
    /// Through nothing.
    pub const CLEAR: Self =
        Self { t: SampledSpectrum::ONE, r_u: SampledSpectrum::ONE, r_l: SampledSpectrum::ONE };

    /// The transmittance, weighted over the wavelengths that could have chosen the collisions.
    #[inline]
    pub fn estimate(&self, heroes: &Heroes) -> SampledSpectrum {
        self.t / heroes.mean(self.r_l)
    }

    /// Passes null collisions or empty distance: `null` is the factor of flights, `all` that of
    /// ratio tracking.
    #[inline]
    fn scale(&mut self, null: SampledSpectrum, all: SampledSpectrum) {
        self.t *= null;
        self.r_u *= null;
        self.r_l *= all;
    }
}

impl Tracer<'_> {
    /// The passage of a ray that leaves `medium` through all media and interfaces; `None` if a
    /// surface occludes it. `numbers` are two coordinates of the sample.
    pub(crate) fn passage(
        &mut self,
        shadow: &ShadowRay,
        medium: Option<MediumId>,
        lambda: &SampledWavelengths,
        heroes: &Heroes,
        numbers: [f32; 2],
    ) -> Option<Passage> {
        if self.scene.media().is_empty() {
            let is_clear = !self.occluded(shadow, Interfaces::Pass);
            return is_clear.then_some(Passage::CLEAR);
        }
        let passage = self.passage_through_media(*shadow, medium, lambda, heroes, numbers);
        let &ShadowRay { ray, t_max } = shadow;
        self.take_step(|_| Step::Shadow { ray, t_max, is_clear: passage.is_some() });
        passage
    }

    /// [`passage`](Self::passage) of a ray that meets neither surfaces nor interfaces.
    #[inline]
    pub(crate) fn passage_within(
        &mut self,
        &ShadowRay { ray, t_max }: &ShadowRay,
        medium: Option<MediumId>,
        lambda: &SampledWavelengths,
        heroes: &Heroes,
        numbers: [f32; 2],
    ) -> Option<Passage> {
        let mut passage = Passage::CLEAR;
        if let Some(medium) = medium {
            let scale = ray.d.length();
            let part = ShadowRay { ray: Ray { d: ray.d / scale, ..ray }, t_max: t_max * scale };
            self.attenuate(medium, &part, lambda, heroes, &mut Collisions::new(numbers), &mut passage)?;
        }
        Some(passage)
    }

    /// [`passage`](Self::passage) in a scene with media.
    #[inline]
    fn passage_through_media(
        &mut self,
        ShadowRay { mut ray, mut t_max }: ShadowRay,
        mut medium: Option<MediumId>,
        lambda: &SampledWavelengths,
        heroes: &Heroes,
        numbers: [f32; 2],
    ) -> Option<Passage> {
        let mut passage = Passage::CLEAR;
        let mut collisions = Collisions::new(numbers);
        // The length of the direction, which is a difference of points for lights at a distance.
        let scale = ray.d.length();
        loop {
            if !self.may_trace() {
                return None;
            }
            let hit = self.scene.hit(&ray, t_max, self.stats);
            if hit.as_ref().is_some_and(|hit| !self.scene.is_interface(hit, &ray)) {
                return None;
            }
            let end = hit.as_ref().map_or(t_max, |hit| hit.t);
            if let Some(medium) = medium {
                let part = ShadowRay { ray: Ray { d: ray.d / scale, ..ray }, t_max: end * scale };
                self.attenuate(medium, &part, lambda, heroes, &mut collisions, &mut passage)?;
            }
            let Some(hit) = hit else { return Some(passage) };
            let surface = self.scene.interaction(&hit, self.scene.world().surface(&ray, &hit));
            medium = surface.medium_towards(ray.d, medium);
            t_max -= hit.t;
            ray = surface.spawn_ray(ray.d);
            if t_max <= 0.0 {
                return Some(passage);
            }
        }
    }

    /// An estimate of the transmittance of a ray that leaves `medium`, and would carry `l` through
    /// empty space; `None` if a surface occludes it.
    pub(crate) fn transmittance(
        &mut self,
        shadow: &ShadowRay,
        medium: Option<MediumId>,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
    ) -> Option<SampledSpectrum> {
        if self.scene.media().is_empty() {
            return (!self.occluded(shadow, Interfaces::Pass)).then_some(SampledSpectrum::ONE);
        }
        let heroes = Heroes::by_throughput(*l, lambda.secondary_terminated(), self.sampler.get_1d());
        let numbers = self.two_numbers();
        let passage = self.passage(shadow, medium, lambda, &heroes, numbers)?;
        Some(passage.estimate(&heroes))
    }

    /// An estimate of the transmittance of one medium along a ray of unit direction that carries
    /// `l`; `None` if nothing is left.
    #[inline]
    pub(crate) fn transmittance_within(
        &mut self,
        shadow: &ShadowRay,
        medium: MediumId,
        l: &SampledSpectrum,
        lambda: &SampledWavelengths,
    ) -> Option<SampledSpectrum> {
        let heroes = Heroes::by_throughput(*l, lambda.secondary_terminated(), self.sampler.get_1d());
        let (mut collisions, mut passage) = (self.collisions(), Passage::CLEAR);
        self.attenuate(medium, shadow, lambda, &heroes, &mut collisions, &mut passage)?;
        Some(passage.estimate(&heroes))
    }

    /// Passes one medium along a part of a ray, of unit direction; `None` if nothing is left.
    #[inline]
    fn attenuate(
        &mut self,
        medium: MediumId,
        &ShadowRay { ref ray, t_max }: &ShadowRay,
        lambda: &SampledWavelengths,
        heroes: &Heroes,
        collisions: &mut Collisions,
        passage: &mut Passage,
    ) -> Option<()> {
        let (hero, medium) = (heroes.hero, &self.scene.media()[medium.0 as usize]);
        if let Some(properties) = medium.homogeneous(lambda) {
            let passed = attenuation(properties.sigma_t(), t_max.min(f32::MAX));
            passage.t *= passed;
            passage.r_u *= passed;
            return (!passage.t.is_black()).then_some(());
        }
        for segment in medium.majorants(ray, t_max, lambda) {
            let [mut t, end] = segment.t;
            let majorant = segment.majorant;
            loop {
                let next = t + collisions.free_path(majorant[hero]);
                let passed = attenuation(majorant, next.min(end) - t);
                let passed = passed / passed[hero];
                if next >= end {
                    passage.scale(passed, passed);
                    break;
                }
                t = next;
                let sigma_t = medium.at(ray.at(t), lambda).sigma_t();
                let passed = passed / majorant[hero];
                passage.scale((majorant - sigma_t).clamp_zero() * passed, majorant * passed);
                if !self.may_trace() {
                    return None;
                }
                let left = passage.estimate(heroes).max_component();
                if left < FAINT {
                    // An end at random that keeps the mean.
                    if left == 0.0 || collisions.uniform() < 0.75 {
                        return None;
                    }
                    passage.t *= 4.0;
                }
            }
        }
        Some(())
    }
}
