//! The materials that are shaded in lanes.

use lanes::{Int, Real};
use scattering::SubsurfaceMethod;
use scene::material::{Material, MaterialEntry, MaterialId, SubsurfaceInside, SubsurfaceMaterial};
use scene::texture::Textures;
use scene::{GeometryEntry, Scene, View};

/// How the hits of a material are shaded.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Shading {
    /// Path by path.
    Scalar,
    /// In lanes.
    Lanes,
    /// In lanes, with the footprint of the pixel.
    LanesWithFootprint,
}

/// How the materials of a scene are shaded.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneMaterials {
    shading: Vec<Shading>,
    /// For each geometry its material, if all hits on it are shaded in lanes and no light, or else
    /// [`DEPENDS`](Self::DEPENDS); then [`NOTHING`](Self::NOTHING).
    of_geometry: Vec<u32>,
}

impl LaneMaterials {
    /// In place of the material of geometries of which not all hits are alike.
    pub const DEPENDS: u32 = u32::MAX - 1;
    /// In place of the material where there is no hit.
    pub const NOTHING: u32 = u32::MAX;

    /// The materials of a view, for an algorithm that follows paths under surfaces in lanes or not.
    pub fn new(scene: &Scene, view: &View, follows_bodies: bool) -> Self {
        let (with_footprints, textures) = (scene.needs_footprints(view), scene.textures());
        let shading = |entry: &MaterialEntry| {
            let (is_in_lanes, is_constant) = match &entry.material {
                Material::Diffuse(diffuse) => (true, textures.is_constant(diffuse.reflectance)),
                Material::DiffuseTransmission(_)
                | Material::Conductor(_)
                | Material::Dielectric(_)
                | Material::ThinDielectric(_)
                | Material::CoatedDiffuse(_)
                | Material::CoatedConductor(_)
                | Material::Hair(_) => (true, false),
                Material::Measured(_) => (true, true),
                Material::OpenPbr(surface) => (!surface.may_be_a_body(textures), false),
                // Where paths enter bodies no footprints are known.
                Material::Subsurface(body) => {
                    let is_plain = !with_footprints || is_constant(body, textures);
                    let diffuses = body.method == SubsurfaceMethod::Diffusion;
                    (follows_bodies && diffuses && is_plain, true)
                }
                Material::Mix(_) | Material::Interface => (false, false),
            };
            match (!view.options.force_diffuse && is_in_lanes, with_footprints && !is_constant) {
                (false, _) => Shading::Scalar,
                (true, false) => Shading::Lanes,
                (true, true) => Shading::LanesWithFootprint,
            }
        };
        let shading: Vec<Shading> = scene.materials().iter().map(shading).collect();
        let of_geometry = |entry: &GeometryEntry| {
            let MaterialId(id) = entry.material;
            let is_in_lanes = shading[id as usize] != Shading::Scalar;
            if is_in_lanes && entry.first_light.is_none() { id } else { Self::DEPENDS }
        };
        let of_geometry = scene.geometries().iter().map(of_geometry).chain([Self::NOTHING]).collect();
        Self { shading, of_geometry }
    }

    /// The materials of geometries, where they tell how all hits on them are shaded.
    #[inline(always)]
    pub fn of_geometries<R: Real>(&self, geometry: R::Int) -> R::Int {
        let last = R::Int::splat(self.of_geometry.len() as u32 - 1);
        R::Int::gather(&self.of_geometry, R::Int::select(geometry.lt(last), geometry, last))
    }

    /// How hits on a material are shaded.
    #[inline]
    pub fn shading(&self, MaterialId(id): MaterialId) -> Shading {
        self.shading[id as usize]
    }
}

/// Whether a body is the same everywhere.
fn is_constant(body: &SubsurfaceMaterial, textures: &Textures) -> bool {
    let spectra = match body.inside {
        SubsurfaceInside::Coefficients { sigma_a, sigma_s, .. } => [sigma_a, sigma_s],
        SubsurfaceInside::Reflectance { reflectance, mfp, .. } => [reflectance, mfp],
    };
    let roughness = [body.roughness.u, body.roughness.v];
    spectra.into_iter().all(|id| textures.is_constant(id))
        && roughness.into_iter().all(|id| textures.constant(id).is_some())
}
