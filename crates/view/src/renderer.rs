//! Renders a scene step by step: at once a draft in large pixels, then finer ones, then the picture
//! itself, sample by sample. Where the camera moves, it begins again.
//!
//! The picture itself is the [`Session`](alhazen::integrators::Session) of a whole render, so that
//! in the end it has the bits of `alhazen render`.

use std::sync::Arc;
use std::time::{Duration, Instant};

use alhazen::Job;
use alhazen::description::Diagnostic;
#[cfg(feature = "gpu")]
use alhazen::device::Kernels;
use alhazen::image::{DisplaySettings, ImageError};
use alhazen::integrators::{Control, Limits};
#[cfg(feature = "gpu")]
use alhazen::realtime::Weights;
use alhazen::trace::{PixelTrace, TraceError};
use alhazen::write_picture;

#[cfg(feature = "gpu")]
use crate::on_device::OnDevice;
use crate::step::{SHORTEST, StepError};
#[cfg(feature = "gpu")]
use crate::world::messages;
use crate::{Frame, Pace, Shot, World};

/// The least ratio of that time to the one that making a picture of the film takes.
const SHARE: u32 = 4;

/// A scene that is being rendered.
pub struct Renderer {
    world: Arc<World>,
    shot: Shot,
    pace: Pace,
    stage: Stage,
    #[cfg(feature = "gpu")]
    device: Option<OnDevice>,
}

/// What the next step does.
enum Stage {
    /// A picture as coarse as the pace has it.
    Draft,
    /// A picture in pixels this many times as wide and high; the picture itself from 1 on.
    Refine(u32),
    /// The next samples of the picture.
    Samples(Box<Samples>),
    /// The next samples of the picture on the device.
    #[cfg(feature = "gpu")]
    OnDevice,
    /// Nothing: the picture is done, or cannot be rendered.
    Rest(Option<Box<Job>>),
}

/// The picture with its next samples.
struct Samples {
    job: Job,
    /// When the last picture was shown, and the rays that had been traced then.
    shown: Instant,
    rays: u64,
    /// How long it took to make it of the film.
    cost: Duration,
}

impl Renderer {
    /// A renderer that shows what the scene's author shows of it, in drafts that take about
    /// `target`.
    pub fn new(world: Arc<World>, target: Duration) -> Self {
        let (shot, pace) = (world.shot(), Pace::new(target, world.bounds()));
        Self {
            world,
            shot,
            pace,
            stage: Stage::Draft,
            #[cfg(feature = "gpu")]
            device: None,
        }
    }

    /// Renders by a GPU what kernels draw, as soon as its driver has compiled them. With `shared`,
    /// pixels and frames share samples of direct light while the camera moves.
    #[cfg(feature = "gpu")]
    pub fn move_to(&mut self, kernels: Arc<Kernels>, shared: Option<Weights>) {
        self.device = Some(OnDevice::new(kernels, shared));
        self.stage = Stage::Draft;
    }

    /// Waits for the driver, so that the next picture is one by the GPU, if there is one that draws
    /// it.
    pub fn wait_for_device(&mut self) -> Result<(), StepError> {
        #[cfg(feature = "gpu")]
        if let Some(device) = &mut self.device {
            device.wait(&self.world, &self.shot)?;
        }
        Ok(())
    }

    /// The GPU that renders what is shown; `None` if that is the CPU.
    pub fn device(&self) -> Option<&str> {
        #[cfg(feature = "gpu")]
        return self.device.as_ref()?.name();
        #[cfg(not(feature = "gpu"))]
        None
    }

    /// How samples of direct light count that pixels and frames on a GPU share, in a word.
    pub fn shared(&self) -> Option<&'static str> {
        #[cfg(feature = "gpu")]
        return match self.device.as_ref()?.shared()? {
            Weights::Unbiased => Some("unbiased"),
            Weights::Biased => Some("biased"),
        };
        #[cfg(not(feature = "gpu"))]
        None
    }

    /// Why the CPU renders although there is a GPU.
    pub fn refusals(&self) -> &[Diagnostic] {
        #[cfg(feature = "gpu")]
        return self.device.as_ref().map_or(&[], OnDevice::refusals);
        #[cfg(not(feature = "gpu"))]
        &[]
    }

    /// The scene.
    pub fn world(&self) -> &Arc<World> {
        &self.world
    }

    /// What is shown.
    pub fn shot(&self) -> &Shot {
        &self.shot
    }

    /// Shows something else.
    pub fn aim(&mut self, shot: Shot) {
        self.shot = shot;
        self.stage = Stage::Draft;
    }

    /// Shows a changed scene.
    pub fn replace(&mut self, world: Arc<World>) {
        self.world = world;
        self.stage = Stage::Draft;
    }

    /// Begins the picture itself again, without drafts; after its samples were cancelled.
    pub fn restart(&mut self) {
        self.stage = Stage::Refine(1);
    }

    /// Whether the next step is the draft that follows a motion.
    pub fn is_draft(&self) -> bool {
        matches!(self.stage, Stage::Draft)
    }

    /// Whether there is nothing to do.
    pub fn is_at_rest(&self) -> bool {
        matches!(self.stage, Stage::Rest(_))
    }

    /// The picture itself, once it has samples.
    pub fn job(&self) -> Option<&Job> {
        let job = match &self.stage {
            Stage::Samples(samples) => Some(&samples.job),
            Stage::Rest(job) => job.as_deref(),
            Stage::Draft | Stage::Refine(_) => None,
            #[cfg(feature = "gpu")]
            Stage::OnDevice => None,
        };
        job.filter(|job| !job.session.state().done.is_empty())
    }

    /// Does the next step, and gives its picture where there is a new one. After an error there is
    /// nothing more to do, unless it was cancelled.
    pub fn step(&mut self, control: &Control) -> Result<Option<Frame>, StepError> {
        let result = self.try_step(control);
        if matches!(result, Err(StepError::Problem(_))) {
            self.stage = Stage::Rest(None);
        }
        result
    }

    fn try_step(&mut self, control: &Control) -> Result<Option<Frame>, StepError> {
        #[cfg(feature = "gpu")]
        if matches!(self.stage, Stage::Samples(_)) && self.device_takes_over()? {
            self.stage = Stage::Draft;
        }
        match &mut self.stage {
            Stage::Draft => {
                let n = self.pace.n();
                let frame = self.draft(n, control)?;
                self.pace.after(frame.pixels.len(), self.shot.samples, frame.time);
                self.stage = Stage::Refine((n / 2).max(1));
                Ok(Some(frame))
            }
            Stage::Refine(n) if *n > 1 => {
                let n = *n;
                let frame = self.draft(n, control)?;
                self.stage = Stage::Refine(n / 2);
                Ok(Some(frame))
            }
            #[cfg(feature = "gpu")]
            Stage::OnDevice => {
                let Some(device) = &mut self.device else { return Ok(None) };
                let (frame, is_done) = device.add(&self.world, &self.shot)?;
                if is_done {
                    self.stage = Stage::Rest(None);
                }
                Ok(frame)
            }
            Stage::Refine(_) => {
                #[cfg(feature = "gpu")]
                if self.rests_on_device()? {
                    self.stage = Stage::OnDevice;
                    return self.try_step(control);
                }
                let job = self.world.job(&self.shot)?;
                let (shown, rays, cost) = (Instant::now(), 0, Duration::ZERO);
                self.stage = Stage::Samples(Box::new(Samples { job, shown, rays, cost }));
                self.try_step(control)
            }
            Stage::Samples(samples) => {
                let frame = samples.step(&self.shot, control)?;
                if samples.is_done()
                    && let Stage::Samples(samples) = std::mem::replace(&mut self.stage, Stage::Rest(None))
                {
                    self.stage = Stage::Rest(Some(Box::new(samples.job)));
                }
                Ok(frame)
            }
            Stage::Rest(_) => Ok(None),
        }
    }

    /// Whether the device can render from now on what the CPU renders.
    #[cfg(feature = "gpu")]
    fn device_takes_over(&mut self) -> Result<bool, StepError> {
        let Some(device) = self.device.as_mut().filter(|device| device.is_ready()) else { return Ok(false) };
        device.wait(&self.world, &self.shot)?;
        Ok(device.name().is_some())
    }

    /// Begins the picture itself on the device, if that draws it.
    #[cfg(feature = "gpu")]
    fn rests_on_device(&mut self) -> Result<bool, StepError> {
        let device = self.device.as_mut();
        device.map_or(Ok(false), |device| device.rest(&self.world, &self.shot))
    }

    fn draft(&mut self, n: u32, control: &Control) -> Result<Frame, StepError> {
        #[cfg(feature = "gpu")]
        if let Some(device) = &mut self.device
            && let Some(frame) = device.draft(&self.world, &self.shot, n)?
        {
            return Ok(frame);
        }
        let begin = Instant::now();
        let mut session = self.world.draft(&self.shot, n)?;
        session.run(0..self.shot.samples, &Limits::default(), control, &mut |_| ())?;
        let mut frame = Frame::of(&session, n, self.shot.layer);
        frame.time = begin.elapsed();
        Ok(frame)
    }

    /// The paths of the first samples of a pixel.
    pub fn trace(&self, pixel: [i32; 2], samples: u32, control: &Control) -> Result<PixelTrace, StepError> {
        let mut job = self.world.job(&self.shot)?;
        PixelTrace::new(&mut job, pixel, 0..samples, control).map_err(|error| match error {
            TraceError::NoPixel => StepError::Problem("there is no such pixel".into()),
            TraceError::Cancelled => StepError::Cancelled,
            TraceError::Algorithm => StepError::Problem(format!(
                "`{}` does not estimate pixels one by one; `path` does",
                self.shot.integrator
            )),
        })
    }

    /// Writes the picture so far; gives its number of samples per pixel, or `None` where there is
    /// no picture yet.
    pub fn save(&self, path: &std::path::Path, display: &DisplaySettings) -> Option<Result<u32, ImageError>> {
        #[cfg(feature = "gpu")]
        if let Some(samples) = self.device.as_ref().and_then(OnDevice::rested) {
            return self.save_of_device(samples, path, display).transpose();
        }
        written(self.job()?, path, display)
    }

    /// Renders the samples that the device has added up again, into a film, and writes that.
    #[cfg(feature = "gpu")]
    fn save_of_device(
        &self,
        samples: u32,
        path: &std::path::Path,
        display: &DisplaySettings,
    ) -> Result<Option<u32>, ImageError> {
        let invalid = |problem: String| ImageError::Invalid(problem);
        let mut job = self.world.job(&self.shot).map_err(invalid)?;
        if let Some(device) = &self.device {
            job.move_to(device.kernels()).map_err(|refusals| invalid(messages(&refusals)))?;
        }
        let done = job.session.run(0..samples, &Limits::default(), &Control::default(), &mut |_| ());
        done.map_err(|error| invalid(format!("{error:?}")))?;
        written(&job, path, display).transpose()
    }
}

fn written(job: &Job, path: &std::path::Path, display: &DisplaySettings) -> Option<Result<u32, ImageError>> {
    let state = job.session.state();
    let written = write_picture(&job.header().development(state), path, display);
    Some(written.map(|()| state.done.count()))
}

impl Samples {
    /// The next samples; a picture if it is time for one.
    fn step(&mut self, shot: &Shot, control: &Control) -> Result<Option<Frame>, StepError> {
        let done = self.job.session.state().done.count();
        let passes = done..(done + shot.samples).min(self.job.planned());
        self.job.session.run(passes, &Limits::default(), control, &mut |_| ())?;
        let time = self.shown.elapsed();
        if done > 0 && !self.is_done() && time < SHORTEST.max(SHARE * self.cost) {
            return Ok(None);
        }
        let begin = Instant::now();
        let mut frame = Frame::of(&self.job.session, 1, shot.layer);
        self.cost = begin.elapsed();
        (frame.time, self.shown) = (time + self.cost, Instant::now());
        let all = std::mem::replace(&mut self.rays, frame.rays);
        frame.rays -= all;
        Ok(Some(frame))
    }

    fn is_done(&self) -> bool {
        self.job.session.state().done.count() >= self.job.planned()
    }
}
