//! `cargo xtask wgsl`: writes the laws that the GPU engine shares, translated to WGSL.

use std::path::Path;

use translate::{FOLDER, generate};

/// Translates everything and writes the files into the workspace at `root`.
pub fn run(root: &Path) -> Result<(), String> {
    let read =
        |path: &str| std::fs::read_to_string(root.join(path)).map_err(|error| format!("{path}: {error}"));
    let files = generate(read)?;
    let folder = root.join(FOLDER);
    let write = || {
        std::fs::remove_dir_all(&folder)?;
        std::fs::create_dir_all(&folder)?;
        files.iter().try_for_each(|(path, text)| std::fs::write(root.join(path), text))
    };
    write().map_err(|error: std::io::Error| format!("{}: {error}", folder.display()))?;
    println!("{} files in {FOLDER}", files.len());
    Ok(())
}
