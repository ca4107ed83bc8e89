//! `alhazen compare`: one scene rendered by several algorithms, and a report of their errors.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use alhazen::assets::Files;
use alhazen::image::{self, replace_file};
use alhazen::import::import;
use alhazen::integrators::{Control, PassError};
use alhazen::system_clock;
use compare::{Bias, Budget, Comparison, Laboratory, Plan, PlanError, ReferenceSource, Run};
use serde_json::Value;

use crate::args::Compare;
use crate::bar::Bar;
use crate::console::{say, warn};
use crate::diagnostics;
use crate::drive::scene_failure;
use crate::failure::{Failure, about_file};
use crate::interrupt::{self, Interrupt};
use crate::numbers::count;
use crate::output;
use crate::results::named_after;
use crate::threads::start_threads;

/// Renders a scene by several algorithms and writes the report.
pub fn compare(arguments: &Compare) -> Result<ExitCode, Failure> {
    let report = Report::new(arguments)?;
    start_threads(arguments.changes.threads)?;
    let reference = match &arguments.reference {
        Some(path) => {
            let picture = image::open(path).map_err(|error| about_file(path, error))?;
            ReferenceSource::Picture { name: path.display().to_string(), picture }
        }
        None => ReferenceSource::Render {
            by: arguments.reference_with.clone(),
            samples_per_pixel: arguments.reference_spp,
        },
    };
    let interrupt = Interrupt::listen(arguments.json)?;
    let talkative = !arguments.quiet && !arguments.json;

    let mut imported = import(&arguments.scene, &Files);
    if imported.has_errors() {
        return Err(scene_failure(imported));
    }
    let plan = Plan {
        title: arguments.scene.display().to_string(),
        contenders: arguments.integrators.clone(),
        budget: match (arguments.time, arguments.spp) {
            (Some(time), _) => Budget::Time(time),
            (None, spp) => Budget::Samples(spp.unwrap_or(1)),
        },
        reference,
        overrides: arguments.changes.overrides(),
        threads: rayon::current_num_threads(),
        #[cfg(feature = "gpu")]
        kernels: crate::device::kernels(arguments.device, &mut imported.diagnostics),
    };
    let laboratory = match Laboratory::new(&imported.desc, plan) {
        Ok((laboratory, warnings)) => {
            imported.diagnostics.extend(warnings);
            laboratory
        }
        Err(PlanError::Plan(message)) => return Err(Failure::Usage(message)),
        Err(PlanError::Reference(message)) => return Err(Failure::Input(message)),
        Err(PlanError::Scene(errors)) => {
            imported.diagnostics.extend(errors);
            return Err(scene_failure(imported));
        }
    };
    interrupt.begin_rendering(talkative);
    if talkative {
        diagnostics::print(&imported.diagnostics, &imported.sources)?;
    }

    let control = Control::new(interrupt.cancel(), system_clock());
    let mut current: Option<(String, Bar)> = None;
    let outcome = laboratory.compare(&control, &mut |name, progress| {
        if current.as_ref().is_none_or(|(before, _)| before != name) {
            let finished = current.replace((name.to_owned(), Bar::named(talkative, name)));
            finished.iter().for_each(|(_, bar)| bar.finish());
        }
        current.iter().for_each(|(_, bar)| bar.show(progress));
    });
    current.iter().for_each(|(_, bar)| bar.finish());
    let mut comparison = match outcome {
        Ok(comparison) => comparison,
        Err(PassError::OutOfMemory(problem) | PassError::Device(problem)) => {
            return Err(Failure::Input(problem));
        }
        Err(PassError::Cancelled) => {
            let message = "interrupted before anything could be compared; there is no report";
            if arguments.json {
                say(serde_json::json!({ "status": "interrupted" }))?;
            } else {
                warn(message)?;
            }
            return Ok(ExitCode::from(interrupt::EXIT_CODE));
        }
    };
    comparison.warnings =
        diagnostics::shown(&imported.diagnostics).into_iter().map(|warning| warning.message).collect();
    let mut json = comparison.to_json();
    json["warnings"] = diagnostics::to_json(&imported.diagnostics, &imported.sources).1;
    report.write(&comparison, &json)?;
    let interrupted = comparison.interrupted();
    if arguments.json {
        json["outputs"] =
            [&report.page, &report.numbers].map(|path| path.display().to_string()).as_slice().into();
        say(json)?;
    } else if talkative {
        say(summary(&comparison, &report))?;
    } else if interrupted {
        warn("interrupted; the report covers what was rendered")?;
    }
    Ok(if interrupted { ExitCode::from(interrupt::EXIT_CODE) } else { ExitCode::SUCCESS })
}

/// The files of the report.
struct Report {
    page: PathBuf,
    numbers: PathBuf,
}

impl Report {
    /// The files given by the command line, checked to be writable.
    fn new(arguments: &Compare) -> Result<Self, Failure> {
        let page = arguments.output.clone().unwrap_or_else(|| named_after(&arguments.scene, "html"));
        let is_page = page.extension().is_some_and(|extension| {
            ["html", "htm"].iter().any(|known| extension.eq_ignore_ascii_case(known))
        });
        if !is_page {
            let message = format!("the report {} is a page, so its extension is .html", page.display());
            return Err(Failure::Usage(message));
        }
        let numbers = page.with_extension("json");
        for path in [&page, &numbers] {
            output::check_place(path).map_err(Failure::Usage)?;
        }
        Ok(Self { page, numbers })
    }

    fn write(&self, comparison: &Comparison, json: &Value) -> Result<(), Failure> {
        let write = |path: &Path, text: String| {
            replace_file(path, text.as_bytes()).map_err(|error| about_file(path, error))
        };
        let numbers = format!("{json:#}\n");
        write(&self.numbers, numbers)?;
        write(&self.page, comparison.to_html().map_err(|error| about_file(&self.page, error))?)
    }
}

/// The figures as a short table.
fn summary(comparison: &Comparison, report: &Report) -> String {
    let setup = &comparison.setup;
    let [x0, x1, y0, y1] = setup.pixel_bounds;
    let mut lines = Vec::new();
    if comparison.interrupted() {
        lines.push("interrupted; the report covers what was rendered".into());
    }
    lines.push(format!(
        "{}: {} × {} pixels, {} for each picture",
        setup.title,
        x1 - x0,
        y1 - y0,
        setup.budget
    ));
    let noise = comparison
        .reference
        .noise
        .map_or("its noise is unknown".into(), |noise| format!("its own relMSE {:.2e}", noise.relative));
    lines.push(format!("reference: {}, {noise}", comparison.reference.source));
    let heads = ["", "passes", "seconds", "relMSE", "noise", "bias", "mean error", "efficiency", "rays/s"];
    let mut rows = vec![heads.map(str::to_owned)];
    rows.extend(comparison.runs.iter().map(|run| row(comparison, run)));
    lines.extend(aligned(&rows));
    lines.extend(comparison.doubt());
    for path in [&report.page, &report.numbers] {
        lines.push(format!("  report   {}", path.display()));
    }
    lines.join("\n")
}

fn row(comparison: &Comparison, run: &Run) -> [String; 9] {
    let last = run.last();
    let parts = last.measure.relative;
    let percent = |share: f64| format!("{:.2} %", 100.0 * share);
    [
        run.name.clone(),
        last.passes.to_string(),
        format!("{:.2}", last.seconds),
        format!("{:.2e}", parts.error),
        percent(parts.variance.sqrt()),
        match parts.bias() {
            Bias::Significant(bias) => percent(bias),
            Bias::Below(_) => "not significant".into(),
            Bias::Hidden => "hidden by noise".into(),
        },
        comparison.relative_mean_error(run).map_or("–".into(), |[error, deviation]| {
            format!("{} ± {}", percent(error), percent(deviation))
        }),
        if run.efficiency() < 1.0 { format!("{:.2e}", run.efficiency()) } else { count(run.efficiency()) },
        count(run.rays_per_second()),
    ]
}

/// Rows with columns as wide as their contents: the first aligned left, numbers right.
fn aligned<const N: usize>(rows: &[[String; N]]) -> Vec<String> {
    let widths: [usize; N] =
        std::array::from_fn(|column| rows.iter().map(|row| row[column].chars().count()).max().unwrap_or(0));
    let line = |row: &[String; N]| {
        let cells = row.iter().zip(widths).enumerate().map(|(column, (cell, width))| match column {
            0 => format!("  {cell:<width$}"),
            _ => format!("  {cell:>width$}"),
        });
        cells.collect::<String>()
    };
    rows.iter().map(line).collect()
}
