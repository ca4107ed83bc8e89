//! The parameters of the model, under their names in the specification.

use math::{Vec3, Vector3};
use spectrum::SampledSpectrum;

/// What a surface is, at a point and the wavelengths of a path. Weights, colours and roughnesses
/// lie in [0, 1], indices are at least 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenPbrParameters {
    /// Factor on the base colour of diffuse bases and metals.
    pub base_weight: f32,
    /// Albedo of the diffuse base; reflectance of metal at normal incidence.
    pub base_color: SampledSpectrum,
    /// Roughness of the diffuse base.
    pub base_diffuse_roughness: f32,
    /// The share of metal.
    pub base_metalness: f32,
    /// Factor on the reflectance of the base's boundary at normal incidence.
    pub specular_weight: f32,
    /// Tint of the boundary's reflection; of metal, near grazing angles.
    pub specular_color: SampledSpectrum,
    /// Roughness of the base's boundary: the root of α.
    pub specular_roughness: f32,
    /// From a round highlight to a stroke.
    pub specular_roughness_anisotropy: f32,
    /// Index of refraction of the dielectric base, at the first wavelength.
    pub specular_ior: f32,
    /// The share of the dielectric base that is transparent.
    pub transmission_weight: f32,
    /// Factor on the light that is transmitted.
    pub transmission_color: SampledSpectrum,
    /// The share of the opaque dielectric base that scatters under its surface.
    pub subsurface_weight: f32,
    /// Albedo of that share.
    pub subsurface_color: SampledSpectrum,
    /// The mean free path there; zero: light leaves where it entered.
    pub subsurface_radius: SampledSpectrum,
    /// The mean cosine of scattering there, in (−1, 1); of light that is scattered in a thin wall,
    /// from all reflected, −1, to all transmitted, 1.
    pub subsurface_scatter_anisotropy: f32,
    /// Presence of the coat.
    pub coat_weight: f32,
    /// Factor on light that crosses the coat twice along the normal.
    pub coat_color: SampledSpectrum,
    /// Roughness of the coat.
    pub coat_roughness: f32,
    /// Its anisotropy.
    pub coat_roughness_anisotropy: f32,
    /// Its index of refraction.
    pub coat_ior: f32,
    /// How far reflections inside the coat darken the base.
    pub coat_darkening: f32,
    /// Its normal, where that of the base is z: of length 1, and above.
    pub geometry_coat_normal: Vector3,
    /// Presence of fuzz.
    pub fuzz_weight: f32,
    /// Albedo of its fibres.
    pub fuzz_color: SampledSpectrum,
    /// Roughness: from fibres that stand to flakes of any direction.
    pub fuzz_roughness: f32,
    /// Presence of a thin film on the base.
    pub thin_film_weight: f32,
    /// Its thickness in micrometres.
    pub thin_film_thickness: f32,
    /// Its index of refraction.
    pub thin_film_ior: f32,
    /// Whether the surface is a sheet without an inside.
    pub geometry_thin_walled: bool,
}

impl Default for OpenPbrParameters {
    /// The defaults of the specification.
    fn default() -> Self {
        Self {
            base_weight: 1.0,
            base_color: SampledSpectrum::splat(0.8),
            base_diffuse_roughness: 0.0,
            base_metalness: 0.0,
            specular_weight: 1.0,
            specular_color: SampledSpectrum::ONE,
            specular_roughness: 0.3,
            specular_roughness_anisotropy: 0.0,
            specular_ior: 1.5,
            transmission_weight: 0.0,
            transmission_color: SampledSpectrum::ONE,
            subsurface_weight: 0.0,
            subsurface_color: SampledSpectrum::splat(0.8),
            subsurface_radius: SampledSpectrum::ZERO,
            subsurface_scatter_anisotropy: 0.0,
            coat_weight: 0.0,
            coat_color: SampledSpectrum::ONE,
            coat_roughness: 0.0,
            coat_roughness_anisotropy: 0.0,
            coat_ior: 1.6,
            coat_darkening: 1.0,
            geometry_coat_normal: Vec3::Z,
            fuzz_weight: 0.0,
            fuzz_color: SampledSpectrum::ONE,
            fuzz_roughness: 0.5,
            thin_film_weight: 0.0,
            thin_film_thickness: 0.5,
            thin_film_ior: 1.4,
            geometry_thin_walled: false,
        }
    }
}
