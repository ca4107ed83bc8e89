//! Citations: every `[Key year]` in code and documents has an entry in `docs/references.md`, and
//! every entry is cited.
//!
//! A citation is `[Surname year]`, optionally with other authors (`& Duff`, `et al.`) and a section
//! (`§9.7`, `ch. 12`); several are separated by semicolons. Its key is the first author's surname
//! and the year. An entry begins `- **Surname year**`.

use std::collections::BTreeSet;

use super::tree::Tree;
use super::{Finding, rust};

const REFERENCES: &str = "docs/references.md";

pub fn check(tree: &Tree) -> Vec<Finding> {
    let mut findings = Vec::new();
    let texts: Vec<_> = citing_texts(tree).map(|(path, text)| (path, citations(&text), text)).collect();
    let mut entries = BTreeSet::new();
    let references = tree.text(REFERENCES).unwrap_or_default();
    for (number, line) in references.lines().enumerate() {
        let Some((key, _)) = line.strip_prefix("- **").and_then(|line| line.split_once("**")) else {
            continue;
        };
        if !entries.insert(key) {
            findings.push(Finding::new(REFERENCES, number + 1, format!("a second entry for `{key}`")));
        }
        let opening = format!("[{key}");
        let cited = texts.iter().any(|(_, citations, text)| {
            citations.iter().any(|(_, cited)| cited == key) || text.contains(&opening)
        });
        if !cited {
            findings.push(Finding::new(REFERENCES, number + 1, format!("`{key}` is never cited")));
        }
    }
    for (path, citations, _) in &texts {
        for (line, key) in citations {
            if !entries.contains(key.as_str()) {
                findings.push(Finding::new(path, *line, format!("[{key}] has no entry in {REFERENCES}")));
            }
        }
    }
    findings
}

/// Paths and texts that may cite: the comments of sources, and documents and tables as a whole.
fn citing_texts(tree: &Tree) -> impl Iterator<Item = (&str, String)> {
    tree.texts().filter(|(path, _)| *path != REFERENCES && !path.contains("/tidy/")).filter_map(
        |(path, text)| match path.rsplit('.').next()? {
            "rs" => Some((path, rust::layers(text).comments)),
            "md" | "txt" | "pbrt" => Some((path, text.to_owned())),
            _ => None,
        },
    )
}

/// Lines and keys of the citations in a text. A citation may span lines.
fn citations(text: &str) -> Vec<(usize, String)> {
    let mut found = Vec::new();
    let all: Vec<&str> = text.lines().collect();
    for (number, line) in all.iter().enumerate() {
        let next = all.get(number + 1).copied().unwrap_or_default();
        let lines = format!("{line} {}", next.trim_start().trim_start_matches(['/', '!', '#']));
        for (at, _) in line.match_indices('[') {
            let Some((inside, _)) = lines[at + 1..].split_once(']') else { continue };
            found.extend(inside.split(';').filter_map(key).map(|key| (number + 1, key)));
        }
    }
    found
}

/// The key of a citation: the surname and the year, if it begins with names and a year.
fn key(citation: &str) -> Option<String> {
    let words: Vec<&str> = citation.split_whitespace().collect();
    let year_at = words.iter().position(|word| is_year(word.trim_end_matches(',')))?;
    let names = &words[..year_at];
    let name = |word: &&str| word.starts_with(char::is_uppercase) || ["&", "et", "al."].contains(word);
    if names.is_empty() || !names.iter().all(name) {
        return None;
    }
    let surname: Vec<&str> = names.iter().take_while(|word| !["&", "et"].contains(word)).copied().collect();
    Some(format!("{} {}", surname.join(" "), words[year_at].trim_end_matches(',')))
}

/// Four digits, and a letter to distinguish works of one year.
fn is_year(word: &str) -> bool {
    let digits = word.trim_end_matches(|c: char| c.is_ascii_lowercase());
    digits.len() == 4 && word.len() <= 5 && digits.bytes().all(|digit| digit.is_ascii_digit())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_surname_and_year() {
        for (citation, expected) in [
            ("Pharr 2023 §9.7", "Pharr 2023"),
            ("Pharr 2023 §2.4, §A.4", "Pharr 2023"),
            ("Conty Estevez & Kulla 2018", "Conty Estevez 2018"),
            ("Karlík et al. 2019", "Karlík 2019"),
            (" Heitz 2018b, §3", "Heitz 2018b"),
        ] {
            assert_eq!(key(citation).as_deref(), Some(expected));
        }
        for other in ["0, 1", "`Rgb`", "IEC 61966-2-1", "2023", "a table of 1024 values", "u32; 1024"] {
            assert_eq!(key(other), None, "{other}");
        }
    }

    #[test]
    fn citations_are_matched_with_entries() {
        let code = "//! Sources: [Owen 1995;\n//! Faure 1982 §2], [Veach 1997].\n";
        let references =
            "- **Owen 1995** A.\n- **Veach 1997** B.\n- **Veach 1997** C.\n- **Kajiya 1986** D.\n";
        let tree = Tree::from([("crates/a/src/b.rs", code), (REFERENCES, references)]);
        let findings: Vec<String> = check(&tree).iter().map(Finding::to_string).collect();
        assert_eq!(
            findings,
            [
                "docs/references.md:3: a second entry for `Veach 1997`",
                "docs/references.md:4: `Kajiya 1986` is never cited",
                "crates/a/src/b.rs:1: [Faure 1982] has no entry in docs/references.md",
            ]
        );
    }
}
