//! Scene and mesh files read into a [`SceneDesc`](description::SceneDesc).
//!
//! [`import`] always gives a description: the scene as far as the files were valid, the texts that
//! were read, and all errors and warnings about them. Files are read through an
//! [`AssetSource`] only.

mod archive;
mod gltf;
mod log;
mod mesh;
mod primitives;
mod selection;
mod studio;
#[cfg(feature = "usd")]
mod usd;

use std::path::Path;

pub use archive::{Manifest, is_archive};
pub use studio::refit_camera;

use assets::AssetSource;
use description::Imported;

/// Reads a scene: a pbrt-v4 file, packed by gzip or not (`-` is standard input of
/// [`Files`](assets::Files)), a glTF or (with the feature `usd`) a USD file, after whose name `#`
/// and settings may follow (`walk.glb#time=0.5`), a PLY, OBJ or STL file, which becomes a scene of
/// one object with a camera and light that show it, or a ZIP archive of a scene and its files.
pub fn import(path: impl AsRef<Path>, assets: &dyn AssetSource) -> Imported {
    let path = path.as_ref();
    if is_archive(path) { archive::read(path, assets) } else { import_file(path, assets) }
}

fn import_file(path: &Path, assets: &dyn AssetSource) -> Imported {
    match assets::mesh::Format::from_path(path) {
        Some(format) => mesh::read(path, format, assets),
        #[cfg(feature = "usd")]
        None if usd::is_named_by(path, assets) => usd::read(path, assets),
        None if gltf::is_named_by(path, assets) => gltf::read(path, assets),
        None => pbrt::read(path, assets),
    }
}
