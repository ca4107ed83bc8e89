//! Checks of the pages as they are in the repository.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

use super::figure::without_drawings;
use super::page::Page;
use super::{INDEX, PAGES, index, neighbours, nothing, read};
use crate::command::target;

/// The fewest words of a page.
const MIN_WORDS: usize = 150;
/// The places to which every page has a link: the code, and the book.
const LEADS: [&str; 2] = ["href=\"../../crates/", "href=\"https://pbr-book.org/"];

/// Pages have the words and commands of their texts, links hold, and a browser shows them.
pub fn check(root: &Path, pages: &[Page]) -> Result<(), String> {
    let folder = root.join(PAGES);
    let entries = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let names: BTreeSet<String> = entries
        .filter_map(|entry| entry.ok()?.file_name().into_string().ok())
        .filter(|name| name.ends_with(".html"))
        .collect();
    let mut expected = Vec::new();
    let start = index(root)?.to_html(nothing, [None; 2])?;
    for (i, page) in pages.iter().enumerate() {
        let (name, html) = (page.file(), page.to_html(nothing, neighbours(pages, i))?);
        if page.words() < MIN_WORDS {
            return Err(format!("{name} has {} words, fewer than {MIN_WORDS}", page.words()));
        }
        if let Some(lead) = LEADS.iter().find(|lead| !html.contains(**lead)) {
            return Err(format!("{name} has no link with `{lead}`"));
        }
        let shown = [format!("href=\"{name}\""), format!("src=\"{}\"", page.thumbnail_file())];
        if let Some(missing) = shown.iter().find(|shown| !start.contains(*shown)) {
            return Err(format!("{INDEX} has no `{missing}`"));
        }
        expected.push((name, html));
    }
    expected.push(("index.html".to_owned(), start));
    for (name, html) in &expected {
        let found = read(&folder.join(name))?;
        if without_drawings(&found) != without_drawings(html) {
            return Err(format!("{name} differs from its text: `cargo xtask gallery --words` updates it"));
        }
        if let Some(link) = links(&found).find(|link| !folder.join(link).exists()) {
            return Err(format!("{name} refers to `{link}`, which does not exist"));
        }
    }
    if let Some(name) = names.iter().find(|name| expected.iter().all(|(known, _)| known != *name)) {
        return Err(format!("{name} has no text"));
    }
    show(root, &names)
}

/// The files that a page refers to.
fn links(html: &str) -> impl Iterator<Item = &str> {
    let attributes = ["href=\"", "src=\""].into_iter().flat_map(|opening| html.split(opening).skip(1));
    let targets = attributes.filter_map(|rest| rest.split(['"', '#']).next());
    targets.filter(|link| !link.is_empty() && !link.starts_with("data:") && !link.starts_with("https://"))
}

/// Counts in a browser the pictures that pages show, all of which must be whole.
fn show(root: &Path, names: &BTreeSet<String>) -> Result<(), String> {
    let browsers = ["chromium", "chromium-browser", "google-chrome"];
    let found = browsers.into_iter().find(|name| Command::new(name).arg("--version").output().is_ok());
    let Some(browser) = found else {
        println!("SKIPPED, pages are not shown: there is no Chromium");
        return Ok(());
    };
    let wrong = |problem: String| format!("{browser}: {problem}");
    let folder = target(root).join("gallery");
    fs::create_dir_all(&folder).map_err(|error| wrong(error.to_string()))?;
    let list = folder.join("shown.html");
    let mut html = String::from("<!doctype html><meta charset=\"utf-8\"><title>pages</title>\n");
    for name in names {
        let url = root.join(PAGES).join(name);
        let _ = writeln!(html, "<iframe data-name=\"{name}\" src=\"file://{}\"></iframe>", url.display());
    }
    fs::write(&list, html + COUNT).map_err(|error| wrong(error.to_string()))?;
    let mut command = Command::new(browser);
    command.env("HOME", &folder).args(["--headless", "--no-sandbox", "--disable-gpu", "--no-first-run"]);
    command.args(["--disable-quic", "--disable-background-networking", "--allow-file-access-from-files"]);
    command.arg(format!("--user-data-dir={}", folder.join("profile").display()));
    command.args(["--enable-logging=stderr", "--virtual-time-budget=20000", "--dump-dom"]);
    command.arg(format!("file://{}", list.display())).stdin(Stdio::null());
    let output = command.output().map_err(|error| wrong(error.to_string()))?;
    let [said, logged] =
        [&output.stdout, &output.stderr].map(|bytes| String::from_utf8_lossy(bytes).into_owned());
    if let Some(line) = logged.lines().find(|line| line.contains("CONSOLE")) {
        return Err(wrong(line.to_owned()));
    }
    for name in names {
        let pictures = fs::read_to_string(root.join(PAGES).join(name)).unwrap_or_default();
        let pictures = pictures.matches("<img ").count();
        let line = format!("{name}: {pictures} of {pictures} pictures");
        if !said.lines().any(|shown| shown == line) {
            let shown = said.lines().find(|shown| shown.starts_with(&format!("{name}: ")));
            return Err(wrong(format!("not `{line}`, but `{}`", shown.unwrap_or("nothing"))));
        }
    }
    Ok(())
}

/// The script that counts the pictures of each page that are shown.
const COUNT: &str = "<pre></pre><script>
onload = () => {
    const lines = [...document.querySelectorAll('iframe')].map(frame => {
        const images = [...frame.contentDocument.images];
        const whole = images.filter(image => image.complete && image.naturalWidth > 0);
        return `${frame.dataset.name}: ${whole.length} of ${images.length} pictures`;
    });
    document.querySelector('pre').textContent = `\\n${lines.join('\\n')}\\n`;
};
</script>
";

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn links_are_those_to_files() {
        let html = "<link href=\"data:,\"><a href=\"a.html\">a</a> <a href=\"https://b\">b</a> <img src=\"c.jpg\">\
                    <a href=\"d.md#e\">d</a> <img src=\"data:a\">";
        assert_eq!(Vec::from_iter(links(html)), ["a.html", "d.md", "c.jpg"]);
    }
}
