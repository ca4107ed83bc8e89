//! The diagnostics of one import.

use description::{Diagnostic, DiagnosticList, Span};

/// Collects diagnostics up to a limit, so that a file of random bytes does not fill memory.
#[derive(Clone, Debug, Default)]
pub(crate) struct Report(DiagnosticList);

impl Report {
    pub(crate) fn push(&mut self, diagnostic: Diagnostic) {
        self.0.push(diagnostic);
    }

    /// Whether the limit of errors is reached, so that reading stops.
    pub(crate) fn is_full(&self) -> bool {
        self.0.has_too_many_errors()
    }

    pub(crate) fn error(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.push(Diagnostic::error(code, message, span));
    }

    pub(crate) fn warning(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.push(Diagnostic::warning(code, message, span));
    }

    /// All diagnostics in the order of the text.
    pub(crate) fn finish(self) -> Vec<Diagnostic> {
        self.0.finish()
    }
}
