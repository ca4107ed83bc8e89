//! A BxDF in the shading frame of a point, for directions in render space.

use crate::{BsdfSample, BxdfFlags, Directions, Scatter, TransportMode};
use lanes::{Mask, Real};
use math::{Frame, Normal3, Vec2, Vector3};
use sampling::HashSequence;
use spectrum::{SampledSpectrum, SampledWavelengths};

/// All scattering at a point of a surface.
///
/// `B` is [`Bxdf`](crate::Bxdf), or one of its members: [`each_bxdf!`](crate::each_bxdf) dispatches
/// once around a whole shading step, within which `Bsdf { bxdf, frame }` has a concrete type.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf<B, R = f32> {
    /// The BxDF, in the local frame.
    pub bxdf: B,
    /// The local frame in render space: z is the shading normal, x follows ∂p/∂u.
    pub frame: Frame<R>,
}

impl<R: Real, B: Scatter<R>> Bsdf<B, R> {
    /// Around the unit shading normal `ns`, with x along the shading ∂p/∂u `dpdus`.
    #[inline(always)]
    pub fn new(ns: Normal3<R>, dpdus: Vector3<R>, bxdf: B) -> Self {
        Self { bxdf, frame: Frame::from_z_and_x(ns, dpdus) }
    }

    /// The flags of all lobes.
    #[inline(always)]
    pub fn flags(&self) -> BxdfFlags<R> {
        self.bxdf.flags()
    }

    /// A direction of render space in the local frame.
    #[inline(always)]
    pub fn render_to_local(&self, v: Vector3<R>) -> Vector3<R> {
        self.frame.to_local(v)
    }

    /// A direction of the local frame in render space.
    #[inline(always)]
    pub fn local_to_render(&self, v: Vector3<R>) -> Vector3<R> {
        self.frame.from_local(v)
    }

    /// [`Scatter::f`]; black if `wo` lies on the horizon.
    #[inline(always)]
    pub fn f(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> SampledSpectrum<R> {
        let (wo, wi) = (self.render_to_local(wo), self.render_to_local(wi));
        let valid = is_normal(wo.z);
        if !valid.any() {
            return SampledSpectrum::zero();
        }
        SampledSpectrum::select(valid, self.bxdf.f(wo, wi, mode), SampledSpectrum::zero())
    }

    /// [`Scatter::sample_f`]; invalid too where `wo` or the sample lies on the horizon, or the
    /// sample carries no light.
    #[inline(always)]
    pub fn sample_lanes(
        &self,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        let wo = self.render_to_local(wo);
        let valid = is_normal(wo.z) & directions.meet(self.flags());
        if !valid.any() {
            return BsdfSample::invalid();
        }
        let sample = self.bxdf.sample_f(wo, uc, u, mode, directions);
        let carries_light = !sample.f.is_black() & sample.pdf.ne(R::zero()) & is_normal(sample.wi.z);
        let valid = valid & sample.valid & carries_light;
        BsdfSample { wi: self.local_to_render(sample.wi), valid, ..sample }
    }

    /// [`Scatter::pdf`]; zero if `wo` lies on the horizon.
    #[inline(always)]
    #[doc(alias = "PDF")]
    pub fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode, directions: Directions) -> R {
        let (wo, wi) = (self.render_to_local(wo), self.render_to_local(wi));
        let valid = is_normal(wo.z);
        if !valid.any() {
            return R::zero();
        }
        R::select(valid, self.bxdf.pdf(wo, wi, mode, directions), R::zero())
    }

    /// [`Scatter::rho_hd`]: the albedo towards `wo`.
    #[inline(always)]
    pub fn rho(&self, wo: Vector3<R>, samples: impl IntoIterator<Item = (R, Vec2<R>)>) -> SampledSpectrum<R> {
        self.bxdf.rho_hd(self.render_to_local(wo), samples)
    }

    /// [`Scatter::regularize`].
    #[inline(always)]
    pub fn regularize(&mut self, mask: R::Mask) {
        self.bxdf.regularize(mask);
    }
}

impl<R: Real, B: Scatter<R>> Bsdf<B, R> {
    /// [`Scatter::seed`] for the vertex at a dimension of a path's random numbers: a path has its
    /// own first wavelength, and each of its vertices a dimension.
    #[inline(always)]
    pub fn seed(&mut self, lambda: &SampledWavelengths<R>, dimension: R::Int) {
        let mut sequence = HashSequence::new([lambda.lambda()[0].to_bits(), dimension]);
        self.bxdf.seed(sequence.word());
    }
}

impl<B: Scatter> Bsdf<B> {
    /// [`sample_lanes`](Self::sample_lanes) of one lane: `None` where the sample is invalid.
    #[inline(always)]
    #[doc(alias = "Sample_f")]
    pub fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        self.sample_lanes(wo, uc, u, mode, directions).into_option()
    }
}

/// Neither zero, subnormal, infinite nor NaN.
#[inline(always)]
fn is_normal<R: Real>(x: R) -> R::Mask {
    x.abs().ge(R::splat(f32::MIN_POSITIVE)) & x.abs().lt(R::splat(f32::INFINITY))
}
