//! A camera path without a window: how fast pictures of a moving camera are.

use std::f64::consts::TAU;
use std::time::{Duration, Instant};

use alhazen::integrators::Control;
use serde_json::{Value, json};

use crate::step::StepError;
use crate::{Flight, Frame, Renderer, Shot, Stages};

/// The frame times of a camera path.
#[derive(Clone, Debug)]
pub struct Report {
    /// From the begin of the program to the first picture.
    pub first_picture: Duration,
    /// How long it took to compile the scene.
    pub compiled_in: Duration,
    /// The time of each frame.
    pub frames: Vec<Duration>,
    /// Width and height of each frame in pixels.
    pub sizes: Vec<[u32; 2]>,
    /// Width and height of the whole picture.
    pub resolution: [u32; 2],
    /// Samples per pixel of a frame.
    pub samples: u32,
    /// Rays of all frames.
    pub rays: u64,
    /// The algorithm.
    pub integrator: String,
    /// The GPU that has rendered; `None` if that is the CPU.
    pub device: Option<String>,
    /// How samples of direct light count that pixels and frames on a GPU share, in a word.
    pub shared: Option<&'static str>,
    /// The times of the parts of each frame that a GPU has rendered.
    pub stages: Vec<Stages>,
}

impl Report {
    /// Renders `frames` frames of a camera that orbits once around what it looks at, and ends where
    /// it began. `begin` is when the program began. Returns the last frame, too.
    pub fn of_orbit(
        renderer: &mut Renderer,
        flight: &mut Flight,
        frames: u32,
        begin: Instant,
        control: &Control,
    ) -> Result<(Self, Option<Frame>), StepError> {
        let shot = renderer.shot().clone();
        let bounds = renderer.world().bounds();
        let mut report = Self {
            first_picture: Duration::ZERO,
            compiled_in: renderer.world().compiled_in,
            frames: Vec::new(),
            sizes: Vec::new(),
            resolution: [bounds.width() as u32, bounds.height() as u32],
            samples: shot.samples,
            rays: 0,
            integrator: shot.integrator.clone(),
            device: None,
            shared: renderer.shared(),
            stages: Vec::new(),
        };
        renderer.wait_for_device()?;
        let mut last = None;
        for frame in 0..frames {
            flight.orbit(TAU / f64::from(frames), 0.0);
            renderer.aim(Shot { camera: flight.camera().clone(), ..shot.clone() });
            let Some(picture) = renderer.step(control)? else { continue };
            if frame == 0 {
                report.first_picture = begin.elapsed();
            }
            report.frames.push(picture.time);
            report.sizes.push(picture.size);
            report.rays += picture.rays;
            report.stages.extend(picture.stages);
            last = Some(picture);
        }
        report.device = renderer.device().map(str::to_owned);
        Ok((report, last))
    }

    /// The median time of a part of the frames that a GPU has rendered.
    pub fn median_of(&self, part: fn(&Stages) -> Duration) -> Option<Duration> {
        let mut times: Vec<Duration> = self.stages.iter().map(part).collect();
        times.sort_unstable();
        times.get(times.len() / 2).copied()
    }

    /// The time that this share of the frames does not exceed.
    pub fn quantile(&self, share: f64) -> Duration {
        quantile(&self.frames, share)
    }

    /// Frames per second.
    pub fn fps(&self) -> f64 {
        self.frames.len() as f64 / self.seconds()
    }

    /// Rays per second.
    pub fn rays_per_second(&self) -> f64 {
        self.rays as f64 / self.seconds()
    }

    fn seconds(&self) -> f64 {
        self.frames.iter().sum::<Duration>().as_secs_f64().max(f64::MIN_POSITIVE)
    }

    /// The size of the frame in the middle, if all are ordered by their size.
    pub fn median_size(&self) -> [u32; 2] {
        let mut sizes = self.sizes.clone();
        sizes.sort_unstable_by_key(|[width, height]| width * height);
        sizes.get(sizes.len() / 2).copied().unwrap_or_default()
    }

    /// The report as JSON; times are in milliseconds.
    pub fn to_json(&self) -> Value {
        let ms = |time: Duration| time.as_secs_f64() * 1e3;
        json!({
            "status": "done",
            "integrator": self.integrator,
            "frames": self.frames.len(),
            "frame_ms": {
                "median": ms(self.quantile(0.5)),
                "p95": ms(self.quantile(0.95)),
                "max": ms(self.quantile(1.0)),
            },
            "fps": self.fps(),
            "first_picture_ms": ms(self.first_picture),
            "compile_ms": ms(self.compiled_in),
            "resolution": self.resolution,
            "frame_resolution": { "median": self.median_size(), "last": self.sizes.last() },
            "samples_per_pixel": self.samples,
            "rays_per_second": self.rays_per_second(),
            "device": self.device.as_deref().unwrap_or("CPU"),
            "restir": self.shared,
            "stage_ms": {
                "trace": self.median_of(|stages| stages.trace).map(ms),
                "filter": self.median_of(|stages| stages.filter).map(ms),
                "rest": self.median_of(|stages| stages.rest).map(ms),
            },
        })
    }
}

/// The time that this share of times does not exceed.
pub fn quantile(times: &[Duration], share: f64) -> Duration {
    let mut times = times.to_vec();
    times.sort_unstable();
    let index = (share * times.len() as f64).ceil() as usize;
    times.get(index.saturating_sub(1)).copied().unwrap_or_default()
}
