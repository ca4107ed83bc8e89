//! Metal, glass, plastic, car paint, velvet: a principled surface after OpenPBR Surface.
//!
//! Parameters and their defaults are those of [`OpenPbrDesc`]. With `transmission_depth` light is
//! absorbed by the medium inside, if there is one, and not by the boundary. Dispersive glass has
//! Cauchy's index of refraction n = A + B/λ² by its Abbe number.

use crate::texture::{FloatTextureId, SpectrumTextureId, TextureContext, Textures};
use description::OpenPbrDesc;
use math::sqr;
use scattering::{OpenPbr, OpenPbrParameters};
use spectrum::{SampledSpectrum, SampledWavelengths};

/// The Fraunhofer lines F, d and C, in nanometres.
const LINES: [f32; 3] = [486.134, 587.562, 656.281];

/// A principled surface.
#[derive(Clone, Debug)]
pub struct OpenPbrMaterial {
    /// The values of [`OpenPbrDesc::NUMBERS`].
    pub numbers: [FloatTextureId; OpenPbrDesc::NUMBERS.len()],
    /// The values of [`OpenPbrDesc::COLORS`].
    pub colors: [SpectrumTextureId; OpenPbrDesc::COLORS.len()],
}

/// The index of refraction at a wavelength, of a glass of index `ior` at the d line.
fn cauchy(ior: f32, abbe_number: f32, lambda: f32) -> f32 {
    let [f, d, c] = LINES.map(|line| 1.0 / sqr(line));
    ior + (ior - 1.0) / (abbe_number * (f - c)) * (1.0 / sqr(lambda) - d)
}

impl OpenPbrMaterial {
    /// The number of a name that is constant.
    fn constant(&self, textures: &Textures, name: &str) -> Option<f32> {
        let index = OpenPbrDesc::NUMBERS.iter().position(|number| number.name == name)?;
        textures.constant(self.numbers[index])
    }

    /// Whether the BxDF may be specular somewhere.
    pub(super) fn may_be_specular(&self, textures: &Textures) -> bool {
        // α below 0.001 counts as smooth.
        let may_be_smooth = |name| self.constant(textures, name).is_none_or(|roughness| roughness < 0.032);
        let is_coated = self.constant(textures, "coat_weight") != Some(0.0);
        may_be_smooth("specular_roughness") || is_coated && may_be_smooth("coat_roughness")
    }

    /// Whether secondary wavelengths may be terminated.
    pub(super) fn may_disperse(&self, textures: &Textures) -> bool {
        let is_zero = |name| self.constant(textures, name) == Some(0.0);
        !(is_zero("transmission_weight") || is_zero("transmission_dispersion_scale"))
    }

    /// Its BxDF.
    #[inline]
    pub fn bxdf(
        &self,
        textures: &Textures,
        context: &TextureContext,
        lambda: &mut SampledWavelengths,
    ) -> OpenPbr {
        let [
            base_weight,
            base_diffuse_roughness,
            base_metalness,
            specular_weight,
            specular_roughness,
            specular_roughness_anisotropy,
            mut specular_ior,
            transmission_weight,
            transmission_depth,
            dispersion_scale,
            abbe_number,
            subsurface_weight,
            coat_weight,
            coat_roughness,
            coat_roughness_anisotropy,
            coat_ior,
            coat_darkening,
            fuzz_weight,
            fuzz_roughness,
            thin_film_weight,
            thin_film_thickness,
            thin_film_ior,
        ] = std::array::from_fn(|i| {
            let [least, most] = OpenPbrDesc::NUMBERS[i].range;
            textures.float(self.numbers[i], context).clamp(least, most)
        });
        let [base_color, specular_color, mut transmission_color, subsurface_color, coat_color, fuzz_color] =
            self.colors.map(|id| textures.spectrum(id, context, lambda).clamp(0.0, 1.0));
        if dispersion_scale > 0.0 && transmission_weight > 0.0 {
            specular_ior = cauchy(specular_ior, abbe_number / dispersion_scale, lambda.lambda()[0]).max(1.0);
            lambda.terminate_secondary();
        }
        if transmission_depth > 0.0 {
            transmission_color = SampledSpectrum::ONE;
        }
        let parameters = OpenPbrParameters {
            base_weight,
            base_color,
            base_diffuse_roughness,
            base_metalness,
            specular_weight,
            specular_color,
            specular_roughness,
            specular_roughness_anisotropy,
            specular_ior,
            transmission_weight,
            transmission_color,
            subsurface_weight,
            subsurface_color,
            coat_weight,
            coat_color,
            coat_roughness,
            coat_roughness_anisotropy,
            coat_ior,
            coat_darkening,
            fuzz_weight,
            fuzz_color,
            fuzz_roughness,
            thin_film_weight,
            thin_film_thickness,
            thin_film_ior,
        };
        OpenPbr::new(&parameters, lambda)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_follow_the_abbe_number() {
        let [f, d, c] = LINES.map(|line| cauchy(1.6, 30.0, line));
        assert!((d - 1.6).abs() < 1e-6);
        assert!(((d - 1.0) / (f - c) - 30.0).abs() < 0.01, "{f} {c}");
    }
}
