//! Paths that go on under the surface of a body, and leave it elsewhere.
//!
//! A path that is transmitted into a body of material `subsurface` goes on from another point of
//! the same material, which a probe of the diffusion profile ([`probe`]) or a random walk
//! ([`walk`]) finds. There light is sampled, and the path leaves, as at a surface that reflects by
//! the exit lobe; all that happens between counts as one scattering event.
//!
//! The throughput is multiplied by [`Exit::value`] over its density. One wavelength, the hero,
//! chooses distances; the others are weighted by spectral MIS as flights are
//! ([`media`](super::media)). Sources: [King 2013], [Pharr 2016 §15.4].

mod probe;
mod walk;

use scattering::{Bsdf, BsdfSample, Bxdf, Subsurface, SubsurfaceMethod};
use scene::SurfaceInteraction;
use spectrum::SampledSpectrum;

use super::Tracer;
use super::media::Heroes;

/// The other point of a path under a surface.
pub(crate) struct Exit {
    /// The point, seen along its normal.
    pub surface: SurfaceInteraction,
    /// The exit lobe.
    pub bsdf: Bsdf<Bxdf<'static>>,
    /// The contribution of the way to it, without the scaling of radiance by the refraction into
    /// the body.
    pub value: SampledSpectrum,
    /// The density of the way, in the measure of `value`, for each wavelength as the hero.
    pub density: SampledSpectrum,
}

/// The body under a surface, of which the BSDF becomes the boundary; `None` if there is none.
pub(crate) fn under_surface<'a>(bsdf: &mut Bsdf<Bxdf<'a>>) -> Option<Subsurface<'a>> {
    let Bxdf::Subsurface(body) = bsdf.bxdf else { return None };
    bsdf.bxdf = body.boundary.into();
    Some(body)
}

/// Whether a path enters a body by a sample of its boundary.
pub(crate) fn enters(surface: &SurfaceInteraction, sample: &BsdfSample) -> bool {
    sample.flags.is_transmissive() && surface.surface.wo.dot(surface.surface.shading.n) > 0.0
}

impl Tracer<'_> {
    /// Samples where a path leaves a body that it enters at `entry` by `sample` of its boundary;
    /// `None` if it does not.
    pub(crate) fn exit(
        &mut self,
        entry: &SurfaceInteraction,
        body: &Subsurface,
        sample: &BsdfSample,
        heroes: &Heroes,
    ) -> Option<Exit> {
        let bssrdf = &body.bssrdf;
        let (mut surface, value, density) = match body.method {
            SubsurfaceMethod::Diffusion => self.probe(entry, bssrdf, heroes.hero)?,
            SubsurfaceMethod::RandomWalk => self.walk(entry, bssrdf, sample.wi, heroes)?,
        };
        let value = value * (bssrdf.eta() * bssrdf.eta());
        if density[heroes.hero] <= 0.0 || value.is_black() {
            return None;
        }
        surface.surface.wo = surface.surface.shading.n;
        let bsdf = Bsdf::new(surface.surface.shading.n, surface.surface.shading.dpdu, bssrdf.exit().into());
        Some(Exit { surface, bsdf, value, density })
    }
}
