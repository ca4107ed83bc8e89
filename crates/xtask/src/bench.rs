//! `cargo xtask bench rays`: finds or fetches Embree's library, then builds and runs the program
//! that measures.
//!
//! The library is the file that the variable `EMBREE_LIB` names; or the one in the Python
//! environment `$PEERS_DIR/venv`; or the one that PyPI's package `embreex` brings, which is then
//! installed into an environment of its own under `target/`.

use std::env;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::command::{cargo, succeed};

/// The package of PyPI that carries the library.
const PACKAGE: &str = "embreex==4.4.*";

/// Measures rays in the workspace at `root`; `arguments` go to the program.
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

fn embree(root: &Path) -> Result<PathBuf, String> {
    if let Some(library) = env::var_os("EMBREE_LIB") {
        return Ok(library.into());
    }
    if let Some(peers) = env::var_os("PEERS_DIR") {
        let folder = Path::new(&peers).join("venv");
        return find(&folder).ok_or(format!("there is none under {}", folder.display()));
    }
    let target = env::var_os("CARGO_TARGET_DIR").map_or(root.join("target"), PathBuf::from);
    let folder = target.join("embree");
    if let Some(library) = find(&folder) {
        return Ok(library);
    }
    eprintln!("installing {PACKAGE} into {}", folder.display());
    let (python, programs) = if cfg!(windows) { ("python", "Scripts") } else { ("python3", "bin") };
    succeed(Command::new(python).args(["-m", "venv"]).arg(&folder))?;
    let python = folder.join(programs).join(python);
    succeed(Command::new(python).args(["-m", "pip", "install", "--quiet", PACKAGE]))?;
    find(&folder).ok_or(format!("{PACKAGE} has no library"))
}

/// The library somewhere under a folder.
fn find(folder: &Path) -> Option<PathBuf> {
    let entries = folder.read_dir().ok()?.flatten();
    entries.map(|entry| entry.path()).find_map(|path| {
        if path.is_dir() && !path.is_symlink() {
            return find(&path);
        }
        let name = path.file_name()?.to_str()?;
        let library = [".so", ".dylib", ".dll"].iter().any(|end| name.contains(end));
        (library && name.trim_start_matches("lib").starts_with("embree4")).then_some(path)
    })
}
