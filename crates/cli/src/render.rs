//! `alhazen render`: from a scene file to pictures.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::time::Instant;

use alhazen::description::{Diagnostic, SceneDesc};
use alhazen::import::{Files, Imported, import};
use alhazen::integrators::Control;
use alhazen::{Job, image::Image, integrator_name, write_picture};

use crate::args::Render;
use crate::bar::Bar;
use crate::console::{say, warn};
use crate::diagnostics;
use crate::failure::{Failure, about_file};
use crate::interrupt::{self, Interrupt};
use crate::output;
use crate::summary::{Seconds, Summary};

/// Renders a scene and tells what came of it.
pub fn render(arguments: &Render) -> Result<ExitCode, Failure> {
    for path in &arguments.output {
        output::check(path).map_err(Failure::Usage)?;
    }
    let threads = start_threads(arguments.threads)?;
    let interrupt = Interrupt::listen()?;
    let begin = Instant::now();

    let mut imported = import(&arguments.scene, &Files);
    if imported.has_errors() {
        return Err(scene_failure(imported));
    }
    arguments.overrides().apply(&mut imported.desc).map_err(|error| Failure::Usage(error.to_string()))?;
    let outputs = outputs(arguments, &imported.desc)?;
    let imported_at = Instant::now();

    let compiled = Job::compile(&imported.desc);
    let mut job = match compiled {
        Ok(compiled) => {
            imported.diagnostics.extend(compiled.warnings);
            compiled.job
        }
        Err(errors) => {
            imported.diagnostics.extend(errors);
            return Err(scene_failure(imported));
        }
    };
    if !arguments.quiet && !arguments.json {
        diagnostics::print(&imported.diagnostics, &imported.sources);
    }
    let compiled_at = Instant::now();

    let shown = !arguments.quiet && !arguments.json;
    let bar = Bar::new(shown, &job);
    interrupt.begin_rendering();
    let control = Control { cancel: interrupt.cancel(), progress: Some(&|progress| bar.show(progress)) };
    let outcome = job.render(&control);
    bar.clear();
    let rendered_at = Instant::now();

    let picture = job.picture();
    for path in &outputs {
        write_picture(&picture, path).map_err(|error| about_file(path, error))?;
    }
    let summary = Summary {
        scene: &arguments.scene,
        outputs: &outputs,
        integrator: integrator_name(&imported.desc.integrator),
        seconds: Seconds {
            import: (imported_at - begin).as_secs_f64(),
            compile: (compiled_at - imported_at).as_secs_f64(),
            render: (rendered_at - compiled_at).as_secs_f64(),
            write: rendered_at.elapsed().as_secs_f64(),
        },
    };
    Ok(ExitCode::SUCCESS)
}
