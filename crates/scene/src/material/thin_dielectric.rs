//! A thin pane: both interfaces in one surface, which light passes without changing direction.
//!
//! Parameter: index of refraction over wavelength, default 1.5.

use super::{MaterialModel, dispersed_index};
use crate::texture::{TextureContext, Textures};
use lanes::Real;
use scattering::ThinDielectric;
use spectrum::{SampledWavelengths, Spectrum};

/// A pane of glass without thickness.
#[derive(Clone, Debug)]
pub struct ThinDielectricMaterial {
    /// Index of refraction.
    pub eta: Spectrum,
}

impl MaterialModel for ThinDielectricMaterial {
    type Bxdf<'a, R: Real> = ThinDielectric<R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        _textures: &Textures,
        _context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> ThinDielectric<R> {
        ThinDielectric { eta: dispersed_index(&self.eta, lambda) }
    }
}
