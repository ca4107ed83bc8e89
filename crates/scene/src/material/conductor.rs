//! Metals, smooth or rough.
//!
//! Parameters: the complex index of refraction η + ik over wavelength, default copper; or the
//! reflectance r at normal incidence, which is taken as η = 1, k = 2·√r/√(1 − r). Roughness,
//! default 0.

use super::{MaterialModel, Roughness};
use crate::texture::{SpectrumTextureId, TextureContext, Textures};
use lanes::Real;
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

impl MaterialModel for ConductorMaterial {
    type Bxdf<'a, R: Real> = Conductor<R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> Conductor<R> {
        let (eta, k) = match self.index {
            ConductorIndex::Complex { eta, k } => {
                (textures.spectrum(eta, context, lambda), textures.spectrum(k, context, lambda))
            }
            ConductorIndex::Reflectance(reflectance) => {
                // Just below 1, where k would be infinite.
                let r = textures.spectrum(reflectance, context, lambda);
                let r = r.clamp(R::zero(), R::splat(0.9999));
                let k = r.map(|r| R::splat(2.0) * r.sqrt() / (R::one() - r).sqrt());
                (SampledSpectrum::splat(R::one()), k)
            }
        };
        Conductor { distribution: self.roughness.distribution(textures, context), eta, k }
    }
}
