//! Views of buffers that are packed as the extension `EXT_meshopt_compression` has it: vertices,
//! triangles and sequences of indices, and filters of unpacked vertices. Streams of the extension
//! are those of version 0 for vertices and 1 for indices. Source: [Kapoulkine 2021].

mod filter;
mod indices;
mod vertices;

use super::json::{Place, Result};
use filter::Filter;

/// What a packed view holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Mode {
    Attributes,
    Triangles,
    Indices,
}

/// The form of a packed view.
#[derive(Clone, Copy, Debug)]
pub(super) struct Layout {
    mode: Mode,
    filter: Filter,
    count: usize,
    stride: usize,
}

impl Layout {
    /// Reads the form from the object of the extension.
    pub fn parse(place: &Place) -> Result<Self> {
        let integer =
            |key: &str| place.integer(key)?.ok_or_else(|| place.invalid(format!("`{key}` is missing")));
        let (count, stride) = (integer("count")?, integer("byteStride")?);
        let mode = match place.string("mode")? {
            Some("ATTRIBUTES") => Mode::Attributes,
            Some("TRIANGLES") => Mode::Triangles,
            Some("INDICES") => Mode::Indices,
            _ => return Err(place.invalid_member("mode", "this must be ATTRIBUTES, TRIANGLES or INDICES")),
        };
        let filter = match place.string("filter")? {
            None | Some("NONE") => Filter::None,
            Some("OCTAHEDRAL") if matches!(stride, 4 | 8) => Filter::Octahedral,
            Some("QUATERNION") if stride == 8 => Filter::Quaternion,
            Some("EXPONENTIAL") => Filter::Exponential,
            Some(name) => {
                let message = format!("the filter `{name}` of elements of {stride} bytes is not read");
                return Err(place.invalid_member("filter", message));
            }
        };
        let is_valid = match mode {
            Mode::Attributes => (4..=256).contains(&stride) && stride % 4 == 0,
            Mode::Triangles => matches!(stride, 2 | 4) && count % 3 == 0 && filter == Filter::None,
            Mode::Indices => matches!(stride, 2 | 4) && filter == Filter::None,
        };
        if !is_valid || count == 0 || count > u32::MAX as usize {
            let message = format!("{count} elements of {stride} bytes cannot be packed so");
            return Err(place.invalid_member("byteStride", message));
        }
        Ok(Self { mode, filter, count, stride })
    }

    /// The number of bytes of the unpacked view.
    pub fn byte_length(&self) -> u64 {
        self.count as u64 * self.stride as u64
    }

    /// The unpacked view; on failure, the reason.
    pub fn decode(&self, bytes: &[u8]) -> std::result::Result<Vec<u8>, String> {
        let indices = match self.mode {
            Mode::Attributes => {
                let mut vertices = vertices::decode(bytes, self.count, self.stride)?;
                self.filter.apply(&mut vertices, self.stride);
                return Ok(vertices);
            }
            Mode::Triangles => indices::triangles(bytes, self.count)?,
            Mode::Indices => indices::sequence(bytes, self.count)?,
        };
        Ok(match self.stride {
            2 => indices.iter().flat_map(|&index| (index as u16).to_le_bytes()).collect(),
            _ => indices.iter().flat_map(|index| index.to_le_bytes()).collect(),
        })
    }
}

/// The bytes of a stream, read one after another.
struct Stream<'a>(&'a [u8]);

impl<'a> Stream<'a> {
    /// A stream that begins with a byte of its kind and version.
    fn new(bytes: &'a [u8], header: u8) -> std::result::Result<Self, String> {
        match bytes.split_first() {
            Some((&found, rest)) if found == header => Ok(Self(rest)),
            Some((found, _)) => Err(format!("the packed data begin with {found:#x} instead of {header:#x}")),
            None => Err("there are no packed data".into()),
        }
    }

    fn take(&mut self, count: usize) -> std::result::Result<&'a [u8], String> {
        let (taken, rest) = self.0.split_at_checked(count).ok_or("the packed data end too early")?;
        self.0 = rest;
        Ok(taken)
    }

    fn byte(&mut self) -> std::result::Result<u8, String> {
        Ok(self.take(1)?[0])
    }

    /// An integer of seven bits in each byte, the lowest first.
    fn varint(&mut self) -> std::result::Result<u32, String> {
        let mut value = 0;
        for shift in [0, 7, 14, 21, 28] {
            let byte = self.byte()?;
            value |= u32::from(byte & 127) << shift;
            if byte < 128 {
                break;
            }
        }
        Ok(value)
    }
}

/// The difference that an integer encodes: 0, −1, 1, −2, …
fn signed(value: u32) -> u32 {
    (value >> 1) ^ (value & 1).wrapping_neg()
}
