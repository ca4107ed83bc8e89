//! `alhazen render`: from a scene file to pictures.

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use alhazen::description::schema::Settings;
use alhazen::description::{IntegratorDesc, RadiosityDesc, SceneDesc};
use alhazen::image::{Image, replace_file};
use alhazen::import::{Files, Imported, import};
use alhazen::integrators::{ByProduct, Control, FilmSink, Progress};
use alhazen::{Header, Job, write_picture};

use crate::args::Render;
use crate::bar::Bar;
use crate::console::{say, warn};
use crate::diagnostics;
use crate::failure::{Failure, about_file};
use crate::interrupt::{self, Interrupt};
use crate::output;
use crate::summary::{Seconds, Summary, peak_memory};
use crate::threads::start_threads;

/// Renders a scene and tells what came of it.
pub fn render(arguments: &Render) -> Result<ExitCode, Failure> {
    for path in &arguments.output {
        output::check(path).map_err(Failure::Usage)?;
    }
    start_threads(arguments.changes.threads)?;
    let interrupt = Interrupt::listen()?;
    let talkative = !arguments.quiet && !arguments.json;

    let begin = Instant::now();
    let mut imported = import(&arguments.scene, &Files);
    if imported.has_errors() {
        return Err(scene_failure(imported));
    }
    let overrides = arguments.overrides();
    overrides.apply(&mut imported.desc).map_err(|error| Failure::Usage(error.to_string()))?;
    let outputs = if arguments.output.is_empty() {
        vec![default_output(&arguments.scene, &imported.desc)?]
    } else {
        arguments.output.clone()
    };
    if let IntegratorDesc::Radiosity(RadiosityDesc { mesh_out: Some(file), .. }) =
        &imported.desc.integrator.value
    {
        output::check_place(Path::new(file)).map_err(Failure::Input)?;
    }
    let imported_at = Instant::now();
    let mut job = match Job::compile(&imported.desc) {
        Ok(compiled) => {
            imported.diagnostics.extend(compiled.warnings);
            compiled.job
        }
        Err(errors) => {
            if let Some(error) = overrides.blamed(&errors) {
                return Err(Failure::Usage(error.to_string()));
            }
            imported.diagnostics.extend(errors);
            return Err(scene_failure(imported));
        }
    };
    interrupt.begin_rendering();
    if talkative {
        diagnostics::print(&imported.diagnostics, &imported.sources)?;
    }
    let compiled_at = Instant::now();

    let bar = Arc::new(Bar::new(talkative, job.passes()));
    let sink = Arc::clone(&bar);
    let progress = Box::new(move |progress: &Progress| sink.show(progress));
    let cancel = interrupt.cancel();
    if let Some(sketch) = job.sketch(&cancel) {
        write_early(&sketch, &outputs);
    }
    let outcome = job.render(&Control {
        cancel,
        progress: Some(progress),
        preview: Some(preview(job.header().clone(), outputs.clone())),
        ..Control::default()
    });
    let last = bar.finish();
    let rendered_at = Instant::now();

    let picture = job.picture();
    // A picture that cannot be written does not keep the others from being written.
    let mut unwritten = None;
    for path in &outputs {
        unwritten =
            unwritten.or(write_picture(&picture, path).map_err(|error| about_file(path, error)).err());
    }
    let mut beside = Vec::new();
    for by_product in job.by_products() {
        let written = write_by_product(by_product, &outputs[0]);
        unwritten = unwritten.or(written.map(|path| beside.push(path)).err());
    }
    if let Some(failure) = unwritten {
        return Err(failure);
    }
    let summary = Summary {
        interrupted: outcome.is_err(),
        scene: &arguments.scene,
        outputs: &outputs,
        beside: &beside,
        notes: &job.summary(),
        integrator: imported.desc.integrator.name(),
        samples_per_pixel: job.samples_per_pixel(),
        film: job.film(),
        progress: last,
        threads: rayon::current_num_threads(),
        seconds: Seconds {
            import: (imported_at - begin).as_secs_f64(),
            compile: (compiled_at - imported_at).as_secs_f64(),
            render: (rendered_at - compiled_at).as_secs_f64(),
            write: rendered_at.elapsed().as_secs_f64(),
        },
        peak_memory: peak_memory(),
    };
    if arguments.json {
        let (_, warnings) = diagnostics::to_json(&imported.diagnostics, &imported.sources);
        say(summary.to_json(warnings))?;
    } else if talkative {
        say(&summary)?;
    } else if let Some(interruption) = summary.interruption() {
        warn(interruption)?;
    }
    Ok(if summary.interrupted { ExitCode::from(interrupt::EXIT_CODE) } else { ExitCode::SUCCESS })
}

/// Writes the picture as it stands, so that it can be looked at: after the first pass that ends
/// later than half a second after the begin, and then whenever it has been rendered for twice as
/// long as the last time. Whether it can be written is told at the end.
fn preview(header: Header, outputs: Vec<PathBuf>) -> FilmSink {
    let begin = Instant::now();
    let next = Mutex::new(Duration::from_millis(500));
    Box::new(move |film| {
        let mut next = next.lock().unwrap_or_else(PoisonError::into_inner);
        if begin.elapsed() < *next {
            return;
        }
        write_early(&header.picture(film), &outputs);
        *next = 2 * begin.elapsed();
    })
}

/// Writes a picture that a better one will replace. Whether it can be written is told at the end.
fn write_early(picture: &Image, outputs: &[PathBuf]) {
    for path in outputs {
        let _ = write_picture(picture, path);
    }
}

/// The failure that a wrong scene is.
pub fn scene_failure(imported: Imported) -> Failure {
    Failure::Scene { diagnostics: imported.diagnostics, sources: imported.sources }
}

/// Where the picture goes if the command line does not say: where the scene's film says, else to
/// the scene's name with the extension of OpenEXR, in the current folder.
fn default_output(scene: &Path, desc: &SceneDesc) -> Result<PathBuf, Failure> {
    let is_stated = desc.film.origin.states("filename");
    let path = if is_stated { PathBuf::from(&desc.film.filename) } else { named_after(scene, "exr") };
    output::check(&path).map_err(|problem| {
        Failure::Input(format!("{problem}\nThe scene names this output; `-o FILE` names another."))
    })?;
    Ok(path)
}

/// Writes what was made beside a picture, and tells where it is.
fn write_by_product(by_product: ByProduct, picture: &Path) -> Result<PathBuf, Failure> {
    match by_product {
        ByProduct::Picture(name, image) => {
            let path = named_beside(picture, &name);
            write_picture(&image, &path).map_err(|error| about_file(&path, error))?;
            Ok(path)
        }
        ByProduct::File(path, contents) => {
            replace_file(&path, &contents).map_err(|error| about_file(&path, error))?;
            Ok(path)
        }
    }
}

/// "out/room.exr" and "s1-t3" give "out/room-s1-t3.exr".
fn named_beside(picture: &Path, name: &str) -> PathBuf {
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    picture.with_file_name(format!("{}-{name}.{}", part(picture.file_stem()), part(picture.extension())))
}

/// "scenes/room.pbrt.gz" gives "room.exr".
pub fn named_after(scene: &Path, extension: &str) -> PathBuf {
    let name = scene.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.split('.').next().filter(|stem| !stem.is_empty() && *stem != "-").unwrap_or("picture");
    PathBuf::from(format!("{stem}.{extension}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn by_products_stand_beside_their_picture() {
        assert_eq!(named_beside(Path::new("out/a.b.exr"), "s1-t3"), Path::new("out/a.b-s1-t3.exr"));
    }

    #[test]
    fn pictures_are_named_after_their_scenes() {
        for (scene, picture) in [
            ("scenes/room.pbrt.gz", "room.exr"),
            ("room.pbrt", "room.exr"),
            ("-", "picture.exr"),
            (".hidden", "picture.exr"),
            ("..", "picture.exr"),
        ] {
            assert_eq!(named_after(Path::new(scene), "exr"), Path::new(picture));
        }
    }
}
