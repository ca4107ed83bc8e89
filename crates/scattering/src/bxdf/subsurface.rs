//! The surface of a body that scatters light under it, as if light left where it entered: the
//! reflection by the boundary, and a diffuse base that reflects the effective albedo ρ,
//!
//! ```text
//! f = f_boundary + (1 − Fr(ωo)) ρ (1 − Fr(ωi))/(c π)
//! ```
//!
//! the limit of a short mean free path. Algorithms that follow paths under the surface take the
//! boundary and the [`Bssrdf`] apart. The body is opaque from inside.

use super::{BsdfSample, Dielectric, NormalizedFresnel, Scatter};
use crate::{Bssrdf, BxdfFlags, Directions, TransportMode, fr_dielectric};
use math::{Vec2, Vector3};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::SampledSpectrum;

/// How light is followed under a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SubsurfaceMethod {
    /// By the diffusion profile of a half space.
    #[default]
    Diffusion,
    /// By a random walk.
    RandomWalk,
}

/// A boundary and what is under it.
#[derive(Clone, Copy, Debug)]
pub struct Subsurface<'a> {
    /// The boundary.
    pub boundary: Dielectric,
    /// Scattering under it, of a medium with the boundary's index of refraction.
    pub bssrdf: Bssrdf<'a>,
    /// How light is followed under it.
    pub method: SubsurfaceMethod,
}

impl Subsurface<'_> {
    /// The base with its albedo.
    fn base(&self) -> (NormalizedFresnel, SampledSpectrum) {
        (self.bssrdf.exit(), self.bssrdf.effective_albedo())
    }

    /// The probability to sample the boundary, and not the base, of an albedo.
    fn boundary_probability(&self, wo: Vector3, albedo: SampledSpectrum) -> f32 {
        if !self.boundary.flags().is_reflective() {
            return 0.0;
        }
        let reflected = fr_dielectric(wo.z, self.boundary.eta);
        let (all, _) =
            Directions::All.probability_of_reflection(reflected, (1.0 - reflected) * albedo.average());
        if reflected > 0.0 { all } else { 0.0 }
    }

    /// The value of the base.
    fn diffused(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        let (lobe, albedo) = self.base();
        lobe.f(wo, wi, mode) * albedo * (1.0 - fr_dielectric(wo.z, self.boundary.eta))
    }
}

impl Scatter for Subsurface<'_> {
    fn flags(&self) -> BxdfFlags {
        let kinds = [BxdfFlags::GLOSSY_REFLECTION, BxdfFlags::SPECULAR_REFLECTION];
        let boundary = self.boundary.flags();
        let reflects = kinds.into_iter().find(|&kind| boundary.contains(kind));
        reflects.unwrap_or(BxdfFlags::NONE) | BxdfFlags::DIFFUSE_REFLECTION
    }

    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        if !(wo.z > 0.0 && wi.z > 0.0) {
            return SampledSpectrum::ZERO;
        }
        self.boundary.f(wo, wi, mode) + self.diffused(wo, wi, mode)
    }

    fn sample_f(
        &self,
        wo: Vector3,
        uc: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample {
        if !(wo.z > 0.0 && directions.reflection()) {
            return BsdfSample::invalid();
        }
        let p = self.boundary_probability(wo, self.bssrdf.effective_albedo());
        let (wi, lobe) = if uc < p {
            let mirrored = self.boundary.sample_f(wo, uc / p, u, mode, Directions::Reflection);
            if mirrored.flags.is_specular() || !mirrored.valid {
                return BsdfSample { pdf: mirrored.pdf * p, ..mirrored };
            }
            (mirrored.wi, mirrored.flags)
        } else {
            (sample_cosine_hemisphere(u), BxdfFlags::DIFFUSE_REFLECTION)
        };
        let pdf = self.pdf(wo, wi, mode, directions);
        BsdfSample { valid: pdf > 0.0, ..BsdfSample::new(self.f(wo, wi, mode), wi, pdf, lobe) }
    }

    fn pdf(&self, wo: Vector3, wi: Vector3, mode: TransportMode, directions: Directions) -> f32 {
        if !(wo.z > 0.0 && wi.z > 0.0 && directions.reflection()) {
            return 0.0;
        }
        let p = self.boundary_probability(wo, self.bssrdf.effective_albedo());
        let boundary = self.boundary.pdf(wo, wi, mode, Directions::Reflection);
        p * boundary + (1.0 - p) * cosine_hemisphere_pdf(wi.z)
    }

    fn regularize(&mut self, mask: bool) {
        self.boundary.regularize(mask);
    }
}
