//! Why a command failed, and how that is reported: text on standard error, or one JSON object on
//! standard output; and the exit code.

use std::process::ExitCode;

use alhazen::description::{Diagnostic, SourceMap};
use serde_json::{Value, json};
use view::StepError;

use crate::console::{Undelivered, say, warn};
use crate::diagnostics;

/// Why a command ended without its result.
#[derive(Debug)]
pub enum Failure {
    /// The command line is invalid.
    Usage(String),
    /// A file is missing, invalid or cannot be written.
    Input(String),
    /// A scene has errors.
    Scene {
        /// All diagnostics of the scene.
        diagnostics: Vec<Diagnostic>,
        /// The files that they are about.
        sources: SourceMap,
    },
    /// The result, or a message, could not be written.
    Output(Undelivered),
}

impl From<Undelivered> for Failure {
    fn from(undelivered: Undelivered) -> Self {
        Self::Output(undelivered)
    }
}

impl From<StepError> for Failure {
    fn from(error: StepError) -> Self {
        match error {
            StepError::Problem(problem) => Self::Input(problem),
            StepError::Cancelled => Self::Input("cancelled".into()),
        }
    }
}

impl Failure {
    /// Reports the failure; gives the exit code of the program.
    pub fn report(&self, as_json: bool) -> ExitCode {
        let reported = match self {
            // Standard output may be what failed.
            Self::Output(undelivered) => warn(format_args!("error: {undelivered}")),
            _ if as_json => say(self.to_json()),
            Self::Usage(message) | Self::Input(message) => warn(format_args!("error: {message}")),
            Self::Scene { diagnostics, sources } => diagnostics::print(diagnostics, sources),
        };
        if let Err(undelivered) = reported {
            // There is no other place to report to; the exit code indicates the failure.
            let _ = warn(format_args!("error: {undelivered}"));
        }
        ExitCode::from(self.exit_code())
    }

    fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Input(_) | Self::Scene { .. } | Self::Output(_) => 1,
        }
    }

    fn to_json(&self) -> Value {
        let (errors, warnings) = match self {
            Self::Usage(message) | Self::Input(message) => (json!([{ "message": message }]), json!([])),
            Self::Output(undelivered) => (json!([{ "message": undelivered.to_string() }]), json!([])),
            Self::Scene { diagnostics, sources } => diagnostics::to_json(diagnostics, sources),
        };
        let status = if self.exit_code() == 2 { "usage" } else { "error" };
        json!({ "status": status, "errors": errors, "warnings": warnings })
    }
}

/// A failure about a file: its name, then what is wrong.
pub fn about_file(path: &std::path::Path, problem: impl std::fmt::Display) -> Failure {
    Failure::Input(format!("{}: {problem}", path.display()))
}
