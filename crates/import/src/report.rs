//! The messages of one import.

use std::collections::HashSet;

use description::{Diagnostic, Severity, Span};

/// Collects messages up to a limit, so that a file of noise does not fill memory.
#[derive(Debug, Default)]
pub(crate) struct Report {
    diagnostics: Vec<Diagnostic>,
    is_full: bool,
    given_once: HashSet<String>,
}

impl Report {
    const LIMIT: usize = 500;

    pub(crate) fn push(&mut self, diagnostic: Diagnostic) {
        if self.diagnostics.len() < Self::LIMIT {
            self.diagnostics.push(diagnostic);
        } else {
            self.is_full = true;
        }
    }

    /// Whether no more messages are taken.
    pub(crate) fn is_full(&self) -> bool {
        self.is_full
    }

    pub(crate) fn error(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.push(Diagnostic::error(code, message, span));
    }

    pub(crate) fn warning(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.push(Diagnostic::warning(code, message, span));
    }

    /// A warning that is given for its first place only.
    pub(crate) fn warning_once(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        let message = message.into();
        if self.given_once.insert(message.clone()) {
            self.warning(code, message, span);
        }
    }

    /// All messages in the order of the text that they are about.
    pub(crate) fn finish(mut self) -> Vec<Diagnostic> {
        self.diagnostics.sort_by_key(|diagnostic| (diagnostic.span().file, diagnostic.span().start));
        if self.is_full {
            self.diagnostics.push(Diagnostic {
                severity: Severity::Error,
                code: "too-many",
                message: format!("only the first {} messages are shown", Self::LIMIT),
                labels: Vec::new(),
                help: None,
            });
        }
        self.diagnostics
    }
}
