//! Gives the program its version: the package's, and the commit that it is built from.

use std::env;
use std::path::Path;
use std::process::Command;

fn main() {
    let commit = commit().map_or(String::new(), |commit| format!(" ({commit})"));
    println!("cargo::rustc-env=ALHAZEN_VERSION={}{commit}", env!("CARGO_PKG_VERSION"));
    println!("cargo::rerun-if-changed=build.rs");
}

/// Hash and date of the commit; `None` outside of the program's own repository, as in an unpacked
/// source archive, or without git.
fn commit() -> Option<String> {
    let workspace = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").canonicalize().ok()?;
    let repository = Path::new(&git(&["rev-parse", "--show-toplevel"])?).canonicalize().ok()?;
    if repository != workspace {
        return None;
    }
    // The log of HEAD grows with every commit and checkout.
    for file in ["HEAD", "logs/HEAD"] {
        let path = git(&["rev-parse", "--path-format=absolute", "--git-path", file])?;
        if Path::new(&path).exists() {
            println!("cargo::rerun-if-changed={path}");
        }
    }
    git(&["log", "-1", "--abbrev=12", "--format=%h %cs"])
}

/// What git says, on one line; `None` if it fails.
fn git(arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?.trim().to_owned();
    (output.status.success() && !text.is_empty() && !text.contains('\n')).then_some(text)
}
