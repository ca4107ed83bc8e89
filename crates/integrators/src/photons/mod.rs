//! Photon methods: vertices of light subpaths are stored, and looked up near vertices of camera
//! subpaths.

mod merging;
mod photon;
mod photon_grid;
mod photon_map;
mod photon_mapping;
mod specular_paths;
mod sppm;
mod vcm;

pub use photon_mapping::PhotonMapping;
pub use sppm::Sppm;
pub use vcm::{MAX_PHOTON_PATHS, Vcm};
