//! The spectral weights of a path through media.

use spectrum::SampledSpectrum;

/// The spectral weights of a path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Throughput {
    /// β: the measured contribution over the density of the hero.
    pub beta: SampledSpectrum,
    /// The density of the path at each wavelength over that of the hero.
    pub r_u: SampledSpectrum,
    /// The density of light sampling, without that of the light's point, over that of the hero.
    pub r_l: SampledSpectrum,
}

impl Throughput {
    /// That of a path that begins with a contribution of 1.
    pub const ONE: Self =
        Self { beta: SampledSpectrum::ONE, r_u: SampledSpectrum::ONE, r_l: SampledSpectrum::ONE };

    /// Passes a distance with the given transmittance, with the density `sampled`. Shadow rays pass
    /// it with the density `by_shadow_rays`.
    #[inline]
    pub(super) fn pass(
        &mut self,
        transmittance: SampledSpectrum,
        by_shadow_rays: SampledSpectrum,
        sampled: f32,
    ) {
        self.beta *= transmittance / sampled;
        self.r_u *= transmittance / sampled;
        self.r_l *= by_shadow_rays / sampled;
    }

    /// The estimate of light that only this path's own sampling finds.
    #[inline]
    pub fn estimate(&self, l: SampledSpectrum, heroes: &Heroes) -> SampledSpectrum {
        self.beta * l / heroes.mean(self.r_u)
    }
}

/// The densities of spectral MIS of a path between two vertices, whose β is its estimate: those of
/// [`Throughput`] over the mean of r_u.
#[derive(Clone, Copy, Debug)]
pub(crate) struct SpectralMis {
    pub heroes: Heroes,
    pub r_u: SampledSpectrum,
    pub r_l: SampledSpectrum,
}

impl SpectralMis {
    /// Of a path that has not flown.
    pub fn new(heroes: Heroes) -> Self {
        Self { heroes, r_u: SampledSpectrum::ONE, r_l: SampledSpectrum::ONE }
    }
}

/// The wavelength that chooses collisions, among those that could have.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Heroes {
    /// The probability of each to be the hero.
    probabilities: SampledSpectrum,
    /// The hero.
    pub hero: usize,
}

impl Heroes {
    /// Any of the four, chosen by `u`.
    pub fn any(u: f32) -> Self {
        Self::any_as(((u * spectrum::N as f32) as usize).min(spectrum::N - 1))
    }

    /// Any of the four, which is this one.
    pub fn any_as(hero: usize) -> Self {
        Self { probabilities: SampledSpectrum::splat(1.0 / spectrum::N as f32), hero }
    }

    /// The first, once dispersion has terminated the others.
    pub fn first() -> Self {
        let mut probabilities = SampledSpectrum::ZERO;
        probabilities[0] = 1.0;
        Self { probabilities, hero: 0 }
    }

    /// One chosen by `u` in proportion to a throughput that is not black; the first once dispersion
    /// has terminated the others.
    pub fn by_throughput(beta: SampledSpectrum, is_first_only: bool, u: f32) -> Self {
        let sum = beta.average() * spectrum::N as f32;
        if is_first_only || !(sum > 0.0 && sum.is_finite()) {
            return Self::first();
        }
        let probabilities = beta / sum;
        let (mut hero, mut rest) = (0, u);
        while hero + 1 < spectrum::N && rest >= probabilities[hero] {
            rest -= probabilities[hero];
            hero += 1;
        }
        // Rounding may lead past the last of them.
        while probabilities[hero] == 0.0 {
            hero -= 1;
        }
        Self { probabilities, hero }
    }

    /// The mean of densities over the wavelengths that could have chosen the path.
    #[inline]
    pub fn mean(&self, densities: SampledSpectrum) -> f32 {
        (densities * self.probabilities).average() * spectrum::N as f32
    }
}
