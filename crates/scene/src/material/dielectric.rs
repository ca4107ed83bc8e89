//! Glass, water, clear coats: reflection and refraction, smooth or rough.
//!
//! Parameters: index of refraction over wavelength, default 1.5; roughness, default 0. An index
//! that varies with wavelength disperses: the path continues with one wavelength only.

use super::{MaterialModel, Roughness, dispersed_index};
use crate::texture::{TextureContext, Textures};
use lanes::Real;
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

impl MaterialModel for DielectricMaterial {
    type Bxdf<'a, R: Real> = Dielectric<R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> Dielectric<R> {
        let eta = dispersed_index(&self.eta, lambda);
        Dielectric { eta, distribution: self.roughness.distribution(textures, context) }
    }
}
