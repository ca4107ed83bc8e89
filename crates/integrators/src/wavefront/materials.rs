//! The materials that are shaded in lanes.

use scene::material::{Material, MaterialId};
use scene::texture::Code;
use scene::{Scene, View};

/// A material in the form that lanes need.
#[derive(Clone, Debug)]
pub(super) enum LaneMaterial {
    /// Lambertian reflection with the same albedo everywhere.
    Diffuse {
        /// The albedo, in the table of spectra.
        reflectance: u32,
    },
}

/// The materials of a scene that are shaded in lanes; the others are shaded path by path.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneMaterials(Vec<Option<LaneMaterial>>);

impl LaneMaterials {
    pub fn new(scene: &Scene, view: &View) -> Self {
        if view.options.force_diffuse {
            return Self::default();
        }
        let constant = |texture: scene::texture::SpectrumTextureId| {
            let textures = scene.textures();
            let program = textures.programs()[texture.0 as usize];
            let operations = &textures.operations()[program.first as usize..][..program.length as usize];
            match operations {
                [only] => match only.code {
                    Code::Spectrum(index) => Some(index),
                    _ => None,
                },
                _ => None,
            }
        };
        let material = |entry: &scene::material::MaterialEntry| match &entry.material {
            Material::Diffuse(diffuse) if entry.normal_map.is_none() => {
                constant(diffuse.reflectance).map(|reflectance| LaneMaterial::Diffuse { reflectance })
            }
            _ => None,
        };
        Self(scene.materials().iter().map(material).collect())
    }

    /// Whether a material is shaded in lanes.
    #[inline]
    pub fn is_in_lanes(&self, id: MaterialId) -> bool {
        self.get(id).is_some()
    }

    /// A material in the form that lanes need.
    pub fn get(&self, id: MaterialId) -> Option<&LaneMaterial> {
        self.0.get(id.0 as usize)?.as_ref()
    }
}
