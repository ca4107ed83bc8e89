//! Where light leaves a body, by its diffusion profile.
//!
//! A probe of the [profile](Profiles) may meet the body several times; if n, one of the points is
//! chosen with probability 1/n.

use math::Ray;
use sampling::{WeightedReservoir, hash};
use scattering::Profiles;
use scene::SurfaceInteraction;
use spectrum::SampledSpectrum;

use super::Entry;
use crate::transport::Tracer;

impl Tracer<'_> {
    /// A point by the profile of wavelength number `hero`, and its density per area, for each
    /// wavelength as the hero.
    pub(super) fn probe(
        &mut self,
        entry: &Entry,
        profiles: &Profiles,
        hero: usize,
    ) -> Option<(SurfaceInteraction, SampledSpectrum)> {
        let (uc, u, seed) = (self.sampler.get_1d(), self.sampler.get_2d(), self.sampler.get_1d());
        let (p, n) = (entry.p.p, entry.ns);
        let probe = profiles.sample_probe(n, hero, uc, u)?;
        let mut ray = Ray::new(p + probe.start, probe.direction, entry.time);
        let end = ray.at(probe.length);
        let mut met = WeightedReservoir::new(hash(&[seed.to_bits()]));
        let mut kept = None;
        loop {
            let rest = (end - ray.o).dot(probe.direction);
            if !(rest > 0.0 && self.may_trace()) {
                break;
            }
            let Some((surface, _)) = self.scene.intersect(&ray, rest, self.stats) else { break };
            ray = surface.spawn_ray(probe.direction);
            if surface.material == entry.material && met.add((), 1.0) {
                kept = Some(surface);
            }
        }
        let surface = kept?;
        let d = surface.p() - p;
        let density = profiles.probe_pdf(n, d, surface.surface.n) * met.sample_probability();
        Some((surface, density))
    }
}
