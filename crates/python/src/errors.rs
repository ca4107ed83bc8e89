//! Exceptions of Python for errors of files and of values.

use std::io;
use std::path::Path;

use alhazen::film::FilmFileError;
use alhazen::image::ImageError;
use pyo3::exceptions::{PyMemoryError, PyOSError, PyTypeError, PyValueError};
use pyo3::prelude::*;

/// Most characters of a value that a message quotes.
const LONGEST: usize = 80;

/// The exception of the system for a file, such as FileNotFoundError, with its number, text and
/// filename.
pub fn os_error(path: &Path, error: &io::Error) -> PyErr {
    let text = error.to_string();
    let text = text.split(" (os error").next().unwrap_or_default();
    Python::attach(|py| {
        let class = py.get_type::<PyOSError>();
        match class.call1((errno(error), text, path.as_os_str())) {
            Ok(exception) => PyErr::from_value(exception),
            Err(failed) => failed,
        }
    })
}

/// The number of an error, by which Python chooses its class. Windows numbers errors in its own
/// way, but its C library has these.
fn errno(error: &io::Error) -> i32 {
    use io::ErrorKind;
    if let Some(number) = error.raw_os_error().filter(|_| cfg!(unix)) {
        return number;
    }
    match error.kind() {
        ErrorKind::NotFound => 2,
        ErrorKind::PermissionDenied => 13,
        ErrorKind::AlreadyExists => 17,
        ErrorKind::NotADirectory => 20,
        ErrorKind::IsADirectory => 21,
        ErrorKind::InvalidInput => 22,
        ErrorKind::StorageFull => 28,
        _ => 5,
    }
}

/// The exception for an error of pictures that are not in a file.
pub fn image_error(error: ImageError) -> PyErr {
    match error {
        ImageError::Io(error) => error.into(),
        ImageError::Limits(text) => PyMemoryError::new_err(text),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// The exception for an error of a picture's file.
pub fn image_file_error(path: &Path, error: ImageError) -> PyErr {
    match error {
        ImageError::Io(error) => os_error(path, &error),
        ImageError::Limits(text) => PyMemoryError::new_err(format!("{}: {text}", path.display())),
        error => PyValueError::new_err(format!("{}: {error}", path.display())),
    }
}

/// The exception for an error of films that are not in a file.
pub fn film_error(error: FilmFileError) -> PyErr {
    match error {
        FilmFileError::Io(error) => error.into(),
        FilmFileError::Limits(text) => PyMemoryError::new_err(text),
        error => PyValueError::new_err(error.to_string()),
    }
}

/// The exception for an error of a film file.
pub fn film_file_error(path: &Path, error: FilmFileError) -> PyErr {
    match error {
        FilmFileError::Io(error) => os_error(path, &error),
        FilmFileError::Limits(text) => PyMemoryError::new_err(format!("{}: {text}", path.display())),
        error => PyValueError::new_err(format!("{}: {error}", path.display())),
    }
}

/// A value as messages quote it.
pub fn shown(value: &Bound<'_, PyAny>) -> String {
    let text = value.repr().map_or_else(|_| "a value".into(), |text| text.to_string_lossy().into_owned());
    match text.char_indices().nth(LONGEST) {
        Some((end, _)) => format!("{}…", &text[..end]),
        None => text,
    }
}

/// The exception for an argument of a wrong type.
pub fn wrong_type(name: &str, wanted: &str, value: &Bound<'_, PyAny>) -> PyErr {
    PyTypeError::new_err(format!("`{name}` is {wanted}, not {}", shown(value)))
}

/// The exception for an argument of the right type whose value is wrong.
pub fn wrong_value(name: &str, wanted: &str, value: &Bound<'_, PyAny>) -> PyErr {
    PyValueError::new_err(format!("`{name}` is {wanted}, not {}", shown(value)))
}
