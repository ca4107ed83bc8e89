//! A walk without a window: how fast pictures of a moving planet are.

use std::time::Duration;

use alhazen::integrators::Control;
use serde_json::{Value, json};

use super::{Input, Outing, Spent};
use crate::step::StepError;

/// The steps of a frame: it shows a thirtieth of a second.
const STEPS: u32 = 2;

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
        let bounds = outing.world().bounds();
        let mut report = Self {
            spheres: outing.planet().bodies().len(),
            resolution: [bounds.width() as u32, bounds.height() as u32],
            samples: outing.shot().samples,
            integrator: outing.shot().integrator.clone(),
            device: outing.device().map(str::to_owned),
            frames: Vec::new(),
            moving: Vec::new(),
            rays: 0,
        };
        for frame in 0..frames {
            let input = Input { forward: 1.0, right: 0.0, runs: true, jumps: frame % 45 == 20 };
            outing.turn(0.012 * alhazen::lanes::sin(0.05 * frame as f32), 0.0);
            if frame % 60 == 40 {
                outing.blast();
            }
            let (picture, spent) = outing.frame(&input, STEPS, control)?;
            report.frames.push(spent);
            report.moving.push(outing.planet().moving());
            report.rays += picture.rays;
        }
        Ok(report)
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
            "fps": self.fps(),
            "resolution": self.resolution,
            "samples_per_pixel": self.samples,
            "rays_per_second": self.rays_per_second(),
        })
    }
}
