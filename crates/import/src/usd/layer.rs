//! What is refused of a layer before it is parsed, because the parser would not survive it.

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
