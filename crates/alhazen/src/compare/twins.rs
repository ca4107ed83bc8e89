//! One algorithm rendered twice, from different seeds, pass by pass in turn.
//!
//! Two independent pictures a and b of equal length tell noise and bias apart, which one picture
//! cannot: where they differ there is noise, and where they agree on something else than the truth
//! there is bias (see [`measure`](super::measure)). The first picture is what a render with the
//! scene's seed gives.

use std::time::{Duration, Instant};

use description::{Diagnostic, SceneDesc};
use film::Film;
use geometry::RayStats;
use image::Image;
use integrators::{Cancelled, Control, Integrator, Progress};
use scene::{Scene, View};

use super::Budget;
use crate::Overrides;

/// How far both renders are, each of which took this time and these rays.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Effort {
    /// Passes of each.
    pub passes: u32,
    /// Mean time in seconds.
    pub seconds: f64,
    /// Mean number of rays.
    pub rays: f64,
}

/// Two renders of one scene by one algorithm that differ in their seeds alone.
pub(super) struct Twins {
    twins: [Twin; 2],
    passes: u32,
    stats: RayStats,
}

struct Twin {
    integrator: Box<dyn Integrator>,
    film: Film,
    elapsed: Duration,
}

impl Twins {
    /// Renders of the scene as described, with seeds `first_seed` and the next one.
    pub fn new(desc: &SceneDesc, first_seed: i32) -> Result<(Self, Vec<Diagnostic>), Vec<Diagnostic>> {
        let mut desc = desc.clone();
        let mut warnings = Vec::new();
        let mut twin = |seed: i32| -> Result<Twin, Vec<Diagnostic>> {
            Overrides { seed: Some(seed), ..Overrides::default() }
                .apply(&mut desc)
                .expect("invariant: any seed will do");
            let built = integrators::build(&desc)?;
            let film = film::compile(&desc)?;
            warnings = [built.warnings, film.warnings].concat();
            Ok(Twin { integrator: built.integrator, film: film.film, elapsed: Duration::ZERO })
        };
        let twins = [twin(first_seed)?, twin(first_seed.wrapping_add(1))?];
        Ok((Self { twins, passes: 0, stats: RayStats::default() }, warnings))
    }

    /// Renders until the budget is used up or the algorithm has done all its passes, and calls
    /// `at_checkpoint` at pass counts that grow geometrically, and at the end: also where it is
    /// cancelled, unless no pass was done by both until then.
    pub fn render(
        &mut self,
        (scene, view): (&Scene, &View),
        budget: Budget,
        control: &Control,
        mut at_checkpoint: impl FnMut(&Self),
    ) -> Result<(), Cancelled> {
        control.check()?;
        for twin in &mut self.twins {
            let start = Instant::now();
            twin.integrator.prepare(scene, view, control)?;
            twin.elapsed += start.elapsed();
        }
        let all = self.twins[0].integrator.passes();
        let (mut checkpoint, mut outcome) = (0, Ok(()));
        while outcome.is_ok() && self.passes < all && !budget.is_spent(self.effort().seconds) {
            outcome = self.pass(scene, view, control);
            if self.passes == next_checkpoint(checkpoint) {
                at_checkpoint(self);
                checkpoint = self.passes;
            }
            self.tell(budget, all, control);
        }
        if self.passes > checkpoint {
            at_checkpoint(self);
        }
        outcome
    }

    /// One pass of each. A cancelled one counts for nothing, though the films may have a part of
    /// its light.
    fn pass(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        let mut took = [Duration::ZERO; 2];
        for (twin, took) in self.twins.iter_mut().zip(&mut took) {
            let start = Instant::now();
            let stats = twin.integrator.pass(self.passes, scene, view, &mut twin.film, control)?;
            *took = start.elapsed();
            self.stats += stats;
        }
        self.twins.iter_mut().zip(took).for_each(|(twin, took)| twin.elapsed += took);
        self.passes += 1;
        Ok(())
    }

    /// Tells the listener how far it is; where time is the limit, it has to guess how many passes
    /// there will be.
    fn tell(&self, budget: Budget, all: u32, control: &Control) {
        let Some(listener) = &control.progress else { return };
        let passes = match budget {
            Budget::Samples(_) => all,
            Budget::Time(time) => {
                let share = self.effort().seconds / time.as_secs_f64();
                (f64::from(self.passes) / share.clamp(1e-6, 1.0)).min(f64::from(all)) as u32
            }
        };
        let samples_per_pass = 2 * self.twins[0].film.pixel_bounds().area() as u64;
        listener(&Progress {
            pass: self.passes,
            passes,
            samples: samples_per_pass * u64::from(self.passes),
            stats: self.stats,
            elapsed: self.twins[0].elapsed + self.twins[1].elapsed,
        });
    }

    /// How far both renders are.
    pub fn effort(&self) -> Effort {
        let elapsed = self.twins[0].elapsed + self.twins[1].elapsed;
        Effort {
            passes: self.passes,
            seconds: elapsed.as_secs_f64() / 2.0,
            rays: self.stats.rays as f64 / 2.0,
        }
    }

    /// What the algorithm tells of itself, in the first render.
    pub fn notes(&self) -> Vec<(&'static str, String)> {
        self.twins[0].integrator.summary()
    }

    /// The two pictures as they stand.
    pub fn pictures(&self) -> [Image; 2] {
        [0, 1].map(|twin: usize| self.twins[twin].film.develop())
    }
}

/// The first of the pass counts 1, 2, 3, 4, 6, 8, 11, 16, … (two for each doubling) above `passes`.
fn next_checkpoint(passes: u32) -> u32 {
    let mut counts = (0..64).map(|half_doublings| (f64::from(half_doublings) / 2.0).exp2().round() as u32);
    counts.find(|&count| count > passes).unwrap_or(u32::MAX)
}
