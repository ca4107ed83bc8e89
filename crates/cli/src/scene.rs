//! `alhazen scene`: scene files checked and converted.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use alhazen::Job;
use alhazen::assets::Files;
use alhazen::description::{Diagnostic, SceneDesc};
use alhazen::image::replace_file;
use alhazen::import::import;
use alhazen::pbrt::{ExportError, export};
use serde_json::json;

use crate::args::{Check, ConvertScene};
use crate::console::say;
use crate::failure::{Failure, about_file};
use crate::{diagnostics, numbers, output};

/// Warnings of compiling that a picture may be black.
const BLACK: [&str; 3] = ["empty-scene", "no-light", "nothing-in-view"];

/// Reports all errors and warnings of a scene; errors make it a failure.
pub fn check(arguments: &Check) -> Result<(), Failure> {
    let mut imported = import(&arguments.scene, &Files);
    // A scene with errors is compiled too, as far as possible, to report all errors in one run.
    // Warnings about a part of a scene, such as that it is dark, may be wrong.
    let (mut found, mut wrong) = match Job::compile(std::mem::take(&mut imported.desc)) {
        Ok(compiled) => (compiled.warnings, false),
        Err(errors) => (errors, true),
    };
    if imported.has_errors() {
        found.retain(Diagnostic::is_error);
        wrong = true;
    }
    let may_be_black = found.iter().any(|found| BLACK.contains(&found.code));
    imported.diagnostics.extend(found);
    let (diagnostics, sources) = (imported.diagnostics, imported.sources);
    if wrong {
        return Err(Failure::Scene { diagnostics, sources });
    }
    if arguments.json {
        let (_, warnings) = diagnostics::to_json(&diagnostics, &sources);
        return Ok(say(json!({ "status": "done", "errors": [], "warnings": warnings }))?);
    }
    diagnostics::print(&diagnostics, &sources)?;
    let name = if arguments.scene == Path::new("-") {
        "the scene".into()
    } else {
        arguments.scene.display().to_string()
    };
    Ok(say(match (diagnostics.is_empty(), may_be_black) {
        (true, _) => format!("{name} is valid"),
        (false, false) => format!("{name} can be rendered, with the differences above"),
        (false, true) => format!("{name} is valid, but its picture may show nothing: see above"),
    })?)
}

/// Writes a scene as pbrt-v4, and the files that it names.
pub fn convert(arguments: &ConvertScene) -> Result<(), Failure> {
    let target = &arguments.output;
    let folder = check_target(&arguments.scene, target).map_err(Failure::Usage)?;
    let imported = import(&arguments.scene, &Files);
    let (diagnostics, sources) = (imported.diagnostics, imported.sources);
    if diagnostics.iter().any(Diagnostic::is_error) {
        return Err(Failure::Scene { diagnostics, sources });
    }
    let (mut written, mut size) = (Vec::new(), 0);
    let mut sink = |name: &str, bytes: &[u8]| {
        if written.is_empty() && !folder.is_dir() {
            fs::create_dir(&folder)?;
        }
        let path = folder.join(name);
        replace_file(&path, bytes)?;
        size += bytes.len() as u64;
        written.push(path.display().to_string());
        Ok(())
    };
    let name = folder.file_name().unwrap_or_default().to_string_lossy().into_owned();
    let exported = export(&imported.desc, &name, &mut sink).map_err(|error| match error {
        ExportError::File(name, error) => about_file(&folder.join(name), error),
        error => Failure::Input(error.to_string()),
    })?;
    replace_file(target, exported.text.as_bytes()).map_err(|error| about_file(target, error))?;

    if arguments.json {
        let (_, warnings) = diagnostics::to_json(&diagnostics, &sources);
        return Ok(say(json!({
            "status": "done",
            "output": target.display().to_string(),
            "files": written,
            "extensions": exported.extensions,
            "errors": [],
            "warnings": warnings,
        }))?);
    }
    diagnostics::print(&diagnostics, &sources)?;
    let mut report = format!("{}: {}", target.display(), contents(&imported.desc));
    if !written.is_empty() {
        let size = numbers::bytes(size);
        report += &format!("; {}, {size}, in {}", counted(written.len(), "file"), folder.display());
    }
    say(report)?;
    if !exported.extensions.is_empty() {
        let list = exported.extensions.join(", ");
        say(format!("pbrt-v4 itself does not know what alhazen does: {list}"))?;
    }
    Ok(())
}

/// Checks that a scene can be written to `target`; returns the folder for its files.
fn check_target(scene: &Path, target: &Path) -> Result<PathBuf, String> {
    let shown = target.display();
    if !target.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("pbrt")) {
        return Err(format!("scenes are written as pbrt-v4: the name {shown} needs the extension .pbrt"));
    }
    output::check_place(target)?;
    if let (Ok(scene), Ok(target)) = (fs::canonicalize(scene), fs::canonicalize(target))
        && scene == target
    {
        return Err(format!("cannot write {shown}: it is the scene that is converted"));
    }
    let folder = target.with_extension("assets");
    if folder.exists() && !folder.is_dir() {
        return Err(format!("cannot write to {}: it is not a folder", folder.display()));
    }
    match folder.file_name().and_then(OsStr::to_str) {
        Some(_) => Ok(folder),
        None => Err(format!("cannot write {shown}: its name is not UTF-8, as a scene's text is")),
    }
}

/// What a scene has.
fn contents(desc: &SceneDesc) -> String {
    let in_objects = desc.objects.iter().map(|(_, object)| (object.shapes.len(), object.instances.len()));
    let [shapes, instances] = in_objects
        .fold([desc.shapes.len(), desc.instances.len()], |[shapes, instances], (more, nested)| {
            [shapes + more, instances + nested]
        });
    let counts = [
        (shapes, "shape"),
        (desc.objects.len(), "object"),
        (instances, "instance"),
        (desc.materials.len(), "material"),
        (desc.float_textures.len() + desc.spectrum_textures.len(), "texture"),
        (desc.lights.len(), "light"),
    ];
    let counts = counts.into_iter().filter(|&(count, noun)| count > 0 || noun == "shape");
    counts.map(|(count, noun)| counted(count, noun)).collect::<Vec<_>>().join(", ")
}

fn counted(count: usize, noun: &str) -> String {
    format!("{count} {noun}{}", if count == 1 { "" } else { "s" })
}
