//! Data and files that a text refers to by URI.

use std::path::{Path, PathBuf};

use base64::Engine;
use base64::engine::general_purpose::{STANDARD, STANDARD_NO_PAD};

use assets::{AssetSource, resolve};

/// The bytes that a URI names, relative to the file `base`; on failure, the reason.
pub(super) fn read(uri: &str, base: &Path, assets: &dyn AssetSource) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        return decoded(data);
    }
    let path = path(uri, base, assets)?;
    assets.read(&path).map_err(|error| format!("cannot read `{}`: {error}", path.display()))
}

/// The name of a file that a URI is, relative to another file.
fn name(uri: &str) -> Result<String, String> {
    let scheme = uri.split_once(':').map(|(scheme, _)| scheme);
    if scheme.is_some_and(|scheme| !scheme.contains('/')) {
        return Err(format!("`{uri}` is not the name of a file beside this one"));
    }
    unescaped(uri)
}

/// The path of a file that a URI names.
fn path(uri: &str, base: &Path, assets: &dyn AssetSource) -> Result<PathBuf, String> {
    let base = base.to_string_lossy();
    let plain = resolve(assets, &name(uri)?, &base, &base);
    // Some programs write names as they are.
    let raw = resolve(assets, uri, &base, &base);
    Ok(if !assets.exists(&plain) && assets.exists(&raw) { raw } else { plain })
}

/// The bytes of a data URI after `data:`.
fn decoded(data: &str) -> Result<Vec<u8>, String> {
    let (kind, text) = data.split_once(',').ok_or("a data URI has a comma before its data")?;
    if !kind.ends_with(";base64") {
        return Ok(unescaped(text)?.into_bytes());
    }
    let wrong = |error| format!("its data are not those of base64: {error}");
    match text.ends_with('=') {
        true => STANDARD.decode(text).map_err(wrong),
        false => STANDARD_NO_PAD.decode(text).map_err(wrong),
    }
}

/// A text whose bytes `%41` are decoded.
fn unescaped(text: &str) -> Result<String, String> {
    let wrong = || format!("`{text}` is not a valid URI");
    let mut bytes = Vec::with_capacity(text.len());
    let mut rest = text.as_bytes();
    while let Some((&byte, tail)) = rest.split_first() {
        rest = tail;
        if byte != b'%' {
            bytes.push(byte);
            continue;
        }
        let (digits, tail) = tail.split_at_checked(2).ok_or_else(wrong)?;
        let digits = std::str::from_utf8(digits).map_err(|_| wrong())?;
        bytes.push(u8::from_str_radix(digits, 16).map_err(|_| wrong())?);
        rest = tail;
    }
    String::from_utf8(bytes).map_err(|_| wrong())
}

#[cfg(test)]
mod tests {
    use super::*;
    use assets::MemoryAssets;

    #[test]
    fn uris_name_data_or_files_beside_the_text() {
        let assets = MemoryAssets::default().with("a/two words.bin", "x").with("a/%.bin", "y");
        let read = |uri| read(uri, Path::new("a/scene.gltf"), &assets);
        for (uri, bytes) in [
            ("two%20words.bin", "x"),
            ("two words.bin", "x"),
            ("data:;base64,aGVsbG8=", "hello"),
            ("data:application/octet-stream;base64,aGVsbG8", "hello"),
            ("data:text/plain,a%20b", "a b"),
        ] {
            assert_eq!(read(uri).as_deref(), Ok(bytes.as_bytes()), "{uri}");
        }
        for uri in ["http://a/b.bin", "two%2.bin", "data:;base64,a*b=", "data:abc", "none.bin"] {
            assert!(read(uri).is_err(), "{uri}");
        }
    }
}
