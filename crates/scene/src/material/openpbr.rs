//! Metal, glass, plastic, car paint, velvet: a principled surface after OpenPBR Surface.
//!
//! Parameters and their defaults are those of [`OpenPbrDesc`]. With `transmission_depth` light is
//! absorbed by the medium inside, if there is one, and not by the boundary. Dispersive glass has
//! Cauchy's index of refraction n = A + B/λ² by its Abbe number.

use super::CoatNormals;
use crate::texture::{FloatTextureId, SpectrumTextureId, TextureContext, Textures};
use description::OpenPbrDesc;
use math::sqr;
use scattering::{OpenPbr, OpenPbrParameters, OpenPbrTable};
use spectrum::{SampledSpectrum, SampledWavelengths};

/// The Fraunhofer lines F, d and C, in nanometres.
const LINES: [f32; 3] = [486.134, 587.562, 656.281];

/// The values of [`OpenPbrDesc::NUMBERS`].
type Numbers = [f32; OpenPbrDesc::NUMBERS.len()];

/// A principled surface.
#[derive(Clone, Debug)]
pub struct OpenPbrMaterial {
    /// The textures of [`OpenPbrDesc::NUMBERS`].
    numbers: [FloatTextureId; OpenPbrDesc::NUMBERS.len()],
    /// Their values where they are the same everywhere.
    constants: Numbers,
    /// Which are not.
    varying: Vec<usize>,
    /// The textures of [`OpenPbrDesc::COLORS`].
    colors: [SpectrumTextureId; OpenPbrDesc::COLORS.len()],
    /// Factors on the radius under the surface.
    radius_scale: SpectrumTextureId,
    is_thin: bool,
    /// Of its coat, if they are others than those of the base.
    coat_normals: Option<CoatNormals>,
    /// What its layers do with light.
    table: OpenPbrTable,
}

/// The index of refraction at a wavelength, of a glass of index `ior` at the d line.
fn cauchy(ior: f32, abbe_number: f32, lambda: f32) -> f32 {
    let [f, d, c] = LINES.map(|line| 1.0 / sqr(line));
    ior + (ior - 1.0) / (abbe_number * (f - c)) * (1.0 / sqr(lambda) - d)
}

impl OpenPbrMaterial {
    /// Of the textures of its numbers and colours, in the order of the description, of the factors
    /// on its radius, and the normals of its coat, if they are others than those of the base.
    pub fn new(
        textures: &Textures,
        numbers: [FloatTextureId; OpenPbrDesc::NUMBERS.len()],
        colors: [SpectrumTextureId; OpenPbrDesc::COLORS.len()],
        radius_scale: SpectrumTextureId,
        is_thin: bool,
        coat_normals: Option<CoatNormals>,
    ) -> Self {
        let ranges: [[f32; 2]; _] = std::array::from_fn(|i| {
            let [least, most] = OpenPbrDesc::NUMBERS[i].range;
            textures.constant(numbers[i]).map_or([least, most], |value| [value.clamp(least, most); 2])
        });
        let varying = (0..numbers.len()).filter(|&i| textures.constant(numbers[i]).is_none()).collect();
        let constants = ranges.map(|[least, _]| least);
        let index = if is_thin { ranges[position("specular_ior")] } else { Self::index_range(&ranges) };
        let ends = [0, 1].map(|end| {
            let values = ranges.map(|range| range[end]);
            let (mut parameters, ..) = parameters(&values);
            parameters.specular_ior = index[end];
            parameters.geometry_thin_walled = is_thin;
            parameters
        });
        let table = OpenPbrTable::new(&ends[0], &ends[1]);
        Self { numbers, constants, varying, colors, radius_scale, is_thin, coat_normals, table }
    }

    /// The least and the largest index of refraction at all wavelengths.
    fn index_range(ranges: &[[f32; 2]; OpenPbrDesc::NUMBERS.len()]) -> [f32; 2] {
        let of = |name| ranges[position(name)];
        let (index, scale) = (of("specular_ior"), of("transmission_dispersion_scale"));
        if of("transmission_weight")[1] == 0.0 || scale[1] == 0.0 {
            return index;
        }
        let abbe_number = of("transmission_dispersion_abbe_number")[0] / scale[1];
        let most = cauchy(index[1], abbe_number, spectrum::LAMBDA_MIN);
        let least = cauchy(index[0], abbe_number, spectrum::LAMBDA_MAX).max(1.0);
        [least, most]
    }

    /// The number of a name that is constant.
    fn constant(&self, textures: &Textures, name: &str) -> Option<f32> {
        textures.constant(self.numbers[position(name)])
    }

    /// Whether the BxDF may be specular somewhere.
    pub(super) fn may_be_specular(&self, textures: &Textures) -> bool {
        // α below 0.001 counts as smooth.
        let may_be_smooth = |name| self.constant(textures, name).is_none_or(|roughness| roughness < 0.032);
        let is_coated = self.constant(textures, "coat_weight") != Some(0.0);
        // Sheets spread what they transmit less than what they reflect, if at all.
        if self.is_thin && self.constant(textures, "transmission_weight") != Some(0.0) {
            return true;
        }
        may_be_smooth("specular_roughness") || is_coated && may_be_smooth("coat_roughness")
    }

    /// Whether secondary wavelengths may be terminated.
    pub(super) fn may_disperse(&self, textures: &Textures) -> bool {
        let is_zero = |name| self.constant(textures, name) == Some(0.0);
        !(self.is_thin || is_zero("transmission_weight") || is_zero("transmission_dispersion_scale"))
    }

    /// Its BxDF.
    #[inline]
    pub fn bxdf(
        &self,
        textures: &Textures,
        context: &TextureContext,
        lambda: &mut SampledWavelengths,
    ) -> OpenPbr<'_> {
        let mut numbers = self.constants;
        for &i in &self.varying {
            let [least, most] = OpenPbrDesc::NUMBERS[i].range;
            numbers[i] = textures.float(self.numbers[i], context).clamp(least, most);
        }
        let (mut p, transmission, radius) = parameters(&numbers);
        p.geometry_thin_walled = self.is_thin;
        if let Some(normals) = self.coat_normals.as_ref().filter(|_| p.coat_weight > 0.0) {
            p.geometry_coat_normal = normals.at(context.uv);
        }
        // Colours that are not seen are not looked up.
        let [base, specular, transmitted, subsurface, coat, fuzz] = self.colors;
        let color = |id, is_seen| match is_seen {
            true => textures.spectrum(id, context, lambda).clamp(0.0, 1.0),
            false => SampledSpectrum::ONE,
        };
        p.base_color = color(base, true);
        p.specular_color = color(specular, true);
        p.transmission_color =
            color(transmitted, p.transmission_weight > 0.0 && (self.is_thin || transmission.depth == 0.0));
        p.subsurface_color = color(subsurface, p.subsurface_weight > 0.0);
        if p.subsurface_weight > 0.0 && radius > 0.0 && !self.is_thin {
            p.subsurface_radius = color(self.radius_scale, true) * radius;
        }
        p.coat_color = color(coat, p.coat_weight > 0.0);
        p.fuzz_color = color(fuzz, p.fuzz_weight > 0.0);
        if transmission.dispersion_scale > 0.0 && p.transmission_weight > 0.0 && !self.is_thin {
            let abbe_number = transmission.abbe_number / transmission.dispersion_scale;
            p.specular_ior = cauchy(p.specular_ior, abbe_number, lambda.lambda()[0]).max(1.0);
            lambda.terminate_secondary();
        }
        OpenPbr::new(&self.table, &p, lambda)
    }
}

/// The numbers of transmission that the BxDF does not know.
struct Transmission {
    depth: f32,
    dispersion_scale: f32,
    abbe_number: f32,
}

/// The index of a number.
fn position(name: &str) -> usize {
    let found = OpenPbrDesc::NUMBERS.iter().position(|number| number.name == name);
    found.expect("invariant: names are those of the description")
}

/// The parameters of the BxDF, with colours of their defaults; and the radius under the surface.
#[inline]
fn parameters(numbers: &Numbers) -> (OpenPbrParameters, Transmission, f32) {
    let [
        base_weight,
        base_diffuse_roughness,
        base_metalness,
        specular_weight,
        specular_roughness,
        specular_roughness_anisotropy,
        specular_ior,
        transmission_weight,
        depth,
        dispersion_scale,
        abbe_number,
        subsurface_weight,
        radius,
        subsurface_scatter_anisotropy,
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
    ] = *numbers;
    let parameters = OpenPbrParameters {
        base_weight,
        base_diffuse_roughness,
        base_metalness,
        specular_weight,
        specular_roughness,
        specular_roughness_anisotropy,
        specular_ior,
        transmission_weight,
        subsurface_weight,
        subsurface_scatter_anisotropy,
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
        ..OpenPbrParameters::default()
    };
    (parameters, Transmission { depth, dispersion_scale, abbe_number }, radius)
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
