//! The framing of film files: magic number, version, and sections with their lengths and checksums.

use std::io::{self, ErrorKind, Read, Write};

use super::{FilmFileError, VERSION};

/// The first bytes of every film file. The first is not ASCII, and a transfer in text mode would
/// change the line ends.
const MAGIC: [u8; 8] = *b"\x89ALZF\r\n\x1a";

/// Bytes allocated at a time, as the length that a section claims may be wrong.
const STEP: usize = 1 << 20;

/// The tag of a section.
pub type Tag = [u8; 4];

/// Writes sections.
#[derive(Debug)]
pub struct SectionWriter<W> {
    output: W,
}

impl<W: Write> SectionWriter<W> {
    /// Writes magic number and version.
    pub fn new(mut output: W) -> io::Result<Self> {
        output.write_all(&MAGIC)?;
        output.write_all(&VERSION.to_le_bytes())?;
        Ok(Self { output })
    }

    /// Writes a section whose payload is these pieces one after another.
    pub fn write(&mut self, tag: Tag, payload: &[&[u8]]) -> io::Result<()> {
        let length: usize = payload.iter().map(|piece| piece.len()).sum();
        let length = (length as u64).to_le_bytes();
        let mut checksum = crc32fast::Hasher::new();
        for piece in [&tag[..], &length].iter().chain(payload) {
            checksum.update(piece);
            self.output.write_all(piece)?;
        }
        self.output.write_all(&checksum.finalize().to_le_bytes())
    }

    /// Ends writing.
    pub fn finish(mut self) -> io::Result<W> {
        self.output.flush()?;
        Ok(self.output)
    }
}

/// A section that was read, with a valid checksum.
#[derive(Debug)]
pub struct Section {
    /// Its tag.
    pub tag: Tag,
    /// Its payload.
    pub payload: Vec<u8>,
}

impl Section {
    /// The payload's fields.
    pub fn fields(&self) -> Fields<'_> {
        Fields { tag: self.tag, rest: &self.payload }
    }
}

/// Reads sections.
#[derive(Debug)]
pub struct SectionReader<R> {
    input: R,
}

impl<R: Read> SectionReader<R> {
    /// Reads magic number and version.
    pub fn new(mut input: R) -> Result<Self, FilmFileError> {
        let mut magic = [0; MAGIC.len()];
        let mut version = [0; 4];
        match input.read_exact(&mut magic) {
            Err(error) if error.kind() == ErrorKind::UnexpectedEof => return Err(FilmFileError::Foreign),
            Err(error) => return Err(error.into()),
            Ok(()) if magic != MAGIC => return Err(FilmFileError::Foreign),
            Ok(()) => (),
        }
        read_exact(&mut input, *b"HEAD", &mut version)?;
        match u32::from_le_bytes(version) {
            VERSION => Ok(Self { input }),
            other => Err(FilmFileError::Version(other)),
        }
    }

    /// Reads the next section, which must be one of those in `expected`, of at most `max_bytes`.
    pub fn read(&mut self, expected: &[Tag], max_bytes: u64) -> Result<Section, FilmFileError> {
        let (mut tag, mut length) = (Tag::default(), [0; 8]);
        // A missing section is named by the one that is expected.
        read_exact(&mut self.input, expected[0], &mut tag)?;
        if !expected.contains(&tag) {
            let names = expected.iter().map(|&tag| name(tag)).collect::<Vec<_>>().join(" or ");
            return Err(damaged(expected[0], format!("{names} is expected, not {}", name(tag))));
        }
        read_exact(&mut self.input, tag, &mut length)?;
        let claimed = u64::from_le_bytes(length);
        if claimed > max_bytes {
            return Err(damaged(
                tag,
                format!("its length is {claimed} bytes; at most {max_bytes} are possible"),
            ));
        }
        let payload = self.payload(tag, claimed)?;
        let mut written = [0; 4];
        read_exact(&mut self.input, tag, &mut written)?;
        let mut checksum = crc32fast::Hasher::new();
        [&tag[..], &length, &payload].iter().for_each(|piece| checksum.update(piece));
        let (computed, written) = (checksum.finalize(), u32::from_le_bytes(written));
        if computed != written {
            return Err(damaged(tag, format!("its checksum is {computed:08x}, not {written:08x}")));
        }
        Ok(Section { tag, payload })
    }

    /// Reads a payload. Memory grows with the bytes that are read, not with the length that is
    /// claimed.
    fn payload(&mut self, tag: Tag, length: u64) -> Result<Vec<u8>, FilmFileError> {
        let no_memory =
            || FilmFileError::Limits(format!("no memory for the {length} bytes of {}", name(tag)));
        let length = usize::try_from(length).map_err(|_| no_memory())?;
        let mut payload = Vec::new();
        while payload.len() < length {
            let (start, step) = (payload.len(), STEP.min(length - payload.len()));
            payload.try_reserve(step).map_err(|_| no_memory())?;
            payload.resize(start + step, 0);
            read_exact(&mut self.input, tag, &mut payload[start..])?;
        }
        Ok(payload)
    }

    /// Refuses bytes after the last section.
    pub fn finish(mut self) -> Result<(), FilmFileError> {
        match read_exact(&mut self.input, *b"END ", &mut [0]) {
            Ok(()) => Err(damaged(*b"END ", "more bytes follow it".into())),
            Err(FilmFileError::Damaged { .. }) => Ok(()),
            Err(error) => Err(error),
        }
    }
}

fn read_exact(input: &mut impl Read, tag: Tag, bytes: &mut [u8]) -> Result<(), FilmFileError> {
    input.read_exact(bytes).map_err(|error| match error.kind() {
        ErrorKind::UnexpectedEof => damaged(tag, "the file ends early".into()),
        _ => error.into(),
    })
}

fn name(tag: Tag) -> String {
    tag.escape_ascii().to_string().trim_end().to_owned()
}

/// The error that a section is damaged.
pub fn damaged(tag: Tag, problem: String) -> FilmFileError {
    FilmFileError::Damaged { section: name(tag), problem }
}

/// The fields of a payload, read one after another.
#[derive(Debug)]
pub struct Fields<'a> {
    tag: Tag,
    rest: &'a [u8],
}

impl<'a> Fields<'a> {
    /// A number of bytes.
    pub fn bytes(&mut self, count: usize) -> Result<&'a [u8], FilmFileError> {
        let (bytes, rest) = self.rest.split_at_checked(count).ok_or_else(|| self.wrong("it is too short"))?;
        self.rest = rest;
        Ok(bytes)
    }

    /// All bytes that are left.
    pub fn remaining(&mut self) -> &'a [u8] {
        std::mem::take(&mut self.rest)
    }

    /// `N` bytes.
    pub fn array<const N: usize>(&mut self) -> Result<[u8; N], FilmFileError> {
        let bytes = self.bytes(N)?;
        Ok(std::array::from_fn(|index| bytes[index]))
    }

    /// One byte.
    pub fn u8(&mut self) -> Result<u8, FilmFileError> {
        Ok(self.array::<1>()?[0])
    }

    /// Four bytes, a whole number.
    pub fn u32(&mut self) -> Result<u32, FilmFileError> {
        self.array().map(u32::from_le_bytes)
    }

    /// Four bytes, a signed whole number.
    pub fn i32(&mut self) -> Result<i32, FilmFileError> {
        self.array().map(i32::from_le_bytes)
    }

    /// Eight bytes, a whole number.
    pub fn u64(&mut self) -> Result<u64, FilmFileError> {
        self.array().map(u64::from_le_bytes)
    }

    /// Four bytes, a floating-point number that is finite.
    pub fn f32(&mut self) -> Result<f32, FilmFileError> {
        let value = self.array().map(f32::from_le_bytes)?;
        if value.is_finite() { Ok(value) } else { Err(self.wrong(&format!("{value} is not finite"))) }
    }

    /// Eight bytes, a floating-point number that is finite.
    pub fn f64(&mut self) -> Result<f64, FilmFileError> {
        let value = self.array().map(f64::from_le_bytes)?;
        if value.is_finite() { Ok(value) } else { Err(self.wrong(&format!("{value} is not finite"))) }
    }

    /// Text: its length in bytes, four bytes, then UTF-8.
    pub fn text(&mut self) -> Result<&'a str, FilmFileError> {
        let length = self.u32()?;
        let bytes = self.bytes(length as usize)?;
        std::str::from_utf8(bytes).map_err(|_| self.wrong("a text is not UTF-8"))
    }

    /// Refuses bytes that are left over.
    pub fn finish(&self) -> Result<(), FilmFileError> {
        match self.rest.len() {
            0 => Ok(()),
            left => Err(self.wrong(&format!("{left} bytes are left over"))),
        }
    }

    /// The error that this section has this problem.
    pub fn wrong(&self, problem: &str) -> FilmFileError {
        damaged(self.tag, problem.to_owned())
    }
}

/// Appends text as [`Fields::text`] reads it.
pub fn put_text(payload: &mut Vec<u8>, text: &str) {
    payload.extend((text.len() as u32).to_le_bytes());
    payload.extend(text.as_bytes());
}
