//! The files of the workspace that are written by hand.

use std::collections::BTreeMap;
use std::fs;
use std::io;
use std::path::Path;

/// The entries at the root that are checked; all others (build output, pictures, data) are not.
const ROOTS: [&str; 15] = [
    ".cargo",
    ".ci",
    ".gitignore",
    "CHANGELOG.md",
    "CITATION.cff",
    "CONTRIBUTING.md",
    "Cargo.toml",
    "LICENSE-APACHE",
    "LICENSE-MIT",
    "README.md",
    "clippy.toml",
    "crates",
    "docs",
    "rustfmt.toml",
    "scenes",
];

/// The folder of pages that a command makes; they hold pictures, in which any word may occur.
const PAGES: &str = "docs/gallery/";

/// Files by their paths from the root, with `/` between folders. Those that are not UTF-8 have no
/// text, nor have pages that a command makes.
#[derive(Debug, Default)]
pub struct Tree {
    files: BTreeMap<String, Option<String>>,
}

impl Tree {
    /// Reads the files under the workspace's root.
    pub fn read(root: &Path) -> io::Result<Self> {
        let mut tree = Self::default();
        for name in ROOTS {
            let path = root.join(name);
            if path.exists() {
                tree.add(&path, name)?;
            }
        }
        Ok(tree)
    }

    fn add(&mut self, path: &Path, name: &str) -> io::Result<()> {
        if path.is_dir() {
            for entry in fs::read_dir(path)? {
                let entry = entry?;
                self.add(&entry.path(), &format!("{name}/{}", entry.file_name().to_string_lossy()))?;
            }
        } else {
            let is_made = name.starts_with(PAGES) && name.ends_with(".html");
            let text = if is_made { None } else { String::from_utf8(fs::read(path)?).ok() };
            self.files.insert(name.to_owned(), text);
        }
        Ok(())
    }

    /// Number of files.
    pub fn len(&self) -> usize {
        self.files.len()
    }

    /// The text of a file.
    pub fn text(&self, path: &str) -> Option<&str> {
        self.files.get(path)?.as_deref()
    }

    /// Whether there is a file or a folder at a path.
    pub fn exists(&self, path: &str) -> bool {
        let path = path.trim_end_matches('/');
        self.files
            .keys()
            .any(|name| name.strip_prefix(path).is_some_and(|rest| rest.is_empty() || rest.starts_with('/')))
    }

    /// Paths and texts of all files that are text.
    pub fn texts(&self) -> impl Iterator<Item = (&str, &str)> {
        self.files.iter().filter_map(|(path, text)| Some((path.as_str(), text.as_deref()?)))
    }

    /// Paths and texts of the files whose path ends with `end`.
    pub fn ending(&self, end: &str) -> impl Iterator<Item = (&str, &str)> {
        self.texts().filter(move |(path, _)| path.ends_with(end))
    }

    /// The names of the folders under `crates/`, sorted.
    pub fn crates(&self) -> Vec<&str> {
        let manifest =
            |path: &'_ str| path.strip_prefix("crates/")?.strip_suffix("/Cargo.toml").map(str::len);
        let names = self.files.keys().filter_map(|path| manifest(path).map(|length| &path[7..7 + length]));
        names.filter(|name| !name.contains('/')).collect()
    }
}

#[cfg(test)]
impl<const N: usize> From<[(&str, &str); N]> for Tree {
    fn from(files: [(&str, &str); N]) -> Self {
        Self { files: files.map(|(path, text)| (path.to_owned(), Some(text.to_owned()))).into() }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_and_crates_are_found() {
        let tree =
            Tree::from([("crates/math/Cargo.toml", ""), ("crates/math/src/lib.rs", ""), ("README.md", "")]);
        assert_eq!(tree.crates(), ["math"]);
        assert!(tree.exists("crates/math/") && tree.exists("README.md") && !tree.exists("READ"));
    }
}
