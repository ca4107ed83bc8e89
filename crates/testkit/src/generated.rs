//! Pages that are made of the code.

use std::path::Path;

/// The environment variable with which [`check_generated`] writes pages instead of comparing them.
const WRITE: &str = "ALHAZEN_WRITE_DOCS";

/// Compares a file of the repository with the text that the code has for it: for the part from
/// `begin` up to `end`, each the rest of the file if it is empty. `cargo xtask docs` writes it.
///
/// # Panics
///
/// If the file differs, or has not these two places.
#[track_caller]
pub fn check_generated(file: &str, [begin, end]: [&str; 2], expected: &str) {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../..").join(file);
    let page = std::fs::read_to_string(&path).unwrap_or_default();
    let start = page.find(begin).unwrap_or_else(|| panic!("{file} has no `{begin}`"));
    let stop = if end.is_empty() { Some(page.len()) } else { page[start..].find(end).map(|at| start + at) };
    let stop = stop.unwrap_or_else(|| panic!("{file} has no `{end}`"));
    let found = &page[start..stop];
    if found == expected {
        return;
    }
    if std::env::var_os(WRITE).is_some() {
        let text = format!("{}{expected}{}", &page[..start], &page[stop..]);
        std::fs::write(&path, text).unwrap_or_else(|error| panic!("{file}: {error}"));
        return;
    }
    let first = found.lines().zip(expected.lines()).find(|(found, expected)| found != expected);
    panic!("{file} is not what the code says, first in {first:#?}; run `cargo xtask docs`");
}
