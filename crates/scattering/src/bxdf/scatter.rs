//! The contract of BxDFs: their values, samples and densities in the local frame.

use crate::{BxdfFlags, Directions, TransportMode};
use lanes::{Mask, Real};
use math::{Vec2, Vector3};
use spectrum::SampledSpectrum;

/// A sampled direction of scattering, for each lane.
#[derive(Clone, Copy, Debug)]
#[doc(alias = "BSDFSample")]
pub struct BsdfSample<R: Real = f32> {
    /// The value of the BSDF; of a specular lobe, the coefficient of its Dirac delta.
    pub f: SampledSpectrum<R>,
    /// The sampled direction, in the frame of `wo`.
    pub wi: Vector3<R>,
    /// Density per solid angle; of a specular lobe, the coefficient of the Dirac delta that cancels
    /// that of `f`.
    pub pdf: R,
    /// The one lobe that was sampled.
    pub flags: BxdfFlags<R>,
    /// The relative index of refraction met along `wi`; 1 for reflection.
    pub eta: R,
    /// Whether `f` and `pdf` are stochastic and only their ratio is right; [`Scatter::pdf`] must
    /// then be asked for a density.
    pub pdf_is_proportional: bool,
    /// Whether there is a sample. If not, no light is scattered, and all else is meaningless.
    pub valid: R::Mask,
}

impl<R: Real> BsdfSample<R> {
    /// A valid sample of `lobe` in a medium that does not change.
    #[inline(always)]
    pub fn new(f: SampledSpectrum<R>, wi: Vector3<R>, pdf: R, lobe: BxdfFlags<R>) -> Self {
        let valid = R::Mask::splat(true);
        Self { f, wi, pdf, flags: lobe, eta: R::one(), pdf_is_proportional: false, valid }
    }

    /// No sample in any lane.
    #[inline(always)]
    pub fn invalid() -> Self {
        let (black, wi) = (SampledSpectrum::zero(), Vector3::splat(R::zero()));
        let lobe = BxdfFlags::splat(BxdfFlags::NONE);
        Self { valid: R::Mask::splat(false), ..Self::new(black, wi, R::zero(), lobe) }
    }

    /// `a` where the mask is true, else `b`. Does not say whether a density is proportional.
    #[inline(always)]
    pub fn select(mask: R::Mask, a: Self, b: Self) -> Self {
        Self {
            f: SampledSpectrum::select(mask, a.f, b.f),
            wi: Vector3::select(mask, a.wi, b.wi),
            pdf: R::select(mask, a.pdf, b.pdf),
            flags: BxdfFlags::select(mask, a.flags, b.flags),
            eta: R::select(mask, a.eta, b.eta),
            pdf_is_proportional: false,
            valid: mask & a.valid | !mask & b.valid,
        }
    }
}

impl BsdfSample {
    /// The sample if it is valid.
    #[inline(always)]
    pub fn into_option(self) -> Option<Self> {
        self.valid.then_some(self)
    }
}

/// How light is scattered in the local frame, for each lane.
pub trait Scatter<R: Real = f32> {
    /// Whether samples depend on `uc`, by which a lobe is chosen.
    const CHOOSES: bool = true;

    /// What kinds of scattering there are.
    fn flags(&self) -> BxdfFlags<R>;

    /// The BxDF for light that comes from `wi` and leaves to `wo`, per steradian; specular lobes
    /// count as zero.
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> SampledSpectrum<R>;

    /// A direction `wi`, distributed about as f·|cos|. `uc` chooses a lobe, `u` a direction within
    /// it. Invalid where no light is scattered; such a sample counts as zero.
    #[doc(alias = "Sample_f")]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R>;

    /// The density of [`Scatter::sample_f`] per solid angle at `wi`; specular lobes count as zero.
    #[doc(alias = "PDF")]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode, directions: Directions) -> R;

    /// Widens narrow lobes where the mask is true, so that light they carry is found at the price
    /// of some bias.
    #[inline(always)]
    fn regularize(&mut self, _: R::Mask) {}

    /// Chooses the random numbers of values that are estimates.
    #[inline(always)]
    fn seed(&mut self, _: R::Int) {}

    /// The hemispherical-directional reflectance: the share of uniform incident light that
    /// is scattered to `wo`, estimated by one term for each (uc, u).
    #[inline(always)]
    fn rho_hd(&self, wo: Vector3<R>, samples: impl IntoIterator<Item = (R, Vec2<R>)>) -> SampledSpectrum<R> {
        let rho = mean(samples.into_iter().map(|(uc, u)| scattered(self, wo, uc, u)));
        SampledSpectrum::select(wo.z.eq(R::zero()), SampledSpectrum::zero(), rho)
    }
}

/// One estimate of the uniform incident light scattered to `wo`.
#[inline(always)]
fn scattered<R: Real>(
    bxdf: &(impl Scatter<R> + ?Sized),
    wo: Vector3<R>,
    uc: R,
    u: Vec2<R>,
) -> SampledSpectrum<R> {
    let sample = bxdf.sample_f(wo, uc, u, TransportMode::Radiance, Directions::All);
    let light = sample.f * (sample.wi.z.abs() / sample.pdf);
    SampledSpectrum::select(sample.valid & sample.pdf.gt(R::zero()), light, SampledSpectrum::zero())
}

/// The mean of estimates; black if there are none.
#[inline(always)]
fn mean<R: Real>(estimates: impl Iterator<Item = SampledSpectrum<R>>) -> SampledSpectrum<R> {
    let (sum, count) = estimates.fold((SampledSpectrum::zero(), 0), |(sum, n), e| (sum + e, n + 1));
    sum / R::splat(count.max(1) as f32)
}
