//! `alhazen view`: a scene walked through in a window, or a camera path without one.

use std::path::Path;
use std::process::ExitCode;
use std::slice;
use std::sync::Arc;
use std::time::{Duration, Instant};

use alhazen::Overrides;
use alhazen::assets::Files;
use alhazen::description::Diagnostic;
use alhazen::integrators::Control;
use view::planet::{Outing, PlanetReport, Spent};
use view::{Renderer, Report, Shot, Stages, World};

use crate::args::View;
use crate::console::say;
use crate::diagnostics;
use crate::drive::Prepared;
use crate::failure::Failure;
use crate::results::write_results;
use crate::threads::start_threads;

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
    if arguments.split.is_some() && !cfg!(feature = "gpu") {
        return Err(Failure::Usage(
            "this program was built without the engine for GPUs, which the cargo feature `gpu` adds".into(),
        ));
    }
    start_threads(arguments.changes.threads)?;
    let overrides = Overrides {
        integrator: arguments.integrator.clone(),
        samples_per_pixel: arguments.spp,
        ..arguments.changes.overrides()
    };
    let Some(scene) = &arguments.scene else {
        return planet(arguments, &overrides);
    };
    let prepared = Prepared::new(scene, &Files, overrides)?;
    let desc = (!arguments.headless).then(|| prepared.imported().desc.clone());
    let (world, compiled) = prepared.compile_as(|desc| {
        let world = World::new(desc)?;
        let warnings = world.warnings.clone();
        Ok((world, warnings))
    })?;
    #[cfg_attr(not(feature = "gpu"), expect(unused_mut, reason = "only a device has warnings"))]
    let mut compiled = compiled;
    #[cfg(feature = "gpu")]
    let kernels = {
        let mut warnings = Vec::new();
        let kernels = crate::device::kernels(arguments.device, &mut warnings);
        compiled.add(warnings);
        kernels
    };
    let imported = compiled.imported();
    if !arguments.json {
        diagnostics::print(&imported.diagnostics, &imported.sources)?;
    }
    let mut flight = world.flight();
    let mut renderer = Renderer::new(Arc::new(world), Duration::from_millis(arguments.frame_time.into()));
    renderer.aim(Shot { samples: arguments.moving_spp, ..renderer.shot().clone() });
    #[cfg(feature = "gpu")]
    if let Some(kernels) = kernels {
        renderer.move_to(kernels, arguments.restir.map(Into::into));
    }
    if let Some(desc) = desc {
        return window(arguments, scene, renderer, desc);
    }
    #[cfg(feature = "gpu")]
    if let Some(share) = arguments.split {
        let report = crate::split::headless(arguments, &mut renderer, share, begin)?;
        if arguments.json {
            let mut json = report.to_json();
            json["warnings"] = diagnostics::to_json(&imported.diagnostics, &imported.sources).1;
            say(json)?;
        } else {
            say(format_args!("{}\n{}", text(&report.traced), crate::split::text(&report)))?;
        }
        return Ok(ExitCode::SUCCESS);
    }
    let control = Control::default();
    let orbit = Report::of_orbit(&mut renderer, &mut flight, arguments.frames, begin, &control);
    let (report, last) = orbit?;
    if let (Some(path), Some(frame)) = (&arguments.output, last) {
        let display = arguments.display.settings();
        write_results(&frame.to_image(), slice::from_ref(path), &display, None, Vec::new())?;
    }
    if arguments.json {
        let (_, warnings) = diagnostics::to_json(&imported.diagnostics, &imported.sources);
        let mut json = report.to_json();
        json["warnings"] = warnings;
        json["not_on_gpu"] = renderer.refusals().iter().map(|refusal| refusal.message.as_str()).collect();
        say(json)?;
    } else {
        say(text(&report))?;
        for refusal in renderer.refusals() {
            say(&refusal.message)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// A walk over a planet, in a window or without one.
fn planet(arguments: &View, overrides: &Overrides) -> Result<ExitCode, Failure> {
    let spheres = arguments.planet.unwrap_or_default() as usize;
    let overrides = Overrides { samples_per_pixel: None, ..overrides.clone() };
    let outing = Outing::new(spheres, &overrides, arguments.spp.unwrap_or(1));
    let mut outing = outing.map_err(Failure::Usage)?;
    let refusals = take_to_device(&mut outing, arguments);
    if !arguments.headless {
        for refusal in refusals {
            say(refusal.message)?;
        }
        return planet_window(arguments, outing);
    }
    let report = PlanetReport::of_walk(&mut outing, arguments.frames, &Control::default());
    let report = report?;
    if arguments.json {
        let mut json = report.to_json();
        json["not_on_gpu"] = refusals.iter().map(|refusal| refusal.message.as_str()).collect();
        say(json)?
    } else {
        say(text_of_planet(&report))?;
        for refusal in refusals {
            say(refusal.message)?;
        }
    }
    Ok(ExitCode::SUCCESS)
}

/// Takes a planet to the chosen device. What is returned says why the CPU keeps it although another
/// was chosen, or what of that is not there.
#[cfg(feature = "gpu")]
fn take_to_device(outing: &mut Outing, arguments: &View) -> Vec<Diagnostic> {
    let mut refusals = Vec::new();
    if let Some(kernels) = crate::device::kernels(arguments.device, &mut refusals) {
        refusals.extend(outing.move_to(&kernels).err().unwrap_or_default());
    }
    refusals
}

/// Without the feature there is only the CPU.
#[cfg(not(feature = "gpu"))]
fn take_to_device(_: &mut Outing, _: &View) -> Vec<Diagnostic> {
    Vec::new()
}

#[cfg(feature = "view")]
fn planet_window(arguments: &View, outing: Outing) -> Result<ExitCode, Failure> {
    view::window::open_planet(outing, arguments.display.settings()).map_err(without_window)?;
    Ok(ExitCode::SUCCESS)
}

/// Without the feature this was refused before.
#[cfg(not(feature = "view"))]
fn planet_window(_: &View, _: Outing) -> Result<ExitCode, Failure> {
    Ok(ExitCode::FAILURE)
}

#[cfg(feature = "view")]
fn without_window(error: String) -> Failure {
    Failure::Input(format!("{error}; --headless renders a camera path without a window"))
}

#[cfg(feature = "view")]
fn window(
    arguments: &View,
    scene: &Path,
    renderer: Renderer,
    desc: alhazen::description::SceneDesc,
) -> Result<ExitCode, Failure> {
    let restir = renderer.shared().map_or(String::new(), |weights| format!(" · ReSTIR, {weights}"));
    let title = format!("{}{restir} · alhazen", scene.display());
    let (display, split) = (arguments.display.settings(), arguments.split);
    view::window::open(&title, renderer, desc, display, split).map_err(without_window)?;
    Ok(ExitCode::SUCCESS)
}

/// Without the feature this was refused before.
#[cfg(not(feature = "view"))]
fn window(_: &View, _: &Path, _: Renderer, _: alhazen::description::SceneDesc) -> Result<ExitCode, Failure> {
    Ok(ExitCode::FAILURE)
}

fn text(report: &Report) -> String {
    let ms = |time: Duration| format!("{:.1} ms", time.as_secs_f64() * 1e3);
    let size = |[width, height]: [u32; 2]| format!("{width} × {height}");
    let median = |part: fn(&Stages) -> Duration| Some(ms(report.median_of(part)?));
    let stages: Option<Vec<_>> =
        [median(|stages| stages.trace), median(|stages| stages.filter), median(|stages| stages.rest)]
            .into_iter()
            .collect();
    let stages = stages.and_then(|stages| <[String; 3]>::try_from(stages).ok());
    format!(
        "{}, {} frames of {} (half of them are no larger), of a picture of {}, {} samples per pixel\n  \
         frame time       median {}, 95 % {}, at most {}: {:.1} frames per second\n  \
         first picture    {} after the start, the scene compiled in {}\n  \
         rays             {:.2} million per second, by {}{}",
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
        report.device.as_deref().unwrap_or("the CPU"),
        stages.map_or(String::new(), |[trace, filter, rest]| format!(
            "{}\n  of which         {trace} trace, {filter} filter, {rest} for the rest (medians)",
            report.shared.map_or(String::new(), |weights| format!(", ReSTIR {weights}")),
        )),
    )
}

fn text_of_planet(report: &PlanetReport) -> String {
    let ms = |share: f64, part: fn(&Spent) -> Duration| {
        format!("{:.1} ms", report.quantile(share, part).as_secs_f64() * 1e3)
    };
    let [width, height] = report.resolution;
    format!(
        "{}, {} frames of {width} × {height}, {} samples per pixel, of a planet of {} spheres, of which \
         {} move\n  \
         frame time       median {}, 95 % {}, at most {}: {:.1} frames per second\n  \
         of which         {} simulate, {} move the spheres, {} render\n  \
         rays             {:.2} million per second, by {}",
        report.integrator,
        report.frames.len(),
        report.samples,
        report.spheres,
        report.median_moving(),
        ms(0.5, Spent::sum),
        ms(0.95, Spent::sum),
        ms(1.0, Spent::sum),
        report.fps(),
        ms(0.5, |spent| spent.simulating),
        ms(0.5, |spent| spent.moving),
        ms(0.5, |spent| spent.rendering),
        report.rays_per_second() / 1e6,
        report.device.as_deref().unwrap_or("the CPU"),
    )
}
