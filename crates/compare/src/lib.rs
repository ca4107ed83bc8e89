//! The laboratory: compares several integrators on one scene, each with the same time or number of
//! samples, by their errors against a reference.
//!
//! A [`Plan`] says what to compare; [`Laboratory::new`] checks it before rendering starts and
//! compiles the scene, once for all; [`Laboratory::compare`] renders; the [`Comparison`] is
//! converted to a page ([`Comparison::to_html`]) or to JSON ([`Comparison::to_json`]).
//!
//! Each integrator renders two pictures from different seeds, each with the whole budget, so that
//! noise and bias can be separated ([`Measure`]). Only rendering is timed, preparation included;
//! measuring at checkpoints is not. Figures are means over both; the picture shown is the first,
//! the one that a render with the scene's seed gives.
//!
//! With a budget of time, samplers are made for the scene's number of samples per pixel, as in a
//! render, and the number may be exceeded.

mod contender;
mod convergence;
mod json;
mod laboratory;
mod measure;
mod page;
mod paired_renders;
mod settings;

use std::fmt;
#[cfg(feature = "gpu")]
use std::sync::Arc;
use std::time::Duration;

use alhazen::Overrides;
use alhazen::description::Diagnostic;
#[cfg(feature = "gpu")]
use alhazen::device::Kernels;
use alhazen::image::Image;

pub use contender::Contender;
pub use laboratory::Laboratory;
pub use measure::{Bias, Measure, Parts, ReferenceNoise};
pub use settings::Settings;

/// The budget of each picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Budget {
    /// Rendering time; the last pass is completed.
    Time(Duration),
    /// Samples per pixel; some samplers round them up.
    Samples(u32),
}

impl Budget {
    /// Whether a render that took this time has used it up.
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

/// The source of the reference.
#[derive(Clone, Debug)]
pub enum ReferenceSource {
    /// A given picture, of the size of the whole image or of the part to render; its noise is
    /// unknown.
    Picture {
        /// Its name in the report.
        name: String,
        /// The picture.
        picture: Image,
    },
    /// A picture to render first, as the mean of two independent halves, whose difference gives its
    /// noise. Its seeds differ from those of the contenders' pictures.
    Render {
        /// The contender that renders it; the first one if `None`.
        by: Option<Contender>,
        /// Samples per pixel of both halves together; if `None`, they get 16 times a contender's
        /// budget.
        samples_per_pixel: Option<u32>,
    },
}

/// What to compare.
#[derive(Clone, Debug)]
pub struct Plan {
    /// The scene's name in the report.
    pub title: String,
    /// The integrators to compare.
    pub contenders: Vec<Contender>,
    /// The budget of each picture.
    pub budget: Budget,
    /// The reference.
    pub reference: ReferenceSource,
    /// Overrides for all contenders; integrator and number of samples are those of the plan.
    pub overrides: Overrides,
    /// Number of threads, for the report.
    pub threads: usize,
    /// The GPU that renders what it draws; the CPU renders the rest, and warnings say what.
    #[cfg(feature = "gpu")]
    pub kernels: Option<Arc<Kernels>>,
}

/// Why a plan cannot be carried out.
#[derive(Debug)]
pub enum PlanError {
    /// The plan is invalid.
    Plan(String),
    /// The reference has the wrong size.
    Reference(String),
    /// The scene has errors; these are all diagnostics of it.
    Scene(Vec<Diagnostic>),
}

/// What all runs have in common.
#[derive(Clone, Debug)]
pub struct Setup {
    /// The scene's name.
    pub title: String,
    /// Width and height of the whole image in pixels.
    pub resolution: [i32; 2],
    /// The pixels rendered, `[x0, x1, y0, y1)`.
    pub pixel_bounds: [i32; 4],
    /// The budget of each picture.
    pub budget: Budget,
    /// Seed of the first picture; the second has the next one.
    pub seed: i32,
    /// Number of threads.
    pub threads: usize,
    /// The pixel filter with its settings.
    pub filter: Settings,
    /// Overrides of the scene for all, as `key=value`.
    pub changes: Vec<String>,
}

/// The reference that errors are measured against.
#[derive(Clone, Debug)]
pub struct Reference {
    /// Its origin: a file, or an integrator with passes and time.
    pub source: String,
    /// The name of the contender that rendered it; `None` for a file.
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

/// Progress and error of a run at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Checkpoint {
    /// Passes of each picture.
    pub passes: u32,
    /// Rendering time of one picture in seconds.
    pub seconds: f64,
    /// Rays of one picture.
    pub rays: f64,
    /// The error of both.
    pub measure: Measure,
}

/// The results of one contender.
#[derive(Clone, Debug)]
pub struct Run {
    /// Its name, with settings of its own.
    pub name: String,
    /// All settings of the integrator.
    pub settings: Settings,
    /// The sampler with its settings.
    pub sampler: Settings,
    /// The integrator's summary: pairs of name and text.
    pub notes: Vec<(&'static str, String)>,
    /// From the first pass to the end; never empty.
    pub checkpoints: Vec<Checkpoint>,
    /// The two pictures.
    pub pictures: [Image; 2],
    /// Mean FLIP of the first picture against the reference; `None` where it is undefined.
    pub flip: Option<f64>,
    /// Whether it was cancelled before its end.
    pub interrupted: bool,
}

impl Run {
    /// The last checkpoint.
    pub fn last(&self) -> &Checkpoint {
        self.checkpoints.last().expect("invariant: a run has a checkpoint")
    }

    /// Efficiency, 1 / (relMSE · seconds): independent of the budget for an unbiased integrator.
    pub fn efficiency(&self) -> f64 {
        let last = self.last();
        1.0 / (last.measure.relative.error * last.seconds)
    }

    /// Rays per second.
    pub fn rays_per_second(&self) -> f64 {
        self.last().rays / self.last().seconds.max(1e-9)
    }

    /// Pairs of seconds and relMSE.
    fn curve(&self) -> Vec<(f64, f64)> {
        self.checkpoints.iter().map(|point| (point.seconds, point.measure.relative.error)).collect()
    }
}

/// The results of a plan.
#[derive(Clone, Debug)]
pub struct Comparison {
    /// What all runs have in common.
    pub setup: Setup,
    /// The reference of all runs.
    pub reference: Reference,
    /// The runs in the order of the plan; at least one.
    pub runs: Vec<Run>,
    /// Names of contenders that were not rendered.
    pub missing: Vec<String>,
    /// What is rendered differently than described, and other warnings.
    pub warnings: Vec<String>,
}

impl Comparison {
    /// Whether it was cancelled before its end.
    pub fn interrupted(&self) -> bool {
        !self.missing.is_empty() || self.runs.iter().any(|run| run.interrupted)
    }

    /// The slope of a run's error over time in log–log space: −1 for independent samples. The
    /// reference's variance is subtracted from the error first, as it would flatten the curve.
    pub fn slope(&self, run: &Run) -> Option<f64> {
        let floor = self.reference.noise.map_or(0.0, |noise| noise.relative);
        let curve: Vec<_> =
            run.curve().into_iter().map(|(seconds, error)| (seconds, error - floor)).collect();
        convergence::slope(&curve)
    }

    /// A run's mean error and its standard deviation, relative to the reference's mean; `None`
    /// where the reference is black.
    pub fn relative_mean_error(&self, run: &Run) -> Option<[f64; 2]> {
        let (mean, measure) = (self.reference.mean(), &run.last().measure);
        (mean > 0.0).then(|| [measure.mean_error, measure.mean_error_deviation].map(|value| value / mean))
    }

    /// The largest final relMSE: an error that all runs have reached.
    pub fn common_error(&self) -> f64 {
        self.runs.iter().map(|run| run.last().measure.relative.error).fold(0.0, f64::max)
    }

    /// The seconds after which a run reached [`Self::common_error`].
    pub fn seconds_to_common_error(&self, run: &Run) -> Option<f64> {
        convergence::seconds_to(self.common_error(), &run.curve())
    }

    /// Why the reference may be biased: at least two other integrators, or all others, find more
    /// light than the one that rendered it.
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
            "The reference may miss light: {by} rendered it, and others find more light ({}). Errors may then be \
             those of the reference; render it with another integrator to find out.",
            found.join(", ")
        ))
    }

    /// Whether the reference's own variance is more than a tenth of a run's error, which is then
    /// unreliable.
    pub fn is_below_reference_noise(&self, run: &Run) -> bool {
        self.reference.noise.is_some_and(|noise| noise.relative > 0.1 * run.last().measure.relative.error)
    }
}
