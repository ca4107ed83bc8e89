//! Pictures by a GPU: in motion, and at rest.
//!
//! A driver may take many seconds to compile the kernels of a scene. A thread waits for that, while
//! the CPU renders.

use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::{Duration, Instant};

use alhazen::description::Diagnostic;
use alhazen::device::Kernels;
use alhazen::realtime::{Aim, GpuError, Picture, Realtime, Weights};
use alhazen::scene::Scene;

use crate::frame::Stages;
use crate::step::{SHORTEST, StepError};
use crate::world::messages;
use crate::{Frame, Shot, World};

/// The device, with what is shown there.
pub struct OnDevice {
    kernels: Arc<Kernels>,
    /// How samples of direct light count, if pixels and frames in motion share them.
    shared: Option<Weights>,
    shown: Option<Shown>,
    /// When the last picture was shown.
    last: Instant,
}

/// A scene by the algorithm of a name.
struct Shown {
    integrator: String,
    scene: Arc<Scene>,
    made: Made,
}

/// What shows a scene on the device.
enum Made {
    /// A thread makes it.
    Soon(JoinHandle<Result<Realtime, Vec<Diagnostic>>>),
    /// It is there.
    Here(Box<Realtime>),
    /// The CPU renders, because kernels do not draw this.
    Not(Vec<Diagnostic>),
}

impl Made {
    /// What a thread has made.
    fn of(thread: JoinHandle<Result<Realtime, Vec<Diagnostic>>>) -> Self {
        match thread.join() {
            Ok(Ok(realtime)) => Self::Here(Box::new(realtime)),
            Ok(Err(refusals)) => Self::Not(refusals),
            // A panic of the thread has been reported by it.
            Err(_) => Self::Not(Vec::new()),
        }
    }
}

impl From<GpuError> for StepError {
    fn from(error: GpuError) -> Self {
        Self::Problem(error.to_string())
    }
}

impl OnDevice {
    /// Nothing is shown yet.
    pub fn new(kernels: Arc<Kernels>, shared: Option<Weights>) -> Self {
        Self { kernels, shared, shown: None, last: Instant::now() }
    }

    /// The device.
    pub fn kernels(&self) -> &Arc<Kernels> {
        &self.kernels
    }

    /// How samples of direct light count, if pixels and frames share them.
    pub fn shared(&self) -> Option<Weights> {
        self.shared
    }

    /// The name of the device, if it draws what is shown.
    pub fn name(&self) -> Option<&str> {
        Some(self.realtime()?.device())
    }

    /// What kernels do not draw of what is shown.
    pub fn refusals(&self) -> &[Diagnostic] {
        match &self.shown {
            Some(Shown { made: Made::Not(refusals), .. }) => refusals,
            _ => &[],
        }
    }

    /// The samples of each pixel of the picture at rest.
    pub fn rested(&self) -> Option<u32> {
        Some(self.realtime()?.progress().0).filter(|&rested| rested > 0)
    }

    fn realtime(&self) -> Option<&Realtime> {
        match &self.shown {
            Some(Shown { made: Made::Here(realtime), .. }) => Some(realtime),
            _ => None,
        }
    }

    /// Whether kernels that were awaited are compiled now.
    pub fn is_ready(&self) -> bool {
        matches!(&self.shown, Some(Shown { made: Made::Soon(thread), .. }) if thread.is_finished())
    }

    /// Waits until the kernels for a shot are compiled.
    pub fn wait(&mut self, world: &World, shot: &Shot) -> Result<(), StepError> {
        if !self.shows(world, shot) {
            self.show(world, shot)?;
        }
        self.shown = self.shown.take().map(|shown| match shown.made {
            Made::Soon(thread) => Shown { made: Made::of(thread), ..shown },
            _ => shown,
        });
        Ok(())
    }

    /// Whether this is what the device shows, or will.
    fn shows(&self, world: &World, shot: &Shot) -> bool {
        self.shown.as_ref().is_some_and(|shown| {
            shown.integrator == shot.integrator && Arc::ptr_eq(&shown.scene, world.scene())
        })
    }

    /// Lets a thread take a scene to the device.
    fn show(&mut self, world: &World, shot: &Shot) -> Result<(), StepError> {
        let (desc, scene) = (world.settings(shot)?, world.scene().clone());
        let (kernels, shared, of) = (self.kernels.clone(), self.shared, scene.clone());
        let made = Made::Soon(thread::spawn(move || Realtime::new(&of, &desc, &kernels, shared)));
        self.shown = Some(Shown { integrator: shot.integrator.clone(), scene, made });
        Ok(())
    }

    /// Looks at a shot, in pixels `n` times as wide and high; `None` if the CPU has to do that.
    fn aim(&mut self, world: &World, shot: &Shot, n: u32) -> Result<Option<(&mut Realtime, Aim)>, StepError> {
        if shot.layer.is_some() {
            return Ok(None);
        }
        if !self.shows(world, shot) {
            self.show(world, shot)?;
        } else if self.is_ready() {
            self.wait(world, shot)?;
        }
        let Some(Shown { made: Made::Here(realtime), .. }) = &mut self.shown else { return Ok(None) };
        match realtime.aim(&world.settings(shot)?, n) {
            Ok(aim) => Ok(Some((realtime, aim))),
            Err(refusals) => Err(StepError::Problem(messages(&refusals))),
        }
    }

    /// A picture of a camera that moves.
    pub fn draft(&mut self, world: &World, shot: &Shot, n: u32) -> Result<Option<Frame>, StepError> {
        let begin = Instant::now();
        let Some((realtime, aim)) = self.aim(world, shot, n)? else { return Ok(None) };
        let picture = realtime.moving(shot.samples)?;
        Ok(Some(frame(realtime, aim, n, picture, begin.elapsed())))
    }

    /// Begins a picture of a camera that rests; false if the CPU has to do that.
    pub fn rest(&mut self, world: &World, shot: &Shot) -> Result<bool, StepError> {
        let is_drawn = self.aim(world, shot, 1)?.is_some();
        self.last = Instant::now();
        Ok(is_drawn)
    }

    /// Adds samples to the picture of a camera that rests; a picture if it is time for one, and
    /// whether it is done.
    pub fn add(&mut self, world: &World, shot: &Shot) -> Result<(Option<Frame>, bool), StepError> {
        let desc = world.settings(shot)?;
        let Some(Shown { made: Made::Here(realtime), .. }) = &mut self.shown else { return Ok((None, true)) };
        let (done, planned) = realtime.progress();
        let is_last = done + shot.samples >= planned;
        let is_shown = done == 0 || is_last || self.last.elapsed() >= SHORTEST;
        let Some(picture) = realtime.resting(shot.samples, is_shown)? else { return Ok((None, is_last)) };
        let aim = realtime.look(&desc, 1).map_err(|errors| StepError::Problem(messages(&errors)))?;
        let time = self.last.elapsed();
        self.last = Instant::now();
        Ok((Some(frame(realtime, aim, 1, picture, time)), is_last))
    }
}

/// A picture, in pixels `n` times as wide and high, that took so long.
pub fn frame(realtime: &Realtime, aim: Aim, n: u32, picture: Picture, time: Duration) -> Frame {
    let (samples, planned) = realtime.progress();
    let Aim { view, pixels: bounds } = aim;
    let of_device = picture.stages;
    let stages = Stages {
        trace: of_device.trace,
        filter: of_device.filter,
        rest: time.saturating_sub(of_device.trace + of_device.filter),
    };
    Frame {
        size: [bounds.width() as u32, bounds.height() as u32],
        n,
        first: bounds.min,
        view,
        pixels: picture.pixels,
        layer: None,
        color_space: realtime.color_space(),
        samples,
        planned,
        time,
        rays: picture.rays,
        stages: Some(stages),
    }
}
