//! What the window shows and has been asked for.

use std::path::PathBuf;

use alhazen::description::SceneDesc;
use alhazen::image::{DisplaySettings, replace_file};
use alhazen::math::Bounds2i;
use alhazen::pbrt::export_camera;
use eframe::egui::Context;

use super::picture::Picture;
use super::split::Split;
use crate::{Engine, Flight, Mode, Output, Renderer, Shot};

/// The state of the window.
pub struct State {
    engine: Engine,
    /// What the engine has found.
    pub output: Output,
    /// The scene with all changes.
    pub desc: SceneDesc,
    /// What is shown.
    pub shot: Shot,
    /// The rasterised side, if there are two.
    pub split: Option<Split>,
    /// The camera.
    pub flight: Flight,
    /// How the camera is moved.
    pub mode: Mode,
    /// Units of the scene per second.
    pub speed: f64,
    /// How colours are shown.
    pub display: DisplaySettings,
    /// The picture on the screen.
    pub picture: Picture,
    /// How many paths of a pixel are traced, and of which pixel.
    pub paths: u32,
    /// The pixel whose paths are shown.
    pub pixel: Option<[i32; 2]>,
    /// The file of the picture, beside which that of the camera is.
    pub file: String,
    /// What was written.
    pub note: Option<Result<String, String>>,
}

impl State {
    /// Shows a scene.
    pub fn new(
        renderer: Renderer,
        desc: SceneDesc,
        display: DisplaySettings,
        split: Option<f32>,
        wake: impl Fn() + Clone + Send + 'static,
    ) -> Self {
        let (shot, flight) = (renderer.shot().clone(), renderer.world().flight());
        let file = PathBuf::from(&desc.film.filename).with_extension("png").display().to_string();
        let engine = Engine::start(renderer, wake.clone());
        Self {
            output: engine.output(),
            engine,
            split: split.map(|share| Split::start(share, wake.clone())),
            desc,
            shot,
            speed: 0.4 * flight.distance().max(f64::MIN_POSITIVE),
            flight,
            mode: Mode::default(),
            display,
            picture: Picture::start(wake),
            paths: 4,
            pixel: None,
            file,
            note: None,
        }
    }

    /// Takes what the engine has found, and shows it.
    pub fn refresh(&mut self, context: &Context) {
        self.output = self.engine.output();
        if let Some(split) = &mut self.split {
            split.refresh(context, &self.output.world, &self.shot, self.display);
        }
        self.picture.refresh(context, self.output.frame.as_ref(), self.display);
    }

    /// The pixels of the picture.
    pub fn bounds(&self) -> Bounds2i {
        self.output.world.bounds()
    }

    /// Shows the camera where it is now, and other settings of the shot.
    pub fn aim(&mut self) {
        self.shot.camera = self.flight.camera().clone();
        self.engine.show(self.shot.clone());
        if let Some(split) = &mut self.split {
            split.show(&self.output.world, &self.shot);
        }
    }

    /// Shows the changed scene.
    pub fn edit(&self) {
        self.engine.replace(self.desc.clone());
    }

    /// Shows the paths of a pixel, or of none.
    pub fn trace(&mut self, pixel: Option<[i32; 2]>) {
        self.pixel = pixel;
        match pixel {
            Some(pixel) => self.engine.trace(pixel, self.paths),
            None => self.engine.forget_trace(),
        }
    }

    /// Looks at what is seen at a position of the film.
    pub fn look_at(&mut self, film: [f32; 2]) {
        let Some((_, frame)) = self.picture.texture() else { return };
        let film = film.map(|x| x / frame.n as f32);
        if let Some(focus) = self.output.world.seen_at(&frame.view, film) {
            self.flight.look_at(focus);
            self.aim();
        }
    }

    /// Writes the picture.
    pub fn save_picture(&mut self) {
        self.note = None;
        self.engine.save(PathBuf::from(&self.file), self.display);
    }

    /// Writes the camera as text of the format beside the picture.
    pub fn save_camera(&mut self) {
        let path = PathBuf::from(&self.file).with_extension("camera.pbrt");
        let written = export_camera(&self.shot.camera).map_err(|error| error.to_string());
        let written = written.and_then(|text| {
            replace_file(&path, text.as_bytes()).map_err(|error| format!("{}: {error}", path.display()))
        });
        self.note = Some(written.map(|()| path.display().to_string()));
    }
}
