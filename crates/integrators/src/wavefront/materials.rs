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
    rows: Vec<Row>,
    /// For each geometry its material, if all hits on it are shaded in lanes and no light, or else
    /// [`DEPENDS`](Self::DEPENDS); then [`NOTHING`](Self::NOTHING).
    of_geometry: Vec<u32>,
}

#[derive(Clone, Copy, Debug)]
struct Row {
    shading: Shading,
    may_be_specular: bool,
}

impl LaneMaterials {
    /// In place of the material of geometries of which not all hits are alike.
    pub const DEPENDS: u32 = u32::MAX - 1;
    /// In place of the material where there is no hit.
    pub const NOTHING: u32 = u32::MAX;

    /// Those of a view.
    pub fn new(scene: &Scene, view: &View) -> Self {
        let (with_footprints, textures) = (scene.needs_footprints(view), scene.textures());
        let row = |entry: &MaterialEntry| {
            let is_plain =
                entry.normal_map.is_none() && entry.bump_map.is_none() && !view.options.force_diffuse;
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
                Material::OpenPbr(surface) => {
                    (!(surface.may_be_a_body(textures) || surface.has_coat_normals()), false)
                }
                Material::Subsurface(_) | Material::Mix(_) | Material::Interface => (false, false),
            };
            let may_be_specular = entry.material.may_be_specular(textures);
            let shading = match (is_plain && is_in_lanes, with_footprints && !is_constant) {
                (false, _) => Shading::Scalar,
                (true, false) => Shading::Lanes,
                (true, true) => Shading::LanesWithFootprint,
            };
            Row { shading, may_be_specular }
        };
        let rows: Vec<Row> = scene.materials().iter().map(row).collect();
        let of_geometry = |entry: &GeometryEntry| {
            let Row { shading, may_be_specular } = rows[entry.material.0 as usize];
            let is_in_lanes = shading != Shading::Scalar && !(may_be_specular && with_footprints);
            if is_in_lanes && entry.first_light.is_none() { entry.material.0 } else { Self::DEPENDS }
        };
        let of_geometry = scene.geometries().iter().map(of_geometry).chain([Self::NOTHING]).collect();
        Self { rows, of_geometry }
    }

    /// The materials of geometries, where they tell how all hits on them are shaded.
    #[inline(always)]
    pub fn of_geometries<R: Real>(&self, geometry: R::Int) -> R::Int {
        let last = R::Int::splat(self.of_geometry.len() as u32 - 1);
        R::Int::gather(&self.of_geometry, R::Int::select(geometry.lt(last), geometry, last))
    }

    /// How the hit of a path with or without ray differentials is shaded: differentials go on only
    /// from specular scattering, and that is not computed in lanes.
    #[inline]
    pub fn shading(&self, id: MaterialId, has_differentials: bool) -> Shading {
        let Row { shading, may_be_specular } = self.rows[id.0 as usize];
        if may_be_specular && has_differentials { Shading::Scalar } else { shading }
    }
}
