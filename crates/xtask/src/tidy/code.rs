//! Rules of Rust code: libraries neither print nor exit, only listed files access the file system,
//! unsafe code is in listed files, and nothing is unfinished or global and mutable.

use super::tree::Tree;
use super::{Finding, rust};

/// Crates that are programs: they may print, exit and access files.
const PROGRAMS: [&str; 3] = ["crates/bench/", "crates/cli/", "crates/xtask/"];

/// Where a library may access files: codecs, the sources of assets, the showcase, and the
/// comparison of pages with the code that they are made of.
const FILE_READERS: [&str; 5] = [
    "crates/assets/src/source.rs",
    "crates/image/",
    "crates/python/",
    "crates/showcase/",
    "crates/testkit/src/generated.rs",
];

/// Words that are forbidden in all code, also in tests, and why.
const NOWHERE: [(&str, &str); 5] = [
    ("todo!", "finish it"),
    ("unimplemented!", "finish it"),
    ("dbg!", "take it out"),
    ("#[ignore]", "say why: #[ignore = \"slow: …\"]"),
    ("static mut ", "there is no mutable global state"),
];

/// Where unsafe code is allowed: SIMD, ray traversal, ray queries of GPUs, the environment of their
/// drivers, and loading of Embree.
const UNSAFE: [&str; 8] = [
    "crates/lanes/",
    "crates/geometry/src/bvh/",
    "crates/geometry/src/triples.rs",
    "crates/geometry/src/watertight.rs",
    "crates/geometry/src/world/",
    "crates/gpu/src/device.rs",
    "crates/cli/src/device.rs",
    "crates/bench/src/embree.rs",
];

/// Words that are forbidden in libraries outside tests, and what to do instead.
const NOT_IN_LIBRARIES: [(&str, &str); 6] = [
    ("print!", "libraries return values, and programs print them"),
    ("println!", "libraries return values, and programs print them"),
    ("eprint!", "libraries return errors, and programs print them"),
    ("eprintln!", "libraries return errors, and programs print them"),
    ("process::exit", "libraries return errors, and programs exit"),
    ("process::abort", "libraries return errors, and programs exit"),
];

/// Where pictures are made, so that the same input gives the same bits on every platform: functions
/// of the standard library are those of the platform's C library.
const PICTURES: [&str; 12] = [
    "crates/math/",
    "crates/spectrum/",
    "crates/sampling/",
    "crates/image/",
    "crates/geometry/",
    "crates/scattering/",
    "crates/planet/",
    "crates/assets/",
    "crates/import/",
    "crates/scene/",
    "crates/film/",
    "crates/integrators/",
];

/// Functions of the standard library that differ among platforms, as methods and by their paths.
const OF_THE_PLATFORM: [&str; 21] = [
    "sin", "cos", "tan", "asin", "acos", "atan", "atan2", "sin_cos", "sinh", "cosh", "tanh", "exp", "exp2",
    "exp_m1", "ln", "ln_1p", "log2", "log10", "powf", "cbrt", "hypot",
];

/// File system access.
const FILES: [&str; 5] = ["std::fs", "fs::read", "File::open", "File::create", "OpenOptions"];

/// Where a static may be mutable: only what a process keeps itself tells it that it was forked.
const GLOBALS: [&str; 1] = ["crates/python/src/calls.rs"];

/// What makes a static mutable.
const CELLS: [&str; 5] = ["Mutex", "RwLock", "Atomic", "Cell<", "thread_local!"];

pub fn check(tree: &Tree) -> Vec<Finding> {
    tree.ending(".rs").flat_map(|(path, text)| check_file(path, text)).collect()
}

fn check_file(path: &str, text: &str) -> Vec<Finding> {
    let mut findings = Vec::new();
    let code = rust::layers(text).code;
    each_word(&code, &NOWHERE, |line, word, instead| {
        findings.push(Finding::new(path, line, format!("`{}`: {instead}", word.trim())));
    });
    let outside = |folders: &[&str]| !folders.iter().any(|folder| path.starts_with(folder));
    if outside(&UNSAFE) {
        each_word(&code, &[("unsafe ", "only what tidy's code.rs names needs it")], |line, word, instead| {
            findings.push(Finding::new(path, line, format!("`{}`: {instead}", word.trim())));
        });
    }
    let is_test = path.ends_with("tests.rs") || path.contains("/tests/");
    let library = path.contains("/src/") && outside(&PROGRAMS) && !is_test;
    if library {
        let code = rust::without_tests(&code);
        each_word(&code, &NOT_IN_LIBRARIES, |line, word, instead| {
            findings.push(Finding::new(path, line, format!("`{word}` in a library: {instead}")));
        });
        for (number, line) in code.lines().enumerate() {
            if !outside(&PICTURES)
                && let Some(function) = of_the_platform(line)
            {
                let message = format!("`{function}` differs among platforms: take that of `lanes` or `libm`");
                findings.push(Finding::new(path, number + 1, message));
            }
            if outside(&FILE_READERS) && FILES.iter().any(|word| finds(line, word)) {
                let message = "files are read by image codecs, the sources of assets and shells alone";
                findings.push(Finding::new(path, number + 1, message));
            }
            let global = words_start(line, "static ") || line.contains("thread_local!");
            if global && outside(&GLOBALS) && CELLS.iter().any(|cell| line.contains(cell)) {
                findings.push(Finding::new(path, number + 1, "mutable global state; pass it as a value"));
            }
        }
    }
    findings
}

/// Calls `found` with line, word and remark for every line that has a word of the table.
fn each_word(code: &str, table: &[(&str, &str)], mut found: impl FnMut(usize, &str, &str)) {
    for (number, line) in code.lines().enumerate() {
        for (word, remark) in table.iter().filter(|(word, _)| finds(line, word)) {
            found(number + 1, word, remark);
        }
    }
}

/// Whether a line has the word, not as the suffix of a longer one.
fn finds(line: &str, word: &str) -> bool {
    line.match_indices(word)
        .any(|(at, _)| !line[..at].chars().next_back().is_some_and(|c| c.is_alphanumeric() || c == '_'))
}

/// The function of the platform's library that a line calls or names, if any.
fn of_the_platform(line: &str) -> Option<&'static str> {
    let calls = |name: &&str| {
        line.contains(&format!(".{name}("))
            || ["f32", "f64"].iter().any(|float| finds(line, &format!("{float}::{name}")))
    };
    OF_THE_PLATFORM.into_iter().find(calls)
}

/// Whether an item starts with these words, after its visibility.
fn words_start(line: &str, word: &str) -> bool {
    line.trim_start().trim_start_matches("pub ").trim_start_matches("pub(crate) ").starts_with(word)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(path: &str, text: &str) -> usize {
        check_file(path, text).len()
    }

    #[test]
    fn libraries_do_not_print_but_programs_and_tests_may() {
        let print = "fn a() {\n    println!(\"b\");\n}\n";
        let finding = &check_file("crates/math/src/a.rs", print)[0];
        assert_eq!(
            finding.to_string(),
            "crates/math/src/a.rs:2: `println!` in a library: libraries return values, and programs print them"
        );
        assert_eq!(found("crates/cli/src/main.rs", print), 0);
        assert_eq!(found("crates/math/tests/a.rs", print), 0);
        assert_eq!(found("crates/math/examples/a.rs", print), 0);
        assert_eq!(found("crates/math/src/a.rs", &format!("#[cfg(test)]\nmod tests {{ {print} }}\n")), 0);
        assert_eq!(found("crates/math/src/a.rs", "//! println!\nconst A: &str = \"println!\";\n"), 0);
    }

    #[test]
    fn files_are_for_codecs_and_assets() {
        for code in ["use std::fs;\n", "let a = File::open(path)?;\n"] {
            assert_eq!(found("crates/scene/src/a.rs", code), 1);
            assert_eq!(found("crates/image/src/a.rs", code), 0);
            assert_eq!(found("crates/assets/src/source.rs", code), 0);
        }
    }

    #[test]
    fn unfinished_and_unsafe_code_is_found_everywhere() {
        for code in
            ["todo!()", "dbg!(a)", "unimplemented!()", "#[ignore]", "unsafe { a() }", "static mut A: u8 = 0;"]
        {
            assert_eq!(found("crates/math/tests/a.rs", code), 1, "{code}");
        }
        assert_eq!(found("crates/math/tests/a.rs", "#[ignore = \"slow: an hour\"]"), 0);
        assert_eq!(found("crates/lanes/src/a.rs", "unsafe { a() }"), 0);
        assert_eq!(found("crates/geometry/src/shape/a.rs", "unsafe { a() }"), 1);
    }

    #[test]
    fn pictures_take_no_functions_of_the_platform() {
        for code in ["let a = b.sin();\n", "let a = (2.0 * b).atan2(c);\n", "let a = b.map(f64::exp);\n"] {
            assert_eq!(found("crates/scene/src/a.rs", code), 1, "{code}");
            assert_eq!(found("crates/cli/src/a.rs", code), 0, "{code}");
        }
        for code in ["let a = lanes::sin(b);\n", "let a = libm::exp(b);\n", "let a = b.since(c);\n"] {
            assert_eq!(found("crates/scene/src/a.rs", code), 0, "{code}");
        }
    }

    #[test]
    fn statics_do_not_change() {
        assert_eq!(found("crates/math/src/a.rs", "static A: Mutex<u8> = Mutex::new(0);\n"), 1);
        assert_eq!(found("crates/math/src/a.rs", "pub static A: AtomicBool = AtomicBool::new(false);\n"), 1);
        assert_eq!(found("crates/math/src/a.rs", "static A: LazyLock<u8> = LazyLock::new(|| 1);\n"), 0);
    }
}
