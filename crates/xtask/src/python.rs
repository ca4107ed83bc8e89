//! The Python package: its wheel and its tests.

use std::fs;
use std::path::Path;
use std::process::Command;

use super::command::{python_environment, succeed, target};
use super::dist;

/// What builds wheels.
const BUILD: [&str; 1] = ["maturin==1.16.*"];
/// What the tests need.
const TEST: [&str; 4] = ["numpy", "pytest==9.*", "nbclient", "ipykernel"];
/// Where the package is.
const FOLDER: &str = "crates/python";

/// Builds the wheel of the workspace at `root` into `target/wheels`. Its library has the program,
/// too, so that the wheel is half as large as with a program of its own.
pub fn wheel(root: &Path) -> Result<(), String> {
    let python = python_environment(&target(root).join("maturin"), &BUILD)?;
    let mut command = Command::new(python);
    command.args(["-m", "maturin", "build", "--profile", dist::PROFILE, "--target", &dist::host(root)?]);
    command.arg("--manifest-path").arg(root.join(FOLDER).join("Cargo.toml"));
    succeed(command.arg("--out").arg(target(root).join("wheels")))
}

/// Tests the package, whose library the tests of the workspace have built, from a folder in which
/// it is put together.
pub fn test(root: &Path) -> Result<(), String> {
    let folder = target(root).join("python-package");
    assemble(root, &folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let python = python_environment(&target(root).join("pytest"), &TEST)?;
    let mut command = Command::new(python);
    command.args(["-m", "pytest", "--quiet", "-p", "no:cacheprovider"]).arg(root.join(FOLDER).join("tests"));
    succeed(command.env("PYTHONPATH", &folder).env("PYTHONDONTWRITEBYTECODE", "1"))
}

/// Copies the sources of the package and its library to a folder, as if they were installed there.
fn assemble(root: &Path, folder: &Path) -> std::io::Result<()> {
    let package = folder.join("alhazen");
    fs::create_dir_all(&package)?;
    for file in root.join(FOLDER).join("python/alhazen").read_dir()? {
        let file = file?;
        if file.file_type()?.is_file() {
            fs::copy(file.path(), package.join(file.file_name()))?;
        }
    }
    let (prefix, suffix) = (std::env::consts::DLL_PREFIX, std::env::consts::DLL_SUFFIX);
    let library = target(root).join("debug/deps").join(format!("{prefix}_alhazen{suffix}"));
    let extension = if cfg!(windows) { "pyd" } else { "abi3.so" };
    fs::copy(library, package.join(format!("_alhazen.{extension}")))?;
    Ok(())
}
