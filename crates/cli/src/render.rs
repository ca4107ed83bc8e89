//! `alhazen render`: from a scene file to pictures.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use alhazen::assets::Files;
use alhazen::description::SceneDesc;
use alhazen::integrators::Limits;
use alhazen::{Fingerprint, RenderOrder, Shard};

use crate::args::Render;
use crate::checkpoint::Checkpoint;
#[cfg(feature = "gpu")]
use crate::console::say;
use crate::drive::{Prepared, Task, Verbosity};
use crate::failure::{Failure, about_file};
use crate::interrupt::Interrupt;
use crate::live::Live;
use crate::output;
use crate::results::named_after;
use crate::threads::start_threads;

/// Renders a scene and reports the result.
pub fn render(arguments: &Render) -> Result<ExitCode, Failure> {
    for path in &arguments.output {
        output::check(path).map_err(Failure::Usage)?;
    }
    if let Some(path) = &arguments.checkpoint {
        if arguments.scene == Path::new("-") {
            let problem = "--checkpoint needs a scene file: standard input cannot be read again";
            return Err(Failure::Usage(problem.into()));
        }
        output::check_place(path).map_err(Failure::Usage)?;
    }
    start_threads(arguments.changes.threads)?;
    let interrupt = Interrupt::listen(arguments.json)?;
    let live =
        Live::start(&arguments.live, arguments.output.first().unwrap_or(&arguments.scene), &interrupt)?;

    let fingerprint = Fingerprint::new(&Files, &arguments.scene);
    let prepared = match &arguments.checkpoint {
        Some(_) => Prepared::new(&arguments.scene, &fingerprint, arguments.overrides())?,
        None => Prepared::new(&arguments.scene, &Files, arguments.overrides())?,
    };
    // The picture of one shard is rarely wanted.
    let outputs = if arguments.output.is_empty() && arguments.shard.is_none() {
        vec![default_output(&arguments.scene, &prepared.imported().desc)?]
    } else {
        arguments.output.clone()
    };
    let display = output::display(&arguments.display, &outputs).map_err(Failure::Usage)?;
    #[cfg_attr(not(feature = "gpu"), expect(unused_mut, reason = "only a job that moves changes"))]
    let (mut job, mut compiled) = prepared.compile()?;
    #[cfg_attr(not(feature = "gpu"), expect(unused_mut, reason = "only a device is noted"))]
    let mut notes = Vec::new();
    #[cfg(feature = "gpu")]
    {
        let mut warnings = Vec::new();
        match crate::device::choose(arguments.device, &mut job, &mut warnings) {
            Some(device) if !arguments.quiet && !arguments.json => say(device)?,
            None if !warnings.is_empty() => notes.push(("device", "CPU".to_owned())),
            _ => {}
        }
        compiled.add(warnings);
    }
    let limits = Limits { time: arguments.limits.time, noise: arguments.limits.noise };
    let (all, shard) = match arguments.shard {
        Some(shard) => (job.planned(), shard),
        None => (arguments.overrides().passes(job.planned(), limits.are_set()), Shard::WHOLE),
    };
    let passes = shard.passes(all);
    if passes.is_empty() {
        let Shard { index, count } = shard;
        return Err(Failure::Usage(format!(
            "shard {index}/{count} is empty: the render has only {all} passes"
        )));
    }
    let checkpoint = match &arguments.checkpoint {
        Some(path) => {
            let scene =
                std::path::absolute(&arguments.scene).map_err(|error| about_file(&arguments.scene, error))?;
            let order = RenderOrder {
                scene,
                scene_hash: fingerprint.hash(),
                overrides: arguments.overrides(),
                passes: all,
                shard,
                limits,
            };
            Some(Checkpoint::new(path.clone(), arguments.every, order, job.header().clone(), 0))
        }
        None => None,
    };
    let verbosity = Verbosity { quiet: arguments.quiet, json: arguments.json };
    let scene = &arguments.scene;
    let task = Task { scene, job, passes, limits, outputs, display, checkpoint, live, notes, verbosity };
    task.run(compiled, &interrupt)
}

/// The default path of the picture: that of the scene's film, else the scene's name with the
/// extension of OpenEXR, in the current folder.
fn default_output(scene: &Path, desc: &SceneDesc) -> Result<PathBuf, Failure> {
    let is_stated = desc.film.origin.states("filename");
    let path = if is_stated { PathBuf::from(&desc.film.filename) } else { named_after(scene, "exr") };
    output::check(&path).map_err(|problem| {
        Failure::Input(format!("{problem}\nThe scene names this output; `-o FILE` names another."))
    })?;
    Ok(path)
}
