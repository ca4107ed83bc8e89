//! The codecs of grids.

use std::borrow::Cow;
use std::io::Read;

use flate2::read::ZlibDecoder;

use super::blosc;
use super::bytes::Bytes;

/// How the grids of a segment are packed.
#[derive(Clone, Copy)]
pub(super) enum Codec {
    None,
    Zip,
    Blosc,
}

impl Codec {
    pub(super) fn numbered(number: u16) -> Result<Self, String> {
        match number {
            0 => Ok(Self::None),
            1 => Ok(Self::Zip),
            2 => Ok(Self::Blosc),
            _ => Err(format!("it is packed by an unknown codec ({number})")),
        }
    }
}

/// A grid as it is stored.
pub(super) struct Packed<'a> {
    pub(super) stored: &'a [u8],
    pub(super) codec: Codec,
    /// Its number of bytes, unpacked.
    pub(super) length: u64,
}

impl<'a> Packed<'a> {
    /// The bytes of the grid.
    pub(super) fn unpack(&self, limit: u64) -> Result<Cow<'a, [u8]>, String> {
        let stored = Bytes(self.stored);
        let unpack = match self.codec {
            Codec::None => return stored.part(0, self.length).map(Cow::Borrowed),
            Codec::Zip => unzip,
            Codec::Blosc => unpack_parts,
        };
        require(self.length, limit)?;
        let length = self.length as usize;
        let unpacked = unpack(stored, length)?;
        if unpacked.len() != length {
            return Err(format!("it is damaged: a grid has not the {length} bytes that it should have"));
        }
        Ok(Cow::Owned(unpacked))
    }
}

/// A stream of zlib after its length. It may be too short or too long.
fn unzip(stored: Bytes, length: usize) -> Result<Vec<u8>, String> {
    let mut unpacked = Vec::with_capacity(length);
    let decoder = ZlibDecoder::new(stored.part(8, stored.u64(0)?)?);
    match decoder.take(length as u64 + 1).read_to_end(&mut unpacked) {
        Ok(_) => Ok(unpacked),
        Err(error) => Err(format!("it is damaged: {error}")),
    }
}

/// Buffers of Blosc, each after its length.
fn unpack_parts(stored: Bytes, length: usize) -> Result<Vec<u8>, String> {
    /// Longer grids are packed in parts of this length.
    const PART: usize = 1 << 30;
    let mut unpacked = Vec::with_capacity(length);
    let mut at = 0;
    while unpacked.len() < length {
        let packed = stored.part(at + 8, stored.u64(at)?)?;
        at += 8 + packed.len();
        blosc::unpack(Bytes(packed), PART.min(length - unpacked.len()), &mut unpacked)?;
    }
    Ok(unpacked)
}

/// Refuses a grid that takes more bytes than are allowed, or than there is memory for.
pub(super) fn require(bytes: u64, limit: u64) -> Result<(), String> {
    if bytes > limit {
        return Err(format!(
            "a grid takes {bytes} bytes; for the length of the file at most {limit} are allowed"
        ));
    }
    image::require_memory(bytes as usize).map_err(|error| error.to_string())
}
