//! A render of a scene: compiled, rendered, developed.

use std::path::Path;
use std::sync::Arc;

use assets::AssetSource;
use description::Imported;
use description::{Diagnostic, SceneDesc, Span};
use film::Film;
use image::{Image, ImageError};
use integrators::{Control, Limits, PassError, Session, SessionState, Stop};
use math::DMat4;
use scene::{Scene, View};

use crate::arrangement::Arrangement;
use crate::coarse;
use crate::sketch::Sketch;
use crate::{Header, OverrideError, Overrides};

/// Everything that one render needs: a [`Session`] and what to write about it.
pub struct Job {
    /// The render. Its passes are the samples of each pixel.
    pub session: Session,
    header: Header,
    sketch: Option<Sketch>,
    planned: u32,
    arrangement: Arrangement,
    /// What it is rendered by.
    #[cfg(feature = "gpu")]
    settings: SceneDesc,
}

/// The result of [`Job::compile`].
pub struct CompiledJob {
    /// The job, before its first pass.
    pub job: Job,
    /// Warnings about what is rendered differently than described.
    pub warnings: Vec<Diagnostic>,
}

impl Job {
    /// Compiles everything that a scene needs to be rendered; the error is the list of all its
    /// diagnostics.
    pub fn compile(desc: SceneDesc) -> Result<CompiledJob, Vec<Diagnostic>> {
        let settings = desc.without_geometry();
        let world_from_render = scene::world_from_render(&desc);
        let scene = scene::compile(desc).map(|compiled| (Arc::new(compiled.scene), compiled.warnings));
        let mut compiled = Self::assemble(scene, world_from_render, &settings)?;
        let session = &compiled.job.session;
        let (scene, resolution) = (session.scene(), session.state().film.full_resolution());
        let has_background = scene.geometries().is_empty() || !scene.infinite_lights().is_empty();
        if !has_background && !scene.has_surface_in(session.view(), resolution) {
            let message = "no surface seems to be in view: none of 4096 camera rays hits one";
            let span = settings.camera.origin.span;
            compiled.warnings.push(Diagnostic::warning("nothing-in-view", message, span));
        }
        compiled.warnings.extend(coarse::warning(scene, session.view(), resolution));
        Ok(compiled)
    }

    /// A job of a scene that is compiled already: with the camera, film, sampler and algorithm of a
    /// description, whose materials and media are those of the scene. Its geometry does not count.
    pub fn of_scene(scene: Arc<Scene>, desc: &SceneDesc) -> Result<CompiledJob, Vec<Diagnostic>> {
        let world_from_render = scene.world_from_render();
        Self::assemble(Ok((scene, Vec::new())), world_from_render, desc)
    }

    fn assemble(
        scene: Result<(Arc<Scene>, Vec<Diagnostic>), Vec<Diagnostic>>,
        world_from_render: DMat4,
        desc: &SceneDesc,
    ) -> Result<CompiledJob, Vec<Diagnostic>> {
        let view = View::compile(desc, world_from_render);
        let parts = (scene, view, film::compile(desc), integrators::build(desc));
        let of_algorithm = match &parts {
            (Ok((scene, _)), _, _, Ok(built)) => built.integrator.warnings(scene),
            _ => Vec::new(),
        };
        let (Ok((scene, of_scene)), Ok(view), Ok(film), Ok(built)) = parts else {
            let (scene, view, film, built) = parts;
            let diagnostics = [
                scene.map_or_else(|errors| errors, |(_, warnings)| warnings),
                view.map_or_else(|errors| errors, |view| view.warnings),
                film.map_or_else(|errors| errors, |film| film.warnings),
                built.map_or_else(|errors| errors, |built| built.warnings),
                of_algorithm,
            ];
            return Err(diagnostics.concat());
        };
        let warnings = [of_scene, view.warnings, film.warnings, built.warnings, of_algorithm].concat();
        let (view, mut film) = (view.view, film.film);
        if built.integrator.splats() {
            film.reserve_splats().map_err(|error| {
                vec![Diagnostic::error("invalid-film", error.to_string(), desc.film.origin.span)]
            })?;
        }
        let header = Header::of(desc, &scene, &film);
        let sketch = Sketch::new(desc, &film);
        let planned = built.integrator.passes();
        let arrangement = Arrangement::new(desc, scene.needs_footprints(&view));
        let session = Session::new(scene, view, built.integrator, SessionState::new(film));
        let job = Self {
            session,
            header,
            sketch,
            planned,
            arrangement,
            #[cfg(feature = "gpu")]
            settings: desc.without_geometry(),
        };
        Ok(CompiledJob { job, warnings })
    }

    /// Goes on with the engine for GPUs, as [`move_to`](crate::device::move_to).
    #[cfg(feature = "gpu")]
    pub fn move_to(
        &mut self,
        kernels: &Arc<crate::device::Kernels>,
    ) -> Result<Vec<Diagnostic>, Vec<Diagnostic>> {
        crate::device::move_to(&mut self.session, &self.settings, kernels)
    }

    /// A preview of the picture before it is rendered: in a resolution so low that a render takes
    /// many times as long, enlarged to the size of the picture. `None` where the picture has so few
    /// pixels itself, or if it was cancelled.
    pub fn sketch(&self, control: &Control) -> Option<Image> {
        self.sketch.as_ref()?.draw(&self.session, &self.header, control)
    }

    /// Renders all passes that are planned. Where the render is cancelled or memory runs out, the
    /// film has what was found until then.
    pub fn render(&mut self, control: &Control) -> Result<Stop, PassError> {
        let passes = 0..self.planned;
        self.session.run(passes, &Limits::default(), control, &mut |_| ())
    }

    /// Begins again with an empty film, or with two between which passes alternate.
    pub fn restart(&mut self, alternates: bool) -> Result<(), ImageError> {
        let mut film = self.session.state().film.blank()?;
        if self.session.integrator().splats() {
            film.reserve_splats()?;
        }
        let mut state = SessionState::new(film);
        if alternates {
            state.alternate()?;
        }
        self.session.resume(state, Vec::new());
        Ok(())
    }

    /// Resumes a saved render of the same job. The error says why it cannot be of the same job.
    pub fn resume(&mut self, state: SessionState, films: Vec<(String, Film)>) -> Result<(), String> {
        let [ours, theirs] = [&self.session.state().film, &state.film]
            .map(|film| (film.full_resolution(), film.pixel_bounds()));
        if ours != theirs {
            return Err("its pixels are not those of the render that it describes".into());
        }
        self.session.resume(state, films);
        Ok(())
    }

    /// The current picture, with the scene's camera and settings in its header; refused where there
    /// is no memory for it.
    pub fn picture(&self) -> Result<Image, ImageError> {
        self.header.picture(self.session.state())
    }

    /// The header of its pictures.
    pub fn header(&self) -> &Header {
        &self.header
    }

    /// The samples per pixel that are planned. There may be more: samplers continue beyond the
    /// plan.
    pub fn planned(&self) -> u32 {
        self.planned
    }

    /// Whether samples differ from those of a render that is planned for this number of them: with
    /// samplers that arrange a number of samples, with algorithms that use such a sampler for paths
    /// from the lights, where pixels that differ take more samples, and with textures, whose filter
    /// narrows as samples increase. The picture then is another one, but as valid.
    pub fn is_arranged_otherwise(&self, samples: u32) -> bool {
        samples != self.planned && self.arrangement.differs_for(samples)
    }

    /// A warning if the render has ended above the noise that was to end it.
    pub fn missed_noise(&self, limits: &Limits, stop: Stop) -> Option<Diagnostic> {
        let limit = limits.noise?;
        let state = self.session.state();
        let end = match stop {
            Stop::Noise => return None,
            Stop::Time => "when the time was up",
            Stop::Passes => "after all passes",
        };
        let message = match state.noise() {
            Some(noise) if noise <= limit => return None,
            Some(noise) => format!("the noise is {noise:.4} {end}, above the limit of {limit}"),
            None => {
                let passes = state.done.count();
                format!("the noise is unknown {end}, for {passes} are too few to estimate it")
            }
        };
        Some(Diagnostic::warning("noise-not-reached", message, Span::NONE))
    }
}

/// Why [`render_file`] gives no picture.
#[derive(Debug)]
pub enum RenderError {
    /// The scene has errors; with all diagnostics. A description that could not be compiled is
    /// empty.
    Scene(Box<Imported>),
    /// A change to the scene is not valid.
    Override(OverrideError),
    /// The render was cancelled.
    Cancelled,
    /// Memory ran out; the text says what for.
    OutOfMemory(String),
}

impl From<PassError> for RenderError {
    fn from(error: PassError) -> Self {
        match error {
            PassError::Cancelled => Self::Cancelled,
            PassError::OutOfMemory(problem) | PassError::Device(problem) => Self::OutOfMemory(problem),
        }
    }
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
    let desc = std::mem::take(&mut imported.desc);
    let compiled = Job::compile(desc).map_err(|errors| match overrides.blamed(&errors) {
        Some(error) => RenderError::Override(error),
        None => {
            imported.diagnostics.extend(errors);
            RenderError::Scene(Box::new(imported))
        }
    })?;
    let mut job = compiled.job;
    job.render(control)?;
    job.picture().map_err(|error| RenderError::OutOfMemory(error.to_string()))
}
