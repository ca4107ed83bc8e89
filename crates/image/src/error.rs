//! Why an image could not be read or written.

use std::{fmt, io};

/// Why an image could not be read or written.
#[derive(Debug)]
pub enum ImageError {
    /// Reading or writing failed.
    Io(io::Error),
    /// The bytes contradict their format, or the request contradicts the image.
    Invalid(String),
    /// The bytes may be right, but this crate does not read or write that kind.
    Unsupported(String),
    /// The image is larger than allowed.
    Limits(String),
}

impl fmt::Display for ImageError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Io(error) if error.kind() == io::ErrorKind::StorageFull => f.write_str("the disk is full"),
            Self::Io(error) => error.fmt(f),
            Self::Invalid(text) => write!(f, "invalid image: {text}"),
            Self::Unsupported(text) => write!(f, "unsupported image: {text}"),
            Self::Limits(text) => write!(f, "image too large: {text}"),
        }
    }
}

impl std::error::Error for ImageError {
    fn source(&self) -> Option<&(dyn std::error::Error + 'static)> {
        match self {
            Self::Io(error) => Some(error),
            _ => None,
        }
    }
}

impl From<io::Error> for ImageError {
    fn from(error: io::Error) -> Self {
        Self::Io(error)
    }
}
