//! Rules of parameters: a function has at most six besides `self`, and none is a tuple, as a struct
//! says what belongs together. Clippy counts `self` too, so its limit of seven is not this one.

use super::tree::Tree;
use super::{Finding, rust};

/// The most parameters of a function, besides `self`.
const MAX_PARAMETERS: usize = 6;

pub fn check(tree: &Tree) -> Vec<Finding> {
    let of_libraries = |path: &str| path.contains("/src/") && !path.ends_with("tests.rs");
    tree.ending(".rs")
        .filter(|(path, _)| of_libraries(path))
        .flat_map(|(path, text)| check_file(path, text))
        .collect()
}

fn check_file(path: &str, text: &str) -> Vec<Finding> {
    let code = rust::without_tests(&rust::layers(text).code);
    let mut findings = Vec::new();
    for function in functions(&code) {
        let line = 1 + code[..function.at].matches('\n').count();
        if function.parameters.len() > MAX_PARAMETERS && !function.is_excused {
            let message = format!("{} parameters, more than {MAX_PARAMETERS}", function.parameters.len());
            findings.push(Finding::new(path, line, message));
        }
        for parameter in function.parameters.iter().filter(|parameter| is_tuple(parameter)) {
            let message = format!("`{parameter}` is a tuple: pass a struct, or its parts");
            findings.push(Finding::new(path, line, message));
        }
    }
    findings
}

/// The head of a function.
struct Function<'a> {
    /// The byte where it begins.
    at: usize,
    /// Whether its attributes say why there are many parameters.
    is_excused: bool,
    /// All but `self`.
    parameters: Vec<&'a str>,
}

/// The functions of a code without comments.
fn functions(code: &str) -> impl Iterator<Item = Function<'_>> {
    code.match_indices("fn ").filter_map(|(at, word)| {
        if code[..at].ends_with(|c: char| c.is_alphanumeric() || c == '_') {
            return None;
        }
        let before = &code[code[..at].rfind(['{', '}', ';']).unwrap_or(0)..at];
        let name = &code[at + word.len()..];
        let after_name = &name[name.find(|c: char| !c.is_alphanumeric() && c != '_')?..];
        let list = match after_name.starts_with('<') {
            true => &after_name[closing(after_name)? + 1..],
            false => after_name,
        };
        let list = list.starts_with('(').then(|| closing(list)).flatten().map(|end| &list[1..end])?;
        let parameters = parts(list).into_iter().filter(|parameter| !is_self(parameter)).collect();
        Some(Function { at, is_excused: before.contains("too_many_arguments"), parameters })
    })
}

/// Each character with its place and the brackets open after it; the `>` of `->` closes none.
fn nested(code: &str) -> impl Iterator<Item = (usize, char, i32)> {
    let mut depth = 0;
    code.char_indices().map(move |(at, c)| {
        depth += match c {
            '(' | '[' | '{' | '<' => 1,
            '>' if code[..at].ends_with(['-', '=']) => 0,
            ')' | ']' | '}' | '>' => -1,
            _ => 0,
        };
        (at, c, depth)
    })
}

/// The place of the bracket that closes the first one.
fn closing(code: &str) -> Option<usize> {
    nested(code).find(|&(_, _, depth)| depth == 0).map(|(at, ..)| at)
}

/// The parts of a list that commas separate.
fn parts(list: &str) -> Vec<&str> {
    let mut from = 0;
    let commas = nested(list).filter(|&(_, c, depth)| c == ',' && depth == 0).map(|(at, ..)| at);
    let part = |to: usize| list[std::mem::replace(&mut from, to + 1)..to].trim();
    commas.chain([list.len()]).map(part).filter(|part| !part.is_empty()).collect()
}

/// Whether a parameter is the receiver.
fn is_self(parameter: &str) -> bool {
    parameter.split(':').next().is_some_and(|pattern| pattern.split_whitespace().last() == Some("self"))
        || parameter.ends_with("&self")
}

/// Whether the pattern or the type of a parameter is a tuple of two or more, or a reference to one.
fn is_tuple(parameter: &str) -> bool {
    let colon = nested(parameter).find(|&(_, c, depth)| c == ':' && depth == 0).map(|(at, ..)| at);
    let (pattern, kind) = parameter.split_at(colon.unwrap_or(parameter.len()));
    [pattern, kind.trim_start_matches(':')].into_iter().any(|side| {
        let side =
            side.split_whitespace().filter(|word| !word.starts_with("&'")).collect::<Vec<_>>().join(" ");
        let side = side.trim_start_matches(['&', ' ']).trim_start_matches("mut ");
        side.starts_with('(') && closing(side).is_some_and(|end| parts(&side[1..end]).len() > 1)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(code: &str) -> usize {
        check_file("crates/math/src/a.rs", code).len()
    }

    #[test]
    fn tuples_are_no_parameters() {
        for code in [
            "fn a((b, c): (u8, u8)) {}",
            "fn a<F: Fn(u8) -> u8>(\n    &self,\n    (b, mut c): &(u8, F),\n) {}",
            "fn a(b: (u8, [u8; 2]), c: u8);",
            "pub fn a<'b>(&'b self, c: &'b mut (u8, u8)) {}",
        ] {
            assert_eq!(found(code), 1, "{code}");
        }
    }

    #[test]
    fn closures_functions_and_arrays_are() {
        for code in [
            "fn a(b: impl Fn(u8, u8) -> (u8, u8), c: &[(u8, u8)], [d, e]: [u8; 2], (): ()) -> (u8, u8) {}",
            "fn a() { let b = |(c, d): (u8, u8)| c + d; }",
            "fn a(b: fn(u8, u8), c: Vec<(u8, u8)>, d: (u8)) {}",
            "#[cfg(test)]\nfn a(b: (u8, u8)) {}",
        ] {
            assert_eq!(found(code), 0, "{code}");
        }
    }

    #[test]
    fn six_parameters_besides_self_are_the_most() {
        assert_eq!(found("fn a(&mut self, b: u8, c: u8, d: A<u8, u8>, e: u8, f: u8, g: u8) {}"), 0);
        assert_eq!(found("fn a(b: u8, c: u8, d: u8, e: u8, f: u8, g: u8, h: u8) {}"), 1);
        let excused = "#[expect(clippy::too_many_arguments, reason = \"\")]\n";
        assert_eq!(found(&format!("{excused}fn a(b: u8, c: u8, d: u8, e: u8, f: u8, g: u8, h: u8) {{}}")), 0);
    }
}
