//! The native part of the Python package `alhazen`.
//!
//! It wraps the façade: a `Scene` is loaded, `render` makes an `Image` of it. Python's lock is
//! released while files are read and rays are traced. Pixels are moved into arrays of numpy, never
//! copied.

mod builder;
mod calls;
mod color;
mod command;
mod difference;
mod errors;
mod film;
mod job;
mod keywords;
mod picture;
mod place;
mod render;
mod scene;
mod value;
mod warning;

use pyo3::prelude::*;

#[pymodule]
fn _alhazen(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    module.add("SceneError", module.py().get_type::<scene::SceneError>())?;
    module.add("SceneWarning", module.py().get_type::<warning::SceneWarning>())?;
    module.add("RenderWarning", module.py().get_type::<warning::RenderWarning>())?;
    module.add_class::<scene::Scene>()?;
    module.add_class::<picture::Picture>()?;
    module.add_class::<builder::SceneBuilder>()?;
    module.add_class::<value::Reference>()?;
    module.add_class::<value::Typed>()?;
    module.add_class::<job::Job>()?;
    module.add_class::<film::Film>()?;
    module.add_class::<render::Progress>()?;
    module.add_class::<difference::Difference>()?;
    module.add_function(wrap_pyfunction!(command::main, module)?)?;
    module.add_function(wrap_pyfunction!(scene::load, module)?)?;
    module.add_function(wrap_pyfunction!(value::rgb, module)?)?;
    module.add_function(wrap_pyfunction!(value::spectrum, module)?)?;
    module.add_function(wrap_pyfunction!(value::blackbody, module)?)?;
    module.add_function(wrap_pyfunction!(scene::integrators, module)?)?;
    module.add_function(wrap_pyfunction!(job::compile, module)?)?;
    module.add_function(wrap_pyfunction!(job::render, module)?)?;
    module.add_function(wrap_pyfunction!(difference::compare, module)?)
}
