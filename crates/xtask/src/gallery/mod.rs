//! The gallery: pages that show what the program draws, each made of a text in
//! `docs/gallery/pages`.
//!
//! The commands in a text are run, and what they draw becomes part of the page with what it cost,
//! so that pages agree with the program. Pages are self-contained. The index is a text, too, which
//! code hosts show with the folder; it has a thumbnail of each page.

mod command;
mod figure;
mod page;
mod pages;
mod thumbnail;

use std::collections::{BTreeSet, HashMap};
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread;

use super::scenes;
use figure::Drawn;
use page::Page;
use showcase::Size;

/// The folders of texts and of pages.
const TEXTS: &str = "docs/gallery/pages";
const PAGES: &str = "docs/gallery";
/// The text of the index.
const INDEX: &str = "docs/gallery/README.md";

/// The option that leaves pictures as they are.
const WORDS: &str = "--words";

/// Makes the pages that have one of these in their names, or all if there are none, with the
/// program built for release. With [`WORDS`] nothing is drawn: each page keeps the pictures of its
/// commands, and a new command is an error.
pub fn make(root: &Path, arguments: &[&str]) -> Result<(), String> {
    let (options, names): (Vec<&str>, Vec<&str>) = arguments.iter().partition(|word| word.starts_with("--"));
    let is_drawn = match options[..] {
        [] => true,
        [WORDS] => false,
        _ => {
            return Err(format!(
                "{} is no option of `gallery`, whose only one is {WORDS}",
                options.join(" ")
            ));
        }
    };
    let pages = pages(root)?;
    let is_chosen = |page: &Page| names.is_empty() || names.iter().any(|name| page.file().contains(name));
    let program = super::command::target(root).join("release/alhazen");
    if is_drawn {
        build(root)?;
        make_scenes(root, pages.iter().filter(|page| is_chosen(page)), Size::Whole)?;
    }
    for (i, page) in pages.iter().enumerate().filter(|(_, page)| is_chosen(page)) {
        println!("{}", page.title);
        let path = root.join(PAGES).join(page.file());
        let kept = if is_drawn { HashMap::new() } else { figure::drawn(&read(&path)?) };
        let draw = |lines: &[&str], compared: bool| match (is_drawn, compared) {
            (false, _) => lines.iter().map(|&line| keep(&kept, line)).collect(),
            (true, true) => command::compare(root, &program, lines),
            (true, false) => {
                lines.iter().map(|line| command::run(root, &program, line, Size::Whole, "picture")).collect()
            }
        };
        let html = page.to_html(draw, neighbours(&pages, i))?;
        if let Some(drawn) = page.thumbnail().and_then(|command| figure::drawn(&html).remove(command)) {
            thumbnail::write(&drawn, &root.join(PAGES).join(page.thumbnail_file()))?;
        }
        write(&path, &html)?;
    }
    write(&root.join(PAGES).join("index.html"), &index(root)?.to_html(nothing, [None; 2])?)
}

/// Builds the program for release.
fn build(root: &Path) -> Result<(), String> {
    let arguments = ["build", "--release", "-p", "alhazen-cli", "--features", "gpu"];
    super::command::succeed(super::command::cargo(root).args(arguments))
}

/// The picture that a page has of a command.
fn keep(kept: &HashMap<String, Drawn>, command: &str) -> Result<Drawn, String> {
    kept.get(command)
        .cloned()
        .ok_or_else(|| format!("the page has no picture of `{command}`; leave out {WORDS}"))
}

/// No pictures, for a page that has none or whose pictures do not matter.
fn nothing(commands: &[&str], _: bool) -> Result<Vec<Drawn>, String> {
    Ok(commands.iter().map(|_| Drawn::default()).collect())
}

/// The text of the index.
fn index(root: &Path) -> Result<Page, String> {
    Page::read(&root.join(INDEX), "")
}

fn read(path: &Path) -> Result<String, String> {
    fs::read_to_string(path).map_err(|error| format!("{}: {error}", path.display()))
}

fn write(path: &Path, text: &str) -> Result<(), String> {
    fs::write(path, text).map_err(|error| format!("{}: {error}", path.display()))
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
    paths.iter().map(|path| Page::read(path, "pages/")).collect()
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
