//! Scenes.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};

use alhazen::assets::{AssetSource, Files, MemoryAssets};
use alhazen::description::Imported;
use alhazen::description::schema::Settings;
use alhazen::description::{Diagnostic, FileId, SourceMap};
use alhazen::import::{import, is_archive};
use alhazen::pbrt::SceneBuilder;
use alhazen::{ConvertError, Fingerprint, PackError, integrator_names, pack, pack_converted};
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::calls::call;
use crate::errors::{os_error, shown, wrong_type};
use crate::place::{BUILT, Calls};
use crate::warning::warn_of_scene;

create_exception!(
    alhazen,
    SceneError,
    PyException,
    "A scene has errors; the text names all with their places."
);

/// The name of a scene that is loaded from the bytes of an archive.
const ARCHIVE: &str = "scene.zip";

/// The name by which a scene is read from standard input.
const STANDARD_INPUT: &str = "-";

/// How every archive begins.
const ARCHIVE_SIGNATURE: &[u8] = b"PK";

/// A scene, as its author described it. It is compiled anew for each render.
#[pyclass(frozen, module = "alhazen")]
pub struct Scene {
    /// What was read, without errors.
    pub imported: Imported,
    /// The file that it was loaded from.
    pub path: PathBuf,
    /// The hash of all its files.
    pub hash: [u8; 32],
    /// The archive, if it was loaded from one in memory.
    archive: Option<Py<PyBytes>>,
    /// The calls that have built it, if it was built.
    calls: Calls,
}

impl Scene {
    /// The scene of a builder.
    pub fn built(py: Python, builder: SceneBuilder, calls: Calls) -> PyResult<Self> {
        let path = PathBuf::from(BUILT);
        let (imported, hash) = call(py, || {
            let fingerprint = Fingerprint::new(&Files, &path);
            let imported = builder.finish(&fingerprint);
            fingerprint.add(&path, imported.sources.text(FileId(0)));
            (imported, fingerprint.hash())
        })?;
        Self { imported, path, hash, archive: None, calls }.checked(py)
    }

    /// The same, if it has no errors; warns of the rest.
    fn checked(self, py: Python) -> PyResult<Self> {
        let diagnostics = &self.imported.diagnostics;
        match self.imported.has_errors() {
            true => Err(self.error(diagnostics)),
            false => warn_of_scene(py, &self.lines(diagnostics)).map(|()| self),
        }
    }

    /// Whether it was built.
    pub fn is_built(&self) -> bool {
        self.path.as_os_str() == BUILT
    }

    /// The exception for errors of the scene.
    pub fn error(&self, diagnostics: &[Diagnostic]) -> PyErr {
        SceneError::new_err(self.lines(diagnostics).join("\n"))
    }

    /// A line for each diagnostic: place, severity, code, message and help.
    pub fn lines(&self, diagnostics: &[Diagnostic]) -> Vec<String> {
        lines(diagnostics, &self.imported.sources, &self.calls)
    }
}

#[pymethods]
impl Scene {
    /// The file that it was loaded from.
    #[getter]
    fn path(&self) -> &Path {
        &self.path
    }

    /// Warnings of its reading, such as of parameters that have no effect.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.lines(&self.imported.diagnostics)
    }

    /// Width and height of the picture in pixels.
    #[getter]
    fn resolution(&self) -> (i32, i32) {
        self.imported.desc.film.resolution.into()
    }

    /// The bytes of one archive with all its files, as `alhazen scene pack` writes it. load() reads
    /// it, wherever it is. Equal scenes have equal archives.
    fn pack<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        if let Some(archive) = &self.archive {
            return Ok(archive.bind(py).clone());
        }
        if is_archive(&self.path) {
            let bytes = std::fs::read(&self.path).map_err(|error| os_error(&self.path, &error))?;
            return Ok(PyBytes::new(py, &bytes));
        }
        let mut bytes = Vec::new();
        let packed = call(py, || match self.is_built() {
            true => pack_converted(&self.imported.desc, &mut bytes),
            false => pack(&self.path, &Files, &mut bytes).map_err(ConvertError::Pack),
        })?;
        let error = match packed {
            Ok(_) => return Ok(PyBytes::new(py, &bytes)),
            Err(ConvertError::Export(error)) => return Err(PyValueError::new_err(error.to_string())),
            Err(ConvertError::Pack(error)) => error,
        };
        Err(match error {
            PackError::Scene(imported) => {
                let calls = Calls::default();
                SceneError::new_err(lines(&imported.diagnostics, &imported.sources, &calls).join("\n"))
            }
            PackError::File(path, error) => os_error(&path, &error),
            PackError::Output(error) => PyOSError::new_err(error),
        })
    }

    /// The name of its integrator.
    #[getter]
    fn integrator(&self) -> &'static str {
        self.imported.desc.integrator.name()
    }

    fn __repr__(&self) -> String {
        format!("<alhazen.Scene {}, {}>", self.path.display(), self.integrator())
    }
}

/// Loads a scene.
///
/// source: a pbrt-v4 file, a glTF file (.gltf, .glb), a USD file, a mesh (.ply, .obj, .stl) in a
/// neutral studio, or an archive (.zip) of a scene with its files, which may be given as bytes.
///
/// Raises SceneError, whose text lists every error of the scene with its file, line and column, and
/// FileNotFoundError and the like where there is no such file.
#[pyfunction]
pub fn load(py: Python, source: &Bound<'_, PyAny>) -> PyResult<Scene> {
    let archive = source.cast::<PyBytes>().ok();
    let path = match archive {
        Some(bytes) if bytes.as_bytes().starts_with(ARCHIVE_SIGNATURE) => PathBuf::from(ARCHIVE),
        Some(bytes) => {
            let problem = format!("the bytes are no archive of a scene (.zip); they begin {}", shown(bytes));
            return Err(SceneError::new_err(problem));
        }
        None => file(source)?,
    };
    let bytes = archive.map(|bytes| bytes.as_bytes());
    let (imported, hash) = call(py, || match bytes {
        Some(bytes) => read(&path, &MemoryAssets::default().with(ARCHIVE, bytes)),
        None => read(&path, &Files),
    })?;
    let archive = archive.map(|bytes| bytes.clone().unbind());
    Scene { imported, path, hash, archive, calls: Calls::default() }.checked(py)
}

/// The path of a scene file that can be read.
fn file(source: &Bound<'_, PyAny>) -> PyResult<PathBuf> {
    let Ok(path) = source.extract::<PathBuf>() else {
        return Err(wrong_type("source", "the name of a scene file or the bytes of an archive", source));
    };
    let no_name = || {
        let problem = format!("`source` is the name of a file, not the text of a scene: {}", shown(source));
        PyValueError::new_err(problem)
    };
    if path.as_os_str().as_encoded_bytes().contains(&b'\n') {
        return Err(no_name());
    }
    if path == Path::new(STANDARD_INPUT) {
        return Ok(path);
    }
    // A pipe is not opened, since it could be read only once.
    let readable = std::fs::metadata(&path).and_then(|found| match found.is_file() {
        true => std::fs::File::open(&path).map(|_| ()),
        false if found.is_dir() => Err(ErrorKind::IsADirectory.into()),
        false => Ok(()),
    });
    match readable {
        Ok(()) => Ok(path),
        // It is too long.
        Err(error) if error.kind() == ErrorKind::InvalidFilename => Err(no_name()),
        Err(error) => Err(os_error(&path, &error)),
    }
}

fn read(path: &Path, assets: &dyn AssetSource) -> (Imported, [u8; 32]) {
    let fingerprint = Fingerprint::new(assets, path);
    let imported = import(path, &fingerprint);
    (imported, fingerprint.hash())
}

/// The names of all integrators.
#[pyfunction]
pub fn integrators() -> Vec<&'static str> {
    integrator_names()
}

fn lines(diagnostics: &[Diagnostic], sources: &SourceMap, calls: &Calls) -> Vec<String> {
    let line = |diagnostic: &Diagnostic| {
        let span = diagnostic.span();
        let place = match calls.describe(sources, span) {
            _ if span.is_none() => String::new(),
            Some(call) => format!("{call}: "),
            None => {
                let at = sources.position(span);
                format!("{}:{}:{}: ", sources.name(span.file), at.line, at.column)
            }
        };
        let severity = if diagnostic.is_error() { "error" } else { "warning" };
        let help = diagnostic.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        format!("{place}{severity}[{}]: {}{help}", diagnostic.code, diagnostic.message)
    };
    diagnostics.iter().map(line).collect()
}
