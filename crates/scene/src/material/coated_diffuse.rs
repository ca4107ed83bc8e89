//! Matte surfaces under a coat: plastic, painted wood, glazed ceramics.
//!
//! Parameters: reflectance of the surface in [0, 1], default 0.5; those of its [`Coat`].

use super::{Coat, DiffuseMaterial, MaterialModel};
use crate::texture::{TextureContext, Textures};
use lanes::Real;
use scattering::{Diffuse, Layered};
use spectrum::SampledWavelengths;

/// A matte surface under a coat.
#[derive(Clone, Debug)]
pub struct CoatedDiffuseMaterial {
    /// The surface.
    pub base: DiffuseMaterial,
    /// The coat.
    pub coat: Coat,
}

impl MaterialModel for CoatedDiffuseMaterial {
    type Bxdf<'a, R: Real> = Layered<Diffuse<R>, R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> Self::Bxdf<'_, R> {
        let base = self.base.bxdf(textures, context, lambda);
        let index = self.coat.index(lambda);
        self.coat.over(textures, context, lambda, index, base)
    }
}
