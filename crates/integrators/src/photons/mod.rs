//! Photon methods: the vertices of light subpaths are kept, and looked up around the vertices of
//! camera subpaths.

mod merging;
mod photon;
mod photon_grid;
mod photon_map;
mod photon_mapping;
mod specular_paths;
mod sppm;
mod vcm;

pub use photon_map::Kernel;
pub use photon_mapping::{PhotonMapping, PhotonMappingSettings};
pub use sppm::{Sppm, SppmSettings};
pub use vcm::{Vcm, VcmSettings};
