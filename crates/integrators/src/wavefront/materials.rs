//! The materials that are shaded in lanes.

use lanes::{Int, Real};
use scene::material::{Material, MaterialEntry, MaterialId};
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

    /// Those of a view.
    pub fn new(scene: &Scene, view: &View) -> Self {
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
                Material::Subsurface(_) | Material::Mix(_) | Material::Interface => (false, false),
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
