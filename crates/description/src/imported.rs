//! The result of an import.

use crate::{Diagnostic, SceneDesc, SourceMap};

/// A scene that was read.
#[derive(Clone, Debug)]
pub struct Imported {
    /// The scene, as far as the files were valid.
    pub desc: SceneDesc,
    /// The texts that the spans of the scene and its messages refer to.
    pub sources: SourceMap,
    /// All errors and warnings, in the order of the text.
    pub diagnostics: Vec<Diagnostic>,
}

impl Imported {
    /// Whether there is any error.
    pub fn has_errors(&self) -> bool {
        self.diagnostics.iter().any(Diagnostic::is_error)
    }
}
