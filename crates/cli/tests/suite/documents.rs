//! The commands of the documents run, at small size.
//!
//! In the README, tutorials, how-tos and explanations
//!
//! - blocks of `sh` are run one after another, in a folder for each page that has the repository's
//!   `scenes`;
//! - a block whose language is followed by a file's name is that file, as in `pbrt first.pbrt`;
//!   with `>>` before the name it is appended;
//! - blocks of `console` and others are shown only: their commands need other machines or programs,
//!   or fail on purpose.

use std::fs::{self, OpenOptions};
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::common::Folder;

/// Commands that are not run, by a part of them, and why.
const NOT_RUN: [(&str, &str); 7] = [
    ("cargo ", "builds the program"),
    ("git ", "needs the network"),
    ("pip ", "needs the network"),
    ("alhazen view ", "opens a window"),
    ("--device ", "needs the feature `gpu`"),
    ("--serve", "needs the feature `serve`"),
    ("--tev", "needs another program"),
];

/// Most samples per pixel of a render.
const MAX_SPP: u32 = 4;

/// Options of renders and comparisons, and their values here.
const SMALL: [(&str, &str); 2] = [("--resolution", "48x32"), ("--time", "0.1s")];

/// A fenced block of a page.
struct Block {
    line: usize,
    info: String,
    text: String,
}

fn blocks(page: &str) -> Vec<Block> {
    let mut blocks = Vec::new();
    let mut open: Option<Block> = None;
    for (number, line) in page.lines().enumerate() {
        match (&mut open, line.strip_prefix("```")) {
            (None, Some(info)) => {
                open = Some(Block { line: number + 1, info: info.trim().into(), text: String::new() });
            }
            (Some(_), Some(_)) => blocks.extend(open.take()),
            (Some(block), None) => block.text += &format!("{line}\n"),
            (None, None) => {}
        }
    }
    blocks
}

/// A command without its comment, with fewer samples and pixels; nothing if it is not run.
fn small(command: &str) -> Option<String> {
    if NOT_RUN.iter().any(|(part, _)| command.contains(part)) {
        return None;
    }
    let command = command.split(" #").next().unwrap_or_default().trim_end();
    let mut words: Vec<String> = command.split_whitespace().map(str::to_owned).collect();
    let program = words.iter().position(|word| word == "alhazen");
    let task = program.and_then(|at| words.get(at + 1)).map(String::as_str);
    if !matches!(task, Some("render" | "compare")) {
        return Some(command.into());
    }
    if let Some(at) = words.iter().position(|word| word == "--spp") {
        let spp: u32 = words[at + 1].parse().expect("a number of samples");
        words[at + 1] = spp.min(MAX_SPP).to_string();
    }
    for (option, value) in SMALL {
        match words.iter().position(|word| word == option) {
            Some(at) => words[at + 1] = value.into(),
            None if option == "--resolution" => words.extend([option.into(), value.into()]),
            None => {}
        }
    }
    Some(words.join(" "))
}

fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// Writes the files of a page and runs its commands; the number of its commands.
fn run(page: &Path) -> usize {
    let folder = Folder::new("documents");
    let scenes = fs::canonicalize(root().join("scenes")).unwrap();
    std::os::unix::fs::symlink(scenes, folder.path().join("scenes")).unwrap();
    let program = Path::new(env!("CARGO_BIN_EXE_alhazen")).parent().unwrap();
    let path = format!("{}:{}", program.display(), std::env::var("PATH").unwrap());
    let text = fs::read_to_string(page).unwrap();
    let mut count = 0;
    for Block { line, info, text } in blocks(&text) {
        match info.split_whitespace().collect::<Vec<_>>()[..] {
            ["sh"] => {
                let joined = text.replace("\\\n", " ");
                let commands: Vec<String> = joined.lines().filter_map(small).collect();
                let mut shell = Command::new("sh");
                shell.args(["-eu", "-c", &commands.join("\n")]).env("PATH", &path).stdin(Stdio::null());
                let output = shell.current_dir(folder.path()).output().unwrap();
                let told = String::from_utf8_lossy(&output.stderr);
                assert!(output.status.success(), "{}:{line}: {told}\n{commands:#?}", page.display());
                count += commands.len();
            }
            [_, name] => folder.write(name, &text),
            [_, ">>", name] => {
                let mut file = OpenOptions::new().append(true).open(folder.path().join(name)).unwrap();
                file.write_all(text.as_bytes()).unwrap();
            }
            _ => {}
        }
    }
    count
}

/// Runs the pages of a folder of documents; the number of their commands.
fn run_folder(name: &str) -> usize {
    let entries = fs::read_dir(root().join("docs").join(name)).unwrap();
    let pages = entries.map(|entry| entry.unwrap().path());
    pages.filter(|path| path.extension().is_some_and(|end| end == "md")).map(|page| run(&page)).sum()
}

#[test]
fn the_commands_of_the_readme_run() {
    run(&root().join("README.md"));
}

#[test]
fn the_commands_of_tutorials_run() {
    assert!(run_folder("tutorials") > 20);
}

#[test]
fn the_commands_of_how_tos_run() {
    assert!(run_folder("how-to") > 20);
}

#[test]
fn the_commands_of_explanations_run() {
    assert!(run_folder("explanation") > 5);
}

#[test]
fn commands_are_made_small() {
    let command = "A=1 alhazen render a.pbrt --spp 64 --time 1s -o a.exr  # a second";
    let expected = "A=1 alhazen render a.pbrt --spp 4 --time 0.1s -o a.exr --resolution 48x32";
    assert_eq!(small(command).as_deref(), Some(expected));
    assert_eq!(small("alhazen merge a.film -o a.exr").as_deref(), Some("alhazen merge a.film -o a.exr"));
    assert_eq!(small("cargo build"), None);
}
