//! Films: renders whose passes can still be merged.

use std::fs::File;
use std::io::{BufReader, BufWriter};
use std::path::PathBuf;
use std::sync::{Mutex, MutexGuard, PoisonError};

use alhazen::SavedRender;
use alhazen::film::{FilmFileError, ReadLimits};
use alhazen::image::replace_file_with;
use pyo3::prelude::*;
use pyo3::types::{PyBytes, PyTuple};

use crate::calls::call;
use crate::errors::{film_error, film_file_error, image_error, wrong_type};
use crate::picture::Picture;

/// The film of a render or of some of its shards, with exact sums: merged in any order, shards give
/// the bits of the whole. It is what the command line writes with --checkpoint.
#[pyclass(frozen, module = "alhazen")]
pub struct Film(Mutex<Contents>);

struct Contents {
    /// Its file, read when more than bytes is asked for: shards travel as they are. Else empty.
    file: Vec<u8>,
    saved: Option<SavedRender>,
}

impl Film {
    /// A film of the bytes of a film file.
    pub fn of_file(file: Vec<u8>) -> Self {
        Self(Mutex::new(Contents { file, saved: None }))
    }

    fn new(saved: SavedRender) -> Self {
        Self(Mutex::new(Contents { file: Vec::new(), saved: Some(saved) }))
    }

    fn contents(&self) -> MutexGuard<'_, Contents> {
        self.0.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Uses the film without Python's lock.
    fn with<T: Send>(
        &self,
        py: Python,
        use_it: impl FnOnce(&mut SavedRender) -> Result<T, FilmFileError> + Send,
    ) -> PyResult<T> {
        let done = call(py, || {
            let Contents { file, saved } = &mut *self.contents();
            match saved {
                Some(saved) => use_it(saved),
                None => {
                    let saved = saved.insert(read(file)?);
                    *file = Vec::new();
                    use_it(saved)
                }
            }
        });
        done?.map_err(film_error)
    }
}

fn read(bytes: &[u8]) -> Result<SavedRender, FilmFileError> {
    SavedRender::read(bytes, &ReadLimits::for_file(bytes.len() as u64))
}

#[pymethods]
impl Film {
    /// Reads a film file.
    ///
    /// path: the file.
    #[staticmethod]
    fn open(py: Python, path: PathBuf) -> PyResult<Self> {
        let saved = call(py, || {
            let file = File::open(&path)?;
            let limits = ReadLimits::for_file(file.metadata()?.len());
            SavedRender::read(BufReader::new(file), &limits)
        });
        Ok(Self::new(saved?.map_err(|error| film_file_error(&path, error))?))
    }

    /// A film of the bytes of a film file.
    ///
    /// data: the bytes.
    #[staticmethod]
    fn from_bytes(py: Python, data: &[u8]) -> PyResult<Self> {
        Ok(Self::new(call(py, || read(data))?.map_err(film_error)?))
    }

    /// The bytes of its film file.
    fn __bytes__<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = call(py, || match &*self.contents() {
            Contents { saved: Some(saved), .. } => saved.write(Vec::new()),
            Contents { file, .. } => Ok(file.clone()),
        });
        Ok(PyBytes::new(py, &bytes?.map_err(film_error)?))
    }

    /// Writes its film file.
    ///
    /// path: the file. One that is there is replaced only when the new one is whole.
    fn write(&self, py: Python, path: PathBuf) -> PyResult<()> {
        let written = self.with(py, |saved| {
            Ok(replace_file_with(&path, |file| saved.write(BufWriter::new(file)).map(|_| ())))
        })?;
        written.map_err(|error: FilmFileError| film_file_error(&path, error))
    }

    /// Adds another film of the same render. Raises ValueError, and leaves this one as it was, if
    /// it is of another render or has passes that this one has.
    ///
    /// other: a Film, or the bytes of a film file.
    fn merge(&self, py: Python, other: &Bound<'_, PyAny>) -> PyResult<()> {
        let bytes = match other.cast::<Self>() {
            Ok(film) => film.get().__bytes__(py)?,
            Err(_) => other
                .clone()
                .cast_into::<PyBytes>()
                .map_err(|_| wrong_type("other", "a Film or the bytes of a film file", other))?,
        };
        let data = bytes.as_bytes();
        let limits = ReadLimits::for_file(data.len() as u64);
        self.with(py, |saved| saved.merge(data, &limits))
    }

    /// The number of passes that it has.
    #[getter]
    fn passes(&self, py: Python) -> PyResult<u32> {
        self.with(py, |saved| Ok(saved.done().count()))
    }

    /// The number of passes of the whole render; None where only time or noise ends it.
    #[getter]
    fn planned(&self, py: Python) -> PyResult<Option<u32>> {
        self.with(py, |saved| Ok(Some(saved.order().passes).filter(|&passes| passes != u32::MAX)))
    }

    /// The shards that it has, as (index, count).
    #[getter]
    fn shards(&self, py: Python) -> PyResult<Vec<(u32, u32)>> {
        self.with(py, |saved| Ok(saved.shards().iter().map(|shard| (shard.index, shard.count)).collect()))
    }

    /// The shards and passes that it lacks, by name; it is whole if there are none.
    #[getter]
    fn missing(&self, py: Python) -> PyResult<Vec<String>> {
        self.with(py, |saved| Ok(saved.missing()))
    }

    /// The estimated relative standard error of its picture; None if its passes do not alternate
    /// between two films, or are too few.
    #[getter]
    fn noise(&self, py: Python) -> PyResult<Option<f64>> {
        self.with(py, |saved| Ok(saved.noise()))
    }

    /// The picture of its passes.
    fn image(&self, py: Python) -> PyResult<Picture> {
        let collected = self.with(py, |saved| Ok(Picture::collect(&saved.development())))?;
        Picture::new(py, collected.map_err(image_error)?)
    }

    /// For pickle.
    fn __reduce__<'py>(slf: &Bound<'py, Self>, py: Python<'py>) -> PyResult<Bound<'py, PyTuple>> {
        let make = slf.get_type().getattr("from_bytes")?;
        PyTuple::new(py, [make, PyTuple::new(py, [slf.get().__bytes__(py)?])?.into_any()])
    }

    fn __repr__(&self, py: Python) -> PyResult<String> {
        Ok(format!("<alhazen.Film of {} passes>", self.passes(py)?))
    }
}
