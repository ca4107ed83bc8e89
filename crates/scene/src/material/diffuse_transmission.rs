//! Lambertian reflection and transmission: leaves, paper, lampshades.
//!
//! Parameters: reflectance and transmittance in [0, 1], default 0.25 each; a scale on both, default
//! 1.

use super::MaterialModel;
use crate::texture::{SpectrumTextureId, TextureContext, Textures};
use lanes::Real;
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

impl MaterialModel for DiffuseTransmissionMaterial {
    type Bxdf<'a, R: Real> = DiffuseTransmission<R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> DiffuseTransmission<R> {
        let reflectance = textures.spectrum(self.reflectance, context, lambda) * R::splat(self.scale);
        let transmittance = textures.spectrum(self.transmittance, context, lambda) * R::splat(self.scale);
        let (zero, one) = (R::zero(), R::one());
        DiffuseTransmission {
            reflectance: reflectance.clamp(zero, one),
            transmittance: transmittance.clamp(zero, one),
        }
    }
}
