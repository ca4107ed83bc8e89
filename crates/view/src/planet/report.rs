//! A walk without a window: how fast pictures of a moving planet are.

use std::time::Duration;

use alhazen::integrators::Control;
use serde_json::{Value, json};

use super::{Input, Moment, Outing, Spent};
use crate::Frame;
use crate::step::StepError;

/// The steps of a frame.
const STEPS: u32 = 1;

/// The frame times of a walk.
#[derive(Clone, Debug)]
pub struct PlanetReport {
    /// All spheres of the planet.
    pub spheres: usize,
    /// Width and height of each frame in pixels.
    pub resolution: [u32; 2],
    /// Samples per pixel of a frame.
    pub samples: u32,
    /// The algorithm.
    pub integrator: String,
    /// The GPU that has rendered; `None` if that is the CPU.
    pub device: Option<String>,
    /// The times of each frame.
    pub frames: Vec<Spent>,
    /// The spheres that moved in each.
    pub moving: Vec<usize>,
    /// Rays of all frames.
    pub rays: u64,
}

impl PlanetReport {
    /// Renders a number of frames, each of a thirtieth of a second, of one who runs over the planet
    /// in curves, jumps, and throws about what is in the way.
    pub fn of_walk(outing: &mut Outing, frames: u32, control: &Control) -> Result<Self, StepError> {
        let mut report = Self::new(outing);
        for frame in 0..frames {
            let input = input(outing, frame);
            let (picture, spent) = outing.frame(&input, STEPS, control)?;
            report.add(outing, &picture, spent);
        }
        Ok(report)
    }

    /// The same walk in two parts: its first frames are simulated, and then a number of frames is
    /// rendered that show them forwards and backwards. So a GPU does not wait for the simulation.
    pub fn of_moments(
        outing: &mut Outing,
        simulated: u32,
        frames: u32,
        control: &Control,
    ) -> Result<Self, StepError> {
        let moment = |frame| {
            let input = input(outing, frame);
            outing.pass(&input, STEPS);
            outing.moment()
        };
        let moments: Vec<Moment> = (0..simulated).map(moment).collect();
        let mut report = Self::new(outing);
        for moment in moments.iter().chain(moments.iter().rev()).cycle().take(frames as usize) {
            let (picture, spent) = outing.show(moment, control)?;
            report.add(outing, &picture, spent);
        }
        Ok(report)
    }

    /// No frames yet.
    fn new(outing: &Outing) -> Self {
        let bounds = outing.world().bounds();
        Self {
            spheres: outing.planet().bodies().len(),
            resolution: [bounds.width() as u32, bounds.height() as u32],
            samples: outing.shot().samples,
            integrator: outing.shot().integrator.clone(),
            device: outing.device().map(str::to_owned),
            frames: Vec::new(),
            moving: Vec::new(),
            rays: 0,
        }
    }

    fn add(&mut self, outing: &Outing, picture: &Frame, spent: Spent) {
        self.frames.push(spent);
        self.moving.push(outing.planet().moving());
        self.rays += picture.rays;
    }

    /// The time of a part of frames that this share of them does not exceed.
    pub fn quantile(&self, share: f64, part: impl Fn(&Spent) -> Duration) -> Duration {
        let mut times: Vec<Duration> = self.frames.iter().map(part).collect();
        times.sort_unstable();
        let index = (share * times.len() as f64).ceil() as usize;
        times.get(index.saturating_sub(1)).copied().unwrap_or_default()
    }

    /// Frames per second.
    pub fn fps(&self) -> f64 {
        self.frames.len() as f64 / self.seconds()
    }

    /// Rays per second of all the time.
    pub fn rays_per_second(&self) -> f64 {
        self.rays as f64 / self.seconds()
    }

    /// The median of the number of spheres that moved.
    pub fn median_moving(&self) -> usize {
        let mut moving = self.moving.clone();
        moving.sort_unstable();
        moving.get(moving.len() / 2).copied().unwrap_or_default()
    }

    fn seconds(&self) -> f64 {
        self.frames.iter().map(Spent::sum).sum::<Duration>().as_secs_f64().max(f64::MIN_POSITIVE)
    }

    /// The report as JSON; times are in milliseconds.
    pub fn to_json(&self) -> Value {
        let times = |part: fn(&Spent) -> Duration| {
            let ms = |share: f64| self.quantile(share, part).as_secs_f64() * 1e3;
            json!({ "median": ms(0.5), "p95": ms(0.95), "max": ms(1.0) })
        };
        json!({
            "status": "done",
            "integrator": self.integrator,
            "device": self.device.as_deref().unwrap_or("CPU"),
            "spheres": self.spheres,
            "moving": { "median": self.median_moving(), "max": self.moving.iter().max() },
            "frames": self.frames.len(),
            "frame_ms": times(Spent::sum),
            "simulate_ms": times(|spent| spent.simulating),
            "move_ms": times(|spent| spent.moving),
            "render_ms": times(|spent| spent.rendering),
            "trace_ms": self.device.as_ref().map(|_| times(|spent| spent.tracing.unwrap_or_default())),
            "fps": self.fps(),
            "resolution": self.resolution,
            "samples_per_pixel": self.samples,
            "rays_per_second": self.rays_per_second(),
        })
    }
}

/// What the walker does in a frame.
fn input(outing: &mut Outing, frame: u32) -> Input {
    outing.turn(0.012 * alhazen::lanes::sin(0.05 * frame as f32), 0.0);
    if frame % 60 == 40 {
        outing.blast();
    }
    Input { forward: 1.0, right: 0.0, runs: true, jumps: frame % 45 == 20 }
}
