//! Paths that go on under the surface of a body, and leave it elsewhere.
//!
//! A path from the camera that enters a [`Body`], a material `subsurface` or an `openpbr` with
//! scattering under its surface, goes on from another point of the same material, which a probe of
//! the diffusion profile ([`probe`]) or a random walk ([`walk`]) finds. There light is sampled, and
//! the path leaves, as at a surface that reflects by the exit lobe; all that happens between counts
//! as one scattering event. A path from a light goes the same way back ([`emerge`]).
//!
//! The throughput is multiplied by [`Exit::value`] over its density. One wavelength, the hero,
//! chooses distances; the others are weighted by spectral MIS as flights are
//! ([`media`](super::media)). Sources: [King 2013], [Pharr 2016 §15.4].

mod emerge;
mod probe;
mod walk;

use math::{Normal3, Point3Error, Vector3};
use scattering::{Body, Bsdf, BsdfSample, Bxdf};
use scene::SurfaceInteraction;
use scene::material::MaterialId;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::Tracer;
use super::media::Heroes;
use super::path_state::{PathState, Scattered};
use super::vertex::SurfaceVertex;

/// The point where a path enters a body.
#[derive(Clone, Copy)]
pub(crate) struct Entry {
    pub p: Point3Error,
    /// Geometric and shading normal.
    pub n: Normal3,
    pub ns: Normal3,
    pub time: f32,
    /// The material of the body's surfaces, before the choice of a mix.
    pub material: MaterialId,
}

impl From<&SurfaceInteraction> for Entry {
    #[inline]
    fn from(SurfaceInteraction { surface, material, .. }: &SurfaceInteraction) -> Self {
        let (p, n, ns) = (surface.p, surface.n, surface.shading.n);
        Self { p, n, ns, time: surface.time, material: *material }
    }
}

/// The other point of a path under a surface.
pub(crate) struct Exit<'a> {
    /// The point, seen from where its BSDF continues the path.
    pub surface: SurfaceInteraction,
    /// How it leaves: for a camera path the exit lobe.
    pub bsdf: Bsdf<Bxdf<'a>>,
    /// The contribution of the way to it, without the scaling of radiance by the refraction into
    /// the body.
    pub value: SampledSpectrum,
    /// The density of the way, in the measure of `value`, for each wavelength as the hero.
    pub density: SampledSpectrum,
}

/// The point of an [`Exit`] by itself.
struct Left {
    surface: SurfaceInteraction,
    value: SampledSpectrum,
    density: SampledSpectrum,
}

impl Left {
    /// With the lobe by which a path leaves a body.
    fn by<'a>(self, body: Body<'_, 'a>) -> Exit<'a> {
        let Self { surface, value, density } = self;
        let shading = &surface.surface.shading;
        let bsdf = Bsdf::new(shading.n, shading.dpdu, body.exit());
        Exit { surface, bsdf, value, density }
    }
}

/// The body that a path enters by a sample of its boundary, if it does.
pub(crate) fn entered<'b, 'a>(
    bsdf: &'b Bsdf<Bxdf<'a>>,
    surface: &SurfaceInteraction,
    sample: &BsdfSample,
) -> Option<Body<'b, 'a>> {
    let from_outside = surface.surface.wo.dot(surface.surface.shading.n) > 0.0;
    bsdf.bxdf.body().filter(|body| from_outside && body.is_entered_by(sample))
}

impl Tracer<'_> {
    /// Samples where a path from the camera leaves a body that it enters at `entry` along `wi`;
    /// `None` if it does not. Profiles do not depend on the direction.
    pub(crate) fn exit<'a>(
        &mut self,
        entry: &Entry,
        body: Body<'_, 'a>,
        wi: Vector3,
        heroes: &Heroes,
    ) -> Option<Exit<'a>> {
        Some(self.leave(entry, body, wi, heroes)?.by(body))
    }

    /// The same, without the lobe by which it leaves.
    fn leave(&mut self, entry: &Entry, body: Body, wi: Vector3, heroes: &Heroes) -> Option<Left> {
        let (mut surface, value, density) = match body.profile() {
            Some(bssrdf) => {
                let profiles = bssrdf.profiles();
                let (surface, density) = self.probe(entry, &profiles, heroes.hero)?;
                let value = profiles.at(surface.p().distance(entry.p.p));
                (surface, value, density)
            }
            None => {
                let walked = self.walk(entry, &body.interior(), wi, heroes, 0.0)?;
                (walked.surface, walked.value, walked.density)
            }
        };
        let value = value * (body.eta() * body.eta());
        if density[heroes.hero] <= 0.0 || value.is_black() {
            return None;
        }
        surface.surface.wo = surface.surface.shading.n;
        Some(Left { surface, value, density })
    }
}

impl PathState {
    /// Leads the path under the surface of a body, which it enters at a vertex as
    /// [`scatter`](Self::scatter) would leave it; `None` if it ends there.
    pub(crate) fn go_under<'a>(
        &mut self,
        tracer: &mut Tracer,
        vertex: &SurfaceVertex,
        body: Body<'_, 'a>,
        scattered: &Scattered,
        lambda: &SampledWavelengths,
    ) -> Option<Exit<'a>> {
        let medium = self.medium;
        self.scatter(vertex, scattered);
        self.medium = medium;
        let entry = vertex.surface.into();
        Some(self.pass_under(tracer, &entry, body, scattered.sample.wi, lambda)?.by(body))
    }

    /// Leads the path out of a body that it has entered along `wi`, to a point.
    pub(crate) fn leave_body(
        &mut self,
        tracer: &mut Tracer,
        entry: &Entry,
        body: Body,
        wi: Vector3,
        lambda: &SampledWavelengths,
    ) -> Option<SurfaceInteraction> {
        self.pass_under(tracer, entry, body, wi, lambda).map(|left| left.surface)
    }

    fn pass_under(
        &mut self,
        tracer: &mut Tracer,
        entry: &Entry,
        body: Body,
        wi: Vector3,
        lambda: &SampledWavelengths,
    ) -> Option<Left> {
        let (heroes, r_u) = match &self.spectral {
            Some(spectral) => (spectral.heroes, spectral.r_u),
            None => {
                let u = tracer.sampler.get_1d();
                let heroes = Heroes::by_throughput(self.beta, lambda.secondary_terminated(), u);
                (heroes, SampledSpectrum::ONE)
            }
        };
        let left = tracer.leave(entry, body, wi, &heroes)?;
        let density = r_u * left.density;
        let mean = heroes.mean(density);
        self.beta *= left.value / mean;
        if let Some(spectral) = &mut self.spectral {
            spectral.r_u = density / mean;
        }
        self.eta_scale /= body.eta() * body.eta();
        Some(left)
    }
}
