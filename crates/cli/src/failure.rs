//! Why a command did not do what it was asked for, and how that is told: text on standard error, or
//! one JSON object on standard output; and the exit code.

use std::process::ExitCode;

use alhazen::description::{Diagnostic, SourceMap};
use serde_json::{Value, json};

use crate::console::{say, warn};
use crate::diagnostics;

/// Why a command ended without its result.
#[derive(Debug)]
pub enum Failure {
    /// The command line asks for what cannot be.
    Usage(String),
    /// A file is missing, wrong or cannot be written.
    Input(String),
    /// A scene is wrong.
    Scene {
        /// Everything there is to say about it.
        diagnostics: Vec<Diagnostic>,
        /// The texts that it is about.
        sources: SourceMap,
    },
}

impl Failure {
    /// Tells the failure.
    pub fn report(&self, as_json: bool) -> ExitCode {
        if as_json {
            say(self.to_json());
        } else {
            match self {
                Self::Usage(message) | Self::Input(message) => warn(format_args!("error: {message}")),
                Self::Scene { diagnostics, sources } => diagnostics::print(diagnostics, sources),
            }
        }
        ExitCode::from(self.exit_code())
    }

    fn exit_code(&self) -> u8 {
        match self {
            Self::Usage(_) => 2,
            Self::Input(_) | Self::Scene { .. } => 1,
        }
    }

    fn to_json(&self) -> Value {
        let (errors, warnings) = match self {
            Self::Usage(message) | Self::Input(message) => (json!([{ "message": message }]), json!([])),
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
