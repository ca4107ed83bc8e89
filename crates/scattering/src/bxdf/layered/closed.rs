//! The closed form of a smooth clear coat over a diffuse base.
//!
//! The base spreads light evenly, whatever it reflects, so that each round of reflections between
//! base and coat keeps the same share: the albedo ρ of the base times the mean inner reflectance R̄
//! of the coat. With the transmittances T of the coat's surface and τ of its medium,
//!
//! ```text
//! f = T(θo) τ(θo') · ρ/(π η²) · (1 − (ρ R̄)ⁿ)/(1 − ρ R̄) · T(θi) τ(θi')
//! R̄ = ∫₀¹ 2μ R(μ) τ(μ)² dμ
//! ```
//!
//! where θ' are refracted angles and walks of at most n reflections by the base are counted.
//! Directions are sampled by their cosine, which takes the place of T τ. The sum over reflections
//! is that of [Saunderson 1942].

use super::{CoatedBase, Layered};
use crate::{BsdfSample, BxdfFlags, Directions, Scatter, TransportMode, fr_dielectric};
use lanes::{Real, exp, powi};
use math::{Vec2, Vector3, safe_sqrt, sqr};
use sampling::warp::{cosine_hemisphere_pdf, sample_cosine_hemisphere};
use spectrum::{N, SampledSpectrum};
use std::f32::consts::PI;

/// R̄: the share of uniform light from below that a smooth coat sends back, after it has crossed
/// the absorbing medium twice. `eta` > 0, `thickness` ≥ 0.
pub fn inner_reflectance(eta: f32, thickness: f32) -> f32 {
    const STEPS: usize = 512;
    let step = |i: usize| {
        let mu = (i as f32 + 0.5) / STEPS as f32;
        (2.0 * mu * fr_dielectric(-mu, eta) * lanes::exp(-2.0 * thickness / mu)) as f64
    };
    ((0..STEPS).map(step).sum::<f64>() / STEPS as f64) as f32
}

impl<R: Real, B: CoatedBase<R>> Layered<B, R> {
    /// The albedo of the base, and where there is a closed form.
    #[inline(always)]
    pub(super) fn closed_form(&self) -> (SampledSpectrum<R>, R::Mask) {
        let (albedo, is_even) = self.base.even_albedo();
        let is_clear = self.interface.flags().is_specular() & !self.has_medium();
        (albedo, is_even & is_clear & self.inner.ge(R::zero()))
    }

    /// The share of light that goes through the coat along `w`, which is above it.
    #[inline(always)]
    fn through(&self, w: Vector3<R>) -> R {
        let eta = self.interface.eta;
        let cosine = safe_sqrt(R::one() - (R::one() - sqr(w.z)) / sqr(eta));
        let absorbed = exp(-(self.thickness / cosine));
        let entering = (R::one() - fr_dielectric(w.z, eta)) * absorbed;
        R::select(cosine.gt(R::zero()), entering, R::zero())
    }

    /// f, for two directions above.
    #[inline(always)]
    pub(super) fn f_closed(
        &self,
        albedo: SampledSpectrum<R>,
        wo: Vector3<R>,
        wi: Vector3<R>,
    ) -> SampledSpectrum<R> {
        let rounds = self.max_depth.div_ceil(2).min(i32::MAX as u32) as i32;
        let mut f = albedo;
        for i in 0..N {
            let round = albedo[i] * self.inner;
            f[i] = albedo[i] * (R::one() - powi(round, rounds)) / (R::one() - round);
        }
        f * (self.through(wo) * self.through(wi) / (R::splat(PI) * sqr(self.interface.eta)))
    }

    /// The density of a direction above, for `wo` above.
    #[inline(always)]
    pub(super) fn pdf_closed(&self, wo: Vector3<R>, wi: Vector3<R>) -> R {
        (R::one() - fr_dielectric(wo.z, self.interface.eta)) * cosine_hemisphere_pdf(wi.z)
    }

    /// A sample for `wo` above.
    #[inline(always)]
    pub(super) fn sample_closed(
        &self,
        albedo: SampledSpectrum<R>,
        wo: Vector3<R>,
        uc: R,
        u: Vec2<R>,
        mode: TransportMode,
    ) -> BsdfSample<R> {
        let entrance = self.interface.sample_f(wo, uc, u, mode, Directions::All);
        let wi = sample_cosine_hemisphere(u);
        let (f, pdf) = (self.f_closed(albedo, wo, wi), self.pdf_closed(wo, wi));
        let below = BsdfSample::new(f, wi, pdf, BxdfFlags::splat(BxdfFlags::DIFFUSE_REFLECTION));
        let sample = BsdfSample::select(entrance.flags.is_reflective(), entrance, below);
        BsdfSample { valid: entrance.valid, ..sample }
    }
}
