//! Warnings about a mesh file.

use std::collections::HashSet;
use std::fmt::Display;

/// Parts of a file that are not in its mesh, each said once, at its first place.
#[derive(Debug, Default)]
pub(super) struct Notes {
    said: HashSet<String>,
    texts: Vec<String>,
}

impl Notes {
    /// More different ones are not kept: files may be of random bytes.
    const MOST: usize = 100;

    /// Says something about a line.
    pub fn add(&mut self, line: usize, text: impl Into<String>) {
        self.add_at(format_args!("line {line}"), text);
    }

    /// Says something about a place.
    pub fn add_at(&mut self, place: impl Display, text: impl Into<String>) {
        let text = text.into();
        if self.said.len() < Self::MOST && !self.said.contains(&text) {
            self.texts.push(format!("{place}: {text}"));
            self.said.insert(text);
        }
    }

    /// All of them, in the order of the file.
    pub fn into_texts(self) -> Vec<String> {
        self.texts
    }
}
