//! `alhazen view`: a scene walked through in a window, or a camera path without one.

use std::process::ExitCode;
use std::sync::Arc;
use std::time::{Duration, Instant};

use alhazen::Overrides;
use alhazen::import::Files;
use alhazen::integrators::Control;
use view::{Renderer, Report, StepError, World};

use crate::args::View;
use crate::console::say;
use crate::diagnostics;
use crate::drive::Prepared;
use crate::failure::Failure;
use crate::threads::start_threads;

/// The time that a frame is to take.
const TARGET: Duration = Duration::from_millis(33);

/// Opens the window, or reports the frame times of a camera path.
pub fn view(arguments: &View) -> Result<ExitCode, Failure> {
    let begin = Instant::now();
    if !arguments.headless && !cfg!(feature = "view") {
        return Err(Failure::Usage(
            "this program was built without the window, which the cargo feature `view` adds; --headless \
             renders a camera path without one"
                .into(),
        ));
    }
    start_threads(arguments.changes.threads)?;
    let overrides = Overrides {
        integrator: arguments.integrator.clone(),
        samples_per_pixel: arguments.spp,
        ..arguments.changes.overrides()
    };
    let prepared = Prepared::new(&arguments.scene, &Files, overrides)?;
    let desc = (!arguments.headless).then(|| prepared.imported().desc.clone());
    let (world, compiled) = prepared.compile_as(|desc| {
        let world = World::new(desc)?;
        let warnings = world.warnings.clone();
        Ok((world, warnings))
    })?;
    let imported = compiled.imported();
    if !arguments.json {
        diagnostics::print(&imported.diagnostics, &imported.sources)?;
    }
    if let Some(desc) = desc {
        return window(arguments, world, desc);
    }
    let mut flight = world.flight();
    let mut renderer = Renderer::new(Arc::new(world), TARGET);
    let control = Control::default();
    let report = Report::of_orbit(&mut renderer, &mut flight, arguments.frames, begin, &control);
    let report = report.map_err(|error| match error {
        StepError::Problem(problem) => Failure::Input(problem),
        StepError::Cancelled => Failure::Input("cancelled".into()),
    })?;
    if arguments.json {
        let (_, warnings) = diagnostics::to_json(&imported.diagnostics, &imported.sources);
        let mut json = report.to_json();
        json["warnings"] = warnings;
        say(json)?;
    } else {
        say(text(&report))?;
    }
    Ok(ExitCode::SUCCESS)
}

#[cfg(feature = "view")]
fn window(
    arguments: &View,
    world: World,
    desc: alhazen::description::SceneDesc,
) -> Result<ExitCode, Failure> {
    let title = format!("{} · alhazen", arguments.scene.display());
    view::window::open(&title, world, desc, arguments.display.settings(), TARGET).map_err(|error| {
        Failure::Input(format!("{error}; --headless renders a camera path without a window"))
    })?;
    Ok(ExitCode::SUCCESS)
}

/// Without the feature this was refused before.
#[cfg(not(feature = "view"))]
fn window(_: &View, _: World, _: alhazen::description::SceneDesc) -> Result<ExitCode, Failure> {
    Ok(ExitCode::FAILURE)
}

fn text(report: &Report) -> String {
    let ms = |time: Duration| format!("{:.1} ms", time.as_secs_f64() * 1e3);
    let size = |[width, height]: [u32; 2]| format!("{width} × {height}");
    format!(
        "{}, {} frames of {} (half of them are no larger), of a picture of {}, {} samples per pixel\n  \
         frame time       median {}, 95 % {}, at most {}: {:.1} frames per second\n  \
         first picture    {} after the start, the scene compiled in {}\n  \
         rays             {:.2} million per second",
        report.integrator,
        report.frames.len(),
        size(report.median_size()),
        size(report.resolution),
        report.samples,
        ms(report.quantile(0.5)),
        ms(report.quantile(0.95)),
        ms(report.quantile(1.0)),
        report.fps(),
        ms(report.first_picture),
        ms(report.compiled_in),
        report.rays_per_second() / 1e6,
    )
}
