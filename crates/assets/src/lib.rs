//! Files that scenes of all formats name, read through an [`AssetSource`]: meshes, images,
//! photometric profiles, volumes and measured materials.

mod ies;
mod images;
mod measured;
pub mod mesh;
mod nanovdb;
pub mod number;
mod source;

pub use images::{black_pixel, decode_image};
pub use measured::read_measured;
pub use mesh::{Mesh, MeshError, read_obj, read_ply, read_stl};
pub use nanovdb::Volumes;
pub use source::{AssetSource, Files, MemoryAssets, read_at_most, read_unpacked, resolve};
