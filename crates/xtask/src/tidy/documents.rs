//! Rules of documents: links have targets, the licences exist, and the page about the command line
//! lists exactly the options of the program.

use std::collections::BTreeSet;

use super::Finding;
use super::tree::Tree;

const COMMAND_LINE: &str = "docs/cli.md";
const LICENCES: [&str; 2] = ["LICENSE-MIT", "LICENSE-APACHE"];
/// The files that define the command line.
const ARGUMENTS: &str = "crates/cli/src/args/";
/// Options that clap adds by itself.
const CLAPS_OWN: [&str; 2] = ["help", "version"];

pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    for licence in LICENCES.iter().filter(|licence| !tree.exists(licence)) {
        findings.push(Finding::new(licence, 0, "missing"));
    }
    for (path, text) in tree.ending(".md") {
        for (line, target) in links(text) {
            if !tree.exists(&resolve(path, target)) {
                findings.push(Finding::new(
                    path,
                    line,
                    format!("a link to `{target}`, which does not exist"),
                ));
            }
        }
    }
    let page = tree.text(COMMAND_LINE).unwrap_or_default();
    let arguments = tree.texts().filter(|(path, _)| path.starts_with(ARGUMENTS));
    let defined: BTreeSet<String> = arguments.flat_map(|(_, text)| defined_options(text)).collect();
    let told = told_options(page);
    for option in told.difference(&defined).filter(|option| !CLAPS_OWN.contains(&option.as_str())) {
        findings.push(Finding::new(COMMAND_LINE, 0, format!("`--{option}` is not an option of alhazen")));
    }
    for option in defined.difference(&told) {
        findings.push(Finding::new(COMMAND_LINE, 0, format!("the option `--{option}` is missing")));
    }
    if defined.is_empty() {
        findings.push(Finding::new(
            ARGUMENTS,
            0,
            "tells nothing to hold the page to; see tidy's documents.rs",
        ));
    }
    findings
}

/// Lines and targets of the links of a document to files.
fn links(text: &str) -> Vec<(usize, &str)> {
    let mut links = Vec::new();
    for (number, line) in text.lines().enumerate() {
        for (at, opening) in line.match_indices("](") {
            let Some((target, _)) = line[at + opening.len()..].split_once(')') else { continue };
            let file = target.split('#').next().unwrap_or_default();
            if !file.is_empty() && !file.contains("://") {
                links.push((number + 1, file));
            }
        }
    }
    links
}

/// The path from the root that a link in a document leads to.
fn resolve(document: &str, target: &str) -> String {
    let mut folders: Vec<&str> = document.split('/').collect();
    folders.pop();
    for part in target.split('/').filter(|part| !matches!(*part, "" | ".")) {
        if part == ".." {
            folders.pop();
        } else {
            folders.push(part);
        }
    }
    folders.join("/")
}

/// The long options that clap parses: the fields under `#[arg(… long …)]`, or the names in
/// `long = "…"`.
fn defined_options(source: &str) -> BTreeSet<String> {
    let mut options = BTreeSet::new();
    for (at, opening) in source.match_indices("#[arg(") {
        let (attribute, rest) = source[at + opening.len()..].split_once(")]").unwrap_or_default();
        let Some(long) = attribute.split(',').map(str::trim).find(|part| part.starts_with("long")) else {
            continue;
        };
        let field = || rest.trim_start().strip_prefix("pub ")?.split(':').next();
        let name = long.split('"').nth(1).map(str::to_owned);
        options.extend(name.or_else(|| Some(field()?.replace('_', "-"))));
    }
    options
}

/// The options in a document, except on lines that run cargo.
fn told_options(text: &str) -> BTreeSet<String> {
    let mut options = BTreeSet::new();
    for line in text.lines().filter(|line| !line.contains("cargo ")) {
        for (at, opening) in line.match_indices("--") {
            let name = line[at + opening.len()..].split(|c: char| !c.is_ascii_lowercase() && c != '-').next();
            options.extend(
                name.map(|name| name.trim_matches('-')).filter(|name| !name.is_empty()).map(str::to_owned),
            );
        }
    }
    options
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_lead_somewhere() {
        let text = "[a](../README.md#here) [b](c.png) [d](https://e.org) [f](#g)\n";
        assert_eq!(links(text), [(1, "../README.md"), (1, "c.png")]);
        assert_eq!(resolve("docs/a.md", "../README.md"), "README.md");
        assert_eq!(resolve("docs/a.md", "./images/b.png"), "docs/images/b.png");
    }

    #[test]
    fn options_are_read_from_both_sides() {
        let source = "#[arg(short, long = \"output\", value_name = \"FILE\")]\npub output: Vec<PathBuf>,\n\
                      #[arg(long, value_parser = range(1..))]\npub spp: u32,\n#[arg(\n    long, default_value_t = 1\n)]\npub max_time: u32,\n";
        let expected: BTreeSet<String> = ["output", "spp", "max-time"].map(String::from).into();
        assert_eq!(defined_options(source), expected);
        let text = "| `--spp N`, `-o` or `--output` |\n|---|---|\ncargo run --release\n`--max-time`\n";
        assert_eq!(told_options(text), expected);
    }
}
