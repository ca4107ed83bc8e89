//! Two renders with one integrator, from different seeds, alternating pass by pass.
//!
//! Two independent pictures with the same budget separate noise and bias, which one picture cannot:
//! their difference is noise, and their common difference from the reference is bias (see
//! [`measure`](super::measure)). The first picture is the one that a render with the scene's seed
//! gives.

use std::sync::Arc;

use alhazen::description::{Diagnostic, SceneDesc};
#[cfg(feature = "gpu")]
use alhazen::device::{Kernels, move_to};
use alhazen::geometry::RayStats;
use alhazen::image::{Image, ImageError};
use alhazen::integrators::{self, Control, Limits, PassError, Progress, Session, SessionState};
use alhazen::scene::{Scene, View};
use alhazen::{Overrides, film};

use super::Budget;

/// The passes that both renders have done, with the mean time and rays of one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Effort {
    /// Passes of each.
    pub passes: u32,
    /// Mean time in seconds.
    pub seconds: f64,
    /// Mean number of rays.
    pub rays: f64,
}

/// The scene, view and device that all contenders share.
pub(super) struct Subject {
    /// The scene.
    pub scene: Arc<Scene>,
    /// The view of it.
    pub view: View,
    /// The GPU, if one is to render.
    #[cfg(feature = "gpu")]
    pub kernels: Option<Arc<Kernels>>,
}

impl Subject {
    /// Has the GPU render a session, if there is one and it draws that; else the warnings say why
    /// not.
    #[cfg(feature = "gpu")]
    fn move_to_device(&self, session: &mut Session, desc: &SceneDesc) -> Vec<Diagnostic> {
        let moved = self.kernels.as_ref().map(|kernels| move_to(session, desc, kernels));
        moved.map_or_else(Vec::new, |moved| moved.unwrap_or_else(|refusals| refusals))
    }
}

/// Two renders of one scene with one integrator that differ only in their seeds.
pub(super) struct PairedRenders {
    pair: [Session; 2],
}

impl PairedRenders {
    /// Two sessions of a view of the scene, with seeds `first_seed` and the next one.
    pub fn new(
        desc: &SceneDesc,
        subject: &Subject,
        first_seed: i32,
    ) -> Result<(Self, Vec<Diagnostic>), Vec<Diagnostic>> {
        let mut desc = desc.clone();
        let mut warnings = Vec::new();
        let mut session = |seed: i32| -> Result<Session, Vec<Diagnostic>> {
            Overrides { seed: Some(seed), ..Overrides::default() }
                .apply(&mut desc)
                .expect("invariant: any seed is valid");
            let built = integrators::build(&desc)?;
            let film = film::compile(&desc)?;
            let Subject { scene, view, .. } = subject;
            warnings = [built.warnings, built.integrator.warnings(scene), film.warnings].concat();
            let state = SessionState::new(film.film);
            #[cfg_attr(
                not(feature = "gpu"),
                expect(unused_mut, reason = "only a session that moves changes")
            )]
            let mut session = Session::new(Arc::clone(scene), view.clone(), built.integrator, state);
            #[cfg(feature = "gpu")]
            warnings.extend(subject.move_to_device(&mut session, &desc));
            Ok(session)
        };
        let pair = [session(first_seed)?, session(first_seed.wrapping_add(1))?];
        Ok((Self { pair }, warnings))
    }

    /// Renders until the budget is used up. Calls `at_checkpoint` at pass counts that grow
    /// geometrically, and at the end, also after a cancellation, unless no pass was done by both
    /// since the last checkpoint. Calls `progress` after each pass of both.
    pub fn render(
        &mut self,
        budget: Budget,
        control: &Control,
        progress: &mut dyn FnMut(&Progress),
        mut at_checkpoint: impl FnMut(&Self) -> Result<(), PassError>,
    ) -> Result<(), PassError> {
        let mut checkpoint = 0;
        progress(&self.progress(budget));
        for pass in 0..self.most_passes(budget) {
            if budget.is_spent(self.effort().seconds) {
                break;
            }
            // A cancelled pass does not count, though the films may have a part of its samples.
            let outcome = self.pass(pass, control);
            let done = self.effort().passes;
            if done == next_checkpoint(checkpoint) || (outcome.is_err() && done > checkpoint) {
                at_checkpoint(self)?;
                checkpoint = done;
            }
            progress(&self.progress(budget));
            outcome?;
        }
        if self.effort().passes > checkpoint {
            at_checkpoint(self)?;
        }
        Ok(())
    }

    /// Only time limits a render with a budget of time: it may exceed the scene's number of passes.
    fn most_passes(&self, budget: Budget) -> u32 {
        match budget {
            Budget::Samples(_) => self.pair[0].integrator().passes(),
            Budget::Time(_) => u32::MAX,
        }
    }

    /// Runs one pass of each.
    fn pass(&mut self, pass: u32, control: &Control) -> Result<(), PassError> {
        let mut run = |session: &mut Session| {
            session.run(pass..pass + 1, &Limits::default(), control, &mut |_| ()).map(|_| ())
        };
        self.pair.iter_mut().try_for_each(&mut run)
    }

    /// Progress of both renders together. With a budget of time the number of passes is estimated.
    fn progress(&self, budget: Budget) -> Progress {
        let Effort { passes: pass, seconds, .. } = self.effort();
        let passes = match budget {
            Budget::Samples(_) => self.most_passes(budget),
            Budget::Time(time) => (f64::from(pass) * time.as_secs_f64() / seconds.max(1e-9)) as u32,
        };
        let [a, b] = self.pair.each_ref().map(Session::progress);
        Progress {
            pass,
            passes,
            samples: a.samples + b.samples,
            stats: self.stats(),
            elapsed: a.elapsed + b.elapsed,
            noise: None,
        }
    }

    fn stats(&self) -> RayStats {
        let [a, b] = self.pair.each_ref().map(|session| session.progress().stats);
        let mut stats = a;
        stats += b;
        stats
    }

    /// Passes, time and rays. A pass that only one has done does not count.
    pub fn effort(&self) -> Effort {
        let [a, b] = self.pair.each_ref().map(Session::progress);
        let passes = self.pair.each_ref().map(|session| session.state().done.count());
        Effort {
            passes: passes[0].min(passes[1]),
            seconds: (a.elapsed + b.elapsed).as_secs_f64() / 2.0,
            rays: self.stats().rays as f64 / 2.0,
        }
    }

    /// The integrator's summary, of the first render.
    pub fn notes(&self) -> Vec<(&'static str, String)> {
        self.pair[0].integrator().summary()
    }

    /// The two pictures so far.
    pub fn pictures(&self) -> Result<[Image; 2], ImageError> {
        let [a, b] = self.pair.each_ref().map(|session| session.state().film.develop());
        Ok([a?, b?])
    }
}

/// The first of the pass counts 1, 2, 3, 4, 6, 8, 11, 16, … (two per doubling) above `passes`.
fn next_checkpoint(passes: u32) -> u32 {
    let mut counts = (0..64).map(|half_doublings| (f64::from(half_doublings) / 2.0).exp2().round() as u32);
    counts.find(|&count| count > passes).unwrap_or(u32::MAX)
}
