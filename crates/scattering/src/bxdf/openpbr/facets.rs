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
use lanes::{Callee, Mask, Real};
use math::sqr;
use spectrum::{N, SampledSpectrum};

/// μ (1 − μ)⁶ at the edge, μ = 1/7, where the tint is that of the model.
const AT_EDGE: f32 = 46_656.0 / 823_543.0;
/// (1 − μ)⁵ there.
const SCHLICK_AT_EDGE: f32 = 7_776.0 / 16_807.0;

impl<R: Real> OpenPbr<'_, R> {
    /// F₀ + (1 − F₀) x.
    #[inline(always)]
    fn schlick(&self, x: R) -> SampledSpectrum<R> {
        let mut schlick = self.metal.color;
        for f in &mut schlick.0 {
            *f = *f + (R::one() - *f) * x;
        }
        schlick
    }

    /// b of the tint; zero where there is none.
    #[inline(always)]
    fn dip(&self) -> SampledSpectrum<R> {
        let untinted = SampledSpectrum::splat(R::one()) - self.specular_color;
        self.schlick(R::splat(SCHLICK_AT_EDGE)) * untinted * R::splat(1.0 / AT_EDGE)
    }

    /// The reflectance of metal.
    #[inline(always)]
    pub(super) fn metal(&self, cosine: R) -> SampledSpectrum<R> {
        let grazing = R::one() - cosine;
        let power = sqr(sqr(grazing)) * grazing;
        let plain = self.schlick(power);
        let mut bare = (plain - self.dip() * (cosine * power * grazing)).clamp_zero();
        let is_filmed = self.stack.film_weight.gt(R::zero());
        if is_filmed.any() {
            let filmed = R::call(FilmedMetal { surface: self, cosine });
            let filmed = bare.lerp(filmed * bare.safe_div(plain), self.stack.film_weight);
            bare = SampledSpectrum::select(is_filmed, filmed, bare);
        }
        bare * self.metal.weight
    }

    /// The mean of [`Self::metal`] over directions by their cosine; under a film about that of the
    /// mean cosine.
    #[inline(always)]
    pub(super) fn mean_metal(&self) -> SampledSpectrum<R> {
        let bare = self.schlick(R::splat(1.0 / 21.0)) - self.dip() * R::splat(1.0 / 126.0);
        let mean = bare.clamp_zero() * self.metal.weight;
        let is_filmed = self.stack.film_weight.gt(R::zero());
        if !is_filmed.any() {
            return mean;
        }
        SampledSpectrum::select(is_filmed, self.metal(R::splat(2.0 / 3.0)), mean)
    }
}

/// The reflectance of the index that metal has under a film.
struct FilmedMetal<'b, 'a, R: Real> {
    surface: &'b OpenPbr<'a, R>,
    cosine: R,
}

impl<R: Real> Callee<R> for FilmedMetal<'_, '_, R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let Self { surface, cosine } = self;
        let stack = &surface.stack;
        let inner = stack.inner_cosine(cosine);
        let mut filmed = surface.waves;
        for i in 0..N {
            let reflected = surface.metal.color[i].min(R::splat(0.9999));
            let root = (reflected / (R::one() - reflected)).sqrt();
            let below = Complex { re: R::one(), im: R::splat(2.0) * root };
            filmed[i] = film_reflectance(inner, stack.above, stack.film_ior, below, surface.waves[i]);
        }
        filmed
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
