//! The JSON text as arrays of objects, and the extensions that it needs.

use serde_json::Value;

use super::json::{Fault, Place, Result};
use crate::log::Log;

/// The extensions that are read, or that change nothing for a renderer that does not cull.
const EXTENSIONS: [&str; 26] = [
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "KHR_lights_punctual",
    "KHR_materials_anisotropy",
    "KHR_materials_clearcoat",
    "KHR_materials_diffuse_transmission",
    "KHR_materials_dispersion",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_iridescence",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_variants",
    "KHR_materials_volume",
    "KHR_mesh_quantization",
    "KHR_meshopt_compression",
    "KHR_node_hoverability",
    "KHR_node_selectability",
    "KHR_node_visibility",
    "KHR_texture_transform",
    "KHR_xmp",
    "KHR_xmp_json_ld",
];

/// Extensions that optional features of the build read.
const OPTIONAL: [(&str, &str, bool); 2] = [
    ("KHR_draco_mesh_compression", "draco", cfg!(feature = "draco")),
    ("KHR_texture_basisu", "basis", cfg!(feature = "basis")),
];

/// The arrays of the text.
const ARRAYS: [&str; 14] = [
    "accessors",
    "animations",
    "buffers",
    "bufferViews",
    "cameras",
    "images",
    "materials",
    "meshes",
    "nodes",
    "samplers",
    "scenes",
    "skins",
    "textures",
    "extensionsUsed",
];

/// The text of a file.
#[derive(Clone, Copy, Debug)]
pub(super) struct Document<'a> {
    root: &'a Value,
}

impl<'a> Document<'a> {
    /// A text whose version and required extensions are known. What else is wrong with its outline
    /// is reported.
    pub fn new(root: &'a Value, log: &mut Log) -> Result<Self> {
        let place = Place::root(root);
        let asset = place.required("asset")?;
        let version = asset.string("version")?.ok_or_else(|| asset.invalid("`version` is missing"))?;
        let least = asset.string("minVersion")?.unwrap_or(version);
        let number = |text: &str| {
            let (major, minor) = text.split_once('.')?;
            Some((major.parse::<u32>().ok()?, minor.parse::<u32>().ok()?))
        };
        let is_known = number(version).is_some_and(|(major, _)| major == 2)
            && number(least).is_some_and(|least| least <= (2, 0) && Some(least) <= number(version));
        if !is_known {
            let message = format!("this is glTF of version `{version}`; read is 2.0");
            return Err(Fault::new("gltf-version", "/asset/version", message));
        }
        let document = Self { root };
        for required in place.array("extensionsRequired")? {
            let Some(name) = required.value.as_str() else {
                return Err(required.invalid("this must be a string"));
            };
            if let Some(unread) = unread(name) {
                let message = format!("the file requires the extension `{name}`, which {unread}");
                return Err(Fault::new("unknown-extension", required.pointer, message));
            }
        }
        for key in ARRAYS {
            for item in place.array(key)? {
                let is_name = key == "extensionsUsed";
                if is_name != item.value.is_string() || is_name == item.value.is_object() {
                    log.fault(item.invalid("this must be an object"));
                }
                let name = item.value.as_str().unwrap_or("");
                if is_name && let Some(unread) = unread(name) {
                    let message = format!("the extension `{name}` {unread}");
                    log.warn("unknown-extension", item.pointer, message);
                }
            }
        }
        Ok(document)
    }

    /// The whole text.
    pub fn root(&self) -> Place<'a> {
        Place::root(self.root)
    }

    /// The number of elements of an array of the text.
    pub fn count(&self, array: &str) -> usize {
        self.root.get(array).and_then(Value::as_array).map_or(0, Vec::len)
    }

    /// The elements of an array of the text.
    pub fn items(&self, array: &str) -> impl Iterator<Item = Place<'a>> {
        (0..self.count(array)).filter_map(move |index| self.item(array, index))
    }

    /// An element of an array of the text; `None` where it is no object.
    pub fn item(&self, array: &str, index: usize) -> Option<Place<'a>> {
        let value = self.root.get(array)?.get(index).filter(|value| value.is_object())?;
        Some(Place { value, pointer: format!("/{array}/{index}") })
    }

    /// The element that a member of an object refers to by its index; `None` if it is absent.
    pub fn index(&self, place: &Place, key: &str, array: &str) -> Result<Option<usize>> {
        place.index(key, self.count(array), array)
    }
}

/// Why an extension is not read, as the end of a sentence about it; `None` if it is.
pub(super) fn unread(name: &str) -> Option<String> {
    let optional = OPTIONAL.iter().find(|(optional, ..)| *optional == name);
    match optional {
        Some((_, feature, is_built)) => (!is_built).then(|| built_without(feature)),
        None => (!EXTENSIONS.contains(&name)).then(|| "is not read".into()),
    }
}

/// The end of a sentence about something that an optional feature of the build reads.
pub(super) fn built_without(feature: &str) -> String {
    format!("is not read, as this program was built without the cargo feature `{feature}`")
}
