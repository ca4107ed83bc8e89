//! Pictures at once. Only those that are shown are read back from the device.
//!
//! While the camera moves, a frame has a few samples of each pixel. They are averaged with those of
//! the frames before, where these saw the same surface, and filtered by an edge-avoiding wavelet
//! transform whose edges of light are as hard as the variance of the pixels allows: spatiotemporal
//! variance-guided filtering [Schied 2017]. What is filtered is light divided by the reflectance of
//! what is seen, so that textures stay sharp.
//!
//! Direct light of first surfaces is that of the algorithm, or of samples that pixels and frames
//! share ([`Weights`]).
//!
//! Spheres, vertices and instances may move from picture to picture ([`Realtime::animated`]): the
//! first kernels of a picture then build their trees.
//!
//! When the camera rests, samples of the algorithm are added up, and the picture goes over from the
//! filtered one to their mean: frames that share samples have errors in common, which a mean keeps.

mod canvas;
pub(crate) mod frame;
mod reservoirs;

use std::sync::Arc;
use std::time::Duration;

use geometry::{GeometryId, InstanceId, World};
use math::{Bounds2i, Point3, Transform};
use rayon::prelude::*;
use sampling::sampler::Independent;
use scene::View;
use scene::camera::Projection;

use crate::Flat;
use crate::algorithm::Algorithm;
use crate::commands::Commands;
use crate::device::{Binding, Buffer, Device, GpuError, Kernel};
use crate::dynamic::{Moving, MovingError, Update};
use crate::flatten::{Head, cameras};
use crate::renderer::{Kernels, SceneBuffers};
use crate::shaders;
use crate::tags::SamplerTag;
use crate::trees::Trees;
use canvas::Canvas;
use frame::{Eye, FrameParameters, Level};
use reservoirs::Reservoirs;

pub use reservoirs::Weights;

/// Pixels of a side of a kernel's workgroups.
const WORKGROUP: u32 = 8;

/// The fewest pixels that a thread copies at a time.
const PIXELS_OF_A_THREAD: usize = 1 << 14;

/// A stage of a frame, as an index of times.
const TRACE: usize = 0;
const FILTER: usize = 1;
const BUILD: usize = 2;

/// The levels of the wavelet transform.
const LEVELS: u32 = 5;

/// As many samples as a filtered picture is worth, and after so many at rest it counts no more.
const WORTH: f32 = 8.0;
const TRANSITION: f32 = 64.0;

/// A scene on a device, of which pictures are made at once.
pub struct Realtime {
    surfaces: Arc<Kernel>,
    light: Arc<Kernel>,
    filters: [Arc<Kernel>; 4],
    levels: Vec<Buffer>,
    reservoirs: Option<Reservoirs>,
    head: Head,
    /// Where the random numbers of frames in motion are among the tables.
    restless: u32,
    scene: SceneBuffers,
    parameters: Buffer,
    canvas: Option<Canvas>,
    /// What moves.
    moving: Option<Moving>,
    /// The camera now, and that of the last frame in motion, if it is of this canvas.
    eye: Eye,
    last: Option<Eye>,
    /// The half of the buffers that the last frame in motion has.
    half: u32,
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
    /// The trees of what moves.
    pub build: Duration,
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
    /// Takes a scene to the device. With `shared`, pixels and frames in motion share samples of
    /// direct light, if that is a part of the algorithm.
    pub fn new(
        kernels: Arc<Kernels>,
        flat: &Flat,
        algorithm: &Algorithm,
        shared: Option<Weights>,
    ) -> Result<Self, GpuError> {
        // Among media light finds its way through them, or through interfaces, and where it leaves
        // bodies it is not that of what is seen.
        let has_direct_light =
            matches!(algorithm, Algorithm::Path(desc) | Algorithm::VolPath(desc) if desc.max_depth > 0);
        let shared = shared.filter(|_| has_direct_light && !(flat.parts.media || flat.parts.subsurface));
        let device = kernels.device();
        let restless = flat.tables.len() as u32;
        let key = Independent::new(1, 0).key();
        let tables: Vec<u32> =
            flat.tables.iter().copied().chain([SamplerTag::Independent as u32, key, 0, 0]).collect();
        let scene = SceneBuffers::new(kernels.clone(), flat, &tables)?;
        let parameters = device.parameters(&FrameParameters::default())?;
        // Drivers take seconds to compile each of these.
        let ((light, surfaces), reservoirs) = rayon::join(
            || {
                rayon::join(
                    || kernels.get("light", shaders::light(algorithm, flat.parts, false)),
                    || kernels.get("surfaces", shaders::surfaces(algorithm, flat.parts)),
                )
            },
            || shared.map(|weights| Reservoirs::new(&kernels, algorithm, flat.parts, weights)).transpose(),
        );
        let (light, surfaces, reservoirs) = (light?, surfaces?, reservoirs?);
        let [temporal, variance, wavelet, develop] = shaders::filters();
        let filters = [
            kernels.get("temporal", temporal)?,
            kernels.get("variance", variance)?,
            kernels.get("wavelet", wavelet)?,
            kernels.get("develop", develop)?,
        ];
        let level =
            |level: u32| Level { step: 1 << level, is_kept: u32::from(level == 0), ..Level::default() };
        let levels = (0..LEVELS).map(|i| device.parameters(&level(i))).collect::<Result<_, _>>()?;
        Ok(Self {
            reservoirs,
            surfaces,
            light,
            filters,
            levels,
            head: flat.head,
            restless,
            scene,
            parameters,
            canvas: None,
            moving: None,
            eye: Eye::default(),
            last: None,
            half: 0,
            rested: 0,
            moved: 0,
        })
    }

    /// Takes a scene to the device, in which spheres of sets, vertices of meshes and instances may
    /// move: those outside of instances. `world` is that of the scene.
    pub fn animated(
        kernels: Arc<Kernels>,
        mut flat: Flat,
        world: &World,
        algorithm: &Algorithm,
    ) -> Result<Self, MovingError> {
        let moving = Moving::new(&kernels, world, &mut flat.bvh)?;
        flat.head.top = flat.bvh.top;
        Ok(Self { moving: Some(moving), ..Self::new(kernels, &flat, algorithm, None)? })
    }

    /// Moves the spheres of some sets and the vertices of some meshes, each given by its geometry
    /// and all its centres or vertices in render space, before the next picture; a picture at rest
    /// begins again.
    ///
    /// # Errors
    /// The scene was not made for that, a geometry has no points that may move, or the points do
    /// not fit; or the device fails.
    pub fn move_points<'a>(
        &mut self,
        moved: impl IntoIterator<Item = (GeometryId, &'a [Point3])>,
        update: Update,
    ) -> Result<(), MovingError> {
        self.move_by(|moving, device| moving.place(device, moved, update))
    }

    /// Gives instances other transforms to render space before the next picture; a picture at rest
    /// begins again.
    ///
    /// # Errors
    /// The scene was not made for that, an instance is within another one or moves by itself, or
    /// its transform has no inverse; or the device fails.
    pub fn move_instances(
        &mut self,
        moved: &[(InstanceId, Transform)],
        update: Update,
    ) -> Result<(), MovingError> {
        self.move_by(|moving, device| moving.place_instances(device, moved, update))
    }

    fn move_by(
        &mut self,
        place: impl FnOnce(&mut Moving, &Device) -> Result<(), MovingError>,
    ) -> Result<(), MovingError> {
        let moving = self.moving.as_mut().ok_or(MovingError::Refused("a scene at rest"))?;
        let placed = place(moving, self.scene.device());
        self.head.top = moving.top();
        self.rested = 0;
        placed
    }

    /// The device.
    pub fn device(&self) -> &Device {
        self.scene.device()
    }

    /// Looks from somewhere, at these pixels of the film; a picture at rest begins again.
    pub fn aim(&mut self, view: &View, pixels: Bounds2i) -> Result<(), AimError> {
        if matches!(view.camera.projection(), Projection::Spherical(_)) {
            return Err(AimError::Refused("frames of camera `spherical`"));
        }
        if matches!(view.camera.projection(), Projection::Realistic(_)) {
            return Err(AimError::Refused("frames of camera `realistic`"));
        }
        if view.camera.is_moving() {
            return Err(AimError::Refused("frames of moving cameras"));
        }
        let camera = cameras::words(view, 0);
        let device = self.scene.device();
        let at = u64::from(self.head.camera) * size_of::<u32>() as u64;
        device.write_at(&self.scene.tables, at, &camera)?;
        if self.canvas.as_ref().is_none_or(|canvas| canvas.pixels != pixels) {
            self.canvas = Some(Canvas::new(device, pixels, self.reservoirs.is_some())?);
            self.last = None;
            if let Some(reservoirs) = &mut self.reservoirs {
                reservoirs.clear();
            }
        }
        self.eye = Eye::new(view);
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
        self.half = 1 - self.half;
        let frame = FrameParameters {
            index: self.moved,
            samples,
            half: self.half,
            has_history: self.last.is_some().into(),
            is_moving: 1,
            eye: self.last.unwrap_or_default(),
            ..canvas.frame()
        };
        let groups = groups(&frame);
        if let Some(reservoirs) = &mut self.reservoirs {
            reservoirs.begin(self.scene.device(), self.eye, frame.eye)?;
        }
        let mut commands = self.begin(canvas, head, frame)?;
        let Canvas { film, seen, history, estimates: [even, odd], .. } = canvas;
        let parameters = &self.parameters;
        let [temporal, variance, wavelet, _] = &self.filters;
        let looked = [&self.scene.with([parameters, seen])[..], &[film as &dyn Binding]].concat();
        commands.run(TRACE, &self.surfaces, &looked, groups);
        self.trace(&mut commands, canvas, groups, self.reservoirs.as_ref());
        commands.run(FILTER, temporal, &[parameters, seen, film, history], groups);
        commands.run(FILTER, variance, &[parameters, seen, history, even], groups);
        let (mut from, mut to) = (even, odd);
        for level in &self.levels {
            commands.run(FILTER, wavelet, &[parameters, seen, history, from, to, level], groups);
            (from, to) = (to, from);
        }
        let picture = self.develop(commands, canvas, from, groups)?;
        self.moved = self.moved.wrapping_add(samples);
        self.settle();
        self.rested = 0;
        self.last = Some(self.eye);
        Ok(Some(picture))
    }

    /// Adds samples to the picture of a camera that rests: those that the whole picture has, one
    /// after another. A picture if it is wanted.
    pub fn resting(&mut self, samples: u32, is_shown: bool) -> Result<Option<Picture>, GpuError> {
        let Some(canvas) = &self.canvas else { return Ok(None) };
        let before = self.rested;
        self.rested += samples;
        // There is no filtered picture of this camera without a frame in motion from there.
        let worth = if self.last == Some(self.eye) { WORTH } else { 0.0 };
        let prior = worth * (1.0 - self.rested as f32 / TRANSITION).max(0.0);
        let (half, eye) = (self.half, self.eye);
        let frame = FrameParameters { index: before, before, samples, half, prior, eye, ..canvas.frame() };
        let groups = groups(&frame);
        let mut commands = self.begin(canvas, self.head, frame)?;
        self.trace(&mut commands, canvas, groups, None);
        let picture = if is_shown {
            Some(self.develop(commands, canvas, &canvas.estimates[0], groups)?)
        } else {
            commands.finish()?;
            None
        };
        self.settle();
        Ok(picture)
    }

    /// After a picture of what has moved.
    fn settle(&mut self) {
        if let Some(moving) = &mut self.moving {
            moving.settle();
        }
    }

    /// The light of the last frame in motion as its samples have found it, before it is filtered:
    /// colours as those of a [`Picture`]. Empty before the camera is aimed.
    pub fn unfiltered(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        let Some(canvas) = &self.canvas else { return Ok(Vec::new()) };
        let words = self.scene.device().read::<f32>(&canvas.film)?;
        let pixels = words[canvas::HEAD as usize / 4..].chunks_exact(canvas::LIGHT as usize / 4);
        let mean = |light: &[f32]| [0, 1, 2].map(|i| if light[3] == 0.0 { 0.0 } else { light[i] / light[3] });
        Ok(pixels.map(mean).collect())
    }

    fn begin<'a>(
        &'a self,
        canvas: &'a Canvas,
        head: Head,
        frame: FrameParameters,
    ) -> Result<Commands<'a>, GpuError> {
        let device = self.scene.device();
        device.write(&self.scene.head, &[head])?;
        device.write(&self.parameters, &[frame])?;
        let mut commands = Commands::new(device, &canvas.timer, 3);
        let SceneBuffers { trees, triangles, items, .. } = &self.scene;
        if let (Some(moving), Trees::Nodes(nodes)) = (&self.moving, trees) {
            let mut start = |kernel: &Kernel, buffers: &[&Buffer], groups: u32| {
                commands.run(BUILD, kernel, buffers, [groups, 1]);
            };
            moving.run(device, [items, triangles, nodes], &mut start)?;
        }
        Ok(commands)
    }

    /// Finds the light of the frame, direct light by shared samples if there are any.
    fn trace(&self, commands: &mut Commands, canvas: &Canvas, groups: [u32; 2], shared: Option<&Reservoirs>) {
        let traced = self.scene.with([&self.parameters, &canvas.film]);
        commands.run(TRACE, shared.map_or(&self.light, |shared| &shared.light), &traced, groups);
        if let (Some(Reservoirs { candidates, reuse, steps, .. }), Some(buffer)) =
            (shared, &canvas.reservoirs)
        {
            for (kernel, step) in [candidates, reuse, reuse].into_iter().zip(steps) {
                let own: [&dyn Binding; 2] = [buffer, step];
                let buffers: Vec<&dyn Binding> = traced.into_iter().chain(own).collect();
                commands.run(TRACE, kernel, &buffers, groups);
            }
        }
    }

    /// Makes the picture, and waits for it.
    fn develop(
        &self,
        mut commands: Commands,
        canvas: &Canvas,
        smooth: &Buffer,
        groups: [u32; 2],
    ) -> Result<Picture, GpuError> {
        let [.., develop] = &self.filters;
        let developed = [&self.parameters, &canvas.film, &canvas.shown, &canvas.seen, smooth];
        commands.run(FILTER, develop, &developed, groups);
        // The number of rays, and colours: many, so that all threads copy them.
        let take = |bytes: &[u8]| {
            let (rays, colors) = bytes.split_at(size_of::<u32>());
            let colors = colors.par_chunks_exact(size_of::<[f32; 3]>()).with_min_len(PIXELS_OF_A_THREAD);
            let pixels = colors.map(bytemuck::pod_read_unaligned).collect();
            (u64::from(bytemuck::pod_read_unaligned::<u32>(rays)), pixels)
        };
        let ((rays, pixels), times) = commands.read(&canvas.shown, take)?;
        let stages = Stages { trace: times[TRACE], filter: times[FILTER], build: times[BUILD] };
        Ok(Picture { pixels, rays, stages })
    }
}

/// The workgroups of a frame.
fn groups(frame: &FrameParameters) -> [u32; 2] {
    frame.size.map(|side| side.div_ceil(WORKGROUP))
}
