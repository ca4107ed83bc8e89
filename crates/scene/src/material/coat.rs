//! The coat of coated materials, a dielectric layer: varnish, lacquer, glaze.
//!
//! Parameters: index of refraction over wavelength, default 1.5 (one that varies disperses);
//! roughness of the outer surface, default 0; of the medium inside, its optical thickness, default
//! 0.01, its single-scattering albedo, default 0, and its asymmetry g in [−1, 1], default 0; the
//! number of events inside, default 10; the number of random walks per value, default 1.

use super::{Roughness, dispersed_index, is_dispersive};
use crate::texture::{FloatTextureId, SpectrumTextureId, TextureContext, Textures};
use lanes::{Int, Real};
use scattering::{Dielectric, HenyeyGreenstein, Layered};
use spectrum::{SampledWavelengths, Spectrum};

/// A dielectric layer.
#[derive(Clone, Debug)]
pub struct Coat {
    /// Index of refraction inside over that outside.
    pub eta: Spectrum,
    /// Roughness of the outer surface.
    pub roughness: Roughness,
    /// Optical thickness.
    pub thickness: FloatTextureId,
    /// Single-scattering albedo of the medium.
    pub albedo: SpectrumTextureId,
    /// Asymmetry of its phase function.
    pub g: FloatTextureId,
    /// The mean inner reflectance of the coat, if index and thickness are the same everywhere.
    pub inner: Option<f32>,
    /// The number of events inside, at most.
    pub max_depth: u32,
    /// Random walks per value.
    pub samples: u32,
}

impl Coat {
    /// Whether the index of refraction varies with the wavelength.
    pub(super) fn is_dispersive(&self) -> bool {
        is_dispersive(&self.eta)
    }

    /// The coat's index of refraction.
    #[inline(always)]
    pub(super) fn index<R: Real>(&self, lambda: &mut SampledWavelengths<R>) -> R {
        dispersed_index(&self.eta, lambda)
    }

    /// The coat of this index at a point, over a base.
    #[inline(always)]
    pub(super) fn over<B, R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
        eta: R,
        base: B,
    ) -> Layered<B, R> {
        let limit = R::splat(0.999);
        Layered {
            base,
            interface: Dielectric { eta, distribution: self.roughness.distribution(textures, context) },
            thickness: textures.float(self.thickness, context).max(R::zero()),
            albedo: textures.spectrum(self.albedo, context, lambda).clamp(R::zero(), R::one()),
            phase: HenyeyGreenstein { g: textures.float(self.g, context).clamp(-limit, limit) },
            inner: R::splat(self.inner.unwrap_or(-1.0)),
            max_depth: self.max_depth,
            samples: self.samples,
            seed: R::Int::splat(0),
        }
    }
}
