//! Metals, smooth or rough.
//!
//! Parameters: the complex index of refraction η + ik over wavelength, default copper; or the
//! reflectance r at normal incidence, which is taken as η = 1, k = 2·√r/√(1 − r). Roughness,
//! default 0.

use super::Roughness;
use crate::texture::{SpectrumTextureId, TextureContext, Textures};
use scattering::Conductor;
use spectrum::{SampledSpectrum, SampledWavelengths};

/// A metal.
#[derive(Clone, Debug)]
pub struct ConductorMaterial {
    /// Index of refraction.
    pub index: ConductorIndex,
    /// Surface roughness.
    pub roughness: Roughness,
}

/// How the reflectance of a metal is given.
#[derive(Clone, Copy, Debug)]
pub enum ConductorIndex {
    /// By its index of refraction.
    Complex {
        /// Real part.
        eta: SpectrumTextureId,
        /// Imaginary part.
        k: SpectrumTextureId,
    },
    /// By its reflectance at normal incidence.
    Reflectance(SpectrumTextureId),
}

impl ConductorMaterial {
    #[inline]
    pub(super) fn bxdf(
        &self,
        textures: &Textures,
        context: &TextureContext,
        lambda: &SampledWavelengths,
    ) -> Conductor {
        let (eta, k) = match self.index {
            ConductorIndex::Complex { eta, k } => {
                (textures.spectrum(eta, context, lambda), textures.spectrum(k, context, lambda))
            }
            ConductorIndex::Reflectance(reflectance) => {
                // Just below 1, where k would be infinite.
                let r = textures.spectrum(reflectance, context, lambda).clamp(0.0, 0.9999);
                (SampledSpectrum::ONE, r.map(|r| 2.0 * r.sqrt() / (1.0 - r).sqrt()))
            }
        };
        Conductor { distribution: self.roughness.distribution(textures, context), eta, k }
    }
}
