//! Mesh files: polygons with shared vertices.

mod contours;
mod model;
mod mtl;
mod notes;
mod obj;
mod ply;
pub mod polygon;
mod stl;
mod text;

use std::path::Path;

pub use contours::{ContourError, triangulate_contours};
pub use model::{Mesh, MeshError};
use model::{decode_colors, invalid};
pub use mtl::{Channel, Map, ObjMaterial, PRINCIPLED, read_materials};
pub use obj::{Obj, read_obj, read_obj_parts};
pub use ply::{read_ply, read_textured};
pub use stl::read_stl;

/// The mesh formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Stanford PLY.
    Ply,
    /// Wavefront OBJ.
    Obj,
    /// STL, text and binary.
    Stl,
}

impl Format {
    /// The format that a path's extension names, before a `.gz`.
    pub fn from_path(path: &Path) -> Option<Self> {
        let name = path.file_name()?.to_string_lossy().to_ascii_lowercase();
        let name = name.strip_suffix(".gz").unwrap_or(&name);
        match name.rsplit_once('.')?.1 {
            "ply" => Some(Self::Ply),
            "obj" => Some(Self::Obj),
            "stl" => Some(Self::Stl),
            _ => None,
        }
    }

    /// Reads a mesh.
    pub fn read(self, bytes: &[u8]) -> Result<Mesh, MeshError> {
        match self {
            Self::Ply => read_ply(bytes),
            Self::Obj => read_obj(bytes),
            Self::Stl => read_stl(bytes),
        }
    }
}
