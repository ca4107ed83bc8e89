//! Lambertian reflection: f = ρ/π.
//!
//! Parameter: reflectance ρ in [0, 1], default 0.5.

use super::MaterialModel;
use crate::texture::{SpectrumTextureId, TextureContext, Textures};
use lanes::Real;
use scattering::Diffuse;
use spectrum::SampledWavelengths;

/// A matte surface.
#[derive(Clone, Debug)]
pub struct DiffuseMaterial {
    /// Albedo.
    pub reflectance: SpectrumTextureId,
}

impl MaterialModel for DiffuseMaterial {
    const IS_CHEAP: bool = true;

    type Bxdf<'a, R: Real> = Diffuse<R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> Diffuse<R> {
        let reflectance = textures.spectrum(self.reflectance, context, lambda);
        Diffuse { reflectance: reflectance.clamp(R::zero(), R::one()) }
    }
}
