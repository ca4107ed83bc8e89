//! The materials that are shaded in lanes.

use scene::material::{Material, MaterialEntry, MaterialId};
use scene::{Scene, View};

/// Which materials of a scene are shaded in lanes; the others are shaded path by path.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneMaterials(Vec<bool>);

impl LaneMaterials {
    /// Those of a view. Lanes have no footprints of pixels: where textures are filtered, only
    /// diffuse surfaces of one colour need none.
    pub fn new(scene: &Scene, view: &View) -> Self {
        let (with_footprints, textures) = (scene.needs_footprints(view), scene.textures());
        let is_in_lanes = |entry: &MaterialEntry| {
            let is_plain = entry.normal_map.is_none() && !view.options.force_diffuse;
            is_plain
                && match &entry.material {
                    Material::Diffuse(diffuse) => {
                        !with_footprints || textures.constant_spectrum(diffuse.reflectance).is_some()
                    }
                    Material::DiffuseTransmission(_)
                    | Material::Conductor(_)
                    | Material::Dielectric(_)
                    | Material::ThinDielectric(_) => !with_footprints,
                    Material::Mix(_) | Material::Interface => false,
                }
        };
        Self(scene.materials().iter().map(is_in_lanes).collect())
    }

    /// Whether a material is shaded in lanes.
    #[inline]
    pub fn contains(&self, id: MaterialId) -> bool {
        self.0[id.0 as usize]
    }
}
