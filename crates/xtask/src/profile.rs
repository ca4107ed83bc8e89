//! Optimization by a profile: the program is compiled so that it counts how often each branch is
//! taken, renders the scenes of `scenes/` small, and is compiled again with these counts.
//!
//! Pictures keep their bits: the compiler only places, inlines and orders code by them.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use super::command::{succeed, target};

/// How each scene is rendered: enough for all stages of a path, and many batches.
const RENDER: [&str; 5] = ["--resolution", "96x96", "--spp", "8", "--quiet"];

/// The flags for the compiler that use a profile of the program. `build` compiles it for this
/// machine's target, `host`, with more flags, and gives its path.
pub fn flags(
    root: &Path,
    host: &str,
    build: impl FnOnce(&str) -> Result<PathBuf, String>,
) -> Result<String, String> {
    let merge = merger(root, host)?;
    let folder = target(root).join("profile");
    let counts = folder.join("counts");
    if counts.exists() {
        fs::remove_dir_all(&counts).map_err(|error| error.to_string())?;
    }
    fs::create_dir_all(&folder).map_err(|error| error.to_string())?;
    let program = build(&format!("-C profile-generate={}", counts.display()))?;
    for scene in scenes(root)? {
        let mut render = Command::new(&program);
        succeed(render.arg("render").arg(scene).args(RENDER).arg("-o").arg(folder.join("picture.exr")))?;
    }
    let profile = folder.join("alhazen.profdata");
    succeed(Command::new(merge).arg("merge").arg("-o").arg(&profile).arg(counts))?;
    Ok(format!("-C profile-use={}", profile.display()))
}

/// The program of the compiler that merges counts.
fn merger(root: &Path, host: &str) -> Result<PathBuf, String> {
    let output = Command::new("rustc").current_dir(root).args(["--print", "sysroot"]).output();
    let sysroot = output.map_err(|error| error.to_string())?.stdout;
    let sysroot = PathBuf::from(String::from_utf8_lossy(&sysroot).trim());
    let path = sysroot.join("lib/rustlib").join(host).join("bin/llvm-profdata");
    match path.exists() {
        true => Ok(path),
        false => Err("there is no llvm-profdata; `rustup component add llvm-tools` installs it".into()),
    }
}

/// The scenes to render, in the order of their names.
fn scenes(root: &Path) -> Result<Vec<PathBuf>, String> {
    let folder = root.join("scenes");
    let entries = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut scenes: Vec<PathBuf> = entries.flatten().map(|entry| entry.path()).collect();
    scenes.retain(|path| path.extension().is_some_and(|extension| extension == "pbrt"));
    scenes.sort();
    Ok(scenes)
}
