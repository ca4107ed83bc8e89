//! Errors and warnings about a scene: one type for all stages.

use std::collections::HashMap;

use crate::Span;

/// How serious a diagnostic is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub enum Severity {
    /// The scene can be rendered, but perhaps not as its author expects.
    Warning,
    /// The scene cannot be rendered.
    Error,
}

/// One error or warning about a scene.
#[derive(Clone, Debug, PartialEq)]
pub struct Diagnostic {
    /// How serious it is.
    pub severity: Severity,
    /// A short constant name of this kind of message, such as `unknown-parameter`.
    pub code: &'static str,
    /// What is wrong, in one sentence without a full stop.
    pub message: String,
    /// The spans that it is about with a text for each, which may be empty; the first is the
    /// primary one.
    pub labels: Vec<(Span, String)>,
    /// Advice on how to resolve it.
    pub help: Option<String>,
    /// The number of occurrences; the labels show the first.
    pub count: usize,
}

impl Diagnostic {
    /// An error at a span. Long quotes from the scene are shortened.
    pub fn error(code: &'static str, message: impl Into<String>, span: Span) -> Self {
        Self {
            severity: Severity::Error,
            code,
            message: shortened(message.into()),
            labels: vec![(span, String::new())],
            help: None,
            count: 1,
        }
    }

    /// A warning at a span. Long quotes from the scene are shortened.
    pub fn warning(code: &'static str, message: impl Into<String>, span: Span) -> Self {
        Self { severity: Severity::Warning, ..Self::error(code, message, span) }
    }

    /// Adds advice on how to resolve it.
    pub fn with_help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(shortened(help.into()));
        self
    }

    /// Adds a further span.
    pub fn with_label(mut self, span: Span, text: impl Into<String>) -> Self {
        self.labels.push((span, text.into()));
        self
    }

    /// Whether this is an error.
    pub fn is_error(&self) -> bool {
        self.severity == Severity::Error
    }

    /// The primary span.
    pub fn span(&self) -> Span {
        self.labels.first().map_or(Span::NONE, |&(span, _)| span)
    }
}

/// Diagnostics to be displayed: warnings with the same message are combined to one with a count,
/// and at most [`DiagnosticList::LIMIT`] of each severity are stored.
#[derive(Clone, Debug, Default)]
pub struct DiagnosticList {
    kept: Vec<Diagnostic>,
    /// Indices of stored warnings, by code and message.
    warnings: HashMap<(&'static str, String), usize>,
    errors: usize,
    errors_left_out: usize,
    warnings_left_out: usize,
}

impl DiagnosticList {
    /// Maximum number of stored errors, and of different warnings.
    pub const LIMIT: usize = 100;

    /// Adds a diagnostic, in constant time.
    pub fn push(&mut self, diagnostic: Diagnostic) {
        if diagnostic.is_error() {
            if self.errors < Self::LIMIT {
                self.errors += 1;
                self.kept.push(diagnostic);
            } else {
                self.errors_left_out += diagnostic.count;
            }
            return;
        }
        let key = (diagnostic.code, diagnostic.message.clone());
        if let Some(&index) = self.warnings.get(&key) {
            let same = &mut self.kept[index];
            let count = same.count + diagnostic.count;
            if position(&diagnostic) < position(same) {
                *same = diagnostic;
            }
            same.count = count;
        } else if self.warnings.len() < Self::LIMIT {
            self.warnings.insert(key, self.kept.len());
            self.kept.push(diagnostic);
        } else {
            self.warnings_left_out += diagnostic.count;
        }
    }

    /// Adds an error.
    pub fn error(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.push(Diagnostic::error(code, message, span));
    }

    /// Adds a warning.
    pub fn warning(&mut self, code: &'static str, message: impl Into<String>, span: Span) {
        self.push(Diagnostic::warning(code, message, span));
    }

    /// Whether errors were left out.
    pub fn has_too_many_errors(&self) -> bool {
        self.errors_left_out > 0
    }

    /// The diagnostics in the order of the source text; at the end the numbers of those left out.
    pub fn finish(mut self) -> Vec<Diagnostic> {
        self.kept.sort_by_key(position);
        let left_out = [
            (Severity::Warning, "more-warnings", "warnings", self.warnings_left_out),
            (Severity::Error, "more-errors", "errors", self.errors_left_out),
        ];
        for (severity, code, noun, count) in left_out {
            if count > 0 {
                let message = format!("only the first {} {noun} are shown", Self::LIMIT);
                let labels = Vec::new();
                self.kept.push(Diagnostic { severity, code, message, labels, help: None, count });
            }
        }
        self.kept
    }
}

impl Extend<Diagnostic> for DiagnosticList {
    fn extend<I: IntoIterator<Item = Diagnostic>>(&mut self, diagnostics: I) {
        diagnostics.into_iter().for_each(|diagnostic| self.push(diagnostic));
    }
}

fn position(diagnostic: &Diagnostic) -> (crate::FileId, u32) {
    let span = diagnostic.span();
    (span.file, span.start)
}

/// Shortens the parts in backticks of a message, and then the message. Names and values of scenes
/// may have any length.
fn shortened(message: String) -> String {
    const LONGEST: usize = 1000;
    const LONGEST_QUOTE: usize = 200;
    if message.len() <= LONGEST_QUOTE {
        return message;
    }
    let parts = message.split('`').enumerate();
    let parts =
        parts.map(|(index, part)| if index % 2 == 1 { cut(part, LONGEST_QUOTE) } else { part.into() });
    cut(&parts.collect::<Vec<_>>().join("`"), LONGEST)
}

/// Cuts a text to `longest` characters, with an ellipsis if it is cut.
fn cut(text: &str, longest: usize) -> String {
    match text.char_indices().nth(longest) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text.to_owned(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::FileId;

    fn at(start: u32) -> Span {
        Span::new(FileId(0), start, start + 1)
    }

    #[test]
    fn warnings_of_the_same_message_are_combined() {
        let mut list = DiagnosticList::default();
        for start in (0..40_000).rev() {
            list.push(Diagnostic::warning("not-drawn", "hair", at(2 * start)));
            list.push(Diagnostic::warning("not-drawn", "clouds", at(2 * start + 1)));
        }
        list.extend([Diagnostic::error("a", "wrong", at(7)), Diagnostic::error("a", "wrong", at(9))]);
        let shown = list.finish();
        let shown: Vec<_> = shown.iter().map(|d| (d.message.as_str(), d.count, d.span().start)).collect();
        assert_eq!(shown, [("hair", 40_000, 0), ("clouds", 40_000, 1), ("wrong", 1, 7), ("wrong", 1, 9)]);
    }

    #[test]
    fn the_number_of_omitted_diagnostics_is_reported() {
        let mut list = DiagnosticList::default();
        for i in 0..250 {
            list.push(Diagnostic::warning("w", format!("warning {i}"), at(i)));
            list.push(Diagnostic::error("e", "error", at(i)));
        }
        assert!(list.has_too_many_errors());
        let shown = list.finish();
        assert_eq!(shown.len(), 202);
        let last: Vec<_> = shown[200..].iter().map(|d| (d.code, d.count, d.is_error())).collect();
        assert_eq!(last, [("more-warnings", 150, false), ("more-errors", 150, true)]);
    }

    #[test]
    fn long_quotes_in_messages_are_shortened() {
        let long = "ä".repeat(10_000_000);
        for message in [format!("there is no material `{long}` here"), long.clone(), "`".repeat(100_000)] {
            let diagnostic = Diagnostic::error("e", message, Span::NONE).with_help(format!("`{long}`"));
            assert!(diagnostic.message.len() < 4000 && diagnostic.help.is_some_and(|help| help.len() < 4000));
        }
        let message = Diagnostic::error("e", format!("no `{long}` here"), Span::NONE).message;
        assert!(message.starts_with("no `ää") && message.ends_with("ä…` here"), "{message}");
    }
}
