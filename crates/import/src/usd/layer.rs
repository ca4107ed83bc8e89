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

/// Refuses texts whose brackets are nested too deeply. Those of strings count as well, of which no
/// text has so many.
fn check_text(bytes: &[u8]) -> Result<(), String> {
    let mut depth = 0_usize;
    for (offset, byte) in bytes.iter().enumerate() {
        match byte {
            b'{' | b'[' | b'(' => depth += 1,
            b'}' | b']' | b')' => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth > DEEPEST {
            let line = 1 + bytes[..offset].iter().filter(|&&byte| byte == b'\n').count();
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
            let line = 1 + bytes[..error.valid_up_to()].iter().filter(|&&byte| byte == b'\n').count();
            return Some((line.to_string(), "this is no UTF-8".to_owned()));
        }
    };
    let mut parser = Parser::new(text);
    let error = parser.parse().err()?;
    let place = parser.last_error_highlight().map(|place| format!("{}:{}", place.line, place.column));
    Some((place.unwrap_or_else(|| "1".to_owned()), format!("{error:#}")))
}
