//! Lambertian reflection and transmission: leaves, paper, lampshades.
//!
//! Parameters: reflectance and transmittance in [0, 1], default 0.25 each; a scale on both, default
//! 1.

use crate::texture::{SpectrumTextureId, TextureContext, Textures};
use scattering::DiffuseTransmission;
use spectrum::SampledWavelengths;

/// A matte, translucent surface.
#[derive(Clone, Debug)]
pub struct DiffuseTransmissionMaterial {
    /// Reflected share.
    pub reflectance: SpectrumTextureId,
    /// Transmitted share.
    pub transmittance: SpectrumTextureId,
    /// Factor on both.
    pub scale: f32,
}

impl DiffuseTransmissionMaterial {
    #[inline]
    pub(super) fn bxdf(
        &self,
        textures: &Textures,
        context: &TextureContext,
        lambda: &SampledWavelengths,
    ) -> DiffuseTransmission {
        let share = |texture| (textures.spectrum(texture, context, lambda) * self.scale).clamp(0.0, 1.0);
        DiffuseTransmission { reflectance: share(self.reflectance), transmittance: share(self.transmittance) }
    }
}
