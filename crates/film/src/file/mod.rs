//! Film files: the state of a render, from which it can be resumed, or merged with other parts.
//!
//! A file holds a [`FilmHeader`] (which scene, which settings, which passes), the picture's
//! [`Film`] with all its sums exactly, films that an algorithm fills beside it, and opaque states
//! of algorithms. As sums are exact, films of any split of the passes merge to the bits of the
//! whole. The bytes are documented in `docs/formats/film.md`.
//!
//! Writing needs no copy of the film:
//!
//! ```
//! # use alhazen_film::{Film, FilmFile, FilmFileError, FilmHeader, FilmWriter};
//! # use alhazen_film::{PassSet, ReadLimits};
//! # fn example(film: &Film) -> Result<(), FilmFileError> {
//! let header = FilmHeader {
//!     scene_hash: [0; 32],
//!     settings: r#"{"scene": "room.pbrt"}"#.into(),
//!     seed: 0,
//!     planned: 64,
//!     done: PassSet::from(0..16),
//! };
//! let mut writer = FilmWriter::new(Vec::new(), &header, film)?;
//! writer.state("chains", &header.done, b"any bytes")?;
//! let bytes = writer.finish()?;
//!
//! let limits = ReadLimits::for_file(bytes.len() as u64);
//! let mut whole = FilmFile::read(&bytes[..], &limits)?;
//! assert_eq!(whole.header, header);
//! // Another part of the same render is added to it with `whole.merge(&other[..], &limits)`.
//! # Ok(())
//! # }
//! ```

mod error;
mod layers;
mod section;
mod settings;

use std::io::{Read, Write};

use rayon::prelude::*;

use crate::{Film, PassSet};

pub use error::FilmFileError;
use section::{Fields, Section, SectionReader, SectionWriter, damaged, put_text};

/// The version of the format that is written, and the only one that is read.
const VERSION: u32 = 2;

const HEADER: section::Tag = *b"HEAD";
const FILM: section::Tag = *b"FILM";
const ROWS: section::Tag = *b"ROWS";
const STATE: section::Tag = *b"STAT";
const END: section::Tag = *b"END ";

/// As many rows of tiles are encoded at once.
const ROWS_AT_ONCE: usize = 16;

/// The most bytes that a header, or the settings of a film, take.
const MAX_SETTINGS: u64 = 16 << 20;

/// The render that a film file is part of.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct FilmHeader {
    /// A hash of the scene's content, which identifies the scene.
    pub scene_hash: [u8; 32],
    /// What is needed to resume the render and to write pictures, in the caller's own format. Files
    /// whose settings differ cannot be merged. At most 16 MiB with the rest of the header.
    pub settings: String,
    /// The seed of the random numbers.
    pub seed: u64,
    /// The number of passes of the whole picture.
    pub planned: u32,
    /// The passes that the films hold.
    pub done: PassSet,
}

impl FilmHeader {
    /// Whether films of the two can be merged: they are of the same render, and no pass is in both.
    pub fn check_merge(&self, other: &Self) -> Result<(), FilmFileError> {
        let differs = |what: &str| Err(FilmFileError::Mismatch(format!("{what} differ")));
        if self.scene_hash != other.scene_hash {
            return differs("the scenes");
        } else if self.settings != other.settings {
            return differs("the settings");
        } else if self.seed != other.seed {
            return differs("the seeds");
        } else if self.planned != other.planned {
            return differs("the numbers of planned passes");
        }
        let both = self.done.intersection(&other.done);
        if both.is_empty() { Ok(()) } else { Err(FilmFileError::Overlap(both)) }
    }

    fn to_payload(&self) -> Vec<u8> {
        let mut payload = self.scene_hash.to_vec();
        payload.extend(self.seed.to_le_bytes());
        payload.extend(self.planned.to_le_bytes());
        put_passes(&mut payload, &self.done);
        put_text(&mut payload, &self.settings);
        payload
    }

    fn from_section(section: &Section) -> Result<Self, FilmFileError> {
        let mut fields = section.fields();
        let (scene_hash, seed, planned) = (fields.array()?, fields.u64()?, fields.u32()?);
        let (done, settings) = (passes(&mut fields)?, fields.text()?.to_owned());
        fields.finish()?;
        Ok(Self { scene_hash, settings, seed, planned, done })
    }
}

/// The state of an algorithm, which only the algorithm itself can read.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct State {
    /// Its name.
    pub name: String,
    /// The passes after which it was saved.
    pub passes: PassSet,
    /// Its bytes.
    pub bytes: Vec<u8>,
}

/// Limits of the memory that a film file may take when it is read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ReadLimits {
    /// Bytes of films and states together.
    pub max_bytes: u64,
}

impl Default for ReadLimits {
    /// 64 GiB.
    fn default() -> Self {
        Self { max_bytes: 64 << 30 }
    }
}

impl ReadLimits {
    /// The limits for a file of this length: the most that its films can take, so that a short file
    /// that claims a huge film is refused.
    pub fn for_file(length: u64) -> Self {
        // A tile has a byte at least for each component of 256 pixels of 16 bytes.
        const GREATEST_RATIO: u64 = 8192;
        Self { max_bytes: length.saturating_mul(GREATEST_RATIO) }
    }

    /// Deducts the memory of a film or a state.
    fn take(&mut self, bytes: u64, what: &str) -> Result<(), FilmFileError> {
        let left = self.max_bytes.checked_sub(bytes).ok_or_else(|| {
            FilmFileError::Limits(format!("{what} needs {bytes} bytes, of which {} are left", self.max_bytes))
        })?;
        self.max_bytes = left;
        Ok(())
    }
}

/// Writes a film file, section by section.
#[derive(Debug)]
pub struct FilmWriter<W> {
    sections: SectionWriter<W>,
}

impl<W: Write> FilmWriter<W> {
    /// Begins a file with its header and the picture's film. Many small pieces are written, so that
    /// a file is best wrapped in a `BufWriter`.
    pub fn new(output: W, header: &FilmHeader, picture: &Film) -> Result<Self, FilmFileError> {
        let mut sections = SectionWriter::new(output)?;
        let payload = header.to_payload();
        if payload.len() as u64 > MAX_SETTINGS {
            return Err(FilmFileError::Limits(format!("a header of {} bytes", payload.len())));
        }
        sections.write(HEADER, &[&payload])?;
        let mut writer = Self { sections };
        writer.film("", picture)?;
        Ok(writer)
    }

    /// Adds a film that is filled beside the picture. Its name is its own.
    pub fn film(&mut self, name: &str, film: &Film) -> Result<(), FilmFileError> {
        let mut payload = Vec::new();
        put_text(&mut payload, name);
        settings::put(&mut payload, film);
        layers::put_totals(&mut payload, film);
        self.sections.write(FILM, &[&payload])?;
        let rows: Vec<usize> = (0..film.grid.rows()).collect();
        for some in rows.chunks(ROWS_AT_ONCE) {
            let payloads: Vec<_> = some.par_iter().map(|&row| layers::row(film, row)).collect();
            payloads.iter().try_for_each(|payload| self.sections.write(ROWS, &[payload]))?;
        }
        Ok(())
    }

    /// Adds the state of an algorithm after these passes. States come after all films.
    pub fn state(&mut self, name: &str, passes: &PassSet, bytes: &[u8]) -> Result<(), FilmFileError> {
        let mut start = Vec::new();
        put_text(&mut start, name);
        put_passes(&mut start, passes);
        Ok(self.sections.write(STATE, &[&start, bytes])?)
    }

    /// Ends the file; without this it counts as truncated.
    pub fn finish(mut self) -> Result<W, FilmFileError> {
        self.sections.write(END, &[])?;
        Ok(self.sections.finish()?)
    }
}

/// The contents of a film file.
#[derive(Debug)]
pub struct FilmFile {
    /// The render, and the passes of it that the films hold.
    pub header: FilmHeader,
    /// The film of the picture.
    pub picture: Film,
    /// The films that are filled beside it, by name.
    pub films: Vec<(String, Film)>,
    /// States of algorithms; several of a name where files were merged.
    pub states: Vec<State>,
}

impl FilmFile {
    /// Reads the header alone, of a file's beginning.
    pub fn read_header(input: impl Read) -> Result<FilmHeader, FilmFileError> {
        FilmHeader::from_section(&SectionReader::new(input)?.read(&[HEADER], MAX_SETTINGS)?)
    }

    /// Reads a file. Many small pieces are read, so that a file is best wrapped in a `BufReader`.
    pub fn read(input: impl Read, limits: &ReadLimits) -> Result<Self, FilmFileError> {
        let mut sections = SectionReader::new(input)?;
        let header = FilmHeader::from_section(&sections.read(&[HEADER], MAX_SETTINGS)?)?;
        let mut limits = *limits;
        let mut films: Vec<(String, Film)> = Vec::new();
        let mut section = sections.read(&[FILM], MAX_SETTINGS)?;
        while section.tag == FILM {
            let mut fields = section.fields();
            let name = fields.text()?.to_owned();
            if films.iter().any(|(other, _)| *other == name) {
                return Err(fields.wrong(&format!("there are two films `{name}`")));
            }
            let mut film = settings::read(&mut fields, &mut limits)?;
            add_rows(&mut film, fields, &mut sections, limits.max_bytes)?;
            films.push((name, film));
            section = sections.read(&[END, FILM, STATE], limits.max_bytes.max(MAX_SETTINGS))?;
        }
        let states = read_states(section, &mut sections, &mut limits)?;
        sections.finish()?;
        let (name, picture) = films.remove(0);
        if !name.is_empty() {
            return Err(damaged(FILM, format!("the first film is `{name}`, not the picture")));
        }
        Ok(Self { header, picture, films, states })
    }

    /// Adds another file of the same render, without holding its films in memory a second time.
    /// States are collected, as only their algorithms can merge them.
    ///
    /// After an error that [`FilmHeader::check_merge`] does not detect, the films may hold a part
    /// of the other file and must not be used.
    pub fn merge(&mut self, input: impl Read, limits: &ReadLimits) -> Result<(), FilmFileError> {
        let mut sections = SectionReader::new(input)?;
        let header = FilmHeader::from_section(&sections.read(&[HEADER], MAX_SETTINGS)?)?;
        self.header.check_merge(&header)?;
        let mut limits = *limits;
        let mut merged = Vec::new();
        let mut section = sections.read(&[FILM], MAX_SETTINGS)?;
        while section.tag == FILM {
            let mut fields = section.fields();
            let name = fields.text()?.to_owned();
            if merged.contains(&name) {
                return Err(fields.wrong(&format!("there are two films `{name}`")));
            }
            let missing = || FilmFileError::Mismatch(format!("only one has a film `{name}`"));
            let film = match name.as_str() {
                "" => &mut self.picture,
                name => self
                    .films
                    .iter_mut()
                    .find(|film| film.0 == name)
                    .map(|film| &mut film.1)
                    .ok_or_else(missing)?,
            };
            settings::check(&mut fields, film)?;
            add_rows(film, fields, &mut sections, limits.max_bytes)?;
            merged.push(name);
            section = sections.read(&[END, FILM, STATE], limits.max_bytes.max(MAX_SETTINGS))?;
        }
        let unmerged = self.films.iter().map(|film| film.0.as_str()).chain([""]);
        if let Some(name) = unmerged.into_iter().find(|name| !merged.iter().any(|other| other == name)) {
            return Err(FilmFileError::Mismatch(format!("only one has a film `{name}`")));
        }
        self.states.extend(read_states(section, &mut sections, &mut limits)?);
        sections.finish()?;
        self.header.done = self.header.done.union(&header.done);
        Ok(())
    }

    /// Writes the file again.
    pub fn write<W: Write>(&self, output: W) -> Result<W, FilmFileError> {
        let mut writer = FilmWriter::new(output, &self.header, &self.picture)?;
        self.films.iter().try_for_each(|(name, film)| writer.film(name, film))?;
        self.states.iter().try_for_each(|state| writer.state(&state.name, &state.passes, &state.bytes))?;
        writer.finish()
    }
}

/// Adds the sums of a film in a file: the totals that its own section ends with, then those of its
/// rows of tiles.
fn add_rows<R: Read>(
    film: &mut Film,
    mut fields: Fields,
    sections: &mut SectionReader<R>,
    max_bytes: u64,
) -> Result<(), FilmFileError> {
    layers::add_totals(&mut fields, film)?;
    fields.finish()?;
    for row in 0..film.grid.rows() {
        let section = sections.read(&[ROWS], layers::max_row_bytes(film, max_bytes))?;
        let mut fields = section.fields();
        layers::add_row(&mut fields, film, row)?;
        fields.finish()?;
    }
    Ok(())
}

/// The states that follow the films, of which this section is the first, up to the end.
fn read_states<R: Read>(
    mut section: Section,
    sections: &mut SectionReader<R>,
    limits: &mut ReadLimits,
) -> Result<Vec<State>, FilmFileError> {
    let mut states = Vec::new();
    while section.tag == STATE {
        limits.take(section.payload.len() as u64, "a state")?;
        let mut fields = section.fields();
        let (name, passes) = (fields.text()?.to_owned(), passes(&mut fields)?);
        states.push(State { name, passes, bytes: fields.remaining().to_vec() });
        section = sections.read(&[END, STATE], limits.max_bytes)?;
    }
    section.fields().finish()?;
    Ok(states)
}

fn put_passes(payload: &mut Vec<u8>, passes: &PassSet) {
    payload.extend((passes.ranges().len() as u32).to_le_bytes());
    for range in passes.ranges() {
        payload.extend(range.start.to_le_bytes());
        payload.extend(range.end.to_le_bytes());
    }
}

fn passes(fields: &mut Fields) -> Result<PassSet, FilmFileError> {
    let mut ranges = Vec::new();
    for _ in 0..fields.u32()? {
        ranges.push(fields.u32()?..fields.u32()?);
    }
    PassSet::from_sorted(ranges).ok_or_else(|| fields.wrong("its passes are not in order"))
}
