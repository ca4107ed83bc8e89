//! Settings of photon mapping.

use crate::photons::photon_map::Kernel;

/// Settings of [`PhotonMapping`](crate::PhotonMapping).
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotonMappingSettings {
    /// Most scattering events of a path; default 5.
    pub max_depth: u32,
    /// Light subpaths for the global map in each pass; default 200 000.
    pub photons: u32,
    /// Light subpaths for the caustic map in each pass; default 100 000.
    pub caustic_photons: u32,
    /// How many of the nearest photons make an estimate; default 50.
    pub nearest: u32,
    /// The farthest that they may be away, in scene units; by default 3 % of the radius of the
    /// sphere around the scene.
    pub radius: Option<f32>,
    /// How they are weighed.
    pub kernel: Kernel,
    /// Rays of a final gather; default 0, for none.
    pub gather: u32,
    /// Whether the picture shows the photons themselves.
    pub show_photons: bool,
}

impl Default for PhotonMappingSettings {
    fn default() -> Self {
        Self {
            max_depth: 5,
            photons: 200_000,
            caustic_photons: 100_000,
            nearest: 50,
            radius: None,
            kernel: Kernel::default(),
            gather: 0,
            show_photons: false,
        }
    }
}
