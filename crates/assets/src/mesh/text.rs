//! Texts of mesh files: their characters and their lines.

use std::borrow::Cow;

/// A text without a byte order mark; one of UTF-16 with such a mark becomes UTF-8.
pub(super) fn unmarked(bytes: &[u8]) -> Cow<'_, [u8]> {
    let wide = |bytes: &[u8], from: fn([u8; 2]) -> u16| {
        let units: Vec<u16> = bytes.as_chunks().0.iter().map(|&unit| from(unit)).collect();
        Cow::Owned(String::from_utf16_lossy(&units).into_bytes())
    };
    match bytes {
        [0xef, 0xbb, 0xbf, text @ ..] => Cow::Borrowed(text),
        [0xff, 0xfe, text @ ..] => wide(text, u16::from_le_bytes),
        [0xfe, 0xff, text @ ..] => wide(text, u16::from_be_bytes),
        text => Cow::Borrowed(text),
    }
}

/// The lines of a text, which end by a line feed, a carriage return, or both, with their numbers
/// from 1.
pub(super) fn lines(text: &[u8]) -> impl Iterator<Item = (usize, &[u8])> {
    let (mut rest, mut number) = (text, 0);
    std::iter::from_fn(move || {
        if rest.is_empty() {
            return None;
        }
        let end = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(rest.len());
        let (line, after) = rest.split_at(end);
        rest = match after {
            [b'\r', b'\n', after @ ..] | [_, after @ ..] => after,
            [] => after,
        };
        number += 1;
        Some((number, line))
    })
}

/// The statements of a Wavefront file, with the numbers of their first lines: lines that are not
/// empty and no comment, where a backslash at the end of one joins it to the next.
pub(super) fn statements(text: &[u8]) -> impl Iterator<Item = (usize, Cow<'_, [u8]>)> {
    let mut lines = lines(text);
    std::iter::from_fn(move || {
        loop {
            let (number, line) = lines.next()?;
            let line = line.trim_ascii_start();
            if line.is_empty() || line.starts_with(b"#") {
                continue;
            }
            let Some(start) = line.strip_suffix(b"\\") else { return Some((number, Cow::Borrowed(line))) };
            let mut joined = start.to_vec();
            for (_, line) in lines.by_ref() {
                joined.push(b' ');
                let (part, goes_on) = line.strip_suffix(b"\\").map_or((line, false), |part| (part, true));
                joined.extend(part);
                if !goes_on {
                    break;
                }
            }
            return Some((number, Cow::Owned(joined)));
        }
    })
}

/// The words of a statement up to a comment.
pub(super) fn words(statement: &[u8]) -> impl Iterator<Item = &[u8]> + Clone {
    let words = statement.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty());
    words.take_while(|word| !word.starts_with(b"#"))
}

/// A statement after its keyword: a name, which may have spaces, `#` and quotes around it.
pub(super) fn name(statement: &[u8]) -> String {
    let keyword = statement.iter().position(u8::is_ascii_whitespace).unwrap_or(statement.len());
    unquoted(&String::from_utf8_lossy(&statement[keyword..])).to_owned()
}

/// A name without spaces and quotes around it.
pub(super) fn unquoted(name: &str) -> &str {
    let name = name.trim();
    name.strip_prefix('"').and_then(|name| name.strip_suffix('"')).unwrap_or(name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn marks_are_removed_and_utf_16_is_unpacked() {
        let units: Vec<u16> = "\u{feff}v é\n".encode_utf16().collect();
        let bytes = |from: fn(u16) -> [u8; 2]| units.iter().flat_map(|&unit| from(unit)).collect::<Vec<u8>>();
        for text in [bytes(u16::to_le_bytes), bytes(u16::to_be_bytes), "\u{feff}v é\n".into()] {
            assert_eq!(unmarked(&text), "v é\n".as_bytes());
        }
        assert_eq!(unmarked(b"\xef\xbbv"), &b"\xef\xbbv"[..]);
    }

    #[test]
    fn statements_have_the_numbers_of_their_lines_whatever_ends_these() {
        let unix = "# c:\\\n\nv 1 \\\n 2 \\\n3 # x\n  newmtl a #2 \nf";
        for end in ["\n", "\r\n", "\r"] {
            let text = unix.replace('\n', end);
            let found: Vec<_> = statements(text.as_bytes())
                .map(|(line, text)| (line, String::from_utf8(text.into()).unwrap()))
                .collect();
            let expected = [(3, "v 1   2  3 # x"), (6, "newmtl a #2 "), (7, "f")];
            assert_eq!(found, expected.map(|(line, text)| (line, text.to_owned())), "{end:?}");
        }
        assert_eq!(words(b"v 1   2  3 # x").collect::<Vec<_>>(), [&b"v"[..], b"1", b"2", b"3"]);
        assert_eq!(name(b"newmtl \"a #2\" "), "a #2");
    }
}
