//! A planet, its walker, and the scene that is rendered of them.

use std::path::Path;
use std::sync::Arc;
use std::time::{Duration, Instant};

use alhazen::Overrides;
use alhazen::assets::MemoryAssets;
#[cfg(feature = "gpu")]
use alhazen::description::Diagnostic;
use alhazen::description::{CameraDesc, FilterDesc, IntegratorDesc, SamplerKind, TransformDesc};
#[cfg(feature = "gpu")]
use alhazen::device::Kernels;
use alhazen::geometry::GeometryId;
use alhazen::import::import;
use alhazen::integrators::{Control, Limits};
use alhazen::math::{DMat4, Point3, Vec3};
use planet::{Input, Planet, Substance, Walker, scene};
use rayon::prelude::*;

#[cfg(feature = "gpu")]
use super::on_device::OnDevice;
use crate::step::StepError;
use crate::world::summary;
use crate::{Frame, Shot, World};

/// The length of a step in seconds.
pub const STEP: f32 = 1.0 / 30.0;

/// What a blast throws: everything this near to where it is, in metres, at up to this speed.
const BLAST: [f32; 2] = [2.5, 11.0];
/// How far in front of the eyes it is.
const BLAST_DISTANCE: f32 = 5.0;

/// The times of a frame.
#[derive(Clone, Copy, Debug, Default)]
pub struct Spent {
    /// Gravity, collisions and the walker.
    pub simulating: Duration,
    /// Moving the spheres of the scene, and refitting or building their tree; of a GPU, by its
    /// clock if it has one.
    pub moving: Duration,
    /// Rendering and developing.
    pub rendering: Duration,
    /// Of rendering, what a GPU spends on rays, and on what is computed where they hit.
    pub tracing: Option<Duration>,
}

impl Spent {
    /// All of it.
    pub fn sum(&self) -> Duration {
        self.simulating + self.moving + self.rendering
    }
}

/// Where the spheres of a planet and its walker's eyes are at a time.
#[derive(Clone, Debug)]
pub struct Moment {
    spheres: Vec<(GeometryId, Arc<[Point3]>)>,
    camera: CameraDesc,
}

/// A planet, its walker, and the scene that is rendered of them.
pub struct Outing {
    planet: Planet,
    walker: Walker,
    world: World,
    shot: Shot,
    /// The sets of spheres of the scene, with what they are made of.
    sets: Vec<(GeometryId, Substance)>,
    /// What renders instead of the CPU.
    #[cfg(feature = "gpu")]
    device: Option<OnDevice>,
}

impl Outing {
    /// On a planet of as many spheres, with changes to its scene. `samples` are those of a pixel in
    /// each picture. The error says what in the changes is not valid.
    pub fn new(spheres: usize, overrides: &Overrides, samples: u32) -> Result<Self, String> {
        let planet = Planet::new(spheres);
        let walker = Walker::new(&planet);
        let name = "planet.pbrt";
        let text = scene(&planet, &walker.viewpoint(&planet), "planet");
        let mut imported = import(Path::new(name), &MemoryAssets::default().with(name, text));
        // A frame has time for a sample of each pixel and a shadow ray towards the sun. Few samples
        // make a sharper picture with the filter that is a pixel.
        imported.desc.filter.value = FilterDesc::Box { radius: [0.5; 2] };
        if samples == 1 {
            // One sample has nothing to be stratified with in its pixel.
            imported.desc.sampler.value.kind = SamplerKind::Independent { pixel_samples: 1 };
        }
        if let IntegratorDesc::Whitted(whitted) = &mut imported.desc.integrator.value {
            whitted.ambient = true;
        }
        overrides.apply(&mut imported.desc).map_err(|error| error.to_string())?;
        let world = World::new(imported.desc).map_err(|errors| summary(&errors))?;
        let shot = Shot { samples, ..world.shot() };
        let occurs = |substance: &Substance| !planet.bodies().range(*substance).is_empty();
        let ids = world.scene().sphere_sets().map(|(id, _)| id);
        let sets = ids.zip(Substance::ALL.into_iter().filter(occurs)).collect();
        Ok(Self {
            planet,
            walker,
            world,
            shot,
            sets,
            #[cfg(feature = "gpu")]
            device: None,
        })
    }

    /// Moves the spheres and renders by a GPU from now on. The error says what it does not draw or
    /// move; then the CPU goes on.
    #[cfg(feature = "gpu")]
    pub fn move_to(&mut self, kernels: &Arc<Kernels>) -> Result<(), Vec<Diagnostic>> {
        self.device = Some(OnDevice::new(&self.world, &self.shot, kernels)?);
        Ok(())
    }

    /// The name of the GPU that renders; `None` if that is the CPU.
    pub fn device(&self) -> Option<&str> {
        #[cfg(feature = "gpu")]
        return self.device.as_ref().map(OnDevice::name);
        #[cfg(not(feature = "gpu"))]
        None
    }

    /// The planet.
    pub fn planet(&self) -> &Planet {
        &self.planet
    }

    /// Who walks on it.
    pub fn walker(&self) -> &Walker {
        &self.walker
    }

    /// The scene.
    pub fn world(&self) -> &World {
        &self.world
    }

    /// What is rendered of it.
    pub fn shot(&self) -> &Shot {
        &self.shot
    }

    /// Turns the walker to the right, and up, by angles in radians.
    pub fn turn(&mut self, right: f32, up: f32) {
        self.walker.turn(&self.planet, right, up);
    }

    /// Tears loose what the walker looks at from nearby.
    pub fn blast(&mut self) {
        let at = self.walker.eyes(&self.planet) + self.walker.gaze(&self.planet) * BLAST_DISTANCE;
        self.planet.blast(at, BLAST[0], BLAST[1]);
    }

    /// Lets time pass, by some steps, and renders a picture.
    pub fn frame(
        &mut self,
        input: &Input,
        steps: u32,
        control: &Control,
    ) -> Result<(Frame, Spent), StepError> {
        let begin = Instant::now();
        self.pass(input, steps);
        let simulating = begin.elapsed();
        let moment = self.moment();
        let copying = begin.elapsed() - simulating;
        let (mut frame, mut spent) = self.show(&moment, control)?;
        spent.simulating = simulating;
        spent.moving += copying;
        frame.time = spent.sum();
        Ok((frame, spent))
    }

    /// Lets time pass, by some steps.
    pub fn pass(&mut self, input: &Input, steps: u32) {
        for _ in 0..steps {
            self.walker.step(&self.planet, input, STEP);
            self.planet.step(Some(self.walker.body()), STEP);
        }
    }

    /// Where everything is by now.
    pub fn moment(&self) -> Moment {
        Moment { spheres: self.moved(), camera: self.camera() }
    }

    /// Renders a picture of a moment of this outing.
    pub fn show(&mut self, moment: &Moment, control: &Control) -> Result<(Frame, Spent), StepError> {
        let begin = Instant::now();
        self.shot.camera = moment.camera.clone();
        #[cfg(feature = "gpu")]
        if let Some(device) = &mut self.device {
            let (mut frame, moving) = device.frame(&self.world, &self.shot, &moment.spheres)?;
            let rendering = begin.elapsed().saturating_sub(moving);
            let tracing = frame.stages.map(|stages| stages.trace);
            let spent = Spent { moving, rendering, tracing, ..Spent::default() };
            frame.time = spent.sum();
            return Ok((frame, spent));
        }
        let moved = self.world.move_points(moment.spheres.clone());
        moved.map_err(|error| StepError::Problem(error.to_string()))?;
        let moving = begin.elapsed();
        let mut session = self.world.draft(&self.shot, 1)?;
        session.run(0..self.shot.samples, &Limits::default(), control, &mut |_| ())?;
        let mut frame = Frame::of(&session, 1, self.shot.layer);
        let spent = Spent { moving, rendering: begin.elapsed() - moving, ..Spent::default() };
        frame.time = spent.sum();
        Ok((frame, spent))
    }

    /// Where the spheres of the scene are by now.
    fn moved(&self) -> Vec<(GeometryId, Arc<[Point3]>)> {
        let origin = self.world.scene().world_from_render().w_axis.truncate().as_vec3();
        let (origin, bodies) = (Vec3::from(origin), self.planet.bodies());
        let centers = |&(id, substance): &(GeometryId, Substance)| {
            let centers = &bodies.center[bodies.range(substance)];
            let centers: Arc<[Point3]> = centers.iter().map(|&center| center - origin).collect();
            (id, centers)
        };
        self.sets.par_iter().map(centers).collect()
    }

    /// The camera in the walker's eyes. Its right is forward × up.
    fn camera(&self) -> CameraDesc {
        let (up, gaze) = (self.walker.up(&self.planet), self.walker.gaze(&self.planet));
        let right = gaze.cross(up).normalize_or(Vec3::X);
        let axes = [right, right.cross(gaze), gaze].map(|axis| axis.as_dvec3().extend(0.0));
        let eyes = self.walker.eyes(&self.planet).as_dvec3().extend(1.0);
        let world_from_camera = DMat4::from_cols(axes[0], axes[1], axes[2], eyes);
        let camera_from_world = TransformDesc::fixed(world_from_camera.inverse());
        CameraDesc { camera_from_world, ..self.shot.camera.clone() }
    }
}
