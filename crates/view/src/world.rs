//! A scene that is walked through: compiled, with its description for changes.

use std::sync::Arc;
use std::time::{Duration, Instant};

use crate::Flight;
use alhazen::description::schema::Settings;
use alhazen::description::{CameraDesc, Diagnostic, SceneDesc};
use alhazen::film::{Layer, pixel_bounds};
use alhazen::geometry::GeometryId;
use alhazen::integrators::Session;
use alhazen::math::{Bounds2i, DVec3, Point3, Vec2};
use alhazen::scene::camera::CameraSample;
use alhazen::scene::texture::color_space;
use alhazen::scene::{MoveError, RayStats, Scene, View};
use alhazen::spectrum::RgbColorSpace;
use alhazen::{CompiledJob, Job, Overrides, draft};

/// What is shown of a scene.
#[derive(Clone, Debug)]
pub struct Shot {
    /// The camera.
    pub camera: CameraDesc,
    /// The name of the algorithm, as in [`alhazen::integrator_names`].
    pub integrator: String,
    /// Samples per pixel of each picture: more make edges smoother.
    pub samples: u32,
    /// The layer that is shown instead of the colours.
    pub layer: Option<Layer>,
}

/// A compiled scene with its description.
pub struct World {
    scene: Arc<Scene>,
    /// The description without geometry.
    desc: SceneDesc,
    /// How long it took to compile.
    pub compiled_in: Duration,
    /// What is rendered differently from its description.
    pub warnings: Vec<Diagnostic>,
}

impl World {
    /// Compiles a scene; the error is the list of all its diagnostics.
    pub fn new(desc: SceneDesc) -> Result<Self, Vec<Diagnostic>> {
        let begin = Instant::now();
        let settings = desc.without_geometry();
        let CompiledJob { job, warnings } = Job::compile(desc)?;
        let scene = Arc::clone(job.session.scene());
        Ok(Self { scene, desc: settings, compiled_in: begin.elapsed(), warnings })
    }

    /// The compiled scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// Moves spheres and vertices ([`Scene::move_points`]).
    pub fn move_points(
        &mut self,
        moved: impl IntoIterator<Item = (GeometryId, Arc<[Point3]>)>,
    ) -> Result<(), MoveError> {
        // Renders that have not ended keep the scene as it was.
        Arc::make_mut(&mut self.scene).move_points(moved)
    }

    /// What the scene's author shows of it.
    pub fn shot(&self) -> Shot {
        Shot {
            camera: self.desc.camera.value.clone(),
            integrator: self.desc.integrator.name().to_owned(),
            samples: 1,
            layer: None,
        }
    }

    /// The pixels of its pictures.
    pub fn bounds(&self) -> Bounds2i {
        pixel_bounds(&self.desc.film)
    }

    /// The colour space of its pictures.
    pub fn color_space(&self) -> &'static RgbColorSpace {
        color_space(self.desc.film.color_space)
    }

    /// A flight that begins at the scene's camera.
    pub fn flight(&self) -> Flight {
        let (shot, bounds) = (self.shot(), self.bounds());
        let middle = [0, 1].map(|axis| 0.5 * (bounds.min[axis] + bounds.max[axis]) as f32);
        let focus = self.view(&shot).and_then(|view| self.seen_at(&view, middle));
        Flight::new(shot.camera, focus.unwrap_or(DVec3::ZERO))
    }

    /// The whole render of a shot.
    pub fn job(&self, shot: &Shot) -> Result<Job, String> {
        let compiled = Job::of_scene(Arc::clone(&self.scene), &self.settings(shot)?);
        compiled.map(|compiled| compiled.job).map_err(|errors| summary(&errors))
    }

    /// A render of a shot in pixels `n` times as wide and high.
    pub fn draft(&self, shot: &Shot, n: u32) -> Result<Session, String> {
        let session = draft(&self.scene, self.settings(shot)?, n, shot.samples);
        session.map_err(|errors| summary(&errors))
    }

    /// The view of a shot; `None` if its camera or its settings have errors.
    pub fn view(&self, shot: &Shot) -> Option<View> {
        let settings = self.settings(shot).ok()?;
        Some(View::compile(&settings, self.scene.world_from_render()).ok()?.view)
    }

    /// The point of the world that is seen at a position on the film; where that is nothing, one
    /// as far away as the middle of the scene.
    pub fn seen_at(&self, view: &View, film: [f32; 2]) -> Option<DVec3> {
        let film = Vec2::new(film[0], film[1]);
        let sample = CameraSample { film, lens: Vec2::splat(0.5), time: 0.5, filter_weight: 1.0 };
        let ray = view.camera.generate_ray(&sample)?.ray;
        let sphere = self.scene.sphere();
        let t = match self.scene.hit(&ray, f32::INFINITY, &mut RayStats::default()) {
            Some(hit) => hit.t,
            None => (sphere.center - ray.o).length().max(0.5 * sphere.radius).max(f32::MIN_POSITIVE),
        };
        let p = ray.o + ray.d * t;
        Some(self.scene.world_from_render().transform_point3(p.as_dvec3()))
    }

    pub(crate) fn settings(&self, shot: &Shot) -> Result<SceneDesc, String> {
        let mut desc = self.desc.clone();
        desc.camera.value = shot.camera.clone();
        let overrides = Overrides {
            integrator: Some(shot.integrator.clone()),
            layers: shot.layer.iter().map(|layer| layer.name().to_owned()).collect(),
            ..Overrides::default()
        };
        overrides.apply(&mut desc).map_err(|error| error.to_string())?;
        Ok(desc)
    }
}

/// The errors among diagnostics, as text.
pub fn summary(diagnostics: &[Diagnostic]) -> String {
    messages(diagnostics.iter().filter(|diagnostic| diagnostic.is_error()))
}

/// Diagnostics as text.
pub fn messages<'a>(diagnostics: impl IntoIterator<Item = &'a Diagnostic>) -> String {
    diagnostics.into_iter().map(|it| it.message.as_str()).collect::<Vec<_>>().join("\n")
}
