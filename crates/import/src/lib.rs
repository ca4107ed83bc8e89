//! Scene and mesh files read into a [`SceneDesc`].
//!
//! [`import`] always gives a description: the scene as far as it could be understood, the texts
//! that were read, and all errors and warnings about them. Files are read through an
//! [`AssetSource`] only.

mod assets;
mod foreign;
mod images;
mod mesh;
mod number;
mod pbrt;
mod report;
mod suggest;

use std::path::Path;

use description::{Diagnostic, SceneDesc, SourceMap};

pub use assets::{AssetSource, Files, MemoryAssets};
pub use mesh::{Mesh, MeshError, read_obj, read_ply};
pub use suggest::closest;

/// A scene that was read.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The scene, as far as it could be understood.
    pub desc: SceneDesc,
    /// The texts that the spans of the scene and its messages refer to.
    pub sources: SourceMap,
    /// All errors and warnings, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

impl Imported {
    /// Whether there is any error.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(Diagnostic::is_error)
    }
}

/// Reads a scene: a pbrt-v4 file, packed by gzip or not (`-` is standard input of [`Files`]), or a
/// PLY or OBJ file, which becomes a scene of one object with a camera and light that show it.
pub fn import(path: impl AsRef<Path>, assets: &dyn AssetSource) -> Imported {
    let path = path.as_ref();
    match mesh::Format::from_path(path) {
        Some(format) => mesh::scene::read(path, format, assets),
        None => pbrt::read(path, assets),
    }
}
