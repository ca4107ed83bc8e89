//! Glass, water and other dielectrics: light is reflected and refracted, by a smooth surface or by
//! microfacets that are.
//!
//! With F the Fresnel reflectance at the microfacet and η' the relative index that light from `wo`
//! meets,
//!
//! ```text
//! reflection     wm ∝ wo + wi
//!                f = D(wm) G F / |4 cos θ_i cos θ_o|
//!                p = F · D_wo(wm) / (4 |wo·wm|)
//! transmission   wm ∝ wo + η' wi
//!                f = D(wm) G (1 − F) |wi·wm wo·wm / (cos θ_i cos θ_o (wi·wm + wo·wm/η')²)|
//!                p = (1 − F) · D_wo(wm) |wi·wm| / (wi·wm + wo·wm/η')²
//! ```
//!
//! and transmitted radiance is divided by η'². An index of 1 is no interface at all, whatever the
//! roughness. Multiple scattering between microfacets is ignored. Sources: [Walter 2007],
//! [Pharr 2023 §9.5, §9.7].

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode, TrowbridgeReitz, fr_dielectric, reflect, refract};
use math::{Vec2, Vec3, Vector3, same_hemisphere, sqr};
use spectrum::SampledSpectrum;

/// An interface between dielectrics.
#[derive(Clone, Copy, Debug)]
pub struct Dielectric {
    /// Index of refraction below the surface over that above; > 0.
    pub eta: f32,
    /// Roughness.
    pub distribution: TrowbridgeReitz,
}

/// What turns `wo` into `wi`: microfacets of normal `wm` in the upper hemisphere.
struct Facet {
    wm: Vector3,
    /// The relative index met from `wo` to `wi`; `None` if the facet reflects.
    refraction: Option<f32>,
}

impl Dielectric {
    #[inline]
    fn is_specular(&self) -> bool {
        self.eta == 1.0 || self.distribution.effectively_smooth()
    }

    /// The facets that turn `wo` into `wi`, if there are any and both directions are on their front
    /// side.
    #[inline]
    fn facet(&self, wo: Vector3, wi: Vector3) -> Option<Facet> {
        if wo.z == 0.0 || wi.z == 0.0 {
            return None;
        }
        let refraction =
            (!same_hemisphere(wo, wi)).then_some(if wo.z > 0.0 { self.eta } else { 1.0 / self.eta });
        let wm = (wi * refraction.unwrap_or(1.0) + wo).try_normalize()?;
        let wm = if wm.z < 0.0 { -wm } else { wm };
        let front = wm.dot(wi) * wi.z >= 0.0 && wm.dot(wo) * wo.z >= 0.0;
        front.then_some(Facet { wm, refraction })
    }

    /// The value at `facet`, which reflects the share `fresnel`.
    #[inline]
    fn f_facet(&self, wo: Vector3, wi: Vector3, facet: &Facet, fresnel: f32, mode: TransportMode) -> f32 {
        let wm = facet.wm;
        let facets = self.distribution.d(wm) * self.distribution.g(wo, wi) / (wi.z * wo.z).abs();
        let Some(eta) = facet.refraction else { return 0.25 * facets * fresnel };
        let ft =
            facets * (1.0 - fresnel) * (wi.dot(wm) * wo.dot(wm)).abs() / sqr(wi.dot(wm) + wo.dot(wm) / eta);
        match mode {
            TransportMode::Radiance => ft / sqr(eta),
            TransportMode::Importance => ft,
        }
    }

    /// The density of `wi` where `facet` is sampled and reflects with probability `pr`.
    #[inline]
    fn pdf_facet(&self, wo: Vector3, wi: Vector3, facet: &Facet, pr: f32) -> f32 {
        let wm = facet.wm;
        let pdf_wm = self.distribution.pdf(wo, wm);
        match facet.refraction {
            None => pr * pdf_wm / (4.0 * wo.dot(wm).abs()),
            Some(eta) => (1.0 - pr) * pdf_wm * wi.dot(wm).abs() / sqr(wi.dot(wm) + wo.dot(wm) / eta),
        }
    }

    #[inline]
    fn sample_specular(
        &self,
        wo: Vector3,
        uc: f32,
        mode: TransportMode,
        directions: Directions,
    ) -> Option<BsdfSample> {
        let fresnel = if self.eta == 1.0 { 0.0 } else { fr_dielectric(wo.z, self.eta) };
        let pr = directions.probability_of_reflection(fresnel, 1.0 - fresnel)?;
        if uc < pr {
            let wi = Vec3::new(-wo.x, -wo.y, wo.z);
            let f = SampledSpectrum::splat(fresnel / wi.z.abs());
            return Some(BsdfSample::new(f, wi, pr, BxdfFlags::SPECULAR | BxdfFlags::REFLECTION));
        }
        let (wi, eta) = refract(wo, Vec3::Z, self.eta)?;
        let scale = match mode {
            TransportMode::Radiance => 1.0 / sqr(eta),
            TransportMode::Importance => 1.0,
        };
        let f = SampledSpectrum::splat(scale * (1.0 - fresnel) / wi.z.abs());
        let lobe = BxdfFlags::SPECULAR | BxdfFlags::TRANSMISSION;
        Some(BsdfSample { eta, ..BsdfSample::new(f, wi, 1.0 - pr, lobe) })
    }
}

impl Scatter for Dielectric {
    #[inline]
    fn flags(&self) -> BxdfFlags {
        let width = if self.is_specular() { BxdfFlags::SPECULAR } else { BxdfFlags::GLOSSY };
        let reflection = if self.eta == 1.0 { BxdfFlags::NONE } else { BxdfFlags::REFLECTION };
        width | reflection | BxdfFlags::TRANSMISSION
    }

    #[inline]
    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        if self.is_specular() {
            return SampledSpectrum::ZERO;
        }
        let Some(facet) = self.facet(wo, wi) else { return SampledSpectrum::ZERO };
        let fresnel = fr_dielectric(wo.dot(facet.wm), self.eta);
        SampledSpectrum::splat(self.f_facet(wo, wi, &facet, fresnel, mode))
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
        if wo.z == 0.0 {
            return None;
        }
        if self.is_specular() {
            return self.sample_specular(wo, uc, mode, directions);
        }
        let wm = self.distribution.sample_wm(wo, u);
        let fresnel = fr_dielectric(wo.dot(wm), self.eta);
        let pr = directions.probability_of_reflection(fresnel, 1.0 - fresnel)?;
        let (wi, refraction, lobe) = if uc < pr {
            (reflect(wo, wm), None, BxdfFlags::REFLECTION)
        } else {
            let (wi, eta) = refract(wo, wm, self.eta)?;
            (wi, Some(eta), BxdfFlags::TRANSMISSION)
        };
        if wi.z == 0.0 || same_hemisphere(wo, wi) != refraction.is_none() {
            return None;
        }
        let facet = Facet { wm, refraction };
        let f = SampledSpectrum::splat(self.f_facet(wo, wi, &facet, fresnel, mode));
        let pdf = self.pdf_facet(wo, wi, &facet, pr);
        Some(BsdfSample {
            eta: refraction.unwrap_or(1.0),
            ..BsdfSample::new(f, wi, pdf, BxdfFlags::GLOSSY | lobe)
        })
    }

    #[inline]
    fn pdf(&self, wo: Vector3, wi: Vector3, _: TransportMode, directions: Directions) -> f32 {
        if self.is_specular() {
            return 0.0;
        }
        let Some(facet) = self.facet(wo, wi) else { return 0.0 };
        let fresnel = fr_dielectric(wo.dot(facet.wm), self.eta);
        match directions.probability_of_reflection(fresnel, 1.0 - fresnel) {
            Some(pr) => self.pdf_facet(wo, wi, &facet, pr),
            None => 0.0,
        }
    }

    #[inline]
    fn regularize(&mut self) {
        self.distribution.regularize();
    }
}
