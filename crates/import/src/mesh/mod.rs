//! Mesh files: polygons with shared vertices.

pub(crate) mod contours;
mod material;
mod model;
mod mtl;
mod notes;
mod obj;
mod outline;
mod ply;
pub(crate) mod polygon;
pub(crate) mod scene;
mod stl;
pub(crate) mod studio;
mod text;

use std::path::Path;

pub use model::{Mesh, MeshError};
use model::{decode_colors, invalid};
pub use obj::read_obj;
pub use ply::read_ply;
pub use stl::read_stl;
pub use studio::refit_camera;

/// The mesh formats.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Format {
    Ply,
    Obj,
    Stl,
}

impl Format {
    /// The format that a path's extension names, before a `.gz`.
    pub(crate) fn from_path(path: &Path) -> Option<Self> {
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
    pub(crate) fn read(self, bytes: &[u8]) -> Result<Mesh, MeshError> {
        match self {
            Self::Ply => read_ply(bytes),
            Self::Obj => read_obj(bytes),
            Self::Stl => read_stl(bytes),
        }
    }
}
