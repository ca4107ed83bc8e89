//! `alhazen scene`: scene files checked.

use std::path::Path;

use alhazen::Job;
use alhazen::description::Diagnostic;
use alhazen::import::{Files, import};
use serde_json::json;

use crate::args::Check;
use crate::console::say;
use crate::diagnostics;
use crate::failure::Failure;

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
    Ok(say(if diagnostics.is_empty() {
        format!("{name} is valid")
    } else {
        format!("{name} can be rendered, with the differences above")
    })?)
}
