//! The reflectance of the facets of the base, for an angle of incidence in air.
//!
//! Below a coat light meets the base at a smaller angle: sin θ' = sin θ/η_coat. Metal has the
//! reflectance of Schlick, with a tint near grazing angles (F82):
//!
//! ```text
//! F(μ) = F₀ + (1 − F₀)(1 − μ)⁵ − b μ (1 − μ)⁶        F(1/7) = tint · (F₀ + (1 − F₀)(6/7)⁵)
//! ```
//!
//! Under a film it has the index 1 + i k that reflects F₀ in air, as the model gives no index.
//! Sources: [Kutz 2021], [OpenPBR 2024].

use super::film::{Complex, film_reflectance};
use crate::fr_dielectric;
use math::{safe_sqrt, sqr};
use spectrum::SampledSpectrum;

/// A film on the base.
#[derive(Clone, Copy, Debug)]
pub(super) struct Film {
    /// Its presence in [0, 1].
    pub weight: f32,
    /// Its thickness in nanometres.
    pub thickness: f32,
    /// Its index of refraction.
    pub ior: f32,
    /// The wavelengths of the path, in nanometres.
    pub lambda: SampledSpectrum,
}

/// The facets of the base.
#[derive(Clone, Copy, Debug)]
pub(super) struct Facets {
    /// Index of refraction above: that of the coat where there is one.
    pub above: f32,
    /// Index of refraction of the dielectric for its reflection.
    pub below: f32,
    /// F₀ of metal.
    pub metal: SampledSpectrum,
    /// Its tint near grazing angles.
    pub edge: SampledSpectrum,
    /// Factor on the reflectance of metal.
    pub metal_weight: f32,
    /// On both.
    pub film: Film,
}

impl Facets {
    /// The cosine at which the base is met by light that meets the surface at `cosine` in air.
    pub fn inner_cosine(&self, cosine: f32) -> f32 {
        safe_sqrt(1.0 - (1.0 - sqr(cosine)) / sqr(self.above))
    }

    /// The reflectance under the film, if there is one, of an index for each wavelength.
    fn under_film(&self, cosine: f32, index: impl Fn(usize) -> Complex) -> SampledSpectrum {
        let Film { thickness, ior, lambda, .. } = self.film;
        let mut reflected = lambda;
        for i in 0..reflected.0.len() {
            reflected[i] = film_reflectance(cosine, self.above, ior, index(i), thickness / lambda[i]);
        }
        reflected
    }

    /// The reflectance of the dielectric.
    pub fn dielectric(&self, cosine: f32) -> SampledSpectrum {
        let cosine = self.inner_cosine(cosine);
        let bare = SampledSpectrum::splat(fr_dielectric(cosine, self.below / self.above));
        if self.film.weight == 0.0 {
            return bare;
        }
        bare.lerp(self.under_film(cosine, |_| Complex::real(self.below)), self.film.weight)
    }

    /// The reflectance of metal.
    pub fn metal(&self, cosine: f32) -> SampledSpectrum {
        const EDGE: f32 = 1.0 / 7.0;
        let one = SampledSpectrum::ONE;
        let schlick = |cosine: f32| self.metal + (one - self.metal) * (1.0 - cosine).powi(5);
        let dip = cosine * (1.0 - cosine).powi(6) / (EDGE * (1.0 - EDGE).powi(6));
        let bare = schlick(cosine) - schlick(EDGE) * (one - self.edge) * dip;
        let bare = bare.clamp_zero();
        if self.film.weight == 0.0 {
            return bare * self.metal_weight;
        }
        let index = |i: usize| {
            let reflected = self.metal[i].min(0.9999);
            Complex { re: 1.0, im: 2.0 * (reflected / (1.0 - reflected)).sqrt() }
        };
        let filmed = self.under_film(self.inner_cosine(cosine), index);
        let filmed = filmed * bare.safe_div(schlick(cosine));
        bare.lerp(filmed, self.film.weight) * self.metal_weight
    }
}
