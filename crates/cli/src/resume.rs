//! `alhazen resume`: resumes a render that was saved.

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use alhazen::assets::Files;
use alhazen::integrators::Limits;
use alhazen::{Fingerprint, Shard};

use crate::args::Resume;
use crate::checkpoint::{self, Checkpoint};
use crate::drive::{Prepared, Task, Verbosity};
use crate::failure::{Failure, about_file};
use crate::interrupt::Interrupt;
use crate::live::Live;
use crate::output;
use crate::results::named_after;
use crate::threads::start_threads;

/// Resumes a render, saves it and writes the picture.
pub fn resume(arguments: &Resume) -> Result<ExitCode, Failure> {
    let outputs = outputs(&arguments.output, &arguments.film)?;
    let display = output::display(&arguments.display, &outputs).map_err(Failure::Usage)?;
    output::check_place(&arguments.film).map_err(Failure::Usage)?;
    start_threads(arguments.threads)?;
    let interrupt = Interrupt::listen(arguments.json)?;
    let live = Live::start(&arguments.live, &outputs[0], &interrupt)?;
    let film = &arguments.film;
    let saved = checkpoint::read(film)?;
    let mut order = saved.order();
    let scene = order.scene.clone();

    let fingerprint = Fingerprint::new(&Files, &scene);
    let prepared = Prepared::new(&scene, &fingerprint, order.overrides.clone())?;
    if fingerprint.hash() != order.scene_hash {
        let scene = scene.display();
        return Err(about_file(
            film,
            format!("files of the scene {scene} have changed since it was rendered"),
        ));
    }
    let (mut job, compiled) = prepared.compile()?;
    let limits = Limits { time: arguments.limits.time, noise: arguments.limits.noise };
    if arguments.spp.is_some() || limits.are_set() {
        order.limits = limits;
    }
    let mut notes = Vec::new();
    if let Some(passes) = arguments.spp {
        if order.shard != Shard::WHOLE && passes != order.passes {
            let Shard { index, count } = order.shard;
            let message =
                format!("--spp cannot change: the film is shard {index}/{count} of {} passes", order.passes);
            return Err(Failure::Usage(message));
        }
        order.passes = passes;
    }
    let (state, films) = saved.into_state();
    let done = state.done.count();
    job.resume(state, films).map_err(|error| about_file(film, error))?;
    if order.passes != u32::MAX && job.is_arranged_otherwise(order.passes) {
        notes.push((
            "samples",
            format!(
                "arranged for {} per pixel; they are as valid as those of a render planned for {}, but others",
                job.planned(),
                order.passes
            ),
        ));
    }
    let passes = order.shard.passes(order.passes);
    if passes.clone().all(|pass| job.session.state().done.contains(pass)) {
        notes.push(("passes", format!("all {} are done already: the film has {done}", passes.len())));
    }
    let limits = order.limits;
    let checkpoint = Checkpoint::new(film.clone(), arguments.every, order, job.header().clone(), done);
    let verbosity = Verbosity { quiet: arguments.quiet, json: arguments.json };
    let checkpoint = Some(checkpoint);
    let scene = &scene;
    let task = Task { scene, job, passes, limits, outputs, display, checkpoint, live, notes, verbosity };
    task.run(compiled, &interrupt)
}

/// The paths of the picture of film files: the outputs, or the film's name with the extension of
/// OpenEXR in the current folder.
pub fn outputs(outputs: &[PathBuf], film: &Path) -> Result<Vec<PathBuf>, Failure> {
    let outputs = if outputs.is_empty() { vec![named_after(film, "exr")] } else { outputs.to_vec() };
    outputs.iter().try_for_each(|path| output::check(path)).map_err(Failure::Usage)?;
    Ok(outputs)
}
