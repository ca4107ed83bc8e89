//! Volumes in the NanoVDB format ([Museth 2021]): grids of numbers on sparse voxels, which hold a
//! tree of three levels of nodes ([Museth 2013]).
//!
//! A file has segments of grids, each grid with its name and packed by one of three codecs; or it
//! is nothing but the grids. Grids are read one by one, by name. All offsets and sizes are checked,
//! and the length of a file limits the memory that its grids take.

mod blosc;
mod bytes;
mod grid;
mod header;
mod tree;
mod unpack;
mod values;

use description::VoxelsDesc;

use bytes::Bytes;
use unpack::{Codec, Packed};

/// The first bytes of grids and files until version 32.6, and later of grids and of files.
const MAGIC: [&[u8; 8]; 3] = [b"NanoVDB0", b"NanoVDB1", b"NanoVDB2"];

/// The version of the layout. It is the upper 11 bits of a version.
const MAJOR: u32 = 32;

/// The grids of a file, not decoded yet.
pub struct Volumes<'a> {
    grids: Vec<(String, Packed<'a>)>,
    /// The most bytes that a grid may take.
    limit: u64,
}

impl<'a> Volumes<'a> {
    /// Lists the grids of a file; on failure, the reason.
    pub fn open(file: &'a [u8]) -> Result<Self, String> {
        /// No codec packs more bytes into one. A smaller file with a larger grid is damaged.
        const GREATEST_RATIO: u64 = 1032;
        const ALWAYS_ALLOWED: u64 = 64 << 20;
        const NEVER_ALLOWED: u64 = 16 << 30;

        let bytes = Bytes(file);
        let grids = if holds_bare_grids(bytes)? { bare_grids(bytes)? } else { segments(bytes)? };
        let limit = (file.len() as u64).saturating_mul(GREATEST_RATIO);
        Ok(Self { grids, limit: limit.clamp(ALWAYS_ALLOWED, NEVER_ALLOWED) })
    }

    /// The names of the grids.
    pub fn names(&self) -> impl Iterator<Item = &str> + Clone {
        self.grids.iter().map(|(name, _)| name.as_str())
    }

    /// Decodes the first grid of a name, if there is one; on failure, the reason.
    pub fn read(&self, name: &str) -> Option<Result<VoxelsDesc, String>> {
        let (_, packed) = self.grids.iter().find(|(known, _)| known == name)?;
        Some(packed.unpack(self.limit).and_then(|bytes| grid::read(Bytes(&bytes), self.limit)))
    }
}

/// Whether a file starts with a grid instead of with the header of a segment.
fn holds_bare_grids(bytes: Bytes) -> Result<bool, String> {
    let magic = bytes.array(0)?;
    if &magic == MAGIC[0] {
        // The first versions without segments had no magic of their own. A version follows, which
        // in a grid comes after its checksum.
        return Ok(bytes.u32(8)? >> 21 != MAJOR && bytes.u32(16)? >> 21 == MAJOR);
    }
    if &magic == MAGIC[1] || &magic == MAGIC[2] {
        return Ok(&magic == MAGIC[1]);
    }
    let reversed: Vec<u8> = magic.iter().rev().copied().collect();
    Err(if MAGIC.iter().any(|known| known[..] == reversed) {
        "its numbers are big-endian, which is not supported".into()
    } else if magic == *b" BDV\0\0\0\0" {
        "it is an OpenVDB file; `nanovdb_convert`, which comes with OpenVDB, makes a NanoVDB file of it"
            .into()
    } else {
        "it is not a NanoVDB file".into()
    })
}

fn check_version(version: u32) -> Result<(), String> {
    let (major, minor) = (version >> 21, version >> 10 & 0x7ff);
    if major == MAJOR {
        return Ok(());
    }
    Err(format!("it is of version {major}.{minor} of the format; versions {MAJOR}.x are supported"))
}

/// The grids of a file that is a sequence of grids.
fn bare_grids(bytes: Bytes) -> Result<Vec<(String, Packed)>, String> {
    let mut grids = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let header = header::Header::read(Bytes(bytes.part(at, header::SIZE as u64)?))?;
        let name = header.name;
        let length = header.length.max(header::SIZE as u64);
        let stored = bytes.part(at, length)?;
        grids.push((name, Packed { stored, codec: Codec::None, length }));
        at += stored.len();
    }
    Ok(grids)
}

/// The grids of a file of segments. A segment is a header, for each grid some facts and its name,
/// and the grids.
fn segments(bytes: Bytes) -> Result<Vec<(String, Packed)>, String> {
    const HEADER: usize = 16;
    const FACTS: usize = 176;

    let mut grids = Vec::new();
    let mut at = 0;
    while at < bytes.len() {
        let magic = bytes.array(at)?;
        if &magic != MAGIC[0] && &magic != MAGIC[2] {
            return Err(format!("it is damaged: no segment begins at its byte {at}"));
        }
        check_version(bytes.u32(at + 8)?)?;
        let count = bytes.u16(at + 12)?;
        let codec = Codec::numbered(bytes.u16(at + 14)?)?;
        at += HEADER;
        let mut listed = Vec::new();
        for _ in 0..count {
            let [length, stored] = [bytes.u64(at)?, bytes.u64(at + 8)?];
            let name = bytes.part(at + FACTS, bytes.u32(at + 136)?.into())?;
            at += FACTS + name.len();
            listed.push((bytes::text(name), length, stored));
        }
        for (name, length, stored) in listed {
            let stored = bytes.part(at, stored)?;
            at += stored.len();
            grids.push((name, Packed { stored, codec, length }));
        }
    }
    Ok(grids)
}
