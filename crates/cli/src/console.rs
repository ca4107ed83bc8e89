//! Text to standard output and standard error. Nobody listening at the other end is no reason to
//! fail.

use std::io::Write;

/// A line to standard output.
pub fn say(line: impl std::fmt::Display) {
    let _ = writeln!(std::io::stdout(), "{line}");
}

/// A line to standard error.
pub fn warn(line: impl std::fmt::Display) {
    let _ = writeln!(std::io::stderr(), "{line}");
}
