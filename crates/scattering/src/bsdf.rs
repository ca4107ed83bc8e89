//! A BxDF in the shading frame of a point, for directions in render space.

use crate::{BsdfSample, Bxdf, BxdfFlags, Directions, Scatter, TransportMode};
use math::{Frame, Normal3, Vec2, Vector3};
use spectrum::SampledSpectrum;

/// All scattering at a point of a surface.
///
/// `B` is [`Bxdf`], or one of its members: [`each_bxdf!`](crate::each_bxdf) dispatches once around
/// a whole shading step, within which `Bsdf { bxdf, frame }` has a concrete type.
#[derive(Clone, Copy, Debug)]
pub struct Bsdf<B = Bxdf> {
    /// The BxDF, in the local frame.
    pub bxdf: B,
    /// The local frame in render space: z is the shading normal, x follows ∂p/∂u.
    pub frame: Frame,
}

impl<B: Scatter> Bsdf<B> {
    /// Around the unit shading normal `ns`, with x along the shading ∂p/∂u `dpdus`.
    #[inline]
    pub fn new(ns: Normal3, dpdus: Vector3, bxdf: B) -> Self {
        Self { bxdf, frame: Frame::from_z_and_x(ns, dpdus) }
    }

    /// The flags of all lobes.
    #[inline]
    pub fn flags(&self) -> BxdfFlags {
        self.bxdf.flags()
    }

    /// A direction of render space in the local frame.
    #[inline]
    pub fn render_to_local(&self, v: Vector3) -> Vector3 {
        self.frame.to_local(v)
    }

    /// A direction of the local frame in render space.
    #[inline]
    pub fn local_to_render(&self, v: Vector3) -> Vector3 {
        self.frame.from_local(v)
    }

    /// [`Scatter::f`]; black if `wo` lies on the horizon.
    #[inline]
    pub fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        let (wo, wi) = (self.render_to_local(wo), self.render_to_local(wi));
        if !wo.z.is_normal() {
            return SampledSpectrum::ZERO;
        }
        self.bxdf.f(wo, wi, mode)
    }

    /// [`Scatter::sample_f`]; `None` too if `wo` or the sample lies on the horizon, or the sample
    /// carries no light.
    #[inline]
    #[doc(alias = "Sample_f")]
    pub fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        let wo = self.render_to_local(wo);
        if !wo.z.is_normal() || !directions.meet(self.flags()) {
            return None;
        }
        let sample = self.bxdf.sample_f(wo, uc, u, mode, directions)?;
        if sample.f.is_black() || sample.pdf == 0.0 || !sample.wi.z.is_normal() {
            return None;
        }
        Some(BsdfSample { wi: self.local_to_render(sample.wi), ..sample })
    }

    /// [`Scatter::pdf`]; zero if `wo` lies on the horizon.
    #[inline]
    #[doc(alias = "PDF")]
    pub fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode, directions: Directions) -> f32 {
        let (wo, wi) = (self.render_to_local(wo), self.render_to_local(wi));
        if !wo.z.is_normal() {
            return 0.0;
        }
        self.bxdf.pdf(wo, wi, mode, directions)
    }

    /// [`Scatter::rho_hd`]: the albedo towards `wo`.
    pub fn rho(&self, wo: Vector3, samples: impl IntoIterator<Item = (f32, Vec2)>) -> SampledSpectrum {
        self.bxdf.rho_hd(self.render_to_local(wo), samples)
    }

    /// [`Scatter::regularize`].
    #[inline]
    pub fn regularize(&mut self) {
        self.bxdf.regularize();
    }
}
