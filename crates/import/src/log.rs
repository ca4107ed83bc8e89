//! What is said about one file: errors where they are, and each thing that is not honoured once.

use std::collections::HashMap;

use description::{Diagnostic, Span};

use description::DiagnosticList;

/// What is wrong with a file, and where.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fault {
    /// The kind of message.
    pub code: &'static str,
    /// The place in the file: a JSON pointer, the path of a prim; empty for the file as a whole.
    pub place: String,
    /// What is wrong.
    pub message: String,
}

impl Fault {
    pub fn new(code: &'static str, place: impl Into<String>, message: impl Into<String>) -> Self {
        Self { code, place: place.into(), message: message.into() }
    }
}

pub(crate) type Result<T> = std::result::Result<T, Fault>;

/// Collects messages about a file.
#[derive(Default)]
pub(crate) struct Log {
    report: DiagnosticList,
    /// Warnings by what they say: their first place, and their number.
    warnings: HashMap<(&'static str, String), usize>,
    order: Vec<(&'static str, String, String, usize)>,
}

impl Log {
    pub fn fault(&mut self, fault: Fault) {
        let message = match fault.place.as_str() {
            "" => fault.message,
            place => format!("{place}: {}", fault.message),
        };
        self.report.error(fault.code, message, Span::NONE);
    }

    /// The value, or its fault in the report.
    pub fn keep<T>(&mut self, result: Result<T>) -> Option<T> {
        result.map_err(|fault| self.fault(fault)).ok()
    }

    /// Says once that something of the file is not drawn as it is described.
    pub fn warn(&mut self, code: &'static str, place: impl Into<String>, message: impl Into<String>) {
        let message = message.into();
        let key = (code, message.clone());
        if let Some(&index) = self.warnings.get(&key) {
            self.order[index].3 += 1;
            return;
        }
        self.warnings.insert(key, self.order.len());
        self.order.push((code, place.into(), message, 1));
    }

    /// Whether so much is wrong that reading stops.
    pub fn is_full(&self) -> bool {
        self.report.has_too_many_errors()
    }

    /// All messages.
    pub fn finish(mut self) -> Vec<Diagnostic> {
        for (code, place, message, count) in self.order {
            let place = if place.is_empty() { String::new() } else { format!("{place}: ") };
            let text = format!("{place}{message}");
            self.report.push(Diagnostic { count, ..Diagnostic::warning(code, text, Span::NONE) });
        }
        self.report.finish()
    }
}
