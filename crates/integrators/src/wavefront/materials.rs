//! The materials that are shaded in lanes.

use scene::material::{Material, MaterialEntry, MaterialId};
use scene::{Scene, View};

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
pub(super) struct LaneMaterials(Vec<Row>);

#[derive(Clone, Copy, Debug)]
struct Row {
    shading: Shading,
    may_be_specular: bool,
}

impl LaneMaterials {
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
                | Material::CoatedConductor(_) => (true, false),
                // Curves, which hair is on, are not in lanes; nor are lookups in large tables.
                Material::Hair(_)
                | Material::Measured(_)
                | Material::Subsurface(_)
                | Material::OpenPbr(_)
                | Material::Mix(_)
                | Material::Interface => (false, false),
            };
            let may_be_specular = entry.material.may_be_specular(textures);
            let shading = match (is_plain && is_in_lanes, with_footprints && !is_constant) {
                (false, _) => Shading::Scalar,
                (true, false) => Shading::Lanes,
                (true, true) => Shading::LanesWithFootprint,
            };
            Row { shading, may_be_specular }
        };
        Self(scene.materials().iter().map(row).collect())
    }

    /// How the hit of a path with or without ray differentials is shaded: differentials go on only
    /// from specular scattering, and that is not computed in lanes.
    #[inline]
    pub fn shading(&self, id: MaterialId, has_differentials: bool) -> Shading {
        let Row { shading, may_be_specular } = self.0[id.0 as usize];
        if may_be_specular && has_differentials { Shading::Scalar } else { shading }
    }
}
