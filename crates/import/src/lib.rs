//! Scene and mesh files read into a [`SceneDesc`](description::SceneDesc).
//!
//! [`import`] always gives a description: the scene as far as the files were valid, the texts that
//! were read, and all errors and warnings about them. Files are read through an [`AssetSource`]
//! only.

mod archive;
mod assets;
mod foreign;
mod gltf;
mod ies;
mod images;
mod imported;
mod log;
mod look;
mod measured;
mod mesh;
mod nanovdb;
mod number;
mod pbrt;
mod report;
mod selection;
mod suggest;
#[cfg(feature = "usd")]
mod usd;
mod view;

use std::path::Path;

pub use archive::{Manifest, is_archive};
pub use assets::{AssetSource, Files, MemoryAssets};
pub use imported::Imported;
pub use mesh::{Mesh, MeshError, read_obj, read_ply, read_stl, refit_camera};
pub use pbrt::{Argument, ArgumentValues, Motion, Placement, SceneBuilder};
pub use suggest::closest;

/// Reads a scene: a pbrt-v4 file, packed by gzip or not (`-` is standard input of [`Files`]), a
/// glTF or (with the feature `usd`) a USD file, after whose name `#` and settings may follow
/// (`walk.glb#time=0.5`), a PLY, OBJ or STL file, which becomes a scene of one object with a camera
/// and light that show it, or a ZIP archive of a scene and its files.
pub fn import(path: impl AsRef<Path>, assets: &dyn AssetSource) -> Imported {
    let path = path.as_ref();
    if is_archive(path) { archive::read(path, assets) } else { import_file(path, assets) }
}

fn import_file(path: &Path, assets: &dyn AssetSource) -> Imported {
    match mesh::Format::from_path(path) {
        Some(format) => mesh::scene::read(path, format, assets),
        #[cfg(feature = "usd")]
        None if usd::is_named_by(path, assets) => usd::read(path, assets),
        None if gltf::is_named_by(path, assets) => gltf::read(path, assets),
        None => pbrt::read(path, assets),
    }
}
