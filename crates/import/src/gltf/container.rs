//! The two containers: text alone, and the binary container (GLB), which has a chunk of text and a
//! chunk of bytes.

use serde_json::Value;

use super::json::{Fault, Result};

/// The content of a file.
#[derive(Debug)]
pub(super) struct Container {
    /// The text.
    pub root: Value,
    /// The bytes after it.
    pub bytes: Option<Vec<u8>>,
}

/// Most bytes of text: in memory it takes up to twenty times as many.
const LONGEST_TEXT: usize = 256 << 20;

const MAGIC: &[u8] = b"glTF";
const JSON: u32 = u32::from_le_bytes(*b"JSON");
const BIN: u32 = u32::from_le_bytes(*b"BIN\0");

/// Whether a file is one of the format, by its first bytes.
pub(super) fn is_binary(bytes: &[u8]) -> bool {
    bytes.starts_with(MAGIC)
}

fn broken<T>(message: impl Into<String>) -> Result<T> {
    Err(Fault::new("invalid-glb", "", message))
}

/// The content of a file. `name_says_binary` is whether its name ends in `.glb`.
pub(super) fn read(bytes: &[u8], name_says_binary: bool) -> Result<Container> {
    if !is_binary(bytes) {
        if name_says_binary {
            return broken("a .glb file begins with the bytes `glTF`, as this one does not");
        }
        return Ok(Container { root: text(bytes)?, bytes: None });
    }
    let number = |at: usize| {
        bytes.get(at..at + 4).map(|four| u32::from_le_bytes([four[0], four[1], four[2], four[3]]))
    };
    let (Some(version), Some(length)) = (number(4), number(8)) else {
        return broken("the file ends within its header of 12 bytes");
    };
    if version != 2 {
        return broken(format!("this is a binary glTF of version {version}; read are those of version 2"));
    }
    let length = length as usize;
    if length > bytes.len() {
        return broken(format!("the header says {length} bytes, but the file has {}", bytes.len()));
    }
    let (mut root, mut binary, mut at) = (None, None, 12);
    while at + 8 <= length {
        let (Some(size), Some(kind)) = (number(at), number(at + 4)) else { break };
        let (start, size) = (at + 8, size as usize);
        let Some(chunk) = bytes.get(start..start.saturating_add(size)).filter(|_| size <= length - start)
        else {
            return broken(format!("the chunk at byte {at} reaches beyond the end of the file"));
        };
        match kind {
            JSON if at != 12 => return broken("there are two chunks of text"),
            JSON => root = Some(text(chunk)?),
            _ if at == 12 => return broken("the first chunk must be text"),
            BIN if binary.is_some() => return broken("there are two chunks of bytes"),
            BIN => binary = Some(chunk.to_vec()),
            // Other chunks are for later versions of the format.
            _ => (),
        }
        at = start + size.next_multiple_of(4);
    }
    match root {
        Some(root) => Ok(Container { root, bytes: binary }),
        None => broken("there is no chunk of text"),
    }
}

fn text(bytes: &[u8]) -> Result<Value> {
    let bytes = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if bytes.len() > LONGEST_TEXT {
        return broken(format!("the text has more than {} MiB", LONGEST_TEXT >> 20));
    }
    match serde_json::from_slice(bytes) {
        Ok(value @ Value::Object(_)) => Ok(value),
        Ok(_) => Err(Fault::new("invalid-gltf", "", "the text is not a JSON object")),
        Err(error) => Err(Fault::new("invalid-json", "", format!("this is no JSON: {error}"))),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A binary container of chunks.
    fn glb(chunks: &[(&[u8; 4], &[u8])]) -> Vec<u8> {
        let body: Vec<u8> = chunks
            .iter()
            .flat_map(|(kind, data)| [&(data.len() as u32).to_le_bytes()[..], &kind[..], data].concat())
            .collect();
        [&b"glTF\x02\0\0\0"[..], &(12 + body.len() as u32).to_le_bytes(), &body].concat()
    }

    #[test]
    fn both_containers_are_read() {
        let text = br#"{"asset":{"version":"2.0"}} "#;
        let plain = read(text, false).unwrap();
        let binary = read(&glb(&[(b"JSON", text), (b"BIN\0", &[1, 2, 3, 4]), (b"ABCD", &[])]), true).unwrap();
        assert_eq!(plain.root, binary.root);
        assert_eq!((plain.bytes, binary.bytes), (None, Some(vec![1, 2, 3, 4])));
    }

    #[test]
    fn damaged_containers_are_refused() {
        let good = glb(&[(b"JSON", b"{}  "), (b"BIN\0", &[0; 4])]);
        for (bytes, message) in [
            (&good[..10], "the file ends within its header of 12 bytes"),
            (&good[..good.len() - 2], "the header says 36 bytes, but the file has 34"),
            (&glb(&[(b"BIN\0", &[0; 4])]), "the first chunk must be text"),
            (&glb(&[(b"JSON", b"{}  "), (b"JSON", b"{}  ")]), "there are two chunks of text"),
            (&glb(&[]), "there is no chunk of text"),
            (&glb(&[(b"JSON", b"[]  ")]), "the text is not a JSON object"),
            (b"{}", "a .glb file begins with the bytes `glTF`, as this one does not"),
        ] {
            assert_eq!(read(bytes, true).unwrap_err().message, message);
        }
        assert!(read(b"{", false).unwrap_err().message.starts_with("this is no JSON"));
    }
}
