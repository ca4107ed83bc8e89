//! Files by number, places in them, and how a place is shown to a reader.

use std::borrow::Cow;
use std::sync::Arc;

/// The number of a file in a [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(pub u32);

impl FileId {
    /// Of what was said by who uses a scene, as on a command line, rather than in a file. Its spans
    /// count what was said.
    pub const CALLER: Self = Self(u32::MAX - 1);
}

/// A range of bytes of one file.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct Span {
    /// The file.
    pub file: FileId,
    /// Its first byte.
    pub start: u32,
    /// The byte after its last.
    pub end: u32,
}

impl Span {
    /// The span of what was said in no file.
    pub const NONE: Self = Self { file: FileId(u32::MAX), start: 0, end: 0 };

    /// The bytes `start..end` of a file.
    pub fn new(file: FileId, start: u32, end: u32) -> Self {
        Self { file, start, end }
    }

    /// Whether it lies in no file: it is [`Span::NONE`], or the [caller's](FileId::CALLER).
    pub fn is_none(self) -> bool {
        self == Self::NONE || self.file == FileId::CALLER
    }

    /// The smallest span that holds both; `self` if they lie in different files.
    pub fn to(self, other: Self) -> Self {
        if self.file != other.file {
            return self;
        }
        Self { file: self.file, start: self.start.min(other.start), end: self.end.max(other.end) }
    }
}

impl Default for Span {
    fn default() -> Self {
        Self::NONE
    }
}

/// A value and the place where it was said.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Spanned<T> {
    /// What was said.
    pub value: T,
    /// Where it was said.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// A value with its place.
    pub fn new(value: T, span: Span) -> Self {
        Self { value, span }
    }
}

/// A line and a column, both counted from 1; columns count characters.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Position {
    /// The line.
    pub line: usize,
    /// The character in the line.
    pub column: usize,
}

/// All files that were read as text, with what they held when they were read.
///
/// Texts are bytes: comments may be in any encoding. Compressed files are kept as the text that was
/// in them.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    files: Vec<(String, Arc<[u8]>)>,
}

impl SourceMap {
    /// Adds a file under the name that messages will show.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<[u8]>>) -> FileId {
        self.files.push((name.into(), text.into()));
        FileId(self.files.len() as u32 - 1)
    }

    /// The name of a file; empty for [`Span::NONE`]'s.
    pub fn name(&self, file: FileId) -> &str {
        self.files.get(file.0 as usize).map_or("", |(name, _)| name)
    }

    /// The text of a file; empty for [`Span::NONE`]'s.
    pub fn text(&self, file: FileId) -> &[u8] {
        self.files.get(file.0 as usize).map_or(&[], |(_, text)| text)
    }

    /// The text of a file, shared.
    pub fn shared_text(&self, file: FileId) -> Arc<[u8]> {
        self.files.get(file.0 as usize).map_or_else(|| Arc::from([]), |(_, text)| text.clone())
    }

    /// The number of files.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// Whether no file was read.
    pub fn is_empty(&self) -> bool {
        self.files.is_empty()
    }

    /// The text of a span; bytes that are not UTF-8 become replacement characters.
    pub fn snippet(&self, span: Span) -> Cow<'_, str> {
        String::from_utf8_lossy(
            self.text(span.file).get(span.start as usize..span.end as usize).unwrap_or(&[]),
        )
    }

    /// Where a span begins.
    pub fn position(&self, span: Span) -> Position {
        let text = self.text(span.file);
        let before = &text[..text.len().min(span.start as usize)];
        let line_start = before.iter().rposition(|&byte| byte == b'\n').map_or(0, |at| at + 1);
        Position {
            line: 1 + before.iter().filter(|&&byte| byte == b'\n').count(),
            column: 1 + String::from_utf8_lossy(&before[line_start..]).chars().count(),
        }
    }

    /// The whole line in which a span begins, without its line end.
    pub fn line(&self, span: Span) -> Cow<'_, str> {
        let text = self.text(span.file);
        let at = text.len().min(span.start as usize);
        let start = text[..at].iter().rposition(|&byte| byte == b'\n').map_or(0, |found| found + 1);
        let end = text[at..].iter().position(|&byte| byte == b'\n').map_or(text.len(), |found| at + found);
        String::from_utf8_lossy(text[start..end].strip_suffix(b"\r").unwrap_or(&text[start..end]))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_are_counted_in_lines_and_characters() {
        let mut sources = SourceMap::default();
        let file = sources.add("a.pbrt", "ab\r\nd\u{e9}f\ng".as_bytes());
        let f = Span::new(file, 7, 8);
        assert_eq!(sources.snippet(f), "f");
        assert_eq!(sources.position(f), Position { line: 2, column: 3 });
        assert_eq!(sources.line(f), "d\u{e9}f");
        assert_eq!(sources.line(Span::new(file, 0, 1)), "ab");
        assert_eq!(sources.position(Span::new(file, 99, 99)), Position { line: 3, column: 2 });
        assert_eq!((sources.name(Span::NONE.file), sources.snippet(Span::NONE)), ("", "".into()));
    }
}
