//! Scenes.

use std::path::{Path, PathBuf};

use alhazen::description::schema::Settings;
use alhazen::description::{Diagnostic, FileId, SourceMap, Span};
use alhazen::import::{AssetSource, Files, Imported, MemoryAssets, SceneBuilder, import, is_archive};
use alhazen::{ConvertError, Fingerprint, PackError, integrator_names, pack, pack_converted};
use pyo3::create_exception;
use pyo3::exceptions::{PyException, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;

use crate::calls::call;
use crate::warning::warn_of_scene;

create_exception!(
    alhazen,
    SceneError,
    PyException,
    "A scene has errors; the text names all with their places."
);

/// The name of a scene that is loaded from the bytes of an archive.
const ARCHIVE: &str = "scene.zip";

/// The name of a scene that was built.
const BUILT: &str = "<scene>";

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
}

impl Scene {
    /// The scene of a builder.
    pub fn built(py: Python, builder: SceneBuilder) -> PyResult<Self> {
        let path = PathBuf::from(BUILT);
        let (imported, hash) = call(py, || {
            let fingerprint = Fingerprint::new(&Files, &path);
            let imported = builder.finish(&fingerprint);
            fingerprint.add(&path, imported.sources.text(FileId(0)));
            (imported, fingerprint.hash())
        })?;
        check(py, &imported)?;
        Ok(Self { imported, path, hash, archive: None })
    }
}

#[pymethods]
impl Scene {
    /// The file that it was loaded from.
    #[getter]
    fn path(&self) -> &Path {
        &self.path
    }

    /// What was found while it was read, such as parameters that have no effect.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        lines(&self.imported.diagnostics, &self.imported.sources)
    }

    /// Width and height of the picture in pixels.
    #[getter]
    fn resolution(&self) -> [i32; 2] {
        self.imported.desc.film.resolution
    }

    /// The bytes of one archive with all its files, as `alhazen scene pack` writes it. load() reads
    /// it, wherever it is. Equal scenes have equal archives.
    fn pack<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        if let Some(archive) = &self.archive {
            return Ok(archive.bind(py).clone());
        }
        if is_archive(&self.path) {
            return Ok(PyBytes::new(py, &std::fs::read(&self.path)?));
        }
        let mut bytes = Vec::new();
        let packed = call(py, || match self.path.as_os_str() == BUILT {
            true => pack_converted(&self.imported.desc, &mut bytes),
            false => pack(&self.path, &Files, &mut bytes).map_err(ConvertError::Pack),
        })?;
        let error = match packed {
            Ok(_) => return Ok(PyBytes::new(py, &bytes)),
            Err(ConvertError::Export(error)) => return Err(PyValueError::new_err(error.to_string())),
            Err(ConvertError::Pack(error)) => error,
        };
        Err(match error {
            PackError::Scene(imported) => scene_error(&imported.diagnostics, &imported.sources),
            PackError::File(path, error) => PyOSError::new_err(format!("{}: {error}", path.display())),
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

/// Loads a scene: a pbrt-v4 file, a glTF file (.gltf, .glb), a USD file, a mesh (.ply, .obj, .stl)
/// in a neutral studio, or an archive (.zip) of a scene with its files, which may be given as
/// bytes.
///
/// Raises SceneError, whose text lists every error of the scene with its file, line and column.
#[pyfunction]
pub fn load(py: Python, source: &Bound<'_, PyAny>) -> PyResult<Scene> {
    let archive = source.cast::<PyBytes>().ok();
    let path = match archive {
        Some(_) => PathBuf::from(ARCHIVE),
        None => source.extract::<PathBuf>()?,
    };
    let bytes = archive.map(|bytes| bytes.as_bytes());
    let (imported, hash) = call(py, || match bytes {
        Some(bytes) => read(&path, &MemoryAssets::default().with(ARCHIVE, bytes)),
        None => read(&path, &Files),
    })?;
    check(py, &imported)?;
    Ok(Scene { imported, path, hash, archive: archive.map(|bytes| bytes.clone().unbind()) })
}

fn read(path: &Path, assets: &dyn AssetSource) -> (Imported, [u8; 32]) {
    let fingerprint = Fingerprint::new(assets, path);
    let imported = import(path, &fingerprint);
    (imported, fingerprint.hash())
}

/// An error where a scene has any; warns of the rest.
fn check(py: Python, imported: &Imported) -> PyResult<()> {
    let Imported { diagnostics, sources, .. } = imported;
    match imported.has_errors() {
        true => Err(scene_error(diagnostics, sources)),
        false => warn_of_scene(py, &lines(diagnostics, sources)),
    }
}

/// The names of all integrators.
#[pyfunction]
pub fn integrators() -> Vec<&'static str> {
    integrator_names()
}

/// The exception for a scene with errors.
pub fn scene_error(diagnostics: &[Diagnostic], sources: &SourceMap) -> PyErr {
    SceneError::new_err(lines(diagnostics, sources).join("\n"))
}

/// The statement of a scene that was built: its directive and type.
fn statement(sources: &SourceMap, span: Span) -> Option<String> {
    let line = (sources.name(span.file) == BUILT).then(|| sources.line(span))?;
    Some(line.split(' ').take(2).take_while(|word| *word != "at").collect::<Vec<_>>().join(" "))
}

/// A line for each diagnostic: place, severity, code, message and help.
pub fn lines(diagnostics: &[Diagnostic], sources: &SourceMap) -> Vec<String> {
    let line = |diagnostic: &Diagnostic| {
        let span = diagnostic.span();
        let place = if span.is_none() {
            String::new()
        } else {
            let at = sources.position(span);
            let statement = statement(sources, span).map_or(String::new(), |it| format!("in {it}: "));
            format!("{}:{}:{}: {statement}", sources.name(span.file), at.line, at.column)
        };
        let severity = if diagnostic.is_error() { "error" } else { "warning" };
        let help = diagnostic.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        format!("{place}{severity}[{}]: {}{help}", diagnostic.code, diagnostic.message)
    };
    diagnostics.iter().map(line).collect()
}
