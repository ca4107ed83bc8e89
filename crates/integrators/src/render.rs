//! The one loop: prepare, then pass after pass.

use std::time::{Duration, Instant};

use film::Film;
use geometry::RayStats;
use scene::{Scene, View};

use crate::{Cancelled, Control, Integrator, Progress};

/// What a render took.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct RenderReport {
    /// Passes done.
    pub passes: u32,
    /// Pixel samples taken.
    pub samples: u64,
    /// Rays traced, and what they met.
    pub stats: RayStats,
    /// Time from the first preparation to the end of the last pass.
    pub elapsed: Duration,
}

/// Renders a view of the scene into the film, on the threads of rayon's current pool.
///
/// After `Err` the film is valid all the same: it holds the light of the passes, and tiles, that
/// were done, and the last progress told has their rays.
pub fn render(
    integrator: &mut dyn Integrator,
    scene: &Scene,
    view: &View,
    film: &mut Film,
    control: &Control,
) -> Result<RenderReport, Cancelled> {
    let start = Instant::now();
    let passes = integrator.passes();
    let samples_per_pass = film.pixel_bounds().area() as u64;
    let mut report = RenderReport::default();
    control.check()?;
    integrator.prepare(scene, view, control)?;
    for pass in 0..passes {
        let outcome = integrator.pass(pass, scene, view, film, control);
        let under_way = control.take_counted();
        if let Ok(stats) = outcome {
            report.stats += stats;
            report.passes += 1;
            report.samples += samples_per_pass;
        } else {
            report.stats += under_way;
        }
        report.elapsed = start.elapsed();
        let RenderReport { passes: pass, samples, stats, elapsed } = report;
        control.report(&Progress { pass, passes, samples, stats, elapsed });
        outcome?;
        if pass < passes {
            control.show(film);
        }
    }
    Ok(report)
}
