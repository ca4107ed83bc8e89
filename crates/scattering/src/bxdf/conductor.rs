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
use math::{Vec2, Vec3, Vector3, same_hemisphere};
use spectrum::SampledSpectrum;

/// A metal of index `eta` + i `k`.
#[derive(Clone, Copy, Debug)]
pub struct Conductor {
    /// Roughness.
    pub distribution: TrowbridgeReitz,
    /// Real part of the index of refraction, relative to the medium above.
    pub eta: SampledSpectrum,
    /// Imaginary part of the index: absorption.
    pub k: SampledSpectrum,
}

impl Conductor {
    /// The value where microfacets of normal `wm` turn `wo` into `wi`, on one side of the surface
    /// and off the horizon.
    #[inline]
    fn f_microfacet(&self, wo: Vector3, wi: Vector3, wm: Vector3) -> SampledSpectrum {
        let fresnel = fr_conductor(wo.dot(wm).abs(), self.eta, self.k);
        fresnel * (self.distribution.d(wm) * self.distribution.g(wo, wi) / (4.0 * wi.z * wo.z))
    }

    /// The density of the reflection of `wo` in sampled microfacets of normal `wm`.
    #[inline]
    fn pdf_microfacet(&self, wo: Vector3, wm: Vector3) -> f32 {
        self.distribution.pdf(wo, wm) / (4.0 * wo.dot(wm).abs())
    }
}

impl Scatter for Conductor {
    #[inline]
    fn flags(&self) -> BxdfFlags {
        let width =
            if self.distribution.effectively_smooth() { BxdfFlags::SPECULAR } else { BxdfFlags::GLOSSY };
        width | BxdfFlags::REFLECTION
    }

    #[inline]
    fn f(&self, wo: Vector3, wi: Vector3, _: TransportMode) -> SampledSpectrum {
        if !same_hemisphere(wo, wi) || self.distribution.effectively_smooth() {
            return SampledSpectrum::ZERO;
        }
        match (wo + wi).try_normalize() {
            Some(wm) => self.f_microfacet(wo, wi, wm),
            None => SampledSpectrum::ZERO,
        }
    }

    #[inline]
    fn sample_f(
        &self,
        wo: Vector3,
        _: f32,
        u: Vec2,
        _: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        if !directions.reflection() || wo.z == 0.0 {
            return None;
        }
        let lobe = self.flags();
        if lobe.is_specular() {
            let wi = Vec3::new(-wo.x, -wo.y, wo.z);
            let f = fr_conductor(wi.z.abs(), self.eta, self.k) / wi.z.abs();
            return Some(BsdfSample::new(f, wi, 1.0, lobe));
        }
        let wm = self.distribution.sample_wm(wo, u);
        let wi = reflect(wo, wm);
        if !same_hemisphere(wo, wi) {
            return None;
        }
        Some(BsdfSample::new(self.f_microfacet(wo, wi, wm), wi, self.pdf_microfacet(wo, wm), lobe))
    }

    #[inline]
    fn pdf(&self, wo: Vector3, wi: Vector3, _: TransportMode, directions: Directions) -> f32 {
        if !directions.reflection() || !same_hemisphere(wo, wi) || self.distribution.effectively_smooth() {
            return 0.0;
        }
        (wo + wi).try_normalize().map_or(0.0, |wm| self.pdf_microfacet(wo, wm))
    }

    #[inline]
    fn regularize(&mut self) {
        self.distribution.regularize();
    }
}
