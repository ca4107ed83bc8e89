//! Diagnostics of scenes, as text with the source lines, and as JSON. Warnings of the same message
//! are shown once with their number.

use std::io::IsTerminal;
use std::ops::Range;

use alhazen::description::{Diagnostic, DiagnosticList, Severity, SourceMap, Span};
use annotate_snippets::renderer::DecorStyle;
use annotate_snippets::{AnnotationKind, Element, Level, Origin, Renderer, Snippet};
use serde_json::{Value, json};

use crate::console::{Undelivered, warn};

/// Most bytes of a line that are shown after what a message is about.
const MARGIN: usize = 200;

/// Most bytes of a line before what a message is about; of longer lines the end of that part alone
/// is shown.
const LONGEST_START: usize = 10_000;

/// Writes diagnostics and their number to standard error.
pub fn print(diagnostics: &[Diagnostic], sources: &SourceMap) -> Result<(), Undelivered> {
    let renderer = renderer(std::io::stderr().is_terminal() && std::env::var_os("NO_COLOR").is_none());
    let diagnostics = shown(diagnostics);
    for diagnostic in &diagnostics {
        warn(format_args!("{}\n", render(diagnostic, sources, &renderer)))?;
    }
    let count = |severity| {
        let of_severity = diagnostics.iter().filter(|diagnostic| diagnostic.severity == severity);
        of_severity.map(|diagnostic| diagnostic.count).sum()
    };
    summary(count(Severity::Error), count(Severity::Warning)).map_or(Ok(()), warn)
}

/// The diagnostics that are shown, in the order of the text.
pub fn shown(diagnostics: &[Diagnostic]) -> Vec<Diagnostic> {
    let mut list = DiagnosticList::default();
    list.extend(diagnostics.iter().cloned());
    list.finish()
}

/// "2 errors and 1 warning"; `None` where there is nothing.
fn summary(errors: usize, warnings: usize) -> Option<String> {
    let count = |count: usize, noun: &str| match count {
        0 => None,
        1 => Some(format!("1 {noun}")),
        _ => Some(format!("{count} {noun}s")),
    };
    match (count(errors, "error"), count(warnings, "warning")) {
        (Some(errors), Some(warnings)) => Some(format!("{errors} and {warnings}")),
        (errors, warnings) => errors.or(warnings),
    }
}

/// Errors and warnings as two JSON lists.
pub fn to_json(diagnostics: &[Diagnostic], sources: &SourceMap) -> (Value, Value) {
    let diagnostics = shown(diagnostics);
    let list = |severity| {
        let of_severity = diagnostics.iter().filter(|diagnostic| diagnostic.severity == severity);
        of_severity.map(|diagnostic| entry(diagnostic, sources)).collect()
    };
    (list(Severity::Error), list(Severity::Warning))
}

fn entry(diagnostic: &Diagnostic, sources: &SourceMap) -> Value {
    let Diagnostic { code, message, help, count, .. } = diagnostic;
    let mut entry = json!({ "code": code, "message": message, "help": help, "count": count });
    let span = diagnostic.span();
    if !span.is_none() {
        let position = sources.position(span);
        entry["file"] = json!(sources.name(span.file));
        entry["line"] = json!(position.line);
        entry["column"] = json!(position.column);
    }
    entry
}

fn renderer(colored: bool) -> Renderer {
    if colored { Renderer::styled() } else { Renderer::plain() }.decor_style(DecorStyle::Ascii)
}

fn render(diagnostic: &Diagnostic, sources: &SourceMap, renderer: &Renderer) -> String {
    let level = match diagnostic.severity {
        Severity::Error => Level::ERROR,
        Severity::Warning => Level::WARNING,
    };
    let excerpts: Vec<_> = diagnostic
        .labels
        .iter()
        .filter(|(span, _)| !span.is_none())
        .map(|(span, label)| (Excerpt::new(*span, sources), label.as_str()))
        .collect();
    let elements = excerpts.iter().enumerate().flat_map(|(i, (excerpt, label))| {
        let kind = if i == 0 { AnnotationKind::Primary } else { AnnotationKind::Context };
        excerpt.elements(kind, label)
    });
    let mut group = level.primary_title(diagnostic.message.as_str()).id(diagnostic.code).elements(elements);
    let more = match (diagnostic.count, diagnostic.labels.len()) {
        (count, 0) => Some(format!("left out: {count}")),
        (1, _) => None,
        (2, _) => Some("the same is found in 1 more place".into()),
        (count, _) => Some(format!("the same is found in {} more places", count - 1)),
    };
    if let Some(more) = &more {
        group = group.element(Level::NOTE.message(more.as_str()));
    }
    if let Some(help) = &diagnostic.help {
        group = group.element(Level::HELP.message(help.as_str()));
    }
    renderer.render(&[group])
}

/// The line on which a span begins, or the part of it around the span where the line is long.
struct Excerpt {
    file: String,
    line: usize,
    /// The column, where the text does not begin at the start of its line.
    column: Option<usize>,
    text: String,
    marked: Range<usize>,
}

impl Excerpt {
    fn new(span: Span, sources: &SourceMap) -> Self {
        let bytes = sources.text(span.file);
        let start = bytes.len().min(span.start as usize);
        let line = sources.line_range(span);
        let (line_start, line_end) = (line.start, line.end.max(start));
        let end = line_end.min(span.end as usize).max(start);
        let whole = start - line_start <= LONGEST_START;
        let first = if whole { line_start } else { start - MARGIN };
        let last = line_end.min(end + MARGIN).min(start + 4 * MARGIN);
        // Each part is decoded separately, so that the marked range is right for any bytes.
        let part = |range: Range<usize>| String::from_utf8_lossy(&bytes[range]).into_owned();
        let end = end.min(last);
        let [before, marked, after] = [first..start, start..end, end..last].map(part);
        let marked_range = before.len()..before.len() + marked.len();
        let position = sources.position(span);
        Self {
            file: sources.name(span.file).to_owned(),
            line: position.line,
            column: (!whole).then_some(position.column),
            text: before + &marked + after.trim_end_matches('\r'),
            marked: marked_range,
        }
    }

    fn elements<'a>(&'a self, kind: AnnotationKind, label: &'a str) -> Vec<Element<'a>> {
        let label = (!label.is_empty()).then_some(label);
        let annotation = kind.span(self.marked.clone()).label(label);
        let snippet = Snippet::source(self.text.as_str()).line_start(self.line).annotation(annotation);
        match self.column {
            None => vec![snippet.path(self.file.as_str()).into()],
            Some(column) => {
                let origin = Origin::path(self.file.as_str()).line(self.line).char_column(column);
                vec![origin.into(), snippet.into()]
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn shown(text: &[u8], make: impl Fn(alhazen::description::FileId) -> Diagnostic) -> String {
        let mut sources = SourceMap::default();
        let file = sources.add("scenes/a.pbrt", text);
        render(&make(file), &sources, &renderer(false))
    }

    #[test]
    fn carets_mark_the_span_of_an_error() {
        let text = b"WorldBegin\nShape \"spere\"\n";
        let shown = shown(text, |file| {
            Diagnostic::error("unknown-type", "no shape is called `spere`", Span::new(file, 17, 24))
                .with_help("did you mean `sphere`?")
        });
        let expected = "\
error[unknown-type]: no shape is called `spere`
 --> scenes/a.pbrt:2:7
  |
2 | Shape \"spere\"
  |       ^^^^^^^
  |
  = help: did you mean `sphere`?";
        assert_eq!(shown, expected);
    }

    #[test]
    fn every_label_is_shown() {
        let shown = shown(b"a\nb\nc\n", |file| {
            Diagnostic::warning("twice", "`a` is defined twice", Span::new(file, 4, 5))
                .with_label(Span::new(file, 0, 1), "first here")
        });
        assert!(
            shown.contains("3 | c") && shown.contains("1 | a") && shown.contains("first here"),
            "{shown}"
        );
    }

    #[test]
    fn any_bytes_and_any_spans_can_be_shown() {
        let mut long = vec![b'x'; 100_000];
        long[50_000] = 0xff;
        long[70_000] = b'\n';
        for (start, end) in
            [(0, 0), (49_999, 50_002), (0, 100_000), (69_999, 90_000), (99_999, 100_000), (100_000, 100_000)]
        {
            let text = shown(&long, |file| Diagnostic::error("e", "m", Span::new(file, start, end)));
            assert!(text.len() < 4000, "{}", text.len());
        }
        let beyond = shown(b"ab", |file| Diagnostic::error("e", "m", Span::new(file, 50, 60)));
        assert!(beyond.contains("a.pbrt:1:3"), "{beyond}");
        let far = shown(&long, |file| Diagnostic::error("e", "m", Span::new(file, 49_000, 49_001)));
        assert!(far.contains("a.pbrt:1:49001"), "{far}");
        let nowhere = shown(b"", |_| Diagnostic::error("e", "nothing", Span::NONE));
        assert_eq!(nowhere, "error[e]: nothing");
    }

    #[test]
    fn places_of_the_same_warning_are_counted() {
        let mut sources = SourceMap::default();
        let file = sources.add("a.pbrt", "x\n".repeat(40_000).into_bytes());
        let warning = |line: u32| Diagnostic::warning("w", "hair", Span::new(file, 2 * line, 2 * line + 1));
        let warnings: Vec<_> = (0..40_000).map(warning).collect();
        let shown = super::shown(&warnings);
        assert_eq!(shown.len(), 1);
        let text = render(&shown[0], &sources, &renderer(false));
        assert!(
            text.contains("a.pbrt:1:1") && text.contains("the same is found in 39999 more places"),
            "{text}"
        );
        let (_, json) = to_json(&warnings, &sources);
        assert_eq!((&json[0]["count"], &json[0]["line"]), (&40_000.into(), &1.into()));
    }

    #[test]
    fn numbers_are_counted_in_words() {
        assert_eq!(summary(0, 0), None);
        assert_eq!(summary(1, 0).unwrap(), "1 error");
        assert_eq!(summary(2, 1).unwrap(), "2 errors and 1 warning");
    }
}
