//! The driver of all integrators: it prepares them and runs passes until a limit is reached.
//!
//! The passes of an integrator are independent of each other given their numbers, and the sums of a
//! film are exact. So the picture has the same bits for any order of passes, any division of them
//! among sessions and any number of interruptions: renders can be resumed and sharded. Previews,
//! checkpoints and comparisons read the session after each pass.
//!
//! # Noise
//!
//! Where noise is a limit, passes alternate between two films, whose pictures a and b of n_a and
//! n_b passes are independent estimates of the same picture. The picture is their weighted mean r.
//! The variance of each of its values is
//!
//! ```text
//! Var[r] = n_a n_b/(n_a + n_b)² · E[(a − b)²]
//! ```
//!
//! for any integrator, also for splats and Markov chains, where the samples of a pixel are not
//! independent. The *noise* of the picture is its relative standard error
//!
//! ```text
//! noise = √⟨Var[r] / (r² + (m/10)²)⟩
//! ```
//!
//! where ⟨·⟩ is the mean over pixels and channels, and m the mean of r, which keeps dark pixels
//! from dominating. It is the root of the relMSE [Rousselle 2011] against the picture without
//! noise, but does not depend on exposure. Bias is not included. Samplers whose passes complement
//! each other have less noise than estimated, because the errors of the two films are negatively
//! correlated.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use film::{Development, Film, PassSet, Rejected};
use geometry::RayStats;
use image::{Image, ImageError, PixelSource};
use rayon::prelude::*;
use scene::{Scene, View};

use crate::{Cancelled, Control, Integrator, PassError, Record};

/// The number of passes of the first noise estimate. Before it, light that few paths find may be
/// missing.
const FIRST_ESTIMATE: u32 = 16;

/// The progress of a session.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Passes done, drafts included.
    pub pass: u32,
    /// Total number of passes: an estimate if time or noise is limited, `u32::MAX` if it is not
    /// known yet.
    pub passes: u32,
    /// Pixel samples taken by this session.
    pub samples: u64,
    /// Rays traced by this session, with their intersection tests.
    pub stats: RayStats,
    /// Running time of this session.
    pub elapsed: Duration,
    /// The last estimate of noise.
    pub noise: Option<f64>,
}

/// Limits that end a run before its last pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// Maximum running time of all sessions together. A pass that would exceed it, if it took as
    /// long as the previous one, is not begun; the first pass always is.
    pub time: Option<Duration>,
    /// The run ends when the estimated noise is at most this.
    pub noise: Option<f64>,
}

impl Limits {
    /// Whether there are any.
    pub fn are_set(&self) -> bool {
        self.time.is_some() || self.noise.is_some()
    }
}

/// Why a run ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Stop {
    /// All its passes are done.
    Passes,
    /// The time is up.
    Time,
    /// The noise is low enough.
    Noise,
}

/// A render: the scene, the view of it, the algorithm, the film, and the passes that the film
/// holds.
pub struct Session {
    scene: Arc<Scene>,
    view: View,
    integrator: Box<dyn Integrator>,
    state: SessionState,
    is_prepared: bool,
    /// Whether the film holds no part of a cancelled pass.
    is_whole: bool,
    /// Drafts done by this session.
    drafts: u32,
    /// Pixel samples in the films before this session.
    samples_before: u64,
    stats: RayStats,
    elapsed: Duration,
    last_pass: Duration,
    noise: Option<f64>,
    /// The passes that the film holds after the current run, if no limit ends it.
    planned: PassSet,
    limits: Limits,
}

/// The state of a session from which another one resumes, with the same bits.
#[derive(Debug)]
pub struct SessionState {
    /// The passes that the films hold.
    pub done: PassSet,
    /// The film.
    pub film: Film,
    /// The film that alternates with the first one, if noise is limited.
    pub second: Option<Film>,
    /// The number of passes in the first and in the second film.
    pub counts: [u32; 2],
    /// Running time of all sessions.
    pub elapsed: Duration,
}

impl SessionState {
    /// The state before the first pass.
    pub fn new(film: Film) -> Self {
        Self { done: PassSet::new(), film, second: None, counts: [0; 2], elapsed: Duration::ZERO }
    }

    /// The picture of all passes, without layers; refused where there is no memory for it.
    pub fn develop(&self) -> Result<Image, ImageError> {
        Development::of_colors(&self.film, self.second.as_ref()).to_image()
    }

    /// The picture of all passes with its layers, row by row while it is written.
    pub fn development(&self) -> Development<'_> {
        Development::of_all(&self.film, self.second.as_ref())
    }

    /// The number of samples in the films.
    pub fn sample_count(&self) -> u64 {
        self.films().map(Film::sample_count).sum()
    }

    /// The samples that the films rejected.
    pub fn rejected(&self) -> Rejected {
        self.films().fold(Rejected::default(), |mut all, film| {
            all.merge(&film.rejected());
            all
        })
    }

    fn films(&self) -> impl Iterator<Item = &Film> {
        std::iter::once(&self.film).chain(&self.second)
    }

    /// Lets further passes alternate between two films, from which noise is estimated; refused
    /// where there is no memory for the second.
    pub fn alternate(&mut self) -> Result<(), ImageError> {
        if self.second.is_none() {
            self.second = Some(self.film.blank()?);
        }
        Ok(())
    }

    /// The estimated relative standard error of the picture; `None` where passes do not alternate,
    /// or too few are done.
    pub fn noise(&self) -> Option<f64> {
        noise([&self.film, self.second.as_ref()?], self.counts)
    }
}

impl Session {
    /// A session that starts from `state`.
    pub fn new(scene: Arc<Scene>, view: View, integrator: Box<dyn Integrator>, state: SessionState) -> Self {
        Self {
            scene,
            view,
            integrator,
            samples_before: state.sample_count(),
            state,
            is_prepared: false,
            is_whole: true,
            drafts: 0,
            stats: RayStats::default(),
            elapsed: Duration::ZERO,
            last_pass: Duration::ZERO,
            noise: None,
            planned: PassSet::new(),
            limits: Limits::default(),
        }
    }

    /// Runs the passes of a range that are not done yet, on the threads of rayon's current pool,
    /// and calls `after_pass` after each.
    ///
    /// Drafts, if the integrator makes any, precede pass 0. The film is valid after `Err`, too: it
    /// holds the passes that are done, and after a cancellation some tiles of the next one. But
    /// unless it [is whole](Self::is_whole), no other session can resume from it.
    pub fn run(
        &mut self,
        passes: Range<u32>,
        limits: &Limits,
        control: &Control,
        after_pass: &mut dyn FnMut(&Self),
    ) -> Result<Stop, PassError> {
        let clock = Stopwatch { control, begin: control.now(), before: self.elapsed };
        let outcome = self.run_passes(passes, limits, &clock, after_pass);
        self.stats += control.take_counted();
        self.take_time(&clock);
        outcome
    }

    fn run_passes(
        &mut self,
        passes: Range<u32>,
        limits: &Limits,
        clock: &Stopwatch,
        after_pass: &mut dyn FnMut(&Self),
    ) -> Result<Stop, PassError> {
        clock.control.check()?;
        self.planned = self.state.done.union(&passes.clone().into());
        self.limits = *limits;
        if limits.noise.is_some() {
            self.state.alternate()?;
        }
        if !self.is_prepared {
            self.integrator.prepare(&self.scene, &self.view, clock.control)?;
            self.is_prepared = true;
        }
        if self.state.done.is_empty() && passes.start == 0 {
            for draft in self.drafts..self.integrator.drafts() {
                self.pass(draft, false, clock)?;
                self.drafts += 1;
                after_pass(self);
            }
        }
        for pass in passes {
            if self.state.done.contains(pass) {
                continue;
            }
            clock.control.check()?;
            if limits.time.is_some_and(|time| self.is_over(time)) {
                return Ok(Stop::Time);
            }
            if let Some(limit) = limits.noise {
                if is_estimated_after(self.state.done.count()) {
                    self.noise = self.state.noise();
                }
                if self.noise.is_some_and(|noise| noise <= limit) {
                    return Ok(Stop::Noise);
                }
            }
            let turn =
                usize::from(self.state.second.is_some() && self.state.counts[1] < self.state.counts[0]);
            self.pass(self.integrator.drafts() + pass, turn == 1, clock)?;
            self.state.counts[turn] += 1;
            self.state.done.insert(pass..pass + 1);
            after_pass(self);
        }
        Ok(Stop::Passes)
    }

    /// One pass of the integrator.
    fn pass(&mut self, pass: u32, on_second: bool, clock: &Stopwatch) -> Result<(), PassError> {
        let begin = clock.control.now();
        let film = match &mut self.state.second {
            Some(second) if on_second => second,
            _ => &mut self.state.film,
        };
        let outcome = self.integrator.pass(pass, &self.scene, &self.view, film, clock.control);
        self.is_whole &= !matches!(outcome, Err(PassError::Cancelled | PassError::Device(_)));
        let stats = outcome?;
        clock.control.take_counted();
        self.stats += stats;
        self.last_pass = clock.control.now().saturating_sub(begin);
        self.take_time(clock);
        Ok(())
    }

    fn take_time(&mut self, clock: &Stopwatch) {
        let elapsed = clock.before + clock.control.now().saturating_sub(clock.begin);
        let more = elapsed.saturating_sub(self.elapsed);
        self.state.elapsed = self.state.elapsed.saturating_add(more);
        self.elapsed = elapsed;
    }

    /// Whether the next pass would end after this time. At least one pass is run.
    fn is_over(&self, time: Duration) -> bool {
        !self.state.done.is_empty() && self.state.elapsed.saturating_add(self.last_pass) >= time
    }

    /// The steps of a sample of a pixel, given by its index, which are not added to the film;
    /// `None` by algorithms that do not estimate pixels one by one.
    pub fn record(
        &mut self,
        pixel: [i32; 2],
        index: u32,
        control: &Control,
    ) -> Result<Option<Record>, Cancelled> {
        if !self.is_prepared {
            self.integrator.prepare(&self.scene, &self.view, control)?;
            self.is_prepared = true;
        }
        let filter = self.state.film.filter();
        self.integrator.record(pixel, index, &self.scene, &self.view, filter, control).transpose()
    }

    /// The progress of the session.
    pub fn progress(&self) -> Progress {
        let done = f64::from(self.state.done.count());
        let share_of_time = self.limits.time.map(|time| self.state.elapsed.div_duration_f64(time));
        let by_time = share_of_time.map(|share| done / share);
        // Variance falls with the number of passes.
        let by_noise = self.noise.zip(self.limits.noise).map(|(noise, limit)| done * (noise / limit).powi(2));
        let planned = f64::from(self.planned.count());
        let passes = [by_time, by_noise].into_iter().flatten().fold(planned, f64::min).max(done).ceil();
        Progress {
            pass: self.drafts + self.state.done.count(),
            passes: self.integrator.drafts().saturating_add(passes as u32),
            samples: self.state.sample_count().saturating_sub(self.samples_before),
            stats: self.stats,
            elapsed: self.elapsed,
            noise: self.noise,
        }
    }

    /// The scene.
    pub fn scene(&self) -> &Arc<Scene> {
        &self.scene
    }

    /// The view of it.
    pub fn view(&self) -> &View {
        &self.view
    }

    /// The film, and which passes it holds.
    pub fn state(&self) -> &SessionState {
        &self.state
    }

    /// Whether the film holds complete passes only, no part of a cancelled one.
    pub fn is_whole(&self) -> bool {
        self.is_whole
    }

    /// Resumes from the state of another session of the same scene, view and algorithm, and from
    /// the further films that its algorithm has filled.
    pub fn resume(&mut self, state: SessionState, films: Vec<(String, Film)>) {
        self.samples_before = state.sample_count();
        self.state = state;
        self.integrator.set_films(films);
    }

    /// The state from which another session can resume.
    pub fn into_state(self) -> SessionState {
        self.state
    }

    /// Goes on with the same algorithm by another engine, which is prepared before its first pass.
    pub fn set_integrator(&mut self, integrator: Box<dyn Integrator>) {
        (self.integrator, self.is_prepared) = (integrator, false);
    }

    /// The algorithm.
    pub fn integrator(&self) -> &dyn Integrator {
        &*self.integrator
    }
}

/// Measures the time of a run.
struct Stopwatch<'a> {
    control: &'a Control,
    begin: Duration,
    /// Running time of the session before this run.
    before: Duration,
}

/// Whether noise is estimated after this number of passes: after every second one at first, later
/// after each increase by about a sixteenth. It depends on nothing else, so that a resumed render
/// ends at the same pass as an uninterrupted one.
fn is_estimated_after(passes: u32) -> bool {
    let step = (1_u32 << passes.max(1).ilog2().saturating_sub(4)).max(2);
    passes >= FIRST_ESTIMATE && passes.is_multiple_of(step)
}

/// The noise of the weighted mean of two films' independent pictures. `counts` are their passes;
/// `None` if they are too few.
pub fn noise(films: [&Film; 2], counts: [u32; 2]) -> Option<f64> {
    if counts.into_iter().min() < Some(FIRST_ESTIMATE / 2) {
        return None;
    }
    let [a, b] = counts.map(f64::from);
    let [share_a, share_b] = [a / (a + b), b / (a + b)];
    let mean_of = |[a, b]: [f64; 2]| share_a * a + share_b * b;
    let mean = mean_over(films, mean_of);
    let floor = (mean / 10.0).powi(2);
    let relative_variance = |[a, b]: [f64; 2]| {
        let variance = share_a * share_b * (a - b).powi(2);
        // Avoids 0/0 where the whole picture is black.
        if variance == 0.0 { 0.0 } else { variance / (mean_of([a, b]).powi(2) + floor) }
    };
    Some(mean_over(films, relative_variance).sqrt())
}

/// The mean of a function of the values of two films' pictures, over pixels and channels. The
/// pictures are developed row by row to save memory. Rows are summed in order, so that the result
/// does not depend on the number of threads.
fn mean_over(films: [&Film; 2], f: impl Fn([f64; 2]) -> f64 + Sync) -> f64 {
    let pictures = films.map(|film| Development::of_colors(film, None));
    let (width, height) = (pictures[0].width(), pictures[0].height());
    let row_sum = |y| {
        let [a, b] = pictures.each_ref().map(|picture| {
            let mut row = vec![0.0; 3 * width as usize];
            picture.row(y, &mut row);
            row
        });
        a.into_iter().zip(b).map(|(a, b)| f([a, b].map(f64::from))).sum::<f64>()
    };
    let sums: Vec<f64> = (0..height).into_par_iter().map(row_sum).collect();
    sums.iter().sum::<f64>() / (3.0 * f64::from(width) * f64::from(height))
}
