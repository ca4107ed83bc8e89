//! The reflectance of metal, for an angle of incidence in air.
//!
//! Metal has the reflectance of Schlick, with a tint near grazing angles (F82):
//!
//! ```text
//! F(μ) = F₀ + (1 − F₀)(1 − μ)⁵ − b μ (1 − μ)⁶        F(1/7) = tint · (F₀ + (1 − F₀)(6/7)⁵)
//! ```
//!
//! whose mean over directions by their cosine is F₀ + (1 − F₀)/21 − b/126. Under a film it has the
//! index 1 + i k that reflects F₀ in air, as the model gives no index. Sources: [Kutz 2021],
//! [OpenPBR 2024].

use super::OpenPbr;
use super::film::{Complex, film_reflectance};
use math::sqr;
use spectrum::SampledSpectrum;

/// μ (1 − μ)⁶ at the edge, μ = 1/7, where the tint is that of the model.
const AT_EDGE: f32 = 46_656.0 / 823_543.0;
/// (1 − μ)⁵ there.
const SCHLICK_AT_EDGE: f32 = 7_776.0 / 16_807.0;

impl OpenPbr<'_> {
    /// F₀ + (1 − F₀) x.
    #[inline]
    fn schlick(&self, x: f32) -> SampledSpectrum {
        self.metal_color.map(|f| f + (1.0 - f) * x)
    }

    /// b of the tint, where there is one.
    #[inline]
    fn dip(&self) -> Option<SampledSpectrum> {
        let tint = self.specular_color;
        (tint != SampledSpectrum::ONE)
            .then(|| self.schlick(SCHLICK_AT_EDGE) * (SampledSpectrum::ONE - tint) * (1.0 / AT_EDGE))
    }

    /// The reflectance of metal.
    #[inline]
    pub(super) fn metal(&self, cosine: f32) -> SampledSpectrum {
        let grazing = 1.0 - cosine;
        let power = sqr(sqr(grazing)) * grazing;
        let plain = self.schlick(power);
        let mut bare = plain;
        if let Some(dip) = self.dip() {
            bare = (bare - dip * (cosine * power * grazing)).clamp_zero();
        }
        if self.stack.film_weight > 0.0 {
            let inner = self.stack.inner_cosine(cosine);
            let mut filmed = self.waves;
            for i in 0..filmed.0.len() {
                let reflected = self.metal_color[i].min(0.9999);
                let below = Complex { re: 1.0, im: 2.0 * (reflected / (1.0 - reflected)).sqrt() };
                filmed[i] =
                    film_reflectance(inner, self.stack.above, self.stack.film_ior, below, self.waves[i]);
            }
            bare = bare.lerp(filmed * bare.safe_div(plain), self.stack.film_weight);
        }
        bare * self.metal_weight
    }

    /// The mean of [`Self::metal`] over directions by their cosine; under a film about that of the
    /// mean cosine.
    #[inline]
    pub(super) fn mean_metal(&self) -> SampledSpectrum {
        if self.stack.film_weight > 0.0 {
            return self.metal(2.0 / 3.0);
        }
        let mut mean = self.schlick(1.0 / 21.0);
        if let Some(dip) = self.dip() {
            mean = (mean - dip * (1.0 / 126.0)).clamp_zero();
        }
        mean * self.metal_weight
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_constants_are_those_of_the_edge() {
        const EDGE: f32 = 1.0 / 7.0;
        let powers = [EDGE * (1.0 - EDGE).powi(6), (1.0 - EDGE).powi(5)];
        assert!((powers[0] - AT_EDGE).abs() < 1e-6 && (powers[1] - SCHLICK_AT_EDGE).abs() < 1e-6);
    }
}
