//! `alhazen scene`: scene files looked at.

use std::path::Path;

use alhazen::Job;
use alhazen::import::{Files, import};
use serde_json::json;

use crate::args::Check;
use crate::console::say;
use crate::diagnostics;
use crate::failure::Failure;

/// Tells everything that is wrong with a scene, or drawn otherwise than it says. What is wrong
/// makes a failure.
pub fn check(arguments: &Check) -> Result<(), Failure> {
    let mut imported = import(&arguments.scene, &Files);
    // What was understood of a wrong scene is compiled all the same: its author wants to hear of
    // everything at once.
    let (said, wrong) = match Job::compile(&imported.desc) {
        Ok(compiled) => (compiled.warnings, false),
        Err(said) => (said, true),
    };
    let wrong = wrong || imported.has_errors();
    imported.diagnostics.extend(said);
    let (diagnostics, sources) = (imported.diagnostics, imported.sources);
    if wrong {
        return Err(Failure::Scene { diagnostics, sources });
    }
    if arguments.json {
        let (_, warnings) = diagnostics::to_json(&diagnostics, &sources);
        say(json!({ "status": "done", "errors": [], "warnings": warnings }));
        return Ok(());
    }
    diagnostics::print(&diagnostics, &sources);
    let name = if arguments.scene == Path::new("-") {
        "the scene".into()
    } else {
        arguments.scene.display().to_string()
    };
    say(if diagnostics.is_empty() {
        format!("{name} is right")
    } else {
        format!("{name} can be rendered, but not all of it as it says")
    });
    Ok(())
}
