//! Paths that go on under the surface of a body, and leave it elsewhere.
//!
//! A path that is transmitted into a body of material `subsurface` goes on from a point of the same
//! material that a probe of its [`Bssrdf`] meets. If the probe meets n, one is chosen with
//! probability 1/n. There light is sampled, and the path leaves, as at a surface that reflects by
//! the exit lobe; both points count as one scattering event.
//!
//! The throughput is multiplied by the profile over its density. As the distance has the profile of
//! one wavelength, the hero, the others are weighted by spectral MIS as flights are
//! ([`media`](super::media)). Sources: [King 2013], [Pharr 2016 §15.4].

use math::Ray;
use sampling::{WeightedReservoir, hash};
use scattering::{Bsdf, BsdfSample, Bssrdf, Bxdf, Subsurface};
use scene::SurfaceInteraction;
use spectrum::SampledSpectrum;

use super::Tracer;

/// The other point of a path under a surface.
pub(crate) struct Exit {
    /// The point, seen along its normal.
    pub surface: SurfaceInteraction,
    /// The exit lobe.
    pub bsdf: Bsdf<Bxdf<'static>>,
    /// The profile at the distance of both points, and without the scaling of radiance by the
    /// refraction into the body.
    pub profile: SampledSpectrum,
    /// The density of the point per area, for each wavelength as the hero.
    pub density: SampledSpectrum,
}

/// The scattering under a surface, of which the BSDF becomes the boundary; `None` if there is none.
pub(crate) fn under_surface<'a>(bsdf: &mut Bsdf<Bxdf<'a>>) -> Option<Bssrdf<'a>> {
    let Bxdf::Subsurface(Subsurface { boundary, bssrdf }) = bsdf.bxdf else { return None };
    bsdf.bxdf = boundary.into();
    Some(bssrdf)
}

/// Whether a path enters a body by a sample of its boundary.
pub(crate) fn enters(surface: &SurfaceInteraction, sample: &BsdfSample) -> bool {
    sample.flags.is_transmissive() && surface.surface.wo.dot(surface.surface.shading.n) > 0.0
}

impl Tracer<'_> {
    /// Samples where a path that enters a body leaves it, by the profile of wavelength number
    /// `hero`; `None` if it does not.
    pub(crate) fn exit(&mut self, entry: &SurfaceInteraction, bssrdf: &Bssrdf, hero: usize) -> Option<Exit> {
        let (uc, u, seed) = (self.sampler.get_1d(), self.sampler.get_2d(), self.sampler.get_1d());
        let (p, n) = (entry.p(), entry.surface.shading.n);
        let probe = bssrdf.sample_probe(n, hero, uc, u)?;
        let mut ray = Ray::new(p + probe.start, probe.direction, entry.surface.time);
        let end = ray.at(probe.length);
        let mut met = WeightedReservoir::new(hash(&[seed.to_bits()]));
        loop {
            let rest = (end - ray.o).dot(probe.direction);
            if !(rest > 0.0 && self.may_trace()) {
                break;
            }
            let Some((surface, _)) = self.scene.intersect(&ray, rest, self.stats) else { break };
            ray = surface.spawn_ray(probe.direction);
            if surface.material == entry.material {
                met.add(surface, 1.0);
            }
        }
        let mut surface = met.sample()?.clone();
        let d = surface.p() - p;
        let density = bssrdf.probe_pdf(n, d, surface.surface.n) * met.sample_probability();
        let profile = bssrdf.profile(d.length()) * (bssrdf.eta() * bssrdf.eta());
        if density[hero] <= 0.0 || profile.is_black() {
            return None;
        }
        surface.surface.wo = surface.surface.shading.n;
        let bsdf = Bsdf::new(surface.surface.shading.n, surface.surface.shading.dpdu, bssrdf.exit().into());
        Some(Exit { surface, bsdf, profile, density })
    }
}
