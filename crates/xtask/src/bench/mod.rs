//! `cargo xtask bench`: installs the programs that alhazen is compared with from PyPI, each into a
//! Python environment of its own under `target/`, and runs the measurement; or measures alhazen
//! alone.

mod forest;

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::command::{cargo, python_environment, succeed, target};
pub use forest::measure as forest;

/// The package of PyPI that carries Embree's library.
const EMBREE: &str = "embreex==4.4.*";
/// The packages that the comparison with Mitsuba needs.
const MITSUBA: [&str; 2] = ["mitsuba==3.9.*", "numpy"];
/// What names an LLVM library for Mitsuba.
const LLVM_VARIABLE: &str = "DRJIT_LIBLLVM_PATH";

/// Measures rays in the workspace at `root`; `arguments` go to the program.
///
/// Embree's library is the file that the variable `EMBREE_LIB` names; or the one in the Python
/// environment `$PEERS_DIR/venv`; or the one of PyPI's package.
pub fn rays(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let library = embree(root);
    if let Err(error) = &library {
        eprintln!("warning: Embree is not available, so only alhazen is measured: {error}");
    }
    let mut command = cargo(root);
    command.args(["run", "--release", "--quiet", "--package", "alhazen-bench", "--bin", "rays", "--"]);
    if let Ok(library) = &library {
        command.arg("--embree").arg(library);
    }
    succeed(command.args(arguments))
}

/// Renders scenes with alhazen and Mitsuba in turn; `arguments` go to `mitsuba/render.py`.
///
/// Mitsuba compiles its kernels with the LLVM library that `DRJIT_LIBLLVM_PATH` names, or else that
/// of the Rust compiler.
pub fn render(root: &Path, arguments: &[&str]) -> Result<(), String> {
    succeed(cargo(root).args(["build", "--release", "--quiet", "--package", "alhazen-cli"]))?;
    let folder = target(root).join("mitsuba");
    let python = python_environment(&folder, &MITSUBA)?;
    let mut command = Command::new(python);
    command.arg(root.join("crates/xtask/mitsuba/render.py"));
    command.arg("--root").arg(root).arg("--alhazen").arg(target(root).join("release/alhazen"));
    if env::var_os(LLVM_VARIABLE).is_none()
        && let Some(library) = compilers_llvm(root)
    {
        command.env(LLVM_VARIABLE, library);
    }
    succeed(command.args(arguments).env("PYTHONDONTWRITEBYTECODE", "1"))
}

/// Measures a GPU in the workspace at `root`; `arguments` go to the program. It needs no other
/// files: carried to another machine, it measures the GPU there.
pub fn gpu(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let mut command = cargo(root);
    command.args(["run", "--release", "--quiet", "--package", "alhazen-bench", "--features", "gpu"]);
    succeed(command.args(["--bin", "gpu", "--"]).args(arguments))
}

fn embree(root: &Path) -> Result<PathBuf, String> {
    if let Some(library) = env::var_os("EMBREE_LIB") {
        return Ok(library.into());
    }
    if let Some(peers) = env::var_os("PEERS_DIR") {
        let folder = Path::new(&peers).join("venv");
        return find(&folder, "embree4").ok_or(format!("there is none under {}", folder.display()));
    }
    let folder = target(root).join("embree");
    python_environment(&folder, &[EMBREE])?;
    find(&folder, "embree4").ok_or(format!("{EMBREE} has no library"))
}

/// The LLVM library of the Rust compiler, where it is one of its own.
fn compilers_llvm(root: &Path) -> Option<PathBuf> {
    let output = Command::new("rustc").args(["--print", "sysroot"]).current_dir(root).output().ok()?;
    let folder = Path::new(String::from_utf8(output.stdout).ok()?.trim()).join("lib");
    find(&folder, "LLVM")
}

/// The shared library somewhere under a folder whose name starts with `name`, but for `lib`.
fn find(folder: &Path, name: &str) -> Option<PathBuf> {
    let entries = folder.read_dir().ok()?.flatten();
    entries.map(|entry| entry.path()).find_map(|path| {
        if path.is_dir() && !path.is_symlink() {
            return find(&path, name);
        }
        let file = path.file_name()?.to_str()?;
        // A linker script may have the name of a library.
        let binary = path.metadata().is_ok_and(|file| file.len() > 4096);
        let library = binary && [".so", ".dylib", ".dll"].iter().any(|end| file.contains(end));
        (library && file.trim_start_matches("lib").starts_with(name)).then_some(path)
    })
}
