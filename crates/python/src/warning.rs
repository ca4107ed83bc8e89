//! Warnings.

use pyo3::create_exception;
use pyo3::exceptions::PyUserWarning;
use pyo3::prelude::*;
use pyo3::types::PyType;

create_exception!(
    alhazen,
    SceneWarning,
    PyUserWarning,
    "Something of a scene is rendered differently than described, or has no effect."
);

create_exception!(
    alhazen,
    RenderWarning,
    PyUserWarning,
    "A picture is not what was asked for: it has more noise, or lacks samples."
);

/// Warns of scenes.
pub fn warn_of_scene(py: Python, messages: &[String]) -> PyResult<()> {
    warn(&py.get_type::<SceneWarning>(), messages)
}

/// Warns of a picture.
pub fn warn_of_render(py: Python, messages: &[String]) -> PyResult<()> {
    warn(&py.get_type::<RenderWarning>(), messages)
}

/// Warns at the line that has called the package, so that Python shows what is found again and
/// again by the same line once.
fn warn(category: &Bound<'_, PyType>, messages: &[String]) -> PyResult<()> {
    if messages.is_empty() {
        return Ok(());
    }
    let py = category.py();
    let mut level = 1;
    let mut frame = py.import("sys")?.call_method0("_getframe")?;
    while !frame.is_none() {
        let module = frame.getattr("f_globals")?.call_method1("get", ("__name__", ""))?.to_string();
        if module != "alhazen" && !module.starts_with("alhazen.") {
            break;
        }
        frame = frame.getattr("f_back")?;
        level += 1;
    }
    let warnings = py.import("warnings")?;
    messages
        .iter()
        .try_for_each(|message| warnings.call_method1("warn", (message, category, level)).map(drop))
}
