//! Source rules beyond the compiler's. Each check reads the files of the tree and returns findings
//! with file and line; `cargo xtask tidy` prints all of them.

mod citations;
mod code;
mod crates;
mod cycles;
mod documents;
mod parameters;
mod rust;
mod text;
mod translations;
mod tree;

use std::fmt;
use std::path::Path;

use tree::Tree;

/// A violation of a rule, and its location.
#[derive(Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Finding {
    /// The file, from the root of the workspace.
    path: String,
    /// The line, counted from 1; 0 is the file as a whole.
    line: usize,
    /// What is wrong, and what to do instead.
    message: String,
}

impl Finding {
    fn new(path: &str, line: usize, message: impl Into<String>) -> Self {
        Self { path: path.to_owned(), line, message: message.into() }
    }
}

impl fmt::Display for Finding {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.line {
            0 => write!(f, "{}: {}", self.path, self.message),
            line => write!(f, "{}:{line}: {}", self.path, self.message),
        }
    }
}

/// All checks.
const CHECKS: [fn(&Tree) -> Vec<Finding>; 8] = [
    text::check,
    code::check,
    crates::check,
    cycles::check,
    citations::check,
    documents::check,
    parameters::check,
    translations::check,
];

/// Checks the workspace at `root`; findings go to standard error.
pub fn run(root: &Path) -> Result<(), String> {
    let tree = Tree::read(root).map_err(|error| format!("{}: {error}", root.display()))?;
    let mut findings: Vec<Finding> = CHECKS.iter().flat_map(|check| check(&tree)).collect();
    findings.sort();
    for finding in &findings {
        eprintln!("{finding}");
    }
    match findings.len() {
        0 => {
            println!("tidy: {} files checked", tree.len());
            Ok(())
        }
        count => Err(format!("{count} violations of the source rules")),
    }
}
