//! `alhazen scene pack`: a scene and all its files in one archive.

use std::fmt::Write;
use std::io::BufWriter;
use std::path::Path;

use alhazen::assets::Files;
use alhazen::image::replace_file_with;
use alhazen::import::is_archive;
use alhazen::{PackError, pack as write_archive};
use serde_json::json;

use crate::args::Pack;
use crate::console::say;
use crate::failure::{Failure, about_file};
use crate::output;
use crate::results::named_after;

/// Writes the archive, and reports what it holds.
pub fn pack(arguments: &Pack) -> Result<(), Failure> {
    if arguments.scene == Path::new("-") {
        return Err(Failure::Usage("a scene of standard input has no folder to pack".into()));
    }
    let path = arguments.output.clone().unwrap_or_else(|| named_after(&arguments.scene, "zip"));
    // Other commands know archives by this extension.
    if !is_archive(&path) {
        let problem = format!("the name {} of an archive needs the extension .zip", path.display());
        return Err(Failure::Usage(problem));
    }
    output::check_place(&path).map_err(Failure::Usage)?;
    // Messages about its content have names relative to its folder.
    std::fs::metadata(&arguments.scene).map_err(|error| about_file(&arguments.scene, error))?;
    let mut packed = None;
    let written = replace_file_with(&path, |file| {
        packed = Some(write_archive(&arguments.scene, &Files, BufWriter::new(file))?);
        Ok(())
    });
    written.map_err(|error| match error {
        PackError::Scene(imported) => {
            Failure::Scene { diagnostics: imported.diagnostics, sources: imported.sources }
        }
        PackError::File(file, error) => about_file(&file, error),
        PackError::Output(error) => about_file(&path, error),
    })?;
    let Some(packed) = packed else { return Ok(()) };
    let hash = packed.hash.iter().fold(String::new(), |mut text, byte| {
        // Texts cannot fail.
        let _ = write!(text, "{byte:02x}");
        text
    });
    if arguments.json {
        let files: Vec<_> = packed.files.iter().map(|file| file.display().to_string()).collect();
        return Ok(say(json!({
            "status": "done",
            "archive": path.display().to_string(),
            "files": files,
            "bytes": packed.bytes,
            "blake3": hash,
        }))?);
    }
    let (count, plural) = (packed.files.len(), if packed.files.len() == 1 { "" } else { "s" });
    Ok(say(format_args!(
        "{}: {count} file{plural}, {} bytes\n  blake3  {hash}",
        path.display(),
        packed.bytes
    ))?)
}
