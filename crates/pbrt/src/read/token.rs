//! The tokens of a pbrt file.
//!
//! A file is tokens separated by white space: `[`, `]`, quoted strings, and bare words (directives,
//! numbers, `true`, `false`). A `#` outside a string begins a comment that ends with its line. The
//! tokenizer works on bytes and allocates nothing: comments may be in any encoding.

use description::{Diagnostic, FileId, Span};

use description::DiagnosticList;

/// What a token is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum TokenKind {
    /// A directive, a number, `true` or `false`.
    Word,
    /// A string with its quotes.
    Quoted,
    /// A string whose line ends before its closing quote.
    Unterminated,
    /// `[`.
    Open,
    /// `]`.
    Close,
    /// The end of the file.
    End,
}

/// One token: the bytes `start..end`.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Token {
    pub(crate) kind: TokenKind,
    pub(crate) start: usize,
    pub(crate) end: usize,
}

/// The tokens of one file.
pub(crate) struct Tokens<'a> {
    text: &'a [u8],
    at: usize,
    file: FileId,
}

impl<'a> Tokens<'a> {
    /// The tokens of a text shorter than 4 GiB.
    pub(crate) fn new(text: &'a [u8], file: FileId) -> Self {
        let at = if text.starts_with(b"\xef\xbb\xbf") { 3 } else { 0 };
        Self { text, at, file }
    }

    /// Consumes the next token.
    #[inline]
    pub(crate) fn next(&mut self) -> Token {
        let token = self.peek();
        self.at = token.end;
        token
    }

    /// The next token, without consuming it.
    #[inline]
    pub(crate) fn peek(&mut self) -> Token {
        let text = self.text;
        let mut start = self.at;
        loop {
            match text.get(start) {
                None => {
                    self.at = start;
                    return Token { kind: TokenKind::End, start, end: start };
                }
                Some(b' ' | b'\t' | b'\n' | b'\r') => start += 1,
                Some(b'#') => {
                    start +=
                        text[start..].iter().position(|&byte| byte == b'\n').unwrap_or(text.len() - start);
                }
                Some(_) => break,
            }
        }
        self.at = start;
        let (kind, end) = match text[start] {
            b'[' => (TokenKind::Open, start + 1),
            b']' => (TokenKind::Close, start + 1),
            b'"' => self.quoted(start),
            _ => {
                let length = text[start..].iter().position(|&byte| is_delimiter(byte));
                (TokenKind::Word, length.map_or(text.len(), |length| start + length))
            }
        };
        Token { kind, start, end }
    }

    fn quoted(&self, start: usize) -> (TokenKind, usize) {
        let mut end = start + 1;
        while let Some(&byte) = self.text.get(end) {
            match byte {
                b'"' => return (TokenKind::Quoted, end + 1),
                b'\n' => break,
                b'\\' => end += 2,
                _ => end += 1,
            }
        }
        (TokenKind::Unterminated, end.min(self.text.len()))
    }

    /// The bytes of a token.
    #[inline]
    pub(crate) fn bytes(&self, token: Token) -> &'a [u8] {
        &self.text[token.start..token.end]
    }

    /// The span of a token.
    pub(crate) fn span(&self, token: Token) -> Span {
        Span::new(self.file, token.start as u32, token.end as u32)
    }

    /// The content of a quoted string, with its escapes resolved. Those that the format does not
    /// have are reported, and kept.
    pub(crate) fn string(&self, token: Token, report: &mut DiagnosticList) -> String {
        let inside = &self.text[token.start + 1..token.end - 1];
        if !inside.contains(&b'\\') {
            return String::from_utf8_lossy(inside).into_owned();
        }
        let mut unescaped = Vec::with_capacity(inside.len());
        let mut bytes = inside.iter().copied().enumerate();
        while let Some((at, byte)) = bytes.next() {
            if byte != b'\\' {
                unescaped.push(byte);
                continue;
            }
            match bytes.next() {
                Some((_, b'n')) => unescaped.push(b'\n'),
                Some((_, b't')) => unescaped.push(b'\t'),
                Some((_, b'r')) => unescaped.push(b'\r'),
                Some((_, b'b')) => unescaped.push(8),
                Some((_, b'f')) => unescaped.push(12),
                Some((_, known @ (b'\\' | b'\'' | b'"'))) => unescaped.push(known),
                other => {
                    let at = (token.start + 1 + at) as u32;
                    let message = "this backslash begins no escape of the format";
                    report.push(
                        Diagnostic::error("unknown-escape", message, Span::new(self.file, at, at + 1))
                            .with_help("write `/` between folders, and `\\\\` for a backslash"),
                    );
                    unescaped.push(b'\\');
                    unescaped.extend(other.map(|(_, byte)| byte));
                }
            }
        }
        String::from_utf8_lossy(&unescaped).into_owned()
    }
}

fn is_delimiter(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t' | b'\n' | b'\r' | b'"' | b'[' | b']' | b'#')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn kinds(text: &str) -> Vec<(TokenKind, String)> {
        let mut tokens = Tokens::new(text.as_bytes(), FileId(0));
        std::iter::from_fn(|| {
            let token = tokens.next();
            (token.kind != TokenKind::End)
                .then(|| (token.kind, String::from_utf8_lossy(tokens.bytes(token)).into_owned()))
        })
        .collect()
    }

    #[test]
    fn text_is_split_into_words_strings_and_brackets() {
        use TokenKind::*;
        let found = kinds("\u{feff}Shape\"x # y\"[1 -.5e3]# c\r\ntrue\r\n\"a\\\"b\"");
        let expected = [
            (Word, "Shape"),
            (Quoted, "\"x # y\""),
            (Open, "["),
            (Word, "1"),
            (Word, "-.5e3"),
            (Close, "]"),
            (Word, "true"),
            (Quoted, "\"a\\\"b\""),
        ];
        assert_eq!(found, expected.map(|(kind, text)| (kind, text.to_owned())));
    }

    #[test]
    fn a_string_ends_with_its_line() {
        assert_eq!(kinds("\"abc\nx")[0], (TokenKind::Unterminated, "\"abc".into()));
        assert_eq!(kinds("\"abc\\")[0], (TokenKind::Unterminated, "\"abc\\".into()));
    }

    #[test]
    fn escapes_are_undone() {
        let string = |text: &[u8]| {
            let (mut tokens, mut report) = (Tokens::new(text, FileId(0)), DiagnosticList::default());
            let token = tokens.next();
            (tokens.string(token, &mut report), report.finish())
        };
        let (text, messages) = string(br#""a\"b\\c\nd\'\b\f\r\t""#);
        assert_eq!((text.as_str(), messages.len()), ("a\"b\\c\nd'\u{8}\u{c}\r\t", 0));
        // As in a path of Windows.
        let (text, messages) = string(br#""textures\metal.png""#);
        assert_eq!((text.as_str(), messages.len()), ("textures\\metal.png", 1));
        assert_eq!((messages[0].code, messages[0].span().start), ("unknown-escape", 9));
    }
}
