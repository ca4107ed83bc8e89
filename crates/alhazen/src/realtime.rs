//! Pictures at once, by a device: of a compiled scene, whose camera may move.

use std::sync::Arc;

use description::schema::Settings;
use description::{Diagnostic, SceneDesc, Span};
use geometry::{GeometryId, InstanceId};
use gpu::{AimError, Algorithm, Flat, MovingError};
use math::{Bounds2i, Point3, Transform};
use sampling::Sampler;
use scene::{Scene, View};
use spectrum::RgbColorSpace;

use crate::device::{Flattened, Kernels, Rays, failed, flattened, name};
use crate::sketch::coarse;

pub use gpu::{GpuError, Picture, Stages, Update, Weights};

/// A scene on a device.
pub struct Realtime {
    scene: Arc<Scene>,
    engine: gpu::Realtime,
    device: String,
    pixels: Bounds2i,
    color_space: &'static RgbColorSpace,
    planned: u32,
}

/// What a device shows.
pub struct Aim {
    /// The view, in pixels of their size.
    pub view: View,
    /// The pixels.
    pub pixels: Bounds2i,
}

impl Realtime {
    /// Takes a compiled scene to a device, with the algorithm, film and sampler of a description,
    /// whose geometry does not count. With `shared`, pixels and frames share samples of direct
    /// light while the camera moves. The error says what kernels do not draw.
    pub fn new(
        scene: &Arc<Scene>,
        desc: &SceneDesc,
        kernels: &Arc<Kernels>,
        shared: Option<Weights>,
    ) -> Result<Self, Vec<Diagnostic>> {
        Self::made(scene, desc, kernels, Rays::OfDevice, |flat, algorithm| {
            gpu::Realtime::new(kernels.clone(), &flat, algorithm, shared).map_err(|error| failed(&error))
        })
    }

    /// The same, of a scene in which spheres, vertices and instances may move. The error says what
    /// kernels do not draw or move.
    pub fn animated(
        scene: &Arc<Scene>,
        desc: &SceneDesc,
        kernels: &Arc<Kernels>,
    ) -> Result<Self, Vec<Diagnostic>> {
        Self::made(scene, desc, kernels, Rays::OfKernels, |flat, algorithm| {
            let made = gpu::Realtime::animated(kernels.clone(), flat, scene.world(), algorithm);
            made.map_err(|error| Diagnostic::warning("not-on-gpu", error.to_string(), Span::NONE))
        })
    }

    /// With an engine that is made of what is taken to the device.
    fn made(
        scene: &Arc<Scene>,
        desc: &SceneDesc,
        kernels: &Arc<Kernels>,
        rays: Rays,
        engine: impl FnOnce(Flat, &Algorithm) -> Result<gpu::Realtime, Diagnostic>,
    ) -> Result<Self, Vec<Diagnostic>> {
        let view = View::compile(desc, scene.world_from_render())?.view;
        let film = film::compile(desc)?.film;
        let Flattened { flat, algorithm, sampler } = flattened(desc, scene, &view, &film, kernels, rays)?;
        let whole = if algorithm.begins_at_lights() {
            Some(format!("integrator `{}`", desc.integrator.name()))
        } else {
            flat.parts().media.then(|| "participating media".to_owned())
        };
        if let Some(what) = whole {
            let message = format!("the engine for GPUs draws {what} only as a whole picture");
            return Err(vec![Diagnostic::warning("not-on-gpu", message, desc.integrator.origin.span)]);
        }
        Ok(Self {
            scene: scene.clone(),
            device: name(kernels.device(), &flat),
            engine: engine(flat, &algorithm).map_err(|error| vec![error])?,
            pixels: film.pixel_bounds(),
            color_space: film.color_space(),
            planned: Sampler::samples_per_pixel(&sampler),
        })
    }

    /// Moves the spheres of some sets and the vertices of some meshes of an
    /// [animated](Self::animated) scene, each given by its geometry and all its centres or vertices
    /// in render space, on the device alone: the scene stays.
    ///
    /// # Errors
    /// A geometry has no such points, or has normals of its own, is within instances, or shines; or
    /// the points do not fit; or the device fails.
    pub fn move_points<'a>(
        &mut self,
        moved: impl IntoIterator<Item = (GeometryId, &'a [Point3])>,
        update: Update,
    ) -> Result<(), MovingError> {
        let moved: Vec<_> = moved.into_iter().collect();
        moved.iter().try_for_each(|(id, _)| self.scene.may_move_points(*id)).map_err(MovingError::Move)?;
        self.engine.move_points(moved, update)
    }

    /// Gives instances of an animated scene other transforms to render space, on the device alone.
    ///
    /// # Errors
    /// An instance is within another one, or moves by itself, or a shape in it shines; or the
    /// transform has no inverse; or the device fails.
    pub fn move_instances(
        &mut self,
        moved: &[(InstanceId, Transform)],
        update: Update,
    ) -> Result<(), MovingError> {
        let may_move = self.scene.may_move_instances(moved.iter().map(|(id, _)| *id));
        may_move.map_err(MovingError::Move)?;
        self.engine.move_instances(moved, update)
    }

    /// Whether it shows this scene.
    pub fn is_of(&self, scene: &Arc<Scene>) -> bool {
        Arc::ptr_eq(&self.scene, scene)
    }

    /// What the camera of a description sees, in pixels `n` times as wide and high.
    pub fn look(&self, desc: &SceneDesc, n: u32) -> Result<Aim, Vec<Diagnostic>> {
        let view = View::compile(desc, self.scene.world_from_render())?.view.coarser(n);
        Ok(Aim { view, pixels: coarse(&self.pixels, n as i32) })
    }

    /// Looks through the camera of a description, in pixels `n` times as wide and high.
    pub fn aim(&mut self, desc: &SceneDesc, n: u32) -> Result<Aim, Vec<Diagnostic>> {
        let Aim { view, pixels } = self.look(desc, n)?;
        self.engine.aim(&view, pixels).map_err(|error| match error {
            AimError::Refused(what) => {
                let message = format!("the engine for GPUs does not draw {what}");
                vec![Diagnostic::warning("not-on-gpu", message, desc.camera.origin.span)]
            }
            AimError::Gpu(error) => vec![failed(&error)],
        })?;
        Ok(Aim { view, pixels })
    }

    /// A picture for a camera that moves, of so many samples of each pixel.
    pub fn moving(&mut self, samples: u32) -> Result<Picture, GpuError> {
        Ok(self.engine.moving(samples)?.unwrap_or_default())
    }

    /// Adds samples to the picture of a camera that rests: the next ones of those that the whole
    /// picture has. The picture, if it is wanted.
    pub fn resting(&mut self, samples: u32, is_shown: bool) -> Result<Option<Picture>, GpuError> {
        self.engine.resting(samples.min(self.planned.saturating_sub(self.engine.rested())), is_shown)
    }

    /// The light of the last frame in motion before it is filtered, as colours.
    pub fn unfiltered(&self) -> Result<Vec<[f32; 3]>, GpuError> {
        self.engine.unfiltered()
    }

    /// The samples of each pixel of the picture at rest, and how many it will have.
    pub fn progress(&self) -> (u32, u32) {
        (self.engine.rested(), self.planned)
    }

    /// The space of its colours.
    pub fn color_space(&self) -> &'static RgbColorSpace {
        self.color_space
    }

    /// The name of the device, and by what it traces rays if ray queries were asked for.
    pub fn device(&self) -> &str {
        &self.device
    }
}
