//! A view of a scene: the camera and the settings that decide which samples are taken.
//!
//! A [`Scene`](crate::Scene) does not depend on its views: another camera, another number of
//! samples or a preview in larger pixels needs a new view, but no new scene.

use crate::camera::{self, Camera};
use crate::compile::media::medium_id;
use crate::medium::MediumId;
use description::{Diagnostic, FilmKind, SceneDesc};
use math::DMat4;

/// Options of the format that apply to all algorithms.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ViewOptions {
    /// All samples of a pixel go through its centre.
    pub disable_pixel_jitter: bool,
    /// All samples have the same wavelengths.
    pub disable_wavelength_jitter: bool,
    /// Textures are evaluated at points, without filtering.
    pub disable_texture_filtering: bool,
    /// Every BSDF is replaced by a diffuse one of the same albedo.
    pub force_diffuse: bool,
}

/// How a scene is rendered, apart from the film and the algorithm.
#[derive(Clone, Debug)]
pub struct View {
    /// The camera, placed in the scene's render space.
    pub camera: Camera,
    /// The medium around the camera, of the scene that was compiled from the same description.
    pub medium: Option<MediumId>,
    /// Samples per pixel, at least 1. The more samples, the smaller the footprint by which textures
    /// are filtered.
    pub samples_per_pixel: u32,
    /// Options that apply to all algorithms.
    pub options: ViewOptions,
    /// The range of wavelengths in nanometres that a spectral film wants, over which they are
    /// sampled uniformly; without it, they are sampled as the eye sees them.
    pub wavelengths: Option<[f32; 2]>,
}

/// What [`View::compile`] returns.
#[derive(Clone, Debug)]
pub struct CompiledView {
    /// The view.
    pub view: View,
    /// What is rendered differently from its description.
    pub warnings: Vec<Diagnostic>,
}

impl View {
    /// Compiles camera, film, number of samples and options of a description, and ignores the
    /// rest of it. `world_from_render` is the render space of the scene to be viewed:
    /// [`Scene::world_from_render`](crate::Scene::world_from_render), or, before it is compiled,
    /// [`world_from_render`]. Returns all errors and warnings if there is an error.
    pub fn compile(desc: &SceneDesc, world_from_render: DMat4) -> Result<CompiledView, Vec<Diagnostic>> {
        let mut diagnostics = Vec::new();
        let camera =
            camera::compile(&desc.camera, &desc.film, &desc.images, world_from_render, &mut diagnostics);
        let Some(camera) = camera else { return Err(diagnostics) };
        let options = ViewOptions {
            disable_pixel_jitter: desc.options.disable_pixel_jitter,
            disable_wavelength_jitter: desc.options.disable_wavelength_jitter,
            disable_texture_filtering: desc.options.disable_texture_filtering,
            force_diffuse: desc.options.force_diffuse,
        };
        let medium = medium_id(desc.camera.medium);
        let wavelengths = match desc.film.kind {
            FilmKind::Spectral { lambda_min, lambda_max, .. } => Some([lambda_min, lambda_max]),
            FilmKind::Rgb | FilmKind::GBuffer { .. } => None,
        };
        let view = Self { camera, medium, samples_per_pixel: desc.samples_per_pixel(), options, wavelengths };
        Ok(CompiledView { view, warnings: diagnostics })
    }

    /// The same view in pixels `n` times as wide and high: film position x of the new view is n·x
    /// of this one.
    pub fn coarser(&self, n: u32) -> Self {
        Self { camera: self.camera.coarser(n), ..self.clone() }
    }
}

/// The render space in which [`compile`](crate::compile()) places the scene of a description, as
/// its transform to world space.
pub fn world_from_render(desc: &SceneDesc) -> DMat4 {
    camera::world_from_render(&desc.camera.camera_from_world, desc.options.render_space)
}
