//! The gallery: pages that show what the program draws, each made of a text in
//! `docs/gallery/pages`.
//!
//! The blocks of commands in a text are run, and what they draw becomes part of the page with what
//! it cost, so that pages agree with the program. Pages are self-contained.

mod command;
mod page;
mod pages;

use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::scenes;
use page::Page;
use showcase::Size;

/// The folders of texts and of pages.
const TEXTS: &str = "docs/gallery/pages";
const PAGES: &str = "docs/gallery";

/// Makes the pages that have one of these in their names, or all if there are none, with the
/// program built for release.
pub fn make(root: &Path, names: &[&str]) -> Result<(), String> {
    super::command::succeed(super::command::cargo(root).args([
        "build",
        "--release",
        "-p",
        "alhazen-cli",
        "--features",
        "gpu",
    ]))?;
    let program = super::command::target(root).join("release/alhazen");
    let pages = pages(root)?;
    let is_chosen = |page: &Page| names.is_empty() || names.iter().any(|name| page.file().contains(name));
    make_scenes(root, pages.iter().filter(|page| is_chosen(page)), Size::Whole)?;
    for (i, page) in pages.iter().enumerate().filter(|(_, page)| is_chosen(page)) {
        println!("{}", page.title);
        let neighbours = neighbours(&pages, i);
        let draw = |lines: &[&str], compared: bool| {
            if compared {
                return command::compare(root, &program, lines);
            }
            lines.iter().map(|line| command::run(root, &program, line, Size::Whole, "picture")).collect()
        };
        let html = page.to_html(draw, neighbours)?;
        let path = root.join(PAGES).join(page.file());
        fs::write(&path, html).map_err(|error| format!("{}: {error}", path.display()))?;
    }
    let index = root.join(PAGES).join("index.html");
    fs::write(&index, page::index(&pages)).map_err(|error| format!("{}: {error}", index.display()))
}

/// Checks pages as they are, and runs the commands of all with small scenes and pictures, and with
/// the program of tests: two at once, because most of what they do is on one core.
pub fn check(root: &Path) -> Result<(), String> {
    let program = super::command::target(root).join("debug/alhazen");
    let pages = pages(root)?;
    pages::check(root, &pages)?;
    make_scenes(root, pages.iter(), Size::Small)?;
    let commands: Vec<String> = pages.iter().flat_map(Page::commands).collect();
    let taken = AtomicUsize::new(0);
    let run = |from: &mut dyn Iterator<Item = &String>, name: &str| {
        while taken.fetch_add(1, Ordering::Relaxed) < commands.len() {
            let Some(command) = from.next() else { break };
            command::run(root, &program, command, Size::Small, name)?;
        }
        Ok(())
    };
    // From both ends: neighbours use the same kernels, which are compiled once.
    thread::scope(|scope| {
        let last = scope.spawn(|| run(&mut commands.iter().rev(), "picture-2"));
        let first = run(&mut commands.iter(), "picture-1");
        first.and(last.join().map_err(|_| "a panic".to_string())?)
    })
}

/// The pages before and after one.
fn neighbours(pages: &[Page], i: usize) -> [Option<&Page>; 2] {
    [i.checked_sub(1), Some(i + 1)].map(|i| i.and_then(|i| pages.get(i)))
}

/// Makes the scenes of formulas that pages draw.
fn make_scenes<'a>(root: &Path, pages: impl Iterator<Item = &'a Page>, size: Size) -> Result<(), String> {
    let commands: Vec<String> = pages.flat_map(Page::commands).collect();
    let names = made_scenes(&commands);
    // No names at all would be all scenes.
    if names.is_empty() { Ok(()) } else { scenes::run(root, &Vec::from_iter(names), size) }
}

/// The names of the scenes in `target/scenes` that commands draw.
fn made_scenes(commands: &[String]) -> BTreeSet<&str> {
    let words = commands.iter().flat_map(|line| line.split_whitespace());
    let in_scenes =
        words.filter_map(|word| word.strip_prefix(scenes::folder(Size::Whole))?.strip_prefix('/'));
    in_scenes.filter_map(|rest| rest.split('/').next()).collect()
}

/// The texts in the order of their names.
fn pages(root: &Path) -> Result<Vec<Page>, String> {
    let folder = root.join(TEXTS);
    let entries = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let mut paths: Vec<PathBuf> = entries.filter_map(|entry| Some(entry.ok()?.path())).collect();
    paths.sort();
    paths.iter().map(|path| Page::read(path)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn scenes_of_formulas_are_known_by_their_folder() {
        let commands =
            ["alhazen render scenes/a.pbrt", "alhazen render target/scenes/car/car-street.pbrt --spp 4"];
        let commands = commands.map(str::to_owned);
        assert_eq!(Vec::from_iter(made_scenes(&commands)), ["car"]);
        assert!(made_scenes(&commands[..1]).is_empty());
    }
}
