//! The program `alhazen` in the library, so that a wheel has the renderer once.

use std::ffi::OsString;
use std::process::ExitCode;

use pyo3::prelude::*;

/// Runs the program with its arguments, of which the first is its name, and returns its exit code.
#[pyfunction(name = "_main")]
pub fn main(py: Python, arguments: Vec<OsString>) -> u8 {
    let ended = py.detach(|| cli::run(arguments));
    // The standard library does not tell the number of an exit code.
    (0..=u8::MAX).find(|&code| ExitCode::from(code) == ended).unwrap_or(1)
}
