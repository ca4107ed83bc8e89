//! Scenes.

use std::path::{Path, PathBuf};

use alhazen::description::schema::Settings;
use alhazen::description::{Diagnostic, SourceMap};
use alhazen::import::{Files, Imported, import};
use alhazen::integrator_names;
use pyo3::create_exception;
use pyo3::exceptions::PyException;
use pyo3::prelude::*;

create_exception!(
    alhazen,
    SceneError,
    PyException,
    "A scene has errors; the text names all with their places."
);

/// A scene, as its author described it. It is compiled anew for each render.
#[pyclass(frozen, module = "alhazen")]
pub struct Scene {
    /// What was read, without errors.
    pub imported: Imported,
    path: PathBuf,
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

    /// The name of its integrator.
    #[getter]
    fn integrator(&self) -> &'static str {
        self.imported.desc.integrator.name()
    }

    fn __repr__(&self) -> String {
        format!("<alhazen.Scene {}, {}>", self.path.display(), self.integrator())
    }
}

/// Loads a scene: a pbrt-v4 file, a glTF file (.gltf, .glb), or a mesh (.ply, .obj) in a neutral
/// studio.
///
/// Raises SceneError, whose text lists every error of the scene with its file, line and column.
#[pyfunction]
pub fn load(py: Python, path: PathBuf) -> PyResult<Scene> {
    let imported = py.detach(|| import(&path, &Files));
    if imported.has_errors() {
        return Err(scene_error(&imported.diagnostics, &imported.sources));
    }
    Ok(Scene { imported, path })
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

/// A line for each diagnostic: place, severity, code, message and help.
fn lines(diagnostics: &[Diagnostic], sources: &SourceMap) -> Vec<String> {
    let line = |diagnostic: &Diagnostic| {
        let span = diagnostic.span();
        let place = if span.is_none() {
            String::new()
        } else {
            let at = sources.position(span);
            format!("{}:{}:{}: ", sources.name(span.file), at.line, at.column)
        };
        let severity = if diagnostic.is_error() { "error" } else { "warning" };
        let help = diagnostic.help.as_ref().map_or(String::new(), |help| format!(" ({help})"));
        format!("{place}{severity}[{}]: {}{help}", diagnostic.code, diagnostic.message)
    };
    diagnostics.iter().map(line).collect()
}
