//! Vertices of paths from which lights are sampled.

use film::FirstEvent;
use lanes::Real;
use math::{Normal3, Point3, Point3Error, Ray, Vec3, Vector3, offset_ray_origin};
use scattering::{Bsdf, Bxdf, BxdfFlags, Directions, HenyeyGreenstein, TransportMode};
use scene::SurfaceInteraction;
use scene::light::{LightLiSample, LightSampleContext};
use scene::medium::MediumId;
use spectrum::SampledSpectrum;

use super::ShadowRay;
use super::parts::event_at;

/// A vertex from which lights are sampled.
pub(crate) enum Vertex<'a> {
    /// On a surface.
    Surface(&'a SurfaceVertex<'a>),
    /// In a medium.
    Medium(&'a MediumVertex),
}

impl Vertex<'_> {
    pub fn context(&self) -> &LightSampleContext {
        match self {
            Self::Surface(vertex) => &vertex.context,
            Self::Medium(vertex) => &vertex.context,
        }
    }

    /// The light of a light sample that it scatters to `wo`, without visibility and density.
    pub fn scattered(&self, light: &LightLiSample) -> SampledSpectrum {
        match self {
            Self::Surface(vertex) => vertex.scattered(light),
            Self::Medium(vertex) => light.l * vertex.phase.p(vertex.wo, light.wi),
        }
    }

    /// The density with which it scatters paths to `wi`.
    pub fn pdf(&self, wi: Vector3) -> f32 {
        match self {
            Self::Surface(SurfaceVertex { surface, bsdf, .. }) => {
                bsdf.pdf(surface.surface.wo, wi, TransportMode::Radiance, Directions::All)
            }
            Self::Medium(vertex) => vertex.phase.p(vertex.wo, wi),
        }
    }

    /// The shadow ray to a light sample.
    pub fn shadow_ray(&self, sample: &LightLiSample) -> ShadowRay {
        match self {
            Self::Surface(vertex) => vertex.shadow_ray(sample),
            Self::Medium(vertex) => ShadowRay::to_light(&vertex.context, sample),
        }
    }

    /// The medium of a ray that leaves it along `wi`, if the path came in `medium`.
    pub fn medium_towards(&self, wi: Vector3, medium: Option<MediumId>) -> Option<MediumId> {
        match self {
            Self::Surface(vertex) => vertex.surface.medium_towards(wi, medium),
            Self::Medium(_) => medium,
        }
    }

    /// The event by which it scatters light from `wi`.
    pub fn event(&self, wi: Vector3) -> FirstEvent {
        match self {
            Self::Surface(vertex) => event_at(vertex.bsdf, vertex.surface.surface.wo, wi),
            Self::Medium(_) => FirstEvent::Volume,
        }
    }
}

/// A point on a surface that scatters light.
pub(crate) struct SurfaceVertex<'a> {
    /// The point.
    pub surface: &'a SurfaceInteraction,
    /// How it scatters.
    pub bsdf: &'a Bsdf<Bxdf<'a>>,
    /// From where lights are sampled.
    pub context: LightSampleContext,
}

impl<'a> SurfaceVertex<'a> {
    /// A point with this BSDF.
    pub fn new(surface: &'a SurfaceInteraction, bsdf: &'a Bsdf<Bxdf<'a>>) -> Self {
        let context = on_its_side(surface.light_context(), surface.surface.wo, &bsdf.flags());
        Self { surface, bsdf, context }
    }

    /// The light of a light sample that it scatters to `wo`: f·|cos|·L, without visibility and
    /// density.
    pub fn scattered(&self, light: &LightLiSample) -> SampledSpectrum {
        let surface = &self.surface.surface;
        let f = self.bsdf.f(surface.wo, light.wi, TransportMode::Radiance);
        scattered(f, light.l, light.wi, surface.shading.n)
    }

    /// The shadow ray to a light sample.
    pub fn shadow_ray(&self, sample: &LightLiSample) -> ShadowRay {
        ShadowRay::to_light(&self.surface.light_context(), sample)
    }
}

/// A point in a medium that scatters light.
#[derive(Clone, Copy)]
pub(crate) struct MediumVertex {
    /// The point.
    pub context: LightSampleContext,
    /// Unit direction back along the path.
    pub wo: Vector3,
    /// How it scatters.
    pub phase: HenyeyGreenstein,
}

impl MediumVertex {
    /// A point at which the flight along `ray` was scattered.
    pub fn new(p: Point3, ray: &Ray, phase: HenyeyGreenstein) -> Self {
        let (p, n) = (Point3Error::exact(p), Normal3::ZERO);
        Self { context: LightSampleContext { p, n, ns: n, time: ray.time }, wo: -ray.d, phase }
    }
}

/// Offsets a point that scatters to one side only to the side of `wo` by its error, so that a light
/// that intersects its surface is not sampled from behind.
#[inline(always)]
pub(crate) fn on_its_side<R: Real>(
    context: LightSampleContext<R>,
    wo: Vector3<R>,
    flags: &BxdfFlags<R>,
) -> LightSampleContext<R> {
    let (reflects, transmits) = (flags.is_reflective(), flags.is_transmissive());
    let (p, is_one_sided) = (context.p, reflects ^ transmits);
    let moved = offset_ray_origin(p, context.n, Vec3::select(reflects, wo, -wo));
    let error = Vec3::select(is_one_sided, Vec3::splat(R::zero()), p.error);
    LightSampleContext { p: Point3Error::new(Vec3::select(is_one_sided, moved, p.p), error), ..context }
}

/// f·|cos|·L: the light from `wi` that a surface scatters.
#[inline(always)]
pub(crate) fn scattered<R: Real>(
    f: SampledSpectrum<R>,
    l: SampledSpectrum<R>,
    wi: Vector3<R>,
    ns: Normal3<R>,
) -> SampledSpectrum<R> {
    f * l * wi.dot(ns).abs()
}
