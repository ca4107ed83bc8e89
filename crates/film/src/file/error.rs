//! Why a film file could not be written, read or merged.

use std::{fmt, io};

use image::ImageError;

use crate::PassSet;

/// Why a film file could not be written, read or merged.
#[derive(Debug)]
pub enum FilmFileError {
    /// Reading or writing failed.
    Io(io::Error),
    /// The bytes are of another format.
    Foreign,
    /// The file has a version of the format that is not known.
    Version(u32),
    /// The file is damaged or cut short.
    Damaged {
        /// The section: `HEAD`, `FILM`, `ROWS`, `STAT` or `END`.
        section: String,
        /// What is wrong with it.
        problem: String,
    },
    /// The file needs more memory than is allowed or available.
    Limits(String),
    /// The files are of different renders.
    Mismatch(String),
    /// Both files hold these passes.
    Overlap(PassSet),
}

impl fmt::Display for FilmFileError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) if error.kind() == io::ErrorKind::StorageFull => f.write_str("the disk is full"),
            Self::Io(error) => error.fmt(f),
            Self::Foreign => f.write_str("not a film file"),
            Self::Version(version) => {
                let known = super::VERSION;
                write!(f, "a film file of version {version}; this program reads version {known}")
            }
            Self::Damaged { section, problem } => {
                write!(f, "damaged film file: section {section}: {problem}")
            }
            Self::Limits(text) => write!(f, "film file too large: {text}"),
            Self::Mismatch(text) => write!(f, "films of different renders: {text}"),
            Self::Overlap(passes) => write!(f, "both films hold passes {passes}"),
        }
    }
}

impl std::error::Error for FilmFileError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            _ => None,
        }
    }
}

/// The error of a film that does not fit in memory.
impl From<ImageError> for FilmFileError {
    fn from(error: ImageError) -> Self {
        match error {
            ImageError::Limits(problem) => Self::Limits(problem),
            error => Self::Limits(error.to_string()),
        }
    }
}

impl From<io::Error> for FilmFileError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
