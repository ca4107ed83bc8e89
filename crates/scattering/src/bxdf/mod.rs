//! The BxDFs: their contract in the local frame, and the enum of all.
//!
//! Every member is [`Scatter`]; the conventions are those at the head of the crate. A new
//! member needs a file, a variant and a line of [`each_bxdf!`](crate::each_bxdf).

mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod thin_dielectric;

pub use conductor::Conductor;
pub use dielectric::Dielectric;
pub use diffuse::Diffuse;
pub use diffuse_transmission::DiffuseTransmission;
pub use thin_dielectric::ThinDielectric;

use crate::{BxdfFlags, Directions, TransportMode};
use math::{Vec2, Vector3};
use sampling::warp::sample_uniform_hemisphere;
use spectrum::SampledSpectrum;
use std::f32::consts::{PI, TAU};

/// A sampled direction of scattering.
#[derive(Clone, Copy, Debug)]
#[doc(alias = "BSDFSample")]
pub struct BsdfSample {
    /// The value of the BSDF; of a specular lobe, the coefficient of its Dirac delta.
    pub f: SampledSpectrum,
    /// The sampled direction, in the frame of `wo`.
    pub wi: Vector3,
    /// Density per solid angle; of a specular lobe, the coefficient of the Dirac delta that cancels
    /// that of `f`.
    pub pdf: f32,
    /// The one lobe that was sampled.
    pub flags: BxdfFlags,
    /// The relative index of refraction met along `wi`; 1 for reflection.
    pub eta: f32,
    /// Whether `f` and `pdf` are stochastic and only their ratio is right; [`Scatter::pdf`] must
    /// then be asked for a density.
    pub pdf_is_proportional: bool,
}

impl BsdfSample {
    /// A sample of `lobe` in a medium that does not change.
    #[inline]
    pub fn new(f: SampledSpectrum, wi: Vector3, pdf: f32, lobe: BxdfFlags) -> Self {
        Self { f, wi, pdf, flags: lobe, eta: 1.0, pdf_is_proportional: false }
    }
}

/// How light is scattered in the local frame.
pub trait Scatter {
    /// What kinds of scattering there are.
    fn flags(&self) -> BxdfFlags;

    /// The BxDF for light that comes from `wi` and leaves to `wo`, per steradian; specular lobes
    /// count as zero.
    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum;

    /// A direction `wi`, distributed about as f·|cos|. `uc` chooses a lobe, `u` a direction within
    /// it. `None` where no light is scattered or the sample is invalid; such a sample counts as
    /// zero.
    #[doc(alias = "Sample_f")]
    fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample>;

    /// The density of [`Scatter::sample_f`] per solid angle at `wi`; specular lobes count as zero.
    #[doc(alias = "PDF")]
    fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode, directions: Directions) -> f32;

    /// Widens narrow lobes, so that light they carry is found at the price of some bias.
    fn regularize(&mut self) {}

    /// The hemispherical-directional reflectance: the share of uniform incident light that
    /// is scattered to `wo`, estimated by one term for each (uc, u).
    fn rho_hd(&self, wo: Vector3, samples: impl IntoIterator<Item = (f32, Vec2)>) -> SampledSpectrum {
        if wo.z == 0.0 {
            return SampledSpectrum::ZERO;
        }
        mean(samples.into_iter().map(|(uc, u)| scattered(self, wo, uc, u)))
    }

    /// The hemispherical-hemispherical reflectance: the share of uniform incident light that is
    /// scattered at all, estimated by one term for each (u for wo, uc, u for wi).
    fn rho_hh(&self, samples: impl IntoIterator<Item = (Vec2, f32, Vec2)>) -> SampledSpectrum {
        mean(samples.into_iter().map(|(uo, uc, ui)| {
            let wo = sample_uniform_hemisphere(uo);
            scattered(self, wo, uc, ui) * (wo.z.abs() * TAU / PI)
        }))
    }
}

/// One estimate of the uniform incident light scattered to `wo`.
fn scattered(bxdf: &(impl Scatter + ?Sized), wo: Vector3, uc: f32, u: Vec2) -> SampledSpectrum {
    match bxdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All) {
        Some(sample) if sample.pdf > 0.0 => sample.f * (sample.wi.z.abs() / sample.pdf),
        _ => SampledSpectrum::ZERO,
    }
}

/// The mean of estimates; black if there are none.
fn mean(estimates: impl Iterator<Item = SampledSpectrum>) -> SampledSpectrum {
    let (sum, count) = estimates.fold((SampledSpectrum::ZERO, 0), |(sum, n), e| (sum + e, n + 1));
    sum / count.max(1) as f32
}

/// Any BxDF, by value: made at each hit, without allocation.
#[derive(Clone, Copy, Debug)]
pub enum Bxdf {
    /// Lambertian reflection.
    Diffuse(Diffuse),
    /// Lambertian reflection and transmission.
    DiffuseTransmission(DiffuseTransmission),
    /// Metal, smooth or rough.
    Conductor(Conductor),
    /// Glass, smooth or rough.
    Dielectric(Dielectric),
    /// A smooth pane of glass without volume.
    ThinDielectric(ThinDielectric),
}

/// Evaluates an expression with the member of a [`Bxdf`](crate::Bxdf), whichever it is, under a
/// name.
///
/// ```
/// use alhazen_scattering::{Bxdf, Scatter, each_bxdf};
/// fn scatters(bxdf: &Bxdf) -> bool {
///     each_bxdf!(bxdf, member => !member.flags().is_empty())
/// }
/// ```
#[macro_export]
macro_rules! each_bxdf {
    ($bxdf:expr, $member:ident => $body:expr) => {
        match $bxdf {
            $crate::Bxdf::Diffuse($member) => $body,
            $crate::Bxdf::DiffuseTransmission($member) => $body,
            $crate::Bxdf::Conductor($member) => $body,
            $crate::Bxdf::Dielectric($member) => $body,
            $crate::Bxdf::ThinDielectric($member) => $body,
        }
    };
}

impl Scatter for Bxdf {
    #[inline]
    fn flags(&self) -> BxdfFlags {
        each_bxdf!(self, bxdf => bxdf.flags())
    }

    #[inline]
    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        each_bxdf!(self, bxdf => bxdf.f(wo, wi, mode))
    }

    #[inline]
    fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        each_bxdf!(self, bxdf => bxdf.sample_f(wo, uc, u, mode, directions))
    }

    #[inline]
    fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode, directions: Directions) -> f32 {
        each_bxdf!(self, bxdf => bxdf.pdf(wo, wi, mode, directions))
    }

    #[inline]
    fn regularize(&mut self) {
        each_bxdf!(self, bxdf => bxdf.regularize())
    }
}

/// Makes each member a [`Bxdf`].
macro_rules! into_bxdf {
    ($($member:ident)*) => {$(
        impl From<$member> for Bxdf {
            #[inline]
            fn from(bxdf: $member) -> Self {
                Self::$member(bxdf)
            }
        }
    )*};
}

into_bxdf!(Diffuse DiffuseTransmission Conductor Dielectric ThinDielectric);
