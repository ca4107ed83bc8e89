//! Source files, spans of them, and the lines and columns of spans.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::{Arc, OnceLock};

/// The number of a file in a [`SourceMap`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct FileId(pub u32);

impl FileId {
    /// The pseudo-file of values from the caller, such as a command line. The start of a span is
    /// the index of a value.
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
    /// The span of items that are not in a file.
    pub const NONE: Self = Self { file: FileId(u32::MAX), start: 0, end: 0 };

    /// The bytes `start..end` of a file.
    pub fn new(file: FileId, start: u32, end: u32) -> Self {
        Self { file, start, end }
    }

    /// Whether it is in no file: it is [`Span::NONE`], or the [caller's](FileId::CALLER).
    pub fn is_none(self) -> bool {
        self == Self::NONE || self.file == FileId::CALLER
    }

    /// The smallest span that contains both; `self` if they are in different files.
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

/// A value with its source location.
#[derive(Clone, Copy, Debug, PartialEq, Default)]
pub struct Spanned<T> {
    /// The value.
    pub value: T,
    /// Its source location.
    pub span: Span,
}

impl<T> Spanned<T> {
    /// A value with its span.
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

/// All files that were read as text, with their content.
///
/// Texts are bytes, as comments may be in any encoding. Compressed files are stored decompressed.
#[derive(Clone, Debug, Default)]
pub struct SourceMap {
    files: Vec<SourceFile>,
}

#[derive(Clone, Debug)]
struct SourceFile {
    name: String,
    text: Arc<[u8]>,
    /// Starts of lines, computed at the first use.
    line_starts: OnceLock<Vec<u32>>,
}

impl SourceFile {
    fn line_starts(&self) -> &[u32] {
        self.line_starts.get_or_init(|| {
            let ends = self.text.iter().enumerate().filter(|&(_, &byte)| byte == b'\n');
            std::iter::once(0).chain(ends.map(|(at, _)| at as u32 + 1)).collect()
        })
    }
}

impl SourceMap {
    /// Adds a file; `name` is displayed in messages.
    pub fn add(&mut self, name: impl Into<String>, text: impl Into<Arc<[u8]>>) -> FileId {
        let line_starts = OnceLock::new();
        self.files.push(SourceFile { name: name.into(), text: text.into(), line_starts });
        FileId(self.files.len() as u32 - 1)
    }

    /// The name of a file; empty for [`Span::NONE`]'s.
    pub fn name(&self, file: FileId) -> &str {
        self.files.get(file.0 as usize).map_or("", |file| &file.name)
    }

    /// The text of a file; empty for [`Span::NONE`]'s.
    pub fn text(&self, file: FileId) -> &[u8] {
        self.files.get(file.0 as usize).map_or(&[], |file| &file.text)
    }

    /// The text of a file, shared.
    pub fn shared_text(&self, file: FileId) -> Arc<[u8]> {
        self.files.get(file.0 as usize).map_or_else(|| Arc::from([]), |file| file.text.clone())
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

    /// The line and column at which a span begins.
    pub fn position(&self, span: Span) -> Position {
        let text = self.text(span.file);
        let at = text.len().min(span.start as usize);
        let (number, start) = self.line_start(span.file, at);
        // Characters are counted by bytes that are not UTF-8 continuation bytes.
        let characters = text[start..at].iter().filter(|&&byte| byte & 0xc0 != 0x80).count();
        Position { line: 1 + number, column: 1 + characters }
    }

    /// The bytes of the line in which a span begins, without its line end.
    pub fn line_range(&self, span: Span) -> Range<usize> {
        let text = self.text(span.file);
        let at = text.len().min(span.start as usize);
        let (number, start) = self.line_start(span.file, at);
        let next = self.files.get(span.file.0 as usize).and_then(|file| file.line_starts().get(number + 1));
        let end = next.map_or(text.len(), |&next| next as usize - 1);
        let carriage_return = text[start..end].ends_with(b"\r");
        start..end - usize::from(carriage_return)
    }

    /// The line in which a span begins, without its line end.
    pub fn line(&self, span: Span) -> Cow<'_, str> {
        String::from_utf8_lossy(&self.text(span.file)[self.line_range(span)])
    }

    /// The number of the line that contains a byte, from 0, and its start.
    fn line_start(&self, file: FileId, at: usize) -> (usize, usize) {
        let Some(file) = self.files.get(file.0 as usize) else { return (0, 0) };
        let starts = file.line_starts();
        let number = starts.partition_point(|&start| start as usize <= at) - 1;
        (number, starts[number] as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_are_lines_and_characters() {
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
