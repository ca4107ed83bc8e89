//! The laboratory: several algorithms over one scene, each for the same time or the same number of
//! samples, and how far from a reference each is.
//!
//! A [`Plan`] says what to compare; [`Laboratory::new`] finds everything that is wrong with it
//! before anything long begins and compiles the scene, once for all; [`Laboratory::compare`]
//! renders; the [`Comparison`] can be had as a page ([`Comparison::to_html`]) and as JSON
//! ([`Comparison::to_json`]).
//!
//! Each algorithm renders two pictures from different seeds, the time or samples asked for *each*,
//! so that noise and bias can be told apart ([`Measure`]). Rendering alone is timed, preparation
//! included; measuring at checkpoints is not. Figures are means over both; the picture shown is the
//! first, which is what a render with the scene's seed gives.
//!
//! Where time is the limit, samplers are made for 65,536 samples per pixel, and the render ends
//! there at the latest. `independent`, `halton`, `sobol` and `zsobol` are as even as ever then;
//! `stratified` and `paddedsobol`, which spread samples over the number they are made for, are as
//! uneven as random ones.

mod contender;
mod convergence;
mod json;
mod laboratory;
mod measure;
mod page;
mod paired_renders;
mod settings;

use std::fmt;
use std::time::Duration;

use description::Diagnostic;
use image::Image;

pub use contender::Contender;
pub use laboratory::Laboratory;
pub use measure::{Bias, Measure, Parts, ReferenceNoise};
pub use settings::Settings;

use crate::Overrides;

/// How long each picture is rendered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// So long, and then to the end of the pass.
    Time(Duration),
    /// With so many samples per pixel; some samplers round them up.
    Samples(u32),
}

impl Budget {
    /// Whether a render that took so long is at its end.
    fn is_spent(self, seconds: f64) -> bool {
        match self {
            Self::Time(time) => seconds >= time.as_secs_f64(),
            Self::Samples(_) => false,
        }
    }

    fn times(self, factor: u32) -> Self {
        match self {
            Self::Time(time) => Self::Time(time.saturating_mul(factor)),
            Self::Samples(samples) => Self::Samples(samples.saturating_mul(factor)),
        }
    }
}

/// `30 s`, `64 samples per pixel`.
impl fmt::Display for Budget {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Time(time) => write!(f, "{} s", time.as_secs_f64()),
            Self::Samples(1) => f.write_str("1 sample per pixel"),
            Self::Samples(samples) => write!(f, "{samples} samples per pixel"),
        }
    }
}

/// What the others are held against.
#[derive(Clone, Debug)]
pub enum ReferenceSource {
    /// A picture that is there, of the size of the whole image or of the part to render; nothing is
    /// known of its noise.
    Picture {
        /// Where it is from, for the report.
        name: String,
        /// The picture.
        picture: Image,
    },
    /// A picture to render first, as the mean of two independent halves that tell its noise. Its
    /// seeds are not those of the pictures that it judges.
    Render {
        /// By whom; by the first of the contenders if `None`.
        by: Option<Contender>,
        /// Samples per pixel of both halves together; if `None`, 16 times the contenders' budget in
        /// all.
        samples_per_pixel: Option<u32>,
    },
}

/// What to compare.
#[derive(Clone, Debug)]
pub struct Plan {
    /// What the report calls the scene.
    pub title: String,
    /// Who takes part.
    pub contenders: Vec<Contender>,
    /// What each picture may take.
    pub budget: Budget,
    /// What they are held against.
    pub reference: ReferenceSource,
    /// Changes to the scene for all; the integrator and the number of samples are the plan's own.
    pub overrides: Overrides,
    /// How many threads there are, for the report.
    pub threads: usize,
}

/// Why a plan cannot be followed.
#[derive(Debug)]
pub enum PlanError {
    /// It asks for what cannot be.
    Plan(String),
    /// The reference is of another size.
    Reference(String),
    /// The scene is wrong; with everything there is to say about it.
    Scene(Vec<Diagnostic>),
}

/// What is the same for all.
#[derive(Clone, Debug)]
pub struct Setup {
    /// What the scene is called.
    pub title: String,
    /// Width and height of the whole image in pixels.
    pub resolution: [i32; 2],
    /// The pixels rendered, `[x0, x1, y0, y1)`.
    pub pixel_bounds: [i32; 4],
    /// What each picture might take.
    pub budget: Budget,
    /// Seed of the first picture; the second has the next one.
    pub seed: i32,
    /// How many threads there were.
    pub threads: usize,
    /// The pixel filter with its settings.
    pub filter: Settings,
    /// What was changed of the scene for all, as `key=value`.
    pub changes: Vec<String>,
}

/// What the others were held against.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Where it is from: a file, or an algorithm and how long it took.
    pub source: String,
    /// Which contender rendered it, or would have, had it been listed; `None` for a file.
    pub by: Option<String>,
    /// The picture.
    pub picture: Image,
    /// Its noise, where it was rendered.
    pub noise: Option<ReferenceNoise>,
}

impl Reference {
    /// The mean of all its finite values.
    pub fn mean(&self) -> f64 {
        let (mut sum, mut count) = (0.0, 0.0);
        for value in self.picture.values().filter(|value| value.is_finite()) {
            sum += f64::from(value);
            count += 1.0;
        }
        sum / f64::max(count, 1.0)
    }
}

/// How far a render was at a moment, and how far from the reference.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint {
    /// Passes of each picture.
    pub passes: u32,
    /// Seconds that one picture took.
    pub seconds: f64,
    /// Rays that one picture took.
    pub rays: f64,
    /// How far they are from the reference.
    pub measure: Measure,
}

/// What came of one contender.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its name, with settings of its own.
    pub name: String,
    /// All settings of the algorithm.
    pub settings: Settings,
    /// The sampler with its settings.
    pub sampler: Settings,
    /// What the algorithm tells of itself: names, and what there is to say.
    pub notes: Vec<(&'static str, String)>,
    /// From the first pass to the end; never empty.
    pub checkpoints: Vec<Checkpoint>,
    /// The two pictures.
    pub pictures: [Image; 2],
    /// The mean visible difference of the first picture from the reference; `None` where it cannot
    /// be told.
    pub flip: Option<f64>,
    /// Whether it was stopped before its end.
    pub interrupted: bool,
}

impl Run {
    /// The state at the end.
    pub fn last(&self) -> &Checkpoint {
        self.checkpoints.last().expect("invariant: a run has a checkpoint")
    }

    /// 1 / (relMSE · s): how much is gained for a second, whatever the time given.
    pub fn efficiency(&self) -> f64 {
        let last = self.last();
        1.0 / (last.measure.relative.error * last.seconds)
    }

    /// Rays traced in a second.
    pub fn rays_per_second(&self) -> f64 {
        self.last().rays / self.last().seconds.max(1e-9)
    }

    /// relMSE against seconds.
    fn curve(&self) -> Vec<(f64, f64)> {
        self.checkpoints.iter().map(|point| (point.seconds, point.measure.relative.error)).collect()
    }
}

/// What came of a plan.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What is the same for all.
    pub setup: Setup,
    /// What the runs were held against.
    pub reference: Reference,
    /// In the order of the plan; at least one.
    pub runs: Vec<Run>,
    /// Names of contenders to whom it did not come.
    pub missing: Vec<String>,
    /// What is drawn otherwise than described, and whatever else the reader has to know.
    pub warnings: Vec<String>,
}

impl Comparison {
    /// Whether it was stopped before its end.
    pub fn interrupted(&self) -> bool {
        !self.missing.is_empty() || self.runs.iter().any(|run| run.interrupted)
    }

    /// The slope of a run's error over time in logarithms: −1 for independent samples. The
    /// reference's noise is taken off the error first, as it would flatten the curve.
    pub fn slope(&self, run: &Run) -> Option<f64> {
        let floor = self.reference.noise.map_or(0.0, |noise| noise.relative);
        let curve: Vec<_> =
            run.curve().into_iter().map(|(seconds, error)| (seconds, error - floor)).collect();
        convergence::slope(&curve)
    }

    /// A run's mean error and its standard deviation as shares of the reference's mean; `None`
    /// where the reference is black.
    pub fn relative_mean_error(&self, run: &Run) -> Option<[f64; 2]> {
        let (mean, measure) = (self.reference.mean(), &run.last().measure);
        (mean > 0.0).then(|| [measure.mean_error, measure.mean_error_deviation].map(|value| value / mean))
    }

    /// The largest relMSE at the end of a run: an error that all have reached.
    pub fn common_error(&self) -> f64 {
        self.runs.iter().map(|run| run.last().measure.relative.error).fold(0.0, f64::max)
    }

    /// The seconds after which a run had come down to [`Self::common_error`].
    pub fn seconds_to_common_error(&self, run: &Run) -> Option<f64> {
        convergence::seconds_to(self.common_error(), &run.curve())
    }

    /// Why the reference is perhaps not what all should tend to: two others or more, or all, find
    /// more light than who rendered it.
    pub fn doubt(&self) -> Option<String> {
        let by = self.reference.by.as_deref()?;
        let others: Vec<&Run> = self.runs.iter().filter(|run| run.name != by).collect();
        let more = |run: &&Run| -> Option<(String, f64)> {
            let [error, deviation] = self.relative_mean_error(run)?;
            (error > f64::max(0.01, 3.0 * deviation)).then(|| (run.name.clone(), error))
        };
        let brighter: Vec<(String, f64)> = others.iter().filter_map(more).collect();
        if brighter.is_empty() || brighter.len() < others.len().min(2) {
            return None;
        }
        let found: Vec<_> =
            brighter.iter().map(|(name, error)| format!("{name} {:.1} %", 100.0 * error)).collect();
        Some(format!(
            "The reference may miss light: {by} rendered it, and others find more than it has ({}). Errors are then those of the reference; \
             one by another algorithm would tell.",
            found.join(", ")
        ))
    }

    /// Whether the reference's own noise is more than a tenth of a run's error, which then says
    /// little.
    pub fn is_below_reference_noise(&self, run: &Run) -> bool {
        self.reference.noise.is_some_and(|noise| noise.relative > 0.1 * run.last().measure.relative.error)
    }
}
