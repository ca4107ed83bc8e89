//! `alhazen trace-pixel`: what happens along the paths of a pixel.

use std::path::Path;
use std::process::ExitCode;

use alhazen::Overrides;
use alhazen::assets::Files;
use alhazen::image::replace_file;
use alhazen::integrators::Control;
use alhazen::system_clock;
use alhazen::trace::{Drawing, PixelTrace, SampleTrace, Side, TraceError, TraceStep, to_ply};
use serde_json::{Value, json};

use crate::args::TracePixel;
use crate::console::say;
use crate::drive::Prepared;
use crate::failure::{Failure, about_file};
use crate::interrupt::{self, Interrupt};
use crate::output;
use crate::threads::start_threads;

/// Traces the samples of a pixel, draws them and tells about them.
pub fn trace(arguments: &TracePixel) -> Result<ExitCode, Failure> {
    for path in &arguments.output {
        format(path)?;
        output::check_place(path).map_err(Failure::Usage)?;
    }
    start_threads(arguments.changes.threads)?;
    let interrupt = Interrupt::listen(arguments.json)?;
    let overrides = Overrides { integrator: arguments.integrator.clone(), ..arguments.changes.overrides() };
    let (mut job, compiled) = Prepared::new(&arguments.scene, &Files, overrides)?.compile()?;
    let control = Control::new(interrupt.cancel(), system_clock());
    let (pixel, samples) = ([arguments.x, arguments.y], arguments.first..arguments.first + arguments.samples);
    let trace = match PixelTrace::new(&mut job, pixel, samples, &control) {
        Ok(trace) => trace,
        Err(TraceError::Cancelled) => return Ok(interrupt::EXIT_CODE.into()),
        Err(TraceError::NoPixel) => {
            let ([x, y], [width, height]) = (pixel, job.session.state().film.full_resolution());
            let message = format!("the picture has no pixel {x}, {y}: it is {width} x {height}");
            return Err(Failure::Usage(message));
        }
        Err(TraceError::Algorithm) => {
            return Err(Failure::Usage(format!(
                "`{}` does not estimate pixels one by one; `path`, `vol-path` and `whitted` do",
                compiled.integrator()
            )));
        }
    };
    let side = Side::ALL.into_iter().find(|side| arguments.from.as_deref() == Some(side.name()));
    for path in &arguments.output {
        let text = match format(path)? {
            Format::Svg => Drawing::new(&trace, &job, side).to_svg(),
            Format::Ply => to_ply(&trace),
        };
        replace_file(path, text.as_bytes()).map_err(|error| about_file(path, error))?;
    }
    if arguments.json {
        say(to_json(&trace))?;
    } else {
        say(trace.to_string().trim_end())?;
    }
    Ok(ExitCode::SUCCESS)
}

/// A format of drawings.
enum Format {
    Svg,
    Ply,
}

fn format(path: &Path) -> Result<Format, Failure> {
    let extension = path.extension().map(|extension| extension.to_ascii_lowercase());
    match extension.as_ref().and_then(|extension| extension.to_str()) {
        Some("svg") => Ok(Format::Svg),
        Some("ply") => Ok(Format::Ply),
        _ => {
            let path = path.display();
            Err(Failure::Usage(format!("{path} is neither a drawing (.svg) nor a file of edges (.ply)")))
        }
    }
}

fn to_json(trace: &PixelTrace) -> Value {
    let samples: Vec<_> = trace.samples.iter().map(sample_json).collect();
    json!({ "status": "done", "pixel": trace.pixel, "samples": samples })
}

fn sample_json(sample: &SampleTrace) -> Value {
    let steps: Vec<_> = sample.steps.iter().map(step_json).collect();
    json!({
        "index": sample.index,
        "wavelengths_nm": sample.wavelengths,
        "rgb": sample.rgb,
        "steps": steps,
    })
}

fn step_json(step: &TraceStep) -> Value {
    match step {
        TraceStep::Ray { way, vertex, from, d, hit } => json!({
            "step": "ray",
            "way": format!("{way:?}").to_lowercase(),
            "vertex": vertex,
            "from": from.to_array(),
            "direction": d.to_array(),
            "length": hit.as_ref().map(|(length, _)| length),
            "object": hit.as_ref().map(|(_, object)| object),
        }),
        TraceStep::Surface { p, material, lobes } => {
            json!({ "step": "surface", "p": p.to_array(), "material": material, "scattering": lobes })
        }
        TraceStep::Medium { p } => json!({ "step": "medium", "p": p.to_array() }),
        TraceStep::Shadow { from, d, length, is_clear } => json!({
            "step": "shadow",
            "from": from.to_array(),
            "direction": d.to_array(),
            "length": length.is_finite().then_some(length),
            "clear": is_clear,
        }),
        TraceStep::Light { name, events, rgb } => {
            json!({ "step": "light", "light": name, "scattered": events, "rgb": rgb })
        }
    }
}
