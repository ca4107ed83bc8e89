//! Pictures at once: while the camera moves, a few samples of each pixel; when it rests, more and
//! more of them, which are added up on the device. Only the picture that is shown is read back.

mod canvas;
mod frame;

use std::sync::Arc;
use std::time::Duration;

use math::Bounds2i;
use sampling::sampler::Independent;
use scene::View;

use crate::Flat;
use crate::algorithm::Algorithm;
use crate::commands::Commands;
use crate::device::{Buffer, Device, GpuError, Kernel};
use crate::flatten::{Head, cameras};
use crate::renderer::Kernels;
use crate::shaders;
use canvas::Canvas;
use frame::Frame;

/// Pixels of a side of a kernel's workgroups.
const WORKGROUP: u32 = 8;

/// A stage of a frame, as an index of times.
const TRACE: usize = 0;
const FILTER: usize = 1;

/// The kinds of random numbers of a frame in motion, which do not repeat themselves.
const INDEPENDENT: u32 = 0;

/// A scene on a device, of which pictures are made at once.
pub struct Realtime {
    kernels: Arc<Kernels>,
    light: Arc<Kernel>,
    develop: Arc<Kernel>,
    head: Head,
    /// Where the random numbers of frames in motion are among the tables.
    restless: u32,
    /// What rays are traced through: heads, nodes, triangles, items, tables and texels.
    scene: [Buffer; 6],
    parameters: Buffer,
    canvas: Option<Canvas>,
    /// The samples of each pixel since the camera rests, and of frames in motion.
    rested: u32,
    moved: u32,
}

/// A picture, and what it took.
#[derive(Clone, Debug, Default)]
pub struct Picture {
    /// Linear colours in the film's colour space, row by row from the upper left.
    pub pixels: Vec<[f32; 3]>,
    /// Rays that were traced since the last picture.
    pub rays: u64,
    /// The times of its parts on the device.
    pub stages: Stages,
}

/// The times of the parts of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Stages {
    /// Rays, and what is computed where they hit.
    pub trace: Duration,
    /// From the light of samples to colours.
    pub filter: Duration,
}

/// Why a scene cannot be shown from somewhere.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum AimError {
    /// What kernels do not draw, as a plural or with an article.
    Refused(&'static str),
    /// The device failed.
    Gpu(GpuError),
}

impl From<GpuError> for AimError {
    fn from(error: GpuError) -> Self {
        Self::Gpu(error)
    }
}

impl Realtime {
    /// Takes a scene to the device.
    pub fn new(kernels: Arc<Kernels>, flat: &Flat, algorithm: &Algorithm) -> Result<Self, GpuError> {
        let device = kernels.device();
        let restless = flat.tables.len() as u32;
        let key = Independent::new(1, 0).key();
        let tables: Vec<u32> = flat.tables.iter().copied().chain([INDEPENDENT, key]).collect();
        let scene = [
            device.buffer("heads of the scene", &[flat.head])?,
            device.buffer("nodes of the scene's trees", &flat.bvh.nodes)?,
            device.buffer("triangles of the scene", &flat.bvh.triangles)?,
            device.buffer("shapes and instances of the scene", &flat.bvh.items)?,
            device.buffer("tables of the scene", &tables)?,
            device.buffer("texels of the scene", &flat.texels)?,
        ];
        let parameters = device.parameters(&Frame::default())?;
        let light = kernels.get("light", shaders::light(algorithm, flat.parts))?;
        let develop = kernels.get("develop", shaders::develop())?;
        let head = flat.head;
        let (canvas, rested, moved) = (None, 0, 0);
        Ok(Self { kernels, light, develop, head, restless, scene, parameters, canvas, rested, moved })
    }

    /// The device.
    pub fn device(&self) -> &Device {
        self.kernels.device()
    }

    /// Looks from somewhere, at these pixels of the film; a picture at rest begins again.
    pub fn aim(&mut self, view: &View, pixels: Bounds2i) -> Result<(), AimError> {
        let camera = cameras::words(view).map_err(AimError::Refused)?;
        let device = self.kernels.device();
        let at = u64::from(self.head.camera) * size_of::<u32>() as u64;
        device.write_at(&self.scene[4], at, &camera)?;
        if self.canvas.as_ref().is_none_or(|canvas| canvas.pixels != pixels) {
            self.canvas = Some(Canvas::new(device, pixels)?);
        }
        self.rested = 0;
        Ok(())
    }

    /// The samples of each pixel of the picture at rest.
    pub fn rested(&self) -> u32 {
        self.rested
    }

    /// A picture for a camera that moves, of so many samples of the middle of each pixel. None
    /// before the camera is aimed.
    pub fn moving(&mut self, samples: u32) -> Result<Option<Picture>, GpuError> {
        let Some(canvas) = &self.canvas else { return Ok(None) };
        let head = Head { random_numbers: self.restless, is_centered: 1, ..self.head };
        let frame = Frame { index: self.moved, samples, ..canvas.frame() };
        self.moved = self.moved.wrapping_add(samples);
        self.rested = 0;
        self.draw(head, frame, true)
    }

    /// Adds samples to the picture of a camera that rests: those that the whole picture has, one
    /// after another. A picture if it is wanted.
    pub fn resting(&mut self, samples: u32, is_shown: bool) -> Result<Option<Picture>, GpuError> {
        let Some(canvas) = &self.canvas else { return Ok(None) };
        let frame = Frame { index: self.rested, before: self.rested, samples, ..canvas.frame() };
        self.rested += samples;
        self.draw(self.head, frame, is_shown)
    }

    fn draw(&self, head: Head, frame: Frame, is_shown: bool) -> Result<Option<Picture>, GpuError> {
        let Some(canvas) = &self.canvas else { return Ok(None) };
        let device = self.kernels.device();
        let [world, nodes, triangles, items, tables, texels] = &self.scene;
        device.write(world, &[head])?;
        device.write(&self.parameters, &[frame])?;
        let groups = frame.size.map(|side| side.div_ceil(WORKGROUP));
        let mut commands = Commands::new(device, &canvas.timer, 2);
        let traced = [world, nodes, triangles, items, tables, &self.parameters, &canvas.film, texels];
        commands.run(TRACE, &self.light, &traced, groups);
        if !is_shown {
            return commands.finish().map(|()| None);
        }
        let developed = [&self.parameters, &canvas.film, &canvas.shown];
        commands.run(FILTER, &self.develop, &developed, groups);
        let (words, times) = commands.read::<u32>(&canvas.shown)?;
        let (rays, colors) = words.split_at(1);
        Ok(Some(Picture {
            pixels: colors.as_chunks().0.iter().map(|color| color.map(f32::from_bits)).collect(),
            rays: rays.iter().map(|&rays| u64::from(rays)).sum(),
            stages: Stages { trace: times[TRACE], filter: times[FILTER] },
        }))
    }
}
