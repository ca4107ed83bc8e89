//! Conductors: specular reflection, by a smooth surface or by microfacets.
//!
//! ```text
//! f = D(wm) G(wo, wi) F(wo·wm) / (4 cos θ_i cos θ_o)        wm = (wo + wi)/|wo + wi|
//! p = D_wo(wm) / (4 |wo·wm|)
//! ```
//!
//! A smooth one has f = F(cos θ_o) δ(wi − mirrored wo)/|cos θ_i|. Multiple scattering between
//! microfacets is ignored, so that rough metals are slightly too dark. Sources: [Torrance 1967],
//! [Walter 2007], [Pharr 2023 §9.4, §9.7].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode, TrowbridgeReitz, fr_conductor, reflect};
use lanes::{Mask, Real};
use math::{Vec2, Vec3, Vector3, same_hemisphere};
use spectrum::SampledSpectrum;

/// A metal of index `eta` + i `k`.
#[derive(Clone, Copy, Debug)]
pub struct Conductor<R = f32> {
    /// Roughness.
    pub distribution: TrowbridgeReitz<R>,
    /// Real part of the index of refraction, relative to the medium above.
    pub eta: SampledSpectrum<R>,
    /// Imaginary part of the index: absorption.
    pub k: SampledSpectrum<R>,
}

impl<R: Real> Conductor<R> {
    /// The value where microfacets of normal `wm` turn `wo` into `wi`, on one side of the surface
    /// and off the horizon.
    #[inline(always)]
    fn f_microfacet(&self, wo: Vector3<R>, wi: Vector3<R>, wm: Vector3<R>) -> SampledSpectrum<R> {
        let fresnel = fr_conductor(wo.dot(wm).abs(), self.eta, self.k);
        let facets = self.distribution.d(wm) * self.distribution.g(wo, wi);
        fresnel * (facets / (R::splat(4.0) * wi.z * wo.z))
    }

    /// The density of the reflection of `wo` in sampled microfacets of normal `wm`.
    #[inline(always)]
    fn pdf_microfacet(&self, wo: Vector3<R>, wm: Vector3<R>) -> R {
        self.distribution.pdf(wo, wm) / (R::splat(4.0) * wo.dot(wm).abs())
    }

    /// The normal of microfacets that turn `wo` into `wi`, and where there are any that are not
    /// those of a smooth surface.
    #[inline(always)]
    fn facet(&self, wo: Vector3<R>, wi: Vector3<R>) -> (Vector3<R>, R::Mask) {
        let (wm, valid) = (wo + wi).normalize_masked();
        (wm, valid & same_hemisphere(wo, wi) & !self.distribution.effectively_smooth())
    }

    #[inline(always)]
    fn sample_specular(&self, wo: Vector3<R>) -> BsdfSample<R> {
        let wi = Vec3::new(-wo.x, -wo.y, wo.z);
        let f = fr_conductor(wi.z.abs(), self.eta, self.k) / wi.z.abs();
        BsdfSample::new(f, wi, R::one(), BxdfFlags::splat(BxdfFlags::SPECULAR_REFLECTION))
    }

    #[inline(always)]
    fn sample_glossy(&self, wo: Vector3<R>, u: Vec2<R>) -> BsdfSample<R> {
        let wm = self.distribution.sample_wm(wo, u);
        let wi = reflect(wo, wm);
        let valid = same_hemisphere(wo, wi);
        if !valid.any() {
            return BsdfSample::invalid();
        }
        let (f, pdf) = (self.f_microfacet(wo, wi, wm), self.pdf_microfacet(wo, wm));
        let lobe = BxdfFlags::splat(BxdfFlags::GLOSSY_REFLECTION);
        BsdfSample { valid, ..BsdfSample::new(f, wi, pdf, lobe) }
    }
}

impl<R: Real> Scatter<R> for Conductor<R> {
    const CHOOSES: bool = false;

    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        BxdfFlags::choose(
            self.distribution.effectively_smooth(),
            BxdfFlags::SPECULAR_REFLECTION,
            BxdfFlags::GLOSSY_REFLECTION,
        )
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode) -> SampledSpectrum<R> {
        let (wm, valid) = self.facet(wo, wi);
        if !valid.any() {
            return SampledSpectrum::zero();
        }
        SampledSpectrum::select(valid, self.f_microfacet(wo, wi, wm), SampledSpectrum::zero())
    }

    #[inline(always)]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        _: R,
        u: Vec2<R>,
        _: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        if !directions.reflection() {
            return BsdfSample::invalid();
        }
        let smooth = self.distribution.effectively_smooth();
        let sample = if smooth.all() {
            self.sample_specular(wo)
        } else {
            let glossy = self.sample_glossy(wo, u);
            if smooth.any() { BsdfSample::select(smooth, self.sample_specular(wo), glossy) } else { glossy }
        };
        BsdfSample { valid: sample.valid & wo.z.ne(R::zero()), ..sample }
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode, directions: Directions) -> R {
        let (wm, valid) = self.facet(wo, wi);
        if !directions.reflection() || !valid.any() {
            return R::zero();
        }
        R::select(valid, self.pdf_microfacet(wo, wm), R::zero())
    }

    #[inline(always)]
    fn regularize(&mut self, mask: R::Mask) {
        self.distribution.regularize(mask);
    }
}
