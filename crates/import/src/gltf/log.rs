//! What is said about one file: errors where they are, and each thing that is not honoured once.

use std::collections::HashMap;

use description::{Diagnostic, Span};

use super::json::Fault;
use crate::report::Report;

/// Collects messages about a file.
#[derive(Default)]
pub(super) struct Log {
    report: Report,
    /// Warnings by what they say: their first place, and their number.
    warnings: HashMap<(&'static str, String), usize>,
    order: Vec<(&'static str, String, String, usize)>,
}

impl Log {
    pub fn fault(&mut self, fault: Fault) {
        let message = match fault.pointer.as_str() {
            "" => fault.message,
            pointer => format!("{pointer}: {}", fault.message),
        };
        self.report.error(fault.code, message, Span::NONE);
    }

    /// The value, or its fault in the report.
    pub fn keep<T>(&mut self, result: Result<T, Fault>) -> Option<T> {
        result.map_err(|fault| self.fault(fault)).ok()
    }

    /// Says once that something of the file is not drawn as it is described.
    pub fn warn(&mut self, code: &'static str, pointer: impl Into<String>, message: impl Into<String>) {
        let message = message.into();
        let key = (code, message.clone());
        if let Some(&index) = self.warnings.get(&key) {
            self.order[index].3 += 1;
            return;
        }
        self.warnings.insert(key, self.order.len());
        self.order.push((code, pointer.into(), message, 1));
    }

    /// Whether so much is wrong that reading stops.
    pub fn is_full(&self) -> bool {
        self.report.is_full()
    }

    /// All messages.
    pub fn finish(mut self) -> Vec<Diagnostic> {
        for (code, pointer, message, count) in self.order {
            let place = if pointer.is_empty() { String::new() } else { format!("{pointer}: ") };
            let text = format!("{place}{message}");
            self.report.push(Diagnostic { count, ..Diagnostic::warning(code, text, Span::NONE) });
        }
        self.report.finish()
    }
}
