//! The driver of all integrators: prepare, then pass after pass, until a limit is reached.
//!
//! The passes of an integrator are independent of each other given their numbers, and the sums of a
//! film are exact. So any order of passes, any split of them over sessions and any number of stops
//! in between give the same bits: renders can be resumed and sharded. Previews, checkpoints and
//! comparisons look at the session after each pass.
//!
//! # Noise
//!
//! Where noise is a limit, passes alternate between two films, whose pictures a and b of n_a and
//! n_b passes are independent estimates of the same picture. Of their weighted mean r, the picture,
//! each value has the variance
//!
//! ```text
//! Var[r] = n_a n_b/(n_a + n_b)² · E[(a − b)²]
//! ```
//!
//! whatever a pass does: it holds for splats and for chains of Metropolis, where samples of a pixel
//! are not independent. The *noise* of the picture is its relative standard error
//!
//! ```text
//! noise = √⟨Var[r] / (r² + (m/10)²)⟩
//! ```
//!
//! where ⟨·⟩ is the mean over pixels and channels, and m the mean of r, which keeps dark pixels
//! from deciding alone. It is the root of the relMSE [Rousselle 2011] against the picture without
//! noise, but does not depend on exposure. Bias is not noise. Samplers whose passes complement each
//! other have less noise than this says, as the halves' errors are negatively correlated.

use std::ops::Range;
use std::sync::Arc;
use std::time::Duration;

use film::{Film, PassSet};
use geometry::RayStats;
use image::Image;
use scene::{Scene, View};

use crate::{Cancelled, Control, Integrator};

/// Passes before which noise is not trusted: light that few paths find may not have been found.
const FIRST_ESTIMATE: u32 = 16;

/// How far a session is.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Progress {
    /// Passes done, drafts included.
    pub pass: u32,
    /// Passes to do in all: an estimate where the limit is time or noise, `u32::MAX` where it is
    /// not known yet.
    pub passes: u32,
    /// Pixel samples taken by this session.
    pub samples: u64,
    /// Rays traced by this session, and what they met.
    pub stats: RayStats,
    /// Time that this session has run.
    pub elapsed: Duration,
    /// The last estimate of noise.
    pub noise: Option<f64>,
}

/// What ends a run before its last pass.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Limits {
    /// No pass but the first is begun that would end, if it took as long as the one before, after
    /// sessions have run for so long.
    pub time: Option<Duration>,
    /// The run ends when the estimated noise is not above this.
    pub noise: Option<f64>,
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
    /// Drafts done by this session.
    drafts: u32,
    /// Passes done by this session, drafts included.
    passes: u32,
    stats: RayStats,
    elapsed: Duration,
    last_pass: Duration,
    noise: Option<f64>,
    /// What the film is to hold at the end of the current run.
    planned: PassSet,
    limits: Limits,
}

/// What has to be kept of a session for another one to go on as if they were one.
#[derive(Debug)]
pub struct SessionState {
    /// The passes that the films hold.
    pub done: PassSet,
    /// The film.
    pub film: Film,
    /// The film that takes turns with the first one, where noise is estimated.
    pub second: Option<Film>,
    /// How many passes the first and the second film hold.
    pub counts: [u32; 2],
    /// Time that sessions have run.
    pub elapsed: Duration,
}

impl SessionState {
    /// No passes.
    pub fn new(film: Film) -> Self {
        Self { done: PassSet::new(), film, second: None, counts: [0; 2], elapsed: Duration::ZERO }
    }

    /// What `look` finds on the film with the light of all passes.
    pub fn with_film<T>(&self, look: impl FnOnce(&Film) -> T) -> T {
        match &self.second {
            None => look(&self.film),
            Some(second) => {
                let mut whole = self.film.blank();
                whole.merge(&self.film);
                whole.merge(second);
                look(&whole)
            }
        }
    }

    /// The estimated relative standard error of the picture; `None` where passes do not alternate,
    /// or too few are done.
    pub fn noise(&self) -> Option<f64> {
        let [a, b] = self.counts;
        let second = self.second.as_ref().filter(|_| a.min(b) >= FIRST_ESTIMATE / 2)?;
        Some(noise(&[self.film.develop(), second.develop()], self.counts))
    }
}

impl Session {
    /// Begins with `state`.
    pub fn new(scene: Arc<Scene>, view: View, integrator: Box<dyn Integrator>, state: SessionState) -> Self {
        Self {
            scene,
            view,
            integrator,
            state,
            is_prepared: false,
            drafts: 0,
            passes: 0,
            stats: RayStats::default(),
            elapsed: Duration::ZERO,
            last_pass: Duration::ZERO,
            noise: None,
            planned: PassSet::new(),
            limits: Limits::default(),
        }
    }

    /// Does those passes of a range that are not done yet, on the threads of rayon's current pool,
    /// and calls `after_pass` after each.
    ///
    /// Pass 0 of an integrator that makes drafts is preceded by them. After `Err` the film is valid
    /// all the same: it holds the light of the passes, and tiles, that were done. But no other
    /// session can go on from it, as it holds a part of a pass.
    pub fn run(
        &mut self,
        passes: Range<u32>,
        limits: &Limits,
        control: &Control,
        after_pass: &mut dyn FnMut(&Self),
    ) -> Result<Stop, Cancelled> {
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
    ) -> Result<Stop, Cancelled> {
        clock.control.check()?;
        self.planned = self.state.done.union(&passes.clone().into());
        self.limits = *limits;
        if limits.noise.is_some() && self.state.second.is_none() {
            self.state.second = Some(self.state.film.blank());
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
    fn pass(&mut self, pass: u32, on_second: bool, clock: &Stopwatch) -> Result<(), Cancelled> {
        let begin = clock.control.now();
        let film = match &mut self.state.second {
            Some(second) if on_second => second,
            _ => &mut self.state.film,
        };
        let stats = self.integrator.pass(pass, &self.scene, &self.view, film, clock.control)?;
        clock.control.take_counted();
        self.stats += stats;
        self.passes += 1;
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

    /// Whether the next pass would end after this time. There is one pass at least.
    fn is_over(&self, time: Duration) -> bool {
        !self.state.done.is_empty() && self.state.elapsed.saturating_add(self.last_pass) >= time
    }

    /// How far the session is.
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
            samples: u64::from(self.passes) * self.state.film.pixel_bounds().area() as u64,
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

    /// Goes on with what another session of the same scene, view and algorithm has left, and with
    /// the films that its algorithm has filled beside the picture's.
    pub fn resume(&mut self, state: SessionState, films: Vec<(String, Film)>) {
        self.state = state;
        self.integrator.set_films(films);
    }

    /// What another session can go on from.
    pub fn into_state(self) -> SessionState {
        self.state
    }

    /// The algorithm.
    pub fn integrator(&self) -> &dyn Integrator {
        &*self.integrator
    }
}

/// Measures a run.
struct Stopwatch<'a> {
    control: &'a Control,
    begin: Duration,
    /// Time that the session had run before.
    before: Duration,
}

/// Whether noise is estimated after so many passes: after every second one at first, later when a
/// sixteenth more are done. It depends on nothing else, so that a render that was resumed ends as
/// one that was not.
fn is_estimated_after(passes: u32) -> bool {
    let step = (1_u32 << passes.max(1).ilog2().saturating_sub(4)).max(2);
    passes >= FIRST_ESTIMATE && passes.is_multiple_of(step)
}

/// The noise of the mean of two independent pictures of so many passes each.
fn noise(pictures: &[Image; 2], counts: [u32; 2]) -> f64 {
    let [a, b] = counts.map(f64::from);
    let [share_a, share_b] = [a / (a + b), b / (a + b)];
    let values = || pictures[0].values().zip(pictures[1].values()).map(|(a, b)| [f64::from(a), f64::from(b)]);
    let mean_of = |[a, b]: [f64; 2]| share_a * a + share_b * b;
    let count = values().count() as f64;
    let mean = values().map(mean_of).sum::<f64>() / count;
    let floor = (mean / 10.0).powi(2);
    let relative_variance = |[a, b]: [f64; 2]| {
        let variance = share_a * share_b * (a - b).powi(2);
        // Where the whole picture is black there is nothing to differ.
        if variance == 0.0 { 0.0 } else { variance / (mean_of([a, b]).powi(2) + floor) }
    };
    (values().map(relative_variance).sum::<f64>() / count).sqrt()
}
