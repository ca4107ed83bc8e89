//! What is refused of a layer before it is parsed, because the parser would not survive it.

use openusd::usda::parser::Parser;

use super::binary;

/// The deepest nesting of a text: the parser calls itself for each level.
const DEEPEST: usize = 512;

/// What is wrong with the bytes of a layer or a package.
pub(super) fn check(bytes: &[u8]) -> Result<(), String> {
    match bytes {
        [b'P', b'K', ..] => Ok(()),
        [b'P', b'X', b'R', b'-', ..] => binary::check(bytes),
        _ => check_text(bytes),
    }
}

fn check_text(bytes: &[u8]) -> Result<(), String> {
    check_depth(bytes)?;
    check_braces(bytes)
}

fn line_of(bytes: &[u8], offset: usize) -> usize {
    1 + bytes[..offset].iter().filter(|&&byte| byte == b'\n').count()
}

/// Refuses paths and names with braces other than those of variants, `{set=name}`: the composition
/// looks for the parents of such a path without end.
fn check_braces(bytes: &[u8]) -> Result<(), String> {
    let (mut at, mut before) = (0, b'\n');
    while let Some(&byte) = bytes.get(at) {
        let rest = &bytes[at..];
        let length = match byte {
            b'#' => until(rest, 1, b"\n", false),
            b'<' => until(rest, 1, b">", false),
            b'"' | b'\'' | b'@' if rest.starts_with(&[byte; 3]) => until(rest, 3, &[byte; 3], byte != b'@'),
            b'"' | b'\'' | b'@' => until(rest, 1, &[byte], byte != b'@'),
            _ => 1,
        };
        let token = &rest[..length];
        let is_wrong = match byte {
            b'<' => !has_braces_of_variants(token),
            // A string is a name where a block or metadata follow, unless it is a value.
            b'"' | b'\'' => {
                let after = rest[length..].trim_ascii_start().first();
                let is_name = matches!(after, Some(b'{' | b'(')) && !b"=[(,:".contains(&before);
                is_name && token.iter().any(|byte| b"{}".contains(byte))
            }
            _ => false,
        };
        if is_wrong {
            return Err(format!("line {}: a path or a name has a brace too many", line_of(bytes, at)));
        }
        if !byte.is_ascii_whitespace() && byte != b'#' {
            before = byte;
        }
        at += length;
    }
    Ok(())
}

/// The length of a token with its end, which is looked for after its first `skip` bytes.
fn until(bytes: &[u8], skip: usize, end: &[u8], has_escapes: bool) -> usize {
    let mut at = skip;
    while at < bytes.len() && !bytes[at..].starts_with(end) {
        at += if has_escapes && bytes[at] == b'\\' { 2 } else { 1 };
    }
    (at + end.len()).min(bytes.len())
}

/// Whether each brace is closed before the next is opened.
fn has_braces_of_variants(path: &[u8]) -> bool {
    let mut is_open = false;
    let mut braces = path.iter().filter(|byte| b"{}".contains(byte));
    let are_in_turn = braces.all(|&byte| {
        let was_open = std::mem::replace(&mut is_open, byte == b'{');
        was_open != is_open
    });
    are_in_turn && !is_open
}

/// Refuses texts whose brackets are nested too deeply. Those of strings count as well, of which no
/// text has so many.
fn check_depth(bytes: &[u8]) -> Result<(), String> {
    let mut depth = 0_usize;
    for (offset, byte) in bytes.iter().enumerate() {
        match byte {
            b'{' | b'[' | b'(' => depth += 1,
            b'}' | b']' | b')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            let line = line_of(bytes, offset);
            return Err(format!("line {line}: brackets are nested more than {DEEPEST} deep"));
        }
    }
    Ok(())
}

/// Where a text is no USD, as line and column, and what is wrong there.
pub(super) fn text_error(bytes: &[u8]) -> Option<(String, String)> {
    if bytes.starts_with(b"PXR-") || bytes.starts_with(b"PK") {
        return None;
    }
    let text = match std::str::from_utf8(bytes) {
        Ok(text) => text,
        Err(error) => {
            return Some((line_of(bytes, error.valid_up_to()).to_string(), "this is no UTF-8".to_owned()));
        }
    };
    let mut parser = Parser::new(text);
    let error = parser.parse().err()?;
    let place = parser.last_error_highlight().map(|place| format!("{}:{}", place.line, place.column));
    Some((place.unwrap_or_else(|| "1".to_owned()), format!("{error:#}")))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn braces_may_be_in_values_and_pair_in_paths() {
        for good in [
            "string x = \"a}b\" (doc = \"c}\")",
            "doc = '''it's {one}''' { }",
            "def \"b\" (references = @a}.usda@</a{v=x}{w=y}c>) { } # }",
            "variantSet \"v\" = { \"x\" { } }",
        ] {
            assert_eq!(check_text(good.as_bytes()), Ok(()), "{good}");
        }
        for bad in ["</a}b>", "</a{v=x>", "</a{v={x}}>", "def \"a}b\" { }", "over 'a{' ( )", "\n</a}b"] {
            assert!(check_text(bad.as_bytes()).is_err(), "{bad}");
        }
    }
}
