//! Hair and fur, on curves whose v goes across the fibre.
//!
//! Parameters: the absorption, by its coefficient per radius of the fibre, by the colour of a
//! volume of hair, or by concentrations of pigments; index of refraction, default 1.55;
//! longitudinal and azimuthal roughness in (0, 1], default 0.3; angle of the scales in degrees,
//! default 2.

use super::MaterialModel;
use crate::texture::{FloatTextureId, SpectrumTextureId, SpectrumType, TextureContext, Textures};
use lanes::Real;
use scattering::Hair;
use spectrum::{RgbColorSpace, SampledSpectrum, SampledWavelengths};

/// A fibre.
#[derive(Clone, Debug)]
pub struct HairMaterial {
    /// Its absorption.
    pub absorption: HairAbsorption,
    /// Index of refraction.
    pub eta: FloatTextureId,
    /// Longitudinal roughness.
    pub beta_m: FloatTextureId,
    /// Azimuthal roughness.
    pub beta_n: FloatTextureId,
    /// Angle of the scales in degrees.
    pub alpha: FloatTextureId,
}

/// How the absorption of hair is given.
#[derive(Clone, Copy, Debug)]
pub enum HairAbsorption {
    /// By its coefficient per radius of the fibre.
    Coefficient(SpectrumTextureId),
    /// By the colour of a volume of hair.
    Color(SpectrumTextureId),
    /// By concentrations of pigments.
    Pigments {
        /// Brown and black.
        eumelanin: FloatTextureId,
        /// Red and yellow.
        pheomelanin: FloatTextureId,
    },
}

/// Absorption by a unit of eumelanin and of pheomelanin, in red, green and blue of sRGB
/// ([dEon 2011 §6.1], [Pharr 2023 §9.9.7]).
const PIGMENTS: [[f32; 3]; 2] = [[0.419, 0.697, 1.37], [0.187, 0.4, 1.05]];

impl HairMaterial {
    #[inline(always)]
    fn sigma_a<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &SampledWavelengths<R>,
        beta_n: R,
    ) -> SampledSpectrum<R> {
        match self.absorption {
            HairAbsorption::Coefficient(sigma_a) => textures.spectrum(sigma_a, context, lambda).clamp_zero(),
            HairAbsorption::Color(color) => {
                let color = textures.spectrum(color, context, lambda).clamp(R::zero(), R::one());
                Hair::sigma_a_from_reflectance(color, beta_n)
            }
            HairAbsorption::Pigments { eumelanin, pheomelanin } => {
                let brown = textures.float(eumelanin, context).max(R::zero());
                let red = textures.float(pheomelanin, context).max(R::zero());
                let mut rgb = [R::zero(); 3];
                for i in 0..3 {
                    rgb[i] = brown * R::splat(PIGMENTS[0][i]) + red * R::splat(PIGMENTS[1][i]);
                }
                SpectrumType::Unbounded.sample_rgb(RgbColorSpace::srgb(), rgb, lambda)
            }
        }
    }
}

impl MaterialModel for HairMaterial {
    type Bxdf<'a, R: Real> = Hair<R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> Hair<R> {
        // Without a closure, which would be called without the instruction set.
        let least = R::splat(1e-2);
        let beta_m = textures.float(self.beta_m, context).clamp(least, R::one());
        let beta_n = textures.float(self.beta_n, context).clamp(least, R::one());
        let eta = textures.float(self.eta, context).max(R::splat(1e-2));
        let alpha = textures.float(self.alpha, context);
        let sigma_a = self.sigma_a(textures, context, lambda, beta_n);
        let h = context.uv.y * R::splat(2.0) - R::one();
        Hair::new(h, eta, sigma_a, [beta_m, beta_n], alpha)
    }
}
