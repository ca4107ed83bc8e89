//! Pictures by a GPU: in motion, and at rest.

use std::sync::Arc;
use std::time::{Duration, Instant};

use alhazen::description::Diagnostic;
use alhazen::device::Kernels;
use alhazen::realtime::{Aim, GpuError, Picture, Realtime, Weights};

use crate::frame::Stages;
use crate::step::{SHORTEST, StepError};
use crate::world::messages;
use crate::{Frame, Shot, World};

/// The device, with what is shown there.
pub struct OnDevice {
    kernels: Arc<Kernels>,
    /// How samples of direct light count, if pixels and frames in motion share them.
    shared: Option<Weights>,
    /// The scene by the algorithm of this name; without it where kernels do not draw it.
    shown: Option<(String, Option<Realtime>)>,
    /// Why the CPU renders.
    refusals: Vec<Diagnostic>,
    /// When the last picture was shown.
    last: Instant,
}

impl From<GpuError> for StepError {
    fn from(error: GpuError) -> Self {
        Self::Problem(error.to_string())
    }
}

impl OnDevice {
    /// Nothing is shown yet.
    pub fn new(kernels: Arc<Kernels>, shared: Option<Weights>) -> Self {
        Self { kernels, shared, shown: None, refusals: Vec::new(), last: Instant::now() }
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
        Some(self.shown.as_ref()?.1.as_ref()?.device())
    }

    /// What kernels do not draw of what is shown.
    pub fn refusals(&self) -> &[Diagnostic] {
        &self.refusals
    }

    /// The samples of each pixel of the picture at rest.
    pub fn rested(&self) -> Option<u32> {
        Some(self.shown.as_ref()?.1.as_ref()?.progress().0).filter(|&rested| rested > 0)
    }

    /// Looks at a shot, in pixels `n` times as wide and high; `None` if the CPU has to do that.
    fn aim(&mut self, world: &World, shot: &Shot, n: u32) -> Result<Option<(&mut Realtime, Aim)>, StepError> {
        if shot.layer.is_some() {
            return Ok(None);
        }
        let desc = world.settings(shot)?;
        let is_shown = self.shown.as_ref().is_some_and(|(name, realtime)| {
            *name == shot.integrator && realtime.as_ref().is_none_or(|realtime| realtime.is_of(world.scene()))
        });
        if !is_shown {
            let made = Realtime::new(world.scene(), &desc, &self.kernels, self.shared);
            self.refusals = made.as_ref().err().cloned().unwrap_or_default();
            self.shown = Some((shot.integrator.clone(), made.ok()));
        }
        let Some((_, Some(realtime))) = &mut self.shown else { return Ok(None) };
        match realtime.aim(&desc, n) {
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
        let Some((_, Some(realtime))) = &mut self.shown else { return Ok((None, true)) };
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
