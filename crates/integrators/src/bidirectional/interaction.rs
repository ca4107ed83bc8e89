//! Where a subpath interacts with the scene: on a surface or in a medium.

use math::{Point3, RayDifferential, Vector3};
use scattering::{Bsdf, BsdfSample, Bxdf, BxdfFlags, Directions, HenyeyGreenstein, TransportMode};
use scene::SurfaceInteraction;
use spectrum::SampledSpectrum;

use crate::transport::subsurface::Exit;

/// A point of a subpath, before it is a vertex.
#[expect(clippy::large_enum_variant, reason = "it lives for one vertex, and a box is an allocation")]
pub(crate) enum Interaction<'a> {
    /// On a surface.
    Surface(SurfaceInteraction),
    /// In a medium.
    Medium(MediumInteraction),
    /// Where the subpath leaves a body, under the surface of which it went.
    Exit(Box<Exit<'a>>),
}

/// A point in a medium that scatters light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct MediumInteraction {
    /// Position.
    pub p: Point3,
    /// Coefficient of scattering.
    pub sigma_s: SampledSpectrum,
    /// The phase function.
    pub phase: HenyeyGreenstein,
}

impl Interaction<'_> {
    /// The ray that leaves along a sampled direction.
    pub fn spawn_scattered(&self, from: &RayDifferential, sample: &BsdfSample) -> RayDifferential {
        match self {
            Self::Surface(surface) => surface.spawn_scattered(from, sample),
            Self::Exit(exit) => exit.surface.spawn_scattered(from, sample),
            Self::Medium(medium) => math::Ray::new(medium.p, sample.wi, from.ray.time).into(),
        }
    }
}

/// The law by which light is scattered at a vertex.
#[derive(Clone, Copy, Debug)]
#[expect(clippy::large_enum_variant, reason = "most vertices are on surfaces")]
pub(crate) enum Law<'a> {
    /// The BSDF of a surface.
    Surface(Bsdf<Bxdf<'a>>),
    /// The phase function of a medium.
    Medium(HenyeyGreenstein),
}

impl Law<'_> {
    /// The lobes. A phase function counts as diffuse on both sides.
    #[inline]
    pub fn flags(&self) -> BxdfFlags {
        match self {
            Self::Surface(bsdf) => bsdf.flags(),
            Self::Medium(_) => BxdfFlags::DIFFUSE | BxdfFlags::REFLECTION | BxdfFlags::TRANSMISSION,
        }
    }

    /// The value, without a cosine.
    #[inline]
    pub fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        match self {
            Self::Surface(bsdf) => bsdf.f(wo, wi, mode),
            Self::Medium(phase) => SampledSpectrum::splat(phase.p(wo, wi)),
        }
    }

    /// Density per solid angle of sampling `wi`.
    #[inline]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> f32 {
        match self {
            Self::Surface(bsdf) => bsdf.pdf(wo, wi, mode, Directions::All),
            Self::Medium(phase) => phase.p(wo, wi),
        }
    }

    /// A sampled direction, on a surface one of those asked for; `None` where there is none.
    pub fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: math::Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        match self {
            Self::Surface(bsdf) => bsdf.sample_f(wo, uc, u, mode, directions),
            Self::Medium(phase) => {
                let (wi, pdf) = phase.sample_p(wo, u);
                let f = SampledSpectrum::splat(pdf);
                Some(BsdfSample::new(f, wi, pdf, self.flags()))
            }
        }
    }
}
