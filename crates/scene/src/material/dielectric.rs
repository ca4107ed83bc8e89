//! Glass, water, clear coats: reflection and refraction, smooth or rough.
//!
//! Parameters: index of refraction over wavelength, default 1.5; roughness, default 0. An index
//! that varies with wavelength disperses: the path continues with one wavelength only.

use super::{Roughness, dispersed_index};
use crate::texture::{TextureContext, Textures};
use scattering::Dielectric;
use spectrum::{SampledWavelengths, Spectrum};

/// The surface of a transparent body.
#[derive(Clone, Debug)]
pub struct DielectricMaterial {
    /// Index of refraction inside over that outside.
    pub eta: Spectrum,
    /// Surface roughness.
    pub roughness: Roughness,
}

impl DielectricMaterial {
    #[inline]
    pub(super) fn bxdf(
        &self,
        textures: &Textures,
        context: &TextureContext,
        lambda: &mut SampledWavelengths,
    ) -> Dielectric {
        let eta = dispersed_index(&self.eta, lambda);
        Dielectric { eta, distribution: self.roughness.distribution(textures, context) }
    }
}
