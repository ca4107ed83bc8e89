//! Metal, glass, plastic, car paint, velvet: a principled surface after OpenPBR Surface.
//!
//! Parameters and their defaults are those of [`OpenPbrDesc`]. With `transmission_depth` light is
//! absorbed by the medium inside, if there is one, and not by the boundary. Dispersive glass has
//! Cauchy's index of refraction n = A + B/λ² by its Abbe number.

use super::dispersion::cauchy;
use super::{CoatNormals, MaterialModel};
use crate::texture::{FloatTextureId, SpectrumTextureId, TextureContext, Textures};
use description::OpenPbrDesc;
use lanes::{Mask, Real};
use scattering::{OpenPbr, OpenPbrParameters, OpenPbrTable};
use spectrum::{SampledSpectrum, SampledWavelengths};

/// The values of [`OpenPbrDesc::NUMBERS`].
type Numbers<R = f32> = [R; OpenPbrDesc::NUMBERS.len()];

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

/// What a principled surface is made of.
#[derive(Clone, Debug)]
pub struct PlainOpenPbr<'a> {
    /// The values of [`OpenPbrDesc::NUMBERS`] where they are the same everywhere.
    pub constants: &'a [f32; OpenPbrDesc::NUMBERS.len()],
    /// Those that are not, and their textures.
    pub varying: Vec<(usize, FloatTextureId)>,
    /// The textures of [`OpenPbrDesc::COLORS`].
    pub colors: &'a [SpectrumTextureId; OpenPbrDesc::COLORS.len()],
    /// The factors on the radius under its surface.
    pub radius_scale: SpectrumTextureId,
    /// Whether it is a wall without an inside.
    pub is_thin: bool,
    /// The normals of its coat, if they are others than those of the base.
    pub coat_normals: Option<&'a CoatNormals>,
    /// What its layers do with light.
    pub table: &'a OpenPbrTable,
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

    /// Whether secondary wavelengths may be terminated.
    pub fn may_disperse(&self, textures: &Textures) -> bool {
        let is_zero = |name| self.constant(textures, name) == Some(0.0);
        !(self.is_thin || is_zero("transmission_weight") || is_zero("transmission_dispersion_scale"))
    }

    /// What it is made of, for an engine that evaluates it elsewhere.
    pub fn plain(&self) -> PlainOpenPbr<'_> {
        let Self { numbers, constants, varying, colors, radius_scale, is_thin, table, .. } = self;
        let varying = varying.iter().map(|&i| (i, numbers[i])).collect();
        let coat_normals = self.coat_normals.as_ref();
        let (radius_scale, is_thin) = (*radius_scale, *is_thin);
        PlainOpenPbr { constants, varying, colors, radius_scale, is_thin, coat_normals, table }
    }

    /// Whether light may be scattered under the surface, to leave elsewhere.
    pub fn may_be_a_body(&self, textures: &Textures) -> bool {
        let is_zero = |name| self.constant(textures, name) == Some(0.0);
        !(self.is_thin || is_zero("subsurface_weight") || is_zero("subsurface_radius"))
    }

    /// A colour, where it is seen.
    #[inline(always)]
    fn color<R: Real>(
        &self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &SampledWavelengths<R>,
        id: SpectrumTextureId,
        is_seen: R::Mask,
    ) -> SampledSpectrum<R> {
        let white = SampledSpectrum::splat(R::one());
        if !is_seen.any() {
            return white;
        }
        let color = textures.spectrum(id, context, lambda).clamp(R::zero(), R::one());
        SampledSpectrum::select(is_seen, color, white)
    }
}

impl MaterialModel for OpenPbrMaterial {
    type Bxdf<'a, R: Real> = OpenPbr<'a, R>;

    #[inline(always)]
    fn bxdf<'a, R: Real>(
        &'a self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> OpenPbr<'a, R> {
        let zero = R::zero();
        let mut numbers = [zero; OpenPbrDesc::NUMBERS.len()];
        for (number, &constant) in numbers.iter_mut().zip(&self.constants) {
            *number = R::splat(constant);
        }
        for &i in &self.varying {
            let [least, most] = OpenPbrDesc::NUMBERS[i].range;
            let value = textures.float(self.numbers[i], context);
            numbers[i] = value.clamp(R::splat(least), R::splat(most));
        }
        let (mut p, transmission, radius) = parameters(&numbers);
        p.geometry_thin_walled = self.is_thin;
        let is_coated = p.coat_weight.gt(zero);
        if let Some(normals) = &self.coat_normals
            && is_coated.any()
        {
            p.geometry_coat_normal = normals.at(context.uv, is_coated);
        }
        let has_inside = R::Mask::splat(!self.is_thin);
        let transmits = p.transmission_weight.gt(zero);
        let scatters = p.subsurface_weight.gt(zero);
        // Colours that are not seen are not looked up.
        let [base, specular, transmitted, subsurface, coat, fuzz] = self.colors;
        p.base_color = self.color(textures, context, lambda, base, R::Mask::splat(true));
        p.specular_color = self.color(textures, context, lambda, specular, R::Mask::splat(true));
        let is_tinted = transmits & (!has_inside | transmission.depth.eq(zero));
        p.transmission_color = self.color(textures, context, lambda, transmitted, is_tinted);
        p.subsurface_color = self.color(textures, context, lambda, subsurface, scatters);
        let is_deep = scatters & has_inside & radius.gt(zero);
        if is_deep.any() {
            let deep = self.color(textures, context, lambda, self.radius_scale, is_deep) * radius;
            p.subsurface_radius = SampledSpectrum::select(is_deep, deep, p.subsurface_radius);
        }
        p.coat_color = self.color(textures, context, lambda, coat, is_coated);
        p.fuzz_color = self.color(textures, context, lambda, fuzz, p.fuzz_weight.gt(zero));
        let disperses = has_inside & transmits & transmission.dispersion_scale.gt(zero);
        if disperses.any() {
            let abbe_number = transmission.abbe_number / transmission.dispersion_scale;
            let index = cauchy(p.specular_ior, abbe_number, lambda.lambda()[0]).max(R::one());
            p.specular_ior = R::select(disperses, index, p.specular_ior);
            let mut first = *lambda;
            first.terminate_secondary();
            *lambda = SampledWavelengths::select(disperses, first, *lambda);
        }
        OpenPbr::new(&self.table, &p, lambda)
    }
}

/// The numbers of transmission that the BxDF does not know.
struct Transmission<R> {
    depth: R,
    dispersion_scale: R,
    abbe_number: R,
}

/// The index of a number.
fn position(name: &str) -> usize {
    let found = OpenPbrDesc::number(name);
    found.expect("invariant: names are those of the description")
}

/// The parameters of the BxDF, with colours of their defaults; and the radius under the surface.
#[inline(always)]
fn parameters<R: Real>(numbers: &Numbers<R>) -> (OpenPbrParameters<R>, Transmission<R>, R) {
    let mut p = OpenPbrParameters::default();
    let (depth, dispersion_scale, abbe_number, radius);
    [
        p.base_weight,
        p.base_diffuse_roughness,
        p.base_metalness,
        p.specular_weight,
        p.specular_roughness,
        p.specular_roughness_anisotropy,
        p.specular_ior,
        p.transmission_weight,
        depth,
        dispersion_scale,
        abbe_number,
        p.subsurface_weight,
        radius,
        p.subsurface_scatter_anisotropy,
        p.coat_weight,
        p.coat_roughness,
        p.coat_roughness_anisotropy,
        p.coat_ior,
        p.coat_darkening,
        p.fuzz_weight,
        p.fuzz_roughness,
        p.thin_film_weight,
        p.thin_film_thickness,
        p.thin_film_ior,
    ] = *numbers;
    (p, Transmission { depth, dispersion_scale, abbe_number }, radius)
}
