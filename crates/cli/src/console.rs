//! Text to standard output and standard error. Text that cannot be written, as to a full disk, is
//! an error; a broken pipe is not, as its reader has closed it on purpose.

use std::fmt::{self, Display};
use std::io::{self, ErrorKind, Write};

/// Text that could not be written, and why.
#[derive(Debug)]
pub struct Undelivered {
    stream: &'static str,
    error: io::Error,
}

impl Display for Undelivered {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "cannot write to {}: {}", self.stream, self.error)
    }
}

/// Writes a line to standard output.
pub fn say(line: impl Display) -> Result<(), Undelivered> {
    deliver(io::stdout().lock(), "standard output", line)
}

/// Writes a line to standard error.
pub fn warn(line: impl Display) -> Result<(), Undelivered> {
    deliver(io::stderr().lock(), "standard error", line)
}

fn deliver(mut to: impl Write, stream: &'static str, line: impl Display) -> Result<(), Undelivered> {
    match writeln!(to, "{line}").and_then(|()| to.flush()) {
        Err(error) if error.kind() != ErrorKind::BrokenPipe => Err(Undelivered { stream, error }),
        _ => Ok(()),
    }
}
