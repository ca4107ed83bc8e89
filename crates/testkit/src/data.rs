//! Files of other authors that tests read.

use std::io::Write;
use std::path::{Path, PathBuf};

/// A part of the files of other authors, in `$ALHAZEN_DATA` or in `../shared/data` beside the
/// workspace; `None` where it is absent, of which the test says that it is skipped.
pub fn data(part: &str) -> Option<PathBuf> {
    let beside = || Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let path = std::env::var_os("ALHAZEN_DATA").map_or_else(beside, PathBuf::from).join(part);
    if path.exists() {
        return Some(path);
    }
    skip(&format!("{} is not there; set ALHAZEN_DATA", path.display()));
    None
}

/// Says that a test is skipped, and why. Not by a macro, whose output the harness keeps to itself.
pub fn skip(reason: &str) {
    let _ = writeln!(std::io::stderr(), "SKIPPED, not tested: {reason}");
}
