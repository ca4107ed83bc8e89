//! `alhazen view --split --headless`: frame times of a ray traced and a rasterised scene, and a
//! picture of both.

use std::slice;
use std::sync::Arc;
use std::time::{Duration, Instant};

use alhazen::integrators::Control;
use view::split::{SplitReport, picture};
use view::{Rasterized, Renderer};

use crate::args::View;
use crate::console::warn;
use crate::failure::Failure;
use crate::results::write_results;

/// Finds both frame times of a camera path, and writes the picture that was asked for.
pub fn headless(
    arguments: &View,
    renderer: &mut Renderer,
    share: f32,
    begin: Instant,
) -> Result<SplitReport, Failure> {
    let device = Rasterized::open()
        .map_err(|error| Failure::Input(format!("{error}; without --split no GPU is needed")))?;
    let start = Instant::now();
    let world = Arc::clone(renderer.world());
    let mut rasterized = Rasterized::new(Arc::clone(&world), device).map_err(Failure::Input)?;
    let prepared_in = start.elapsed();
    for note in rasterized.warnings().iter().filter(|_| !arguments.json) {
        warn(format_args!("warning: {}", note.message))?;
    }
    let mut flight = world.flight();
    let control = Control::default();
    let frames = arguments.frames;
    let mut report = SplitReport::of_orbit(renderer, &mut rasterized, &mut flight, frames, begin, &control)?;
    report.prepared_in += prepared_in;
    if let Some(path) = &arguments.output {
        let picture = picture(renderer, &mut rasterized, share, &control)?;
        let display = arguments.display.settings();
        write_results(&picture, slice::from_ref(path), &display, None, Vec::new())?;
    }
    Ok(report)
}

/// The times of the rasterised frames in words.
pub fn text(report: &SplitReport) -> String {
    let ms = |time: Duration| format!("{:.1} ms", time.as_secs_f64() * 1e3);
    format!(
        "  rasterised       median {}, 95 % {}, at most {}, by {}; prepared in {}\n  \
         of the last      {:.2} million triangles and {} sprites",
        ms(report.quantile(0.5)),
        ms(report.quantile(0.95)),
        ms(report.quantile(1.0)),
        report.device,
        ms(report.prepared_in),
        report.triangles as f64 / 1e6,
        report.sprites,
    )
}
