//! `alhazen merge`: the picture of film files, such as all shards of a render.

use std::path::{Path, PathBuf};

use alhazen::film::{FilmFileError, PassSet};
use alhazen::{SavedRender, Shard};
use serde_json::json;

use crate::args::Merge;
use crate::checkpoint;
use crate::console::say;
use crate::failure::{Failure, about_file};
use crate::output;
use crate::results::write_results;
use crate::resume::outputs;

/// Merges film files and writes the picture.
pub fn merge(arguments: &Merge) -> Result<(), Failure> {
    let [first, others @ ..] = &arguments.films[..] else {
        return Err(Failure::Usage("there is no film file to merge".into()));
    };
    let outputs = outputs(&arguments.output, first)?;
    let display = output::display(&arguments.display, &outputs).map_err(Failure::Usage)?;
    let mut merged = checkpoint::read(first)?;
    for (path, before) in others.iter().zip(1..) {
        let (file, limits) = checkpoint::open(path)?;
        merged.merge(file, &limits).map_err(|error| match error {
            FilmFileError::Overlap(passes) => {
                let first = &arguments.films[..before];
                // The headers of the files before show which of them has the passes.
                let holder = first.iter().find(|path| holds(path, &passes)).unwrap_or(&first[0]);
                let mut shards = merged.shards();
                shards.extend(checkpoint::read(path).iter().flat_map(SavedRender::shards));
                let splits = splits(&arguments.films, &shards);
                about_file(path, format!("passes {passes} are in {} too{splits}", holder.display()))
            }
            FilmFileError::Mismatch(problem) => {
                about_file(path, format!("not of the same render as {}: {problem}", first.display()))
            }
            error => about_file(path, error),
        })?;
    }
    let missing = merged.missing();
    if !missing.is_empty() {
        let (missing, splits) = (list(&missing), splits(&arguments.films, &merged.shards()));
        return Err(Failure::Input(format!("the picture is incomplete: missing {missing}{splits}")));
    }
    let header = merged.header().clone();
    let (state, films) = merged.into_state();
    let films = films.iter().map(|(name, film)| (name.clone(), film));
    let beside = write_results(&header.development(&state), &outputs, &display, films, Vec::new())?;
    let passes = state.done.count();
    if arguments.json {
        let names = |paths: &[PathBuf]| paths.iter().map(|p| p.display().to_string()).collect::<Vec<_>>();
        let (films, outputs, beside) = (names(&arguments.films), names(&outputs), names(&beside));
        say(json!({
            "status": "done",
            "films": films,
            "outputs": outputs,
            "by_products": beside,
            "passes": passes,
            "noise": state.noise(),
        }))?;
    } else if !arguments.quiet {
        let plural = if arguments.films.len() == 1 { "" } else { "s" };
        say(format_args!("{passes} passes of {} film{plural}", arguments.films.len()))?;
        for output in outputs.iter().chain(&beside) {
            say(format_args!("  picture  {}", output.display()))?;
        }
    }
    Ok(())
}

/// Whether a film file holds some of these passes.
fn holds(path: &Path, passes: &PassSet) -> bool {
    checkpoint::header(path).is_ok_and(|header| !header.done.intersection(passes).is_empty())
}

/// The shard of each film, where they are not of the same split; else nothing.
fn splits(films: &[PathBuf], shards: &[Shard]) -> String {
    if shards.iter().all(|shard| shard.count == shards[0].count) {
        return String::new();
    }
    let shard = |(film, &Shard { index, count }): (&PathBuf, &Shard)| match count {
        1 => format!("{} is not split", film.display()),
        _ => format!("{} is shard {index}/{count}", film.display()),
    };
    let shards: Vec<_> = films.iter().zip(shards).map(shard).collect();
    format!("\nThe films are of different splits: {}", shards.join(", "))
}

/// "a, b and c".
fn list(names: &[String]) -> String {
    match names {
        [] => String::new(),
        [one] => one.clone(),
        [first @ .., last] => format!("{} and {last}", first.join(", ")),
    }
}
