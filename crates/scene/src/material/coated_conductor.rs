//! Metals under a coat: varnished brass, car paint without flakes.
//!
//! Parameters: those of the [metal](ConductorMaterial) and of its [`Coat`].

use super::{Coat, ConductorMaterial, MaterialModel};
use crate::texture::{TextureContext, Textures};
use lanes::Real;
use scattering::{Conductor, Layered};
use spectrum::SampledWavelengths;

/// A metal under a coat.
#[derive(Clone, Debug)]
pub struct CoatedConductorMaterial {
    /// The metal, with indices of refraction relative to air.
    pub base: ConductorMaterial,
    /// The coat.
    pub coat: Coat,
}

impl MaterialModel for CoatedConductorMaterial {
    type Bxdf<'a, R: Real> = Layered<Conductor<R>, R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> Self::Bxdf<'_, R> {
        let base = self.base.bxdf(textures, context, lambda);
        let index = self.coat.index(lambda);
        // Seen from within the coat.
        let base = Conductor { eta: base.eta / index, k: base.k / index, ..base };
        self.coat.over(textures, context, lambda, index, base)
    }
}
