//! Materials. At one point and four wavelengths a material evaluates to a BxDF, returned by value.
//!
//! A material holds textures and spectra; [`Material::bxdf`] evaluates them at a point. `Mix`
//! chooses one of two materials at each point by a hash, and is resolved before that; `Interface`
//! has no BxDF: rays pass through it.

mod bump_map;
mod coat;
mod coat_normals;
mod coated_conductor;
mod coated_diffuse;
mod conductor;
mod dielectric;
mod diffuse;
mod diffuse_transmission;
mod dispersion;
mod hair;
mod measured;
mod mix;
mod normal_map;
mod openpbr;
mod roughness;
mod subsurface;
mod thin_dielectric;

pub use crate::id::MaterialId;
pub use bump_map::BumpMap;
pub use coat::Coat;
pub use coat_normals::CoatNormals;
pub use coated_conductor::CoatedConductorMaterial;
pub use coated_diffuse::CoatedDiffuseMaterial;
pub use conductor::{ConductorIndex, ConductorMaterial};
pub use dielectric::DielectricMaterial;
pub use diffuse::DiffuseMaterial;
pub use diffuse_transmission::DiffuseTransmissionMaterial;
pub use hair::{HairAbsorption, HairMaterial};
pub use measured::MeasuredMaterial;
pub use mix::MixMaterial;
pub use normal_map::NormalMap;
pub use openpbr::{OpenPbrMaterial, PlainOpenPbr};
pub use roughness::Roughness;
pub use subsurface::{SubsurfaceInside, SubsurfaceMaterial};
pub use thin_dielectric::ThinDielectricMaterial;

use crate::interaction::SurfaceInteraction;
use crate::texture::{TextureContext, Textures};
use description::Span;
use lanes::Real;
use scattering::{Bxdf, Scatter};
use spectrum::{SampledWavelengths, Spectrum};

/// The interface of a kind of material.
pub trait MaterialModel {
    /// Whether it takes so little time that a call for each hit would be seen.
    const IS_CHEAP: bool = false;

    /// Its BxDF.
    type Bxdf<'a, R: Real>: Scatter<R>
    where
        Self: 'a;

    /// The BxDF at a point, for each lane. Dispersive materials terminate the secondary
    /// wavelengths.
    fn bxdf<'a, R: Real>(
        &'a self,
        textures: &Textures,
        context: &TextureContext<R>,
        lambda: &mut SampledWavelengths<R>,
    ) -> Self::Bxdf<'a, R>;
}

/// One material.
#[derive(Clone, Debug)]
pub enum Material {
    /// See [`DiffuseMaterial`].
    Diffuse(DiffuseMaterial),
    /// See [`DiffuseTransmissionMaterial`].
    DiffuseTransmission(DiffuseTransmissionMaterial),
    /// See [`ConductorMaterial`].
    Conductor(ConductorMaterial),
    /// See [`DielectricMaterial`].
    Dielectric(DielectricMaterial),
    /// See [`ThinDielectricMaterial`].
    ThinDielectric(ThinDielectricMaterial),
    /// See [`CoatedDiffuseMaterial`].
    CoatedDiffuse(CoatedDiffuseMaterial),
    /// See [`CoatedConductorMaterial`].
    CoatedConductor(CoatedConductorMaterial),
    /// See [`HairMaterial`].
    Hair(HairMaterial),
    /// See [`MeasuredMaterial`].
    Measured(MeasuredMaterial),
    /// See [`SubsurfaceMaterial`].
    Subsurface(SubsurfaceMaterial),
    /// See [`OpenPbrMaterial`].
    OpenPbr(Box<OpenPbrMaterial>),
    /// See [`MixMaterial`].
    Mix(MixMaterial),
    /// Rays pass through; only the medium changes.
    Interface,
}

impl Material {
    /// The BxDF at a point. Dispersive materials terminate the secondary wavelengths. `None`: rays
    /// pass through the surface.
    #[inline]
    pub fn bxdf(
        &self,
        textures: &Textures,
        context: &TextureContext,
        lambda: &mut SampledWavelengths,
    ) -> Option<Bxdf<'_>> {
        match self {
            Self::Diffuse(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::DiffuseTransmission(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::Conductor(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::Dielectric(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::ThinDielectric(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::CoatedDiffuse(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::CoatedConductor(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::Hair(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::Measured(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::Subsurface(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::OpenPbr(m) => Some(m.bxdf(textures, context, lambda).into()),
            Self::Mix(_) | Self::Interface => None,
        }
    }

    /// Whether a path that does not scatter ends there with its wavelengths as they are: no ray
    /// passes through the material, and it is not dispersive.
    pub fn stops(&self, textures: &Textures) -> bool {
        match self {
            Self::Diffuse(_)
            | Self::DiffuseTransmission(_)
            | Self::Conductor(_)
            | Self::Hair(_)
            | Self::Measured(_)
            | Self::Subsurface(_) => true,
            Self::OpenPbr(m) => !m.may_disperse(textures),
            Self::Dielectric(m) => !is_dispersive(&m.eta),
            Self::ThinDielectric(m) => !is_dispersive(&m.eta),
            Self::CoatedDiffuse(m) => !m.coat.is_dispersive(),
            Self::CoatedConductor(m) => !m.coat.is_dispersive(),
            Self::Mix(_) | Self::Interface => false,
        }
    }
}

/// A material with what changes the normals of its surfaces: a row of the scene's [table of
/// materials](crate::Scene::materials).
#[derive(Clone, Debug)]
pub struct MaterialEntry {
    /// The material.
    pub material: Material,
    /// Its normal map, if it has one.
    pub normal_map: Option<NormalMap>,
    /// Its bump map, if it has one, and no normal map.
    pub bump_map: Option<BumpMap>,
    /// Where it is described; nowhere for the default material.
    pub span: Span,
}

/// The material at a point, after the choices of mixes.
#[inline]
pub(crate) fn resolve(
    materials: &[MaterialEntry],
    interaction: &SurfaceInteraction,
    textures: &Textures,
) -> MaterialId {
    let mut id = interaction.material;
    while let Material::Mix(mix) = &materials[id.0 as usize].material {
        id = mix.choose(interaction, textures);
    }
    id
}

/// An index of refraction at the first wavelength. Where it varies, the secondary wavelengths are
/// terminated, as they would refract in other directions.
#[inline(always)]
fn dispersed_index<R: Real>(eta: &Spectrum, lambda: &mut SampledWavelengths<R>) -> R {
    let index = eta.at(lambda.lambda()[0]);
    if is_dispersive(eta) {
        lambda.terminate_secondary();
    }
    // A spectrum is zero outside of its table, where the index is unknown.
    R::select(index.eq(R::zero()), R::one(), index)
}

/// Whether an index of refraction varies with the wavelength.
#[inline(always)]
fn is_dispersive(eta: &Spectrum) -> bool {
    !matches!(eta, Spectrum::Constant(_))
}
