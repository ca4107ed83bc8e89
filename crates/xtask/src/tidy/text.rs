//! Rules of all texts: whitespace, length of source files and comment lines, no unfinished work, no
//! paths of one machine.

use super::tree::Tree;
use super::{Finding, rust};

/// Most lines of a source file; long tables live in `data/`.
const MAX_LINES: usize = 600;

/// Most characters of a comment's line, its indentation included; rows of tables cannot be broken.
const MAX_COMMENT_WIDTH: usize = 100;

/// Words that mark unfinished work.
const MARKERS: [&str; 4] = ["TODO", "FIXME", "XXX", "HACK"];

/// Folders of a single machine.
const MACHINE_FOLDERS: [&str; 4] = ["work", "root", "home", "Users"];

pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for (path, text) in tree.texts() {
        let source = path.ends_with(".rs");
        if source && !path.contains("/data/") && text.lines().count() > MAX_LINES {
            let message = format!("{} lines; {MAX_LINES} are the most", text.lines().count());
            findings.push(Finding::new(path, 0, message));
        }
        if !text.is_empty() && !text.ends_with('\n') {
            findings.push(Finding::new(path, 0, "no newline at the end"));
        }
        let mut find = |line: usize, message: String| findings.push(Finding::new(path, line + 1, message));
        for (number, line) in text.lines().enumerate() {
            if line.ends_with([' ', '\t', '\r']) {
                find(number, "whitespace at the end of the line".into());
            }
            if line.contains('\t') {
                find(number, "a tab; indent with spaces".into());
            }
            if source && is_wide_comment(line) {
                find(number, format!("a comment wider than {MAX_COMMENT_WIDTH} characters"));
            }
            if let Some(folder) = MACHINE_FOLDERS.iter().find(|folder| names_folder(line, folder)) {
                find(number, format!("a path of one machine: /{folder}/"));
            }
        }
        let comments = source.then(|| rust::layers(text).comments);
        for (number, line) in comments.as_deref().unwrap_or(text).lines().enumerate() {
            if let Some(marker) = words(line).find(|word| MARKERS.contains(word)) {
                find(number, format!("`{marker}`: finish it, or open an issue"));
            }
        }
    }
    findings
}

/// Whether a line is a comment, and no row of a table, that is too wide.
fn is_wide_comment(line: &str) -> bool {
    let Some(text) = line.trim_start().strip_prefix("//") else { return false };
    let text = text.trim_start_matches(['/', '!']).trim_start();
    line.chars().count() > MAX_COMMENT_WIDTH && !text.starts_with('|')
}

/// Whether a line has an absolute path into `/folder/`.
fn names_folder(line: &str, folder: &str) -> bool {
    let path = format!("/{folder}/");
    line.match_indices(&path).any(|(at, _)| {
        let before = line[..at].chars().next_back();
        !before.is_some_and(|c| c.is_alphanumeric() || ".-_}".contains(c))
    })
}

/// The words of a line: runs of letters, digits and underscores.
fn words(line: &str) -> impl Iterator<Item = &str> {
    line.split(|c: char| !c.is_alphanumeric() && c != '_')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn messages(path: &str, text: &str) -> Vec<String> {
        check(&Tree::from([(path, text)])).iter().map(Finding::to_string).collect()
    }

    #[test]
    fn whitespace_is_found() {
        assert_eq!(
            messages("a.md", "a \nb\tc\nd"),
            [
                "a.md: no newline at the end",
                "a.md:1: whitespace at the end of the line",
                "a.md:2: a tab; indent with spaces",
            ]
        );
    }

    #[test]
    fn long_sources_are_found() {
        assert_eq!(messages("a.rs", &"\n".repeat(600)).len(), 0);
        assert_eq!(messages("a.rs", &"\n".repeat(601)), ["a.rs: 601 lines; 600 are the most"]);
        assert_eq!(messages("crates/a/data/b.rs", &"\n".repeat(601)).len(), 0);
    }

    #[test]
    fn wide_comments_are_found() {
        let comment = |width: usize| format!("    /// {}\n", "é".repeat(width - 8));
        assert!(messages("a.rs", &comment(100)).is_empty());
        assert_eq!(messages("a.rs", &comment(101)), ["a.rs:1: a comment wider than 100 characters"]);
        assert!(messages("a.rs", &format!("//! | {} |\n", "a".repeat(100))).is_empty());
        assert!(messages("a.md", &comment(101)).is_empty());
    }

    #[test]
    fn markers_are_found_in_comments_and_prose() {
        let marker = MARKERS[0];
        assert_eq!(messages("a.rs", &format!("// {marker}: more\n")).len(), 1);
        assert_eq!(messages("a.rs", &format!("const A: &str = \"{marker}\";\n")).len(), 0);
        assert_eq!(messages("a.md", &format!("{marker}\n")).len(), 1);
        assert_eq!(messages("a.md", &format!("{marker}S\n")).len(), 0);
    }

    #[test]
    fn paths_of_one_machine_are_found() {
        let folder = MACHINE_FOLDERS[0];
        assert_eq!(messages("a.md", &format!("see /{folder}/a\n")).len(), 1);
        assert_eq!(messages("a.md", &format!("see a/{folder}/b\n")).len(), 0);
    }
}
