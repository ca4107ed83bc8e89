//! The rule of files: those of a crate do not use each other in cycles.
//!
//! A file uses another where a path of its code resolves to an item of the other; re-exports are
//! followed to the file that defines the item. A module's own file (`mod.rs`) is the contract of
//! its members and may also list them, as the enum of a closed set does, so the use of a module's
//! file by its direct members does not count. Everything else does. Code of tests is left out.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::tree::Tree;
use super::{Finding, rust};

/// The path of a module from the root of its crate.
type Module = Vec<String>;

/// Keywords that name an item when they stand before an identifier.
const ITEMS: [&str; 9] = ["struct", "enum", "union", "trait", "type", "fn", "const", "static", "macro_rules"];

/// How many re-exports are followed, as two globs may refer to each other.
const DEPTH: usize = 8;

pub fn check(tree: &Tree) -> Vec<Finding> {
    tree.crates().iter().flat_map(|name| check_crate(tree, &format!("crates/{name}/src/"))).collect()
}

/// Finds a shortest cycle of each group of files of a crate that use each other.
fn check_crate(tree: &Tree, root: &str) -> Vec<Finding> {
    let files = tree.ending(".rs").filter(|(path, _)| path.starts_with(root) && !path.ends_with("/tests.rs"));
    let sources: BTreeMap<Module, Source> =
        files.map(|(path, text)| (module(&path[root.len()..]), Source::read(path, text))).collect();
    let uses: BTreeMap<&Module, BTreeMap<&Module, usize>> =
        sources.iter().map(|(module, source)| (module, uses(&sources, module, source))).collect();
    let mut reported: BTreeSet<&Module> = BTreeSet::new();
    let mut findings = Vec::new();
    for &start in uses.keys() {
        let Some(cycle) = shortest_cycle(&uses, start) else { continue };
        if cycle.iter().any(|&module| reported.contains(module)) {
            continue;
        }
        reported.extend(cycle.iter().copied());
        let next = cycle.iter().cycle().skip(1);
        let steps: Vec<String> = (cycle.iter().zip(next))
            .map(|(from, to)| {
                format!("{}:{} uses {}", sources[*from].path, uses[*from][*to], sources[*to].path)
            })
            .collect();
        let line = uses[start][cycle[1 % cycle.len()]];
        findings.push(Finding::new(&sources[start].path, line, format!("a cycle: {}", steps.join("; "))));
    }
    findings
}

/// The module of a file, whose path begins at the crate's `src`.
fn module(path: &str) -> Module {
    let mut module: Module = path.trim_end_matches(".rs").split('/').map(str::to_owned).collect();
    if matches!(module.last().map(String::as_str), Some("mod" | "lib" | "main")) {
        module.pop();
    }
    module
}

/// The shortest way from a file over others back to it.
fn shortest_cycle<'a>(
    uses: &BTreeMap<&'a Module, BTreeMap<&'a Module, usize>>,
    start: &'a Module,
) -> Option<Vec<&'a Module>> {
    let mut from: BTreeMap<&Module, &Module> = BTreeMap::new();
    let mut queue = VecDeque::from([start]);
    while let Some(at) = queue.pop_front() {
        for &to in uses[at].keys() {
            if to == start {
                let mut cycle = vec![at];
                while let Some(&before) = from.get(cycle[cycle.len() - 1]) {
                    cycle.push(before);
                }
                cycle.reverse();
                return Some(cycle);
            }
            if !from.contains_key(to) {
                from.insert(to, at);
                queue.push_back(to);
            }
        }
    }
    None
}

/// The files whose items a file uses, each with the first line that does.
fn uses<'a>(
    sources: &'a BTreeMap<Module, Source>,
    module: &'a Module,
    source: &Source,
) -> BTreeMap<&'a Module, usize> {
    let mut found = BTreeMap::new();
    let imports =
        source.imports.iter().filter(|import| !import.public || source.words.contains(&import.name));
    for (path, line) in imports
        .map(|import| (&import.path, import.line))
        .chain(source.paths.iter().map(|(path, line)| (path, *line)))
    {
        let Some(target) = resolve(sources, module, path, DEPTH) else { continue };
        let own_contract = module.split_last().is_some_and(|(_, parent)| parent == &target[..]);
        if target != module && !own_contract {
            let first = found.entry(target).or_insert(line);
            *first = line.min(*first);
        }
    }
    found
}

/// The module whose file has the item of a path, or nothing if the item is of another crate.
fn resolve<'a>(
    sources: &'a BTreeMap<Module, Source>,
    from: &Module,
    path: &[String],
    depth: usize,
) -> Option<&'a Module> {
    let (mut at, mut rest) = match path[0].as_str() {
        "crate" => (Module::new(), &path[1..]),
        "self" => (from.clone(), &path[1..]),
        "super" => (from[..from.len().checked_sub(1)?].to_vec(), &path[1..]),
        _ => (from.clone(), path),
    };
    let mut qualified = rest.len() < path.len();
    while let Some((name, after)) = rest.split_first() {
        let child: Module = at.iter().chain([name]).cloned().collect();
        if name == "super" {
            at.pop()?;
        } else if sources.contains_key(&child) {
            at = child;
        } else {
            break;
        }
        qualified = true;
        rest = after;
    }
    let (known, source) = sources.get_key_value(&at)?;
    let Some(name) = rest.first() else { return Some(known) };
    if source.items.contains(name) {
        return qualified.then_some(known);
    }
    let import = source.imports.iter().find(|import| import.name == *name && import.path != path);
    if let Some(import) = import.filter(|_| depth > 0) {
        let path: Vec<String> = import.path.iter().chain(&rest[1..]).cloned().collect();
        return resolve(sources, known, &path, depth - 1);
    }
    let globs = source.imports.iter().filter(|import| import.name == "*" && depth > 0);
    let behind = globs.filter_map(|glob| resolve(sources, known, &glob.path, depth - 1));
    let defining = behind.into_iter().find(|module| sources[*module].items.contains(name));
    defining.or_else(|| qualified.then_some(known))
}

/// What a file defines, imports and names, outside its tests.
struct Source {
    path: String,
    /// Names that it defines, at any depth.
    items: BTreeSet<String>,
    imports: Vec<Import>,
    /// Paths of two and more names outside imports, with their lines.
    paths: Vec<(Vec<String>, usize)>,
    /// Identifiers outside imports.
    words: BTreeSet<String>,
}

/// One name that a `use` brings in; the name of a glob is `*`.
struct Import {
    name: String,
    path: Vec<String>,
    public: bool,
    line: usize,
}

impl Source {
    fn read(path: &str, text: &str) -> Self {
        let code = rust::without_tests(&rust::layers(text).code);
        let tokens = tokens(&code);
        let mut source = Self {
            path: path.to_owned(),
            items: BTreeSet::new(),
            imports: Vec::new(),
            paths: Vec::new(),
            words: BTreeSet::new(),
        };
        let word = |at: usize| tokens.get(at).map_or("", |token| token.0);
        let before = |at: usize| at.checked_sub(1).map_or("", word);
        let mut at = 0;
        while at < tokens.len() {
            let (token, line) = tokens[at];
            if token == "use" && word(at + 1) != "<" {
                let public = before(at) == "pub" || before(at) == ")";
                at = source.read_use(&tokens, at + 1, &mut Vec::new(), public);
                continue;
            }
            if is_name(token) {
                source.words.insert(token.to_owned());
                let name = if word(at + 1) == "!" { word(at + 2) } else { word(at + 1) };
                if ITEMS.contains(&token) && is_name(name) {
                    source.items.insert(name.to_owned());
                }
                let mut names = vec![token.to_owned()];
                while word(at + 1) == "::" && is_name(word(at + 2)) {
                    names.push(word(at + 2).to_owned());
                    at += 2;
                }
                let restriction = names.len() > 1 && before(at + 2 - 2 * names.len()) == "in";
                if names.len() > 1 && !restriction {
                    source.paths.push((names, line));
                }
            }
            at += 1;
        }
        source
    }

    /// Reads one tree of a `use` after `prefix`; returns the place after it.
    fn read_use(
        &mut self,
        tokens: &[(&str, usize)],
        mut at: usize,
        prefix: &mut Vec<String>,
        public: bool,
    ) -> usize {
        let length = prefix.len();
        while let Some(&(token, line)) = tokens.get(at) {
            at += 1;
            match token {
                "{" => {
                    while tokens.get(at).is_some_and(|token| token.0 != "}") {
                        at = self.read_use(tokens, at, prefix, public);
                        at += usize::from(tokens.get(at).is_some_and(|token| token.0 == ","));
                    }
                    at += 1;
                    break;
                }
                "::" => {}
                name => {
                    if name != "*" && (name != "self" || prefix.is_empty()) {
                        prefix.push(name.to_owned());
                    }
                    if tokens.get(at).is_some_and(|token| token.0 == "::") {
                        continue;
                    }
                    let mut name = if name == "*" { "*" } else { prefix.last().map_or("", |last| last) };
                    if tokens.get(at).is_some_and(|token| token.0 == "as") {
                        name = tokens.get(at + 1).map_or("", |token| token.0);
                        at += 2;
                    }
                    let name = name.to_owned();
                    self.imports.push(Import { name, path: prefix.clone(), public, line });
                    break;
                }
            }
        }
        prefix.truncate(length);
        at
    }
}

fn is_name(token: &str) -> bool {
    token.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// Names, `::` and single other characters, each with its line counted from 1.
fn tokens(code: &str) -> Vec<(&str, usize)> {
    let mut tokens = Vec::new();
    for (number, mut line) in (1..).zip(code.lines()) {
        loop {
            line = line.trim_start();
            let Some(first) = line.chars().next() else { break };
            let name = line.find(|c: char| !c.is_alphanumeric() && c != '_').unwrap_or(line.len());
            let length = if line.starts_with("::") { 2 } else { name.max(first.len_utf8()) };
            tokens.push((&line[..length], number));
            line = &line[length..];
        }
    }
    tokens
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The cycles of a crate with these files.
    fn cycles<const N: usize>(files: [(&str, &str); N]) -> Vec<String> {
        let paths = files.map(|(path, text)| (format!("crates/a/src/{path}"), text));
        let tree = Tree::from(paths.each_ref().map(|(path, text)| (path.as_str(), *text)));
        check_crate(&tree, "crates/a/src/").iter().map(ToString::to_string).collect()
    }

    #[test]
    fn files_that_use_each_other_are_a_cycle() {
        let used = "pub struct B;\nuse super::c;\nfn f() { c::g::<u8>() }\n";
        let found = cycles([
            ("lib.rs", "mod a;\nmod b;\nmod c;\n"),
            ("a.rs", "use std::fmt;\nuse crate::b::{self as other, B};\npub fn f() {}\n"),
            ("b.rs", used),
            ("c.rs", "pub fn g() { crate::a::f() }\n"),
        ]);
        let steps = "crates/a/src/a.rs:2 uses crates/a/src/b.rs; crates/a/src/b.rs:2 uses \
                     crates/a/src/c.rs; crates/a/src/c.rs:1 uses crates/a/src/a.rs";
        assert_eq!(found, [format!("crates/a/src/a.rs:2: a cycle: {steps}")]);
    }

    #[test]
    fn re_exports_lead_to_the_files_of_their_items() {
        let named = "mod a;\nmod b;\npub use a::A;\npub use b::*;\n";
        for (root, count) in [(named, 1), ("mod a;\nmod b;\npub struct A;\npub struct B;\n", 0)] {
            let a = "use super::B;\npub struct A(B);\n";
            let found = cycles([("lib.rs", root), ("a.rs", a), ("b.rs", "pub struct B(crate::A);\n")]);
            assert_eq!(found.len(), count, "{root}");
        }
    }

    #[test]
    fn a_module_lists_its_members_and_they_use_its_contract() {
        let set = "mod a;\nmod b;\npub use a::A;\npub trait T {}\npub enum E { A(A), B(b::B) }\n";
        let a = "use super::T;\npub struct A;\nimpl T for A {}\n";
        let of_b = |b: &str| {
            cycles([("s/mod.rs", set), ("s/a.rs", a), ("s/b.rs", b), ("c.rs", "use crate::s::E;\n")])
        };
        assert_eq!(of_b("use super::T;\npub struct B;\nimpl T for B {}\n").len(), 0);
        // Through a file outside the module, or below a member, the way back counts.
        assert_eq!(of_b("pub struct B(crate::c::C);\n").len(), 1);
        let deep = [
            ("s/mod.rs", "mod a;\npub trait T {}\npub enum E { A(a::A) }\n"),
            ("s/a/mod.rs", "mod b;\npub struct A(b::B);\n"),
            ("s/a/b.rs", "use crate::s::E;\npub struct B;\n"),
        ];
        assert_eq!(cycles(deep).len(), 1);
    }

    #[test]
    fn comments_tests_and_visibilities_are_no_uses() {
        let a = "/// See [`crate::b::B`].\npub(in crate::b) struct A;\n#[cfg(test)]\nmod tests { use crate::b::B; }\n";
        let b = "pub struct B(crate::a::A);\n";
        assert_eq!(cycles([("a.rs", a), ("b.rs", b), ("a/tests.rs", "use crate::b::B;\n")]).len(), 0);
    }
}
