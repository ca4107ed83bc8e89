//! A scene on its way to a picture: compiled, rendered, developed.

use std::path::Path;
use std::sync::Arc;
use std::sync::atomic::AtomicBool;

use description::schema::Settings;
use description::{CameraKind, Diagnostic, SceneDesc};
use film::Film;
use image::{Attribute, Image, ImageMetadata};
use import::{AssetSource, Imported};
use integrators::{ByProduct, Cancelled, Control, Integrator, RenderReport};
use scene::{Scene, View};

use crate::sketch::Sketch;
use crate::{OverrideError, Overrides};

/// Everything that one render needs, and the film that holds what it has found so far.
pub struct Job {
    scene: Scene,
    view: View,
    film: Film,
    integrator: Box<dyn Integrator>,
    header: Header,
    sketch: Option<Sketch>,
}

/// What the header of a picture says: the scene's camera, and settings.
#[derive(Clone, Debug)]
pub struct Header(Vec<(&'static str, Attribute)>);

impl Header {
    /// The picture on a film, with this in its header.
    pub fn picture(&self, film: &Film) -> Image {
        let mut picture = film.develop();
        for (name, value) in &self.0 {
            picture.metadata.set(name, value.clone());
        }
        picture
    }
}

/// What [`Job::compile`] gives.
pub struct CompiledJob {
    /// The job, not begun.
    pub job: Job,
    /// What will be drawn otherwise than described.
    pub warnings: Vec<Diagnostic>,
}

impl Job {
    /// Makes everything that a scene needs to be rendered, or tells everything that is wrong with
    /// it.
    pub fn compile(desc: &SceneDesc) -> Result<CompiledJob, Vec<Diagnostic>> {
        let view = View::compile(desc, scene::world_from_render(desc));
        let compiled = (view, scene::compile(desc), film::compile(desc), integrators::build(desc));
        let (view, scene, film, built) = match compiled {
            (Ok(view), Ok(scene), Ok(film), Ok(built)) => (view, scene, film, built),
            (view, scene, film, built) => {
                let said = [
                    view.map_or_else(|errors| errors, |view| view.warnings),
                    scene.map_or_else(|errors| errors, |scene| scene.warnings),
                    film.map_or_else(|errors| errors, |film| film.warnings),
                    built.map_or_else(|errors| errors, |built| built.warnings),
                ];
                return Err(said.concat());
            }
        };
        let warnings = [view.warnings, scene.warnings, film.warnings, built.warnings].concat();
        let (scene, view, film, integrator) = (scene.scene, view.view, film.film, built.integrator);
        let header = header(desc, integrator.samples_per_pixel());
        let sketch = Sketch::new(desc, &film);
        Ok(CompiledJob { job: Self { scene, view, film, integrator, header, sketch }, warnings })
    }

    /// A first look at the picture, before it is rendered and without any part in it: in pixels so
    /// large that a render takes many times as long, repeated to the size of the picture. `None`
    /// where the picture has so few pixels itself, or if it was cancelled.
    pub fn sketch(&self, cancel: &Arc<AtomicBool>) -> Option<Image> {
        self.sketch.as_ref()?.draw(&self.scene, &self.view, &self.film, &self.header, cancel)
    }

    /// Renders all passes. Where the render is cancelled, the film has what was found until then.
    pub fn render(&mut self, control: &Control) -> Result<RenderReport, Cancelled> {
        integrators::render(self.integrator.as_mut(), &self.scene, &self.view, &mut self.film, control)
    }

    /// The picture as it stands, with the scene's camera and settings in its header.
    pub fn picture(&self) -> Image {
        self.header.picture(&self.film)
    }

    /// The header of its pictures.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// What has been made beside the picture.
    pub fn by_products(&self) -> Vec<ByProduct> {
        self.integrator.by_products()
    }

    /// What the algorithm tells of itself: names, and what there is to say.
    pub fn summary(&self) -> Vec<(&'static str, String)> {
        self.integrator.summary()
    }

    /// How many passes make the picture.
    pub fn passes(&self) -> u32 {
        self.integrator.passes()
    }

    /// How many of these passes a pixel of the finished picture is the mean of.
    pub fn samples_per_pixel(&self) -> u32 {
        self.integrator.samples_per_pixel()
    }

    /// The film as it stands.
    pub fn film(&self) -> &Film {
        &self.film
    }
}

/// Why [`render_file`] gives no picture.
#[derive(Debug)]
pub enum RenderError {
    /// The scene is wrong; with everything there is to say about it.
    Scene(Box<Imported>),
    /// A change to the scene makes no sense.
    Override(OverrideError),
    /// The render was cancelled.
    Cancelled,
}

/// Renders a scene file: import, change, compile, render, develop.
pub fn render_file(
    path: impl AsRef<Path>,
    assets: &dyn AssetSource,
    overrides: &Overrides,
    control: &Control,
) -> Result<Image, RenderError> {
    let mut imported = import::import(path, assets);
    if imported.has_errors() {
        return Err(RenderError::Scene(Box::new(imported)));
    }
    overrides.apply(&mut imported.desc).map_err(RenderError::Override)?;
    let compiled = Job::compile(&imported.desc).map_err(|errors| match overrides.blamed(&errors) {
        Some(error) => RenderError::Override(error),
        None => {
            imported.diagnostics.extend(errors);
            RenderError::Scene(Box::new(imported))
        }
    })?;
    let mut job = compiled.job;
    job.render(control).map_err(|Cancelled| RenderError::Cancelled)?;
    Ok(job.picture())
}

/// Camera and settings as attributes of a picture.
fn header(desc: &SceneDesc, samples_per_pixel: u32) -> Header {
    let camera = match &desc.camera.kind {
        CameraKind::Perspective { fov, .. } => format!("perspective, {fov} degrees"),
        CameraKind::Orthographic { .. } => "orthographic".into(),
        CameraKind::Spherical { .. } => "spherical".into(),
        CameraKind::Realistic(_) => "realistic".into(),
    };
    let transform = desc.camera.camera_from_world.start.as_mat4();
    Header(vec![
        (ImageMetadata::SOFTWARE, Attribute::Text(concat!("alhazen ", env!("CARGO_PKG_VERSION")).into())),
        (ImageMetadata::WORLD_TO_CAMERA, Attribute::Matrix(transform)),
        ("camera", Attribute::Text(camera)),
        ("integrator", Attribute::Text(desc.integrator.name().into())),
        ("sampler", Attribute::Text(desc.sampler.name().into())),
        ("samplesPerPixel", Attribute::Integer(samples_per_pixel as i32)),
        ("seed", Attribute::Integer(desc.sampler.seed.unwrap_or(desc.options.seed))),
    ])
}
