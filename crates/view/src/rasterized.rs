//! The rasterised side of a split view: the same scene through the raster pipeline of a GPU.

use std::sync::Arc;
use std::time::Instant;

use alhazen::description::Diagnostic;
use alhazen::device::{Device, Rasterizer};
use alhazen::image::Image;

use crate::{Frame, Shot, World};

/// A scene on a GPU.
pub struct Rasterized {
    world: Arc<World>,
    rasterizer: Rasterizer,
}

/// Pictures of it, with what they took.
pub struct Raster {
    /// The picture, in the film's resolution.
    pub frame: Frame,
    /// The same as an image.
    pub image: Image,
    /// The triangles and sprites that were drawn.
    pub triangles: u64,
    /// The sprites.
    pub sprites: u64,
}

impl Rasterized {
    /// Takes a scene to the GPU; the error says why that cannot be.
    pub fn new(world: Arc<World>, device: Arc<Device>) -> Result<Self, String> {
        let session = world.draft(&world.shot(), 1)?;
        let film = &session.state().film;
        let made = Rasterizer::new(device, world.scene(), session.view(), film);
        let rasterizer = made.map_err(|error| error.to_string())?;
        Ok(Self { world, rasterizer })
    }

    /// Opens the fastest GPU.
    pub fn open() -> Result<Arc<Device>, String> {
        let device = Device::open("").map_err(|error| error.to_string())?;
        Ok(Arc::new(device))
    }

    /// The scene.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// The GPU.
    pub fn device(&self) -> &Arc<Device> {
        self.rasterizer.device()
    }

    /// What is left out.
    pub fn warnings(&self) -> Vec<Diagnostic> {
        self.rasterizer.notes().iter().cloned().map(Diagnostic::from).collect()
    }

    /// Draws a shot; the error says why that cannot be.
    pub fn draw(&mut self, shot: &Shot) -> Result<Raster, String> {
        let begin = Instant::now();
        let view = self.world.view(shot).ok_or("the camera has errors")?;
        let bounds = self.world.bounds();
        let drawing = self.rasterizer.draw(&view, bounds).map_err(|error| error.to_string())?;
        let mut frame = Frame::of_image(&drawing.image, view, bounds, self.world.color_space());
        frame.time = begin.elapsed();
        Ok(Raster { frame, image: drawing.image, triangles: drawing.triangles, sprites: drawing.sprites })
    }
}
