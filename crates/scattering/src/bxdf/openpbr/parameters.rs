//! The parameters of the model, under their names in the specification.

use lanes::Real;
use math::{Vec3, Vector3};
use spectrum::SampledSpectrum;

/// What a surface is, at a point and the wavelengths of a path. Weights, colours and roughnesses
/// lie in [0, 1], indices are at least 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OpenPbrParameters<R = f32> {
    /// Factor on the base colour of diffuse bases and metals.
    pub base_weight: R,
    /// Albedo of the diffuse base; reflectance of metal at normal incidence.
    pub base_color: SampledSpectrum<R>,
    /// Roughness of the diffuse base.
    pub base_diffuse_roughness: R,
    /// The share of metal.
    pub base_metalness: R,
    /// Factor on the reflectance of the base's boundary at normal incidence.
    pub specular_weight: R,
    /// Tint of the boundary's reflection; of metal, near grazing angles.
    pub specular_color: SampledSpectrum<R>,
    /// Roughness of the base's boundary: the root of α.
    pub specular_roughness: R,
    /// From a round highlight to a stroke.
    pub specular_roughness_anisotropy: R,
    /// Index of refraction of the dielectric base, at the first wavelength.
    pub specular_ior: R,
    /// The share of the dielectric base that is transparent.
    pub transmission_weight: R,
    /// Factor on the light that is transmitted.
    pub transmission_color: SampledSpectrum<R>,
    /// The share of the opaque dielectric base that scatters under its surface.
    pub subsurface_weight: R,
    /// Albedo of that share.
    pub subsurface_color: SampledSpectrum<R>,
    /// The mean free path there; zero: light leaves where it entered.
    pub subsurface_radius: SampledSpectrum<R>,
    /// The mean cosine of scattering there, in (−1, 1); of light that is scattered in a thin wall,
    /// from all reflected, −1, to all transmitted, 1.
    pub subsurface_scatter_anisotropy: R,
    /// Presence of the coat.
    pub coat_weight: R,
    /// Factor on light that crosses the coat twice along the normal.
    pub coat_color: SampledSpectrum<R>,
    /// Roughness of the coat.
    pub coat_roughness: R,
    /// Its anisotropy.
    pub coat_roughness_anisotropy: R,
    /// Its index of refraction.
    pub coat_ior: R,
    /// How far reflections inside the coat darken the base.
    pub coat_darkening: R,
    /// Its normal, where that of the base is z: of length 1, and above.
    pub geometry_coat_normal: Vector3<R>,
    /// Presence of fuzz.
    pub fuzz_weight: R,
    /// Albedo of its fibres.
    pub fuzz_color: SampledSpectrum<R>,
    /// Roughness: from fibres that stand to flakes of any direction.
    pub fuzz_roughness: R,
    /// Presence of a thin film on the base.
    pub thin_film_weight: R,
    /// Its thickness in micrometres.
    pub thin_film_thickness: R,
    /// Its index of refraction.
    pub thin_film_ior: R,
    /// Whether the surface is a sheet without an inside.
    pub geometry_thin_walled: bool,
}

impl<R: Real> Default for OpenPbrParameters<R> {
    /// The defaults of the specification.
    #[inline(always)]
    fn default() -> Self {
        let c = R::splat;
        Self {
            base_weight: R::one(),
            base_color: SampledSpectrum::splat(c(0.8)),
            base_diffuse_roughness: R::zero(),
            base_metalness: R::zero(),
            specular_weight: R::one(),
            specular_color: SampledSpectrum::splat(R::one()),
            specular_roughness: c(0.3),
            specular_roughness_anisotropy: R::zero(),
            specular_ior: c(1.5),
            transmission_weight: R::zero(),
            transmission_color: SampledSpectrum::splat(R::one()),
            subsurface_weight: R::zero(),
            subsurface_color: SampledSpectrum::splat(c(0.8)),
            subsurface_radius: SampledSpectrum::zero(),
            subsurface_scatter_anisotropy: R::zero(),
            coat_weight: R::zero(),
            coat_color: SampledSpectrum::splat(R::one()),
            coat_roughness: R::zero(),
            coat_roughness_anisotropy: R::zero(),
            coat_ior: c(1.6),
            coat_darkening: R::one(),
            geometry_coat_normal: Vec3::broadcast(Vec3::Z),
            fuzz_weight: R::zero(),
            fuzz_color: SampledSpectrum::splat(R::one()),
            fuzz_roughness: c(0.5),
            thin_film_weight: R::zero(),
            thin_film_thickness: c(0.5),
            thin_film_ior: c(1.4),
            geometry_thin_walled: false,
        }
    }
}
