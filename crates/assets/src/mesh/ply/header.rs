//! Headers of PLY files.

use std::borrow::Cow;

use crate::mesh::{MeshError, invalid};

/// How values are stored.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Encoding {
    Ascii,
    LittleEndian,
    BigEndian,
}

/// The type of a number.
#[derive(Clone, Copy, PartialEq)]
pub(super) enum Scalar {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Scalar {
    fn from_name(name: &str) -> Result<Self, MeshError> {
        Ok(match name {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return invalid(format!("there is no property type `{name:.40}`")),
        })
    }

    /// The number of bytes of a value.
    pub fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// The number that stands for 1 as a colour.
    pub fn one(self) -> f64 {
        match self {
            Self::F32 | Self::F64 => 1.0,
            Self::U16 => 65535.0,
            Self::I8 | Self::U8 | Self::I16 | Self::I32 | Self::U32 => 255.0,
        }
    }

    /// Whether it is an integer.
    pub fn is_integer(self) -> bool {
        !matches!(self, Self::F32 | Self::F64)
    }
}

/// A number, or a list of numbers after their count.
pub(super) enum PropertyKind {
    Scalar(Scalar),
    List { count: Scalar, item: Scalar },
}

/// A property of an element.
pub(super) struct Property {
    pub name: String,
    pub kind: PropertyKind,
}

/// A kind of element, and how many there are.
pub(super) struct Element {
    pub name: String,
    pub count: usize,
    pub properties: Vec<Property>,
}

/// A header.
pub(super) struct Header {
    pub format: Encoding,
    pub elements: Vec<Element>,
    /// Pictures that comments name.
    pub textures: Vec<String>,
}

/// The header of a file, and the bytes after it. Lines end as the first one does: by a line feed,
/// or by a carriage return alone. Comments may be in any encoding.
pub(super) fn read(bytes: &[u8]) -> Result<(Header, &[u8]), MeshError> {
    let mut rest = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    let first = rest.iter().position(|byte| matches!(byte, b'\n' | b'\r')).unwrap_or(0);
    let is_return = rest[first..].first() == Some(&b'\r') && rest.get(first + 1) != Some(&b'\n');
    let line_end = if is_return { b'\r' } else { b'\n' };
    let mut line = || -> Result<Cow<str>, MeshError> {
        let Some(end) = rest.iter().position(|&byte| byte == line_end) else {
            return invalid("the header has no end");
        };
        let (line, after) = (&rest[..end], &rest[end + 1..]);
        rest = after;
        Ok(String::from_utf8_lossy(line))
    };
    if line()?.trim() != "ply" {
        return invalid("the first line is not `ply`");
    }
    let (mut format, mut elements, mut textures) = (None, Vec::<Element>::new(), Vec::new());
    loop {
        let line = line()?;
        let words: Vec<&str> = line.split_ascii_whitespace().collect();
        match (words.as_slice(), elements.last_mut()) {
            (["comment", "TextureFile", name @ ..], _) => textures.push(name.join(" ")),
            ([] | ["comment" | "obj_info", ..], _) => (),
            (["end_header"], _) => break,
            (["format", name, "1.0"], _) => {
                format = Some(match *name {
                    "ascii" => Encoding::Ascii,
                    "binary_little_endian" => Encoding::LittleEndian,
                    "binary_big_endian" => Encoding::BigEndian,
                    _ => return invalid(format!("there is no format `{name:.40}`")),
                });
            }
            (["element", name, count], _) => {
                let Ok(count) = count.parse() else {
                    return invalid(format!("`{count:.40}` is not a count"));
                };
                elements.push(Element { name: (*name).into(), count, properties: Vec::new() });
            }
            (["property", "list", count, item, name], Some(element)) => {
                let kind =
                    PropertyKind::List { count: Scalar::from_name(count)?, item: Scalar::from_name(item)? };
                element.properties.push(Property { name: (*name).into(), kind });
            }
            (["property", kind, name], Some(element)) => {
                let kind = PropertyKind::Scalar(Scalar::from_name(kind)?);
                element.properties.push(Property { name: (*name).into(), kind });
            }
            _ => return invalid(format!("the header has the line `{:.60}`", line.trim())),
        }
    }
    match format {
        Some(format) => Ok((Header { format, elements, textures }, rest)),
        None => invalid("the header names no format"),
    }
}
