//! Lambertian reflection: f = ρ/π.
//!
//! Parameter: reflectance ρ in [0, 1], default 0.5.

use crate::texture::{SpectrumTextureId, TextureContext, Textures};
use scattering::Diffuse;
use spectrum::SampledWavelengths;

/// A matte surface.
#[derive(Clone, Debug)]
pub struct DiffuseMaterial {
    /// Albedo.
    pub reflectance: SpectrumTextureId,
}

impl DiffuseMaterial {
    #[inline]
    pub(super) fn bxdf(
        &self,
        textures: &Textures,
        context: &TextureContext,
        lambda: &SampledWavelengths,
    ) -> Diffuse {
        Diffuse { reflectance: textures.spectrum(self.reflectance, context, lambda).clamp(0.0, 1.0) }
    }
}
