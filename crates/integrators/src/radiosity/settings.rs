//! Settings of radiosity.

use std::path::PathBuf;

/// How form factors are found.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FormFactors {
    /// By the closed form for polygons, with rays for what lies between.
    Analytic,
    /// By a hemicube.
    Hemicube {
        /// Pixels along an edge.
        resolution: u32,
    },
}

/// Settings of [`Radiosity`](crate::Radiosity); see there for units and defaults.
#[derive(Clone, Debug, PartialEq)]
pub struct RadiositySettings {
    /// Most scattering events.
    pub max_depth: u32,
    /// How form factors are found.
    pub form_factors: FormFactors,
    /// Longest side of a patch, in scene units; a tenth of the scene's radius if `None`.
    pub patch_size: Option<f32>,
    /// How often an element may be quartered.
    pub subdivision: u32,
    /// The change of light across an element, in parts of what is there, above which it is
    /// quartered.
    pub gradient: f32,
    /// Most elements.
    pub max_patches: u32,
    /// Share of light that need not be sent.
    pub tolerance: f32,
    /// Passes in which light is sent, one at least.
    pub steps: u32,
    /// Rays of a final gather for each sample of a pixel; 0 shows by interpolation instead.
    pub gather: u32,
    /// File for the elements with their radiosity as vertex colours.
    pub mesh_out: Option<PathBuf>,
}

impl Default for RadiositySettings {
    fn default() -> Self {
        Self {
            max_depth: 5,
            form_factors: FormFactors::Analytic,
            patch_size: None,
            subdivision: 3,
            gradient: 0.1,
            max_patches: 50_000,
            tolerance: 0.002,
            steps: 8,
            gather: 0,
            mesh_out: None,
        }
    }
}
