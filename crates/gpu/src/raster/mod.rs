//! Scenes by the raster pipeline of a GPU: triangle by triangle instead of ray by ray.
//!
//! What it has of light is what a rasteriser has without rays: surfaces are under the whole sky,
//! which nothing hides, so that there are no shadows; fog is a function of depth; the largest flat
//! water mirrors a second picture of the scene, made by the mirrored camera; other glass and metal
//! mirror the sky alone. Instances far away are sprites. Light is red, green and blue.
//!
//! [`Rasterizer::new`] makes buffers of a scene once, [`Rasterizer::draw`] pictures of it by any
//! perspective camera. Sources: [Akenine-Möller 2018].

mod canvas;
mod colors;
mod detail;
mod eye;
mod fog;
mod lens;
mod models;
mod paint;
mod pass;
mod pipelines;
mod placements;
mod pond;
mod sky;
mod sprites;

use std::sync::Arc;

use description::Span;
use film::Film;
use geometry::GeometryId;
use image::Image;
use math::Bounds2i;
use scene::camera::Projection;
use scene::{Scene, View};

use crate::device::{Device, GpuError};
use crate::flatten::Refusal;
use colors::Colors;
use detail::Drawn;
pub(crate) use eye::Eye;
use fog::Fog;
use lens::Lens;
use models::{Model, Models};
use paint::Painter;
use pass::Painted;
use placements::{Placement, placements};
use pond::Pond;
use sky::Sky;
use sprites::Album;

/// The distance of the near plane, as a share of the scene's radius.
const NEAR: f32 = 1e-4;

/// A scene on a device, of which pictures can be drawn.
pub struct Rasterizer {
    device: Arc<Device>,
    models: Vec<Model>,
    placements: Vec<Placement>,
    light: Eye,
    pond: Option<Pond>,
    album: Album,
    painted: Painted,
    notes: Vec<Refusal>,
    radius: f32,
}

/// A picture, and what it took.
#[derive(Clone, Debug)]
pub struct Drawing {
    /// Linear colours in the film's space.
    pub image: Image,
    /// The triangles that were given to the GPU, mirrored views included.
    pub triangles: u64,
    /// The sprites.
    pub sprites: u64,
}

/// Why there is no picture.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DrawError {
    /// The camera is not a perspective one.
    Camera,
    /// The device failed.
    Gpu(GpuError),
}

impl From<GpuError> for DrawError {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

impl std::fmt::Display for DrawError {
    fn fmt(&self, f: &mut std::fmt::Formatter) -> std::fmt::Result {
        match self {
            Self::Camera => f.write_str("only perspective cameras are rasterised"),
            Self::Gpu(error) => error.fmt(f),
        }
    }
}

impl std::error::Error for DrawError {}

impl Rasterizer {
    /// Takes a scene to a device. Colours are those of the film; textures are filtered for the
    /// view, whose medium is the fog.
    ///
    /// # Errors
    /// Those of the device.
    pub fn new(device: Arc<Device>, scene: &Scene, view: &View, film: &Film) -> Result<Self, GpuError> {
        let colors = Colors::new(film);
        let painter = Painter { scene, view, colors: &colors };
        let sky = Sky::new(scene, &colors);
        let fog = Fog::new(scene, view, &sky, &colors);
        let pond = Pond::new(&painter);
        let models = Models::new(&painter, pond.as_ref().map(|pond| pond.geometry));
        let notes = notes(scene, view, &models, fog.is_none());
        let radius = scene.sphere().radius.max(f32::MIN_POSITIVE);
        let light = Eye::of_light(sky.irradiance(), &fog.unwrap_or_default(), radius);
        let painted = Painted::new(&device, &models, pond.as_ref(), &sky)?;
        let placements = placements(scene.world(), view.camera.sample_time(0.5));
        let (models, album) = (models.groups, Album::default());
        Ok(Self { device, models, placements, light, pond, album, painted, notes, radius })
    }

    /// What it leaves out.
    pub fn notes(&self) -> &[Refusal] {
        &self.notes
    }

    /// The device.
    pub fn device(&self) -> &Arc<Device> {
        &self.device
    }

    /// Draws a view of the scene, the pixels in `bounds`.
    ///
    /// # Errors
    /// Cameras that are not perspective, and those of the device.
    pub fn draw(&mut self, view: &View, bounds: Bounds2i) -> Result<Drawing, DrawError> {
        let lens = Lens::new(view, bounds, NEAR * self.radius).ok_or(DrawError::Camera)?;
        let size = [bounds.width().max(1) as u32, bounds.height().max(1) as u32];
        let budget = detail::BUDGET[usize::from(self.device.is_software())];
        let mut eye = self.light.through(&lens, size);
        let mut mirrored = None;
        if let Some(pond) = &self.pond {
            let plane = pond.plane_towards(lens.eye);
            eye = eye.with(plane, pond);
            let lens = lens.mirrored(plane);
            let drawn = detail::drawn(&lens, &self.models, &self.placements, &mut self.album, budget / 2);
            mirrored = Some(Drawn { eye: self.light.through(&lens, size), ..drawn });
        }
        let drawn = detail::drawn(&lens, &self.models, &self.placements, &mut self.album, budget);
        let drawn = Drawn { eye, ..drawn };
        let missing = self.album.take_missing();
        self.painted.bake(&self.device, &self.light, &self.models, &missing)?;
        let count = |f: fn(&Drawn) -> u64| f(&drawn) + mirrored.as_ref().map_or(0, f);
        let (triangles, sprites) =
            (count(|drawn| drawn.triangles), count(|drawn| drawn.sprites.len() as u64));
        let pixels = self.painted.draw(&self.device, size, &self.models, mirrored.as_ref(), &drawn)?;
        let pixel = |x: u32, y: u32| pixels[(y * size[0] + x) as usize];
        let image = Image::from_fn(size[0], size[1], ["R", "G", "B"], pixel);
        Ok(Drawing { image, triangles, sprites })
    }
}

/// What is not drawn of a scene.
fn notes(scene: &Scene, view: &View, models: &Models, has_other_fog: bool) -> Vec<Refusal> {
    let mut notes = Vec::new();
    let mut add = |what: &str, span| notes.push(Refusal { what: what.into(), span });
    let entry = |id: GeometryId| &scene.geometries()[id.0 as usize];
    if let Some(id) = models.left_out.first() {
        add("shapes that are not cut into triangles", entry(*id).span);
    }
    if let Some(entry) = scene.geometries().iter().find(|entry| entry.alpha.is_some()) {
        add("holes that an alpha cuts", entry.span);
    }
    if let Some(light) = scene.lights().iter().find(|light| !light.is_infinite()) {
        add("lights other than the sky", light.span());
    }
    if has_other_fog {
        add("media that vary around the camera", Span::NONE);
    }
    let projection = view.camera.projection();
    if matches!(projection, Projection::Perspective(perspective) if perspective.lens().area().is_some()) {
        add("depth of field", Span::NONE);
    }
    notes
}
