//! The location of the third-party pictures.

use std::path::PathBuf;

/// The folder of third-party test data, or `None`, with a message, where it is absent.
pub fn data_folder() -> Option<PathBuf> {
    let beside = || PathBuf::from(concat!(env!("CARGO_MANIFEST_DIR"), "/../../../shared/data"));
    let folder = std::env::var_os("ALHAZEN_DATA").map_or_else(beside, PathBuf::from);
    if !folder.is_dir() {
        eprintln!("skipped: no test data in {}; set ALHAZEN_DATA", folder.display());
        return None;
    }
    Some(folder)
}

/// All files below a folder, in order.
pub fn files_below(folder: &std::path::Path) -> Vec<PathBuf> {
    let mut files = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() { files.extend(files_below(&path)) } else { files.push(path) }
    }
    files.sort();
    files
}
