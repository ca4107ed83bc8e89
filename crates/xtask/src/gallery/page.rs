//! A page: its text, and the HTML with what its commands draw.

use std::path::Path;

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd, html};

use super::figure::{Drawn, Figure, escaped};
use super::read;

/// A text in Markdown, which begins with its title. Its blocks `sh` have [figures](Figure), each
/// with a command; those of `sh compared` are compared with the last one of the block.
pub struct Page {
    /// The first heading.
    pub title: String,
    /// The name of its file without the extension.
    name: String,
    text: String,
    /// The folder of the text, from that of pages.
    folder: &'static str,
    /// The figures of each block.
    blocks: Vec<Vec<Figure>>,
}

/// The look of all pages.
const STYLE: &str = "\
body { margin: 2rem auto; max-width: 62rem; padding: 0 1rem; font: 17px/1.5 serif; color: #222; background: #fafaf7 }
h1, h2, nav { font-family: sans-serif } nav { font-size: 14px; display: flex; justify-content: space-between }
figure { margin: 0; flex: 1 1 24rem; max-width: 38rem } figure img { width: 100%; display: block; background: #000 }
figcaption { font: 15px/1.4 sans-serif; padding: .5rem 0 } .pictures { display: flex; flex-wrap: wrap; gap: 1rem; margin: 1rem 0 }
details { font: 13px/1.4 sans-serif; color: #555 } pre { overflow-x: auto; background: #eee; padding: .5rem; margin: 0 0 .25rem }
pre { font-size: 13px; white-space: pre-wrap } code { font-size: .9em }
blockquote { margin: 1rem 0; padding: .25rem 1.5rem; border-left: 3px solid #c8b273; background: #f3f1e7; font-size: 18px }
blockquote p { margin: .5rem 0 } sub, sup { line-height: 0 } td, th { padding: .2rem .75rem; text-align: left; vertical-align: top }
table:has(img) { table-layout: fixed; width: 100% } td img { max-width: 100% } th:empty { padding: 0 }";

impl Page {
    /// Reads a text in a folder, which is told from that of pages.
    pub fn read(path: &Path, folder: &'static str) -> Result<Self, String> {
        let wrong = |problem: &str| format!("{}: {problem}", path.display());
        let text = read(path)?;
        let blocks = blocks(&text).map_err(|problem| wrong(&problem))?;
        let title = text.lines().next().and_then(|line| line.strip_prefix("# "));
        let title = title.ok_or_else(|| wrong("a page begins with its title"))?.to_owned();
        let name =
            path.file_stem().and_then(|stem| stem.to_str()).ok_or_else(|| wrong("no name"))?.to_owned();
        Ok(Self { title, name, text, folder, blocks })
    }

    /// The name of its HTML file.
    pub fn file(&self) -> String {
        format!("{}.html", self.name)
    }

    /// The file of its thumbnail.
    pub fn thumbnail_file(&self) -> String {
        format!("thumbnails/{}.jpg", self.name)
    }

    /// The command whose picture stands for the page: the one so marked, else the first.
    pub fn thumbnail(&self) -> Option<&str> {
        let mut figures = self.blocks.iter().flatten();
        let first = figures.clone().next();
        figures.find(|figure| figure.is_thumbnail).or(first).map(|figure| figure.command.as_str())
    }

    /// Its commands in their order.
    pub fn commands(&self) -> Vec<String> {
        self.blocks.iter().flatten().map(|figure| figure.command.clone()).collect()
    }

    /// The number of words that are read, without those of commands and their figures.
    pub fn words(&self) -> usize {
        let mut in_code = false;
        let mut count = 0;
        for event in Parser::new(&self.text) {
            match event {
                Event::Start(Tag::CodeBlock(_)) => in_code = true,
                Event::End(TagEnd::CodeBlock) => in_code = false,
                Event::Text(text) if !in_code => {
                    let is_word = |word: &&str| word.chars().filter(|c| c.is_alphabetic()).count() > 1;
                    count += text.split_whitespace().filter(is_word).count();
                }
                _ => (),
            }
        }
        count
    }

    /// The page with what its commands draw, and links to its neighbours. The lines of a block are
    /// drawn together, and it is told whether they are compared.
    pub fn to_html(
        &self,
        draw: impl Fn(&[&str], bool) -> Result<Vec<Drawn>, String>,
        [before, after]: [Option<&Self>; 2],
    ) -> Result<String, String> {
        let (mut events, mut blocks, mut inside) = (Vec::new(), self.blocks.iter(), false);
        for event in Parser::new_ext(&self.text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::CodeBlock(kind)) if is_of_commands(&kind) => {
                    inside = true;
                    let figures = blocks.next().map_or(&[][..], Vec::as_slice);
                    let lines: Vec<&str> = figures.iter().map(|figure| figure.command.as_str()).collect();
                    let drawn = draw(&lines, is_compared(&kind))?;
                    let figures: String =
                        figures.iter().zip(&drawn).map(|(figure, drawn)| figure.to_html(drawn)).collect();
                    events.push(Event::Html(format!("<div class=\"pictures\">{figures}</div>\n").into()));
                }
                Event::End(TagEnd::CodeBlock) if inside => inside = false,
                Event::Text(_) if inside => (),
                Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                    let dest_url = self.target(&dest_url).into();
                    events.push(Event::Start(Tag::Link { link_type, dest_url, title, id }));
                }
                event => events.push(event),
            }
        }
        let mut body = String::new();
        html::push_html(&mut body, events.into_iter());
        let link = |page: Option<&Self>, arrow: &str| {
            page.map_or(String::new(), |page| {
                format!("<a href=\"{}\">{arrow} {}</a>", page.file(), escaped(&page.title))
            })
        };
        if self.folder.is_empty() {
            return Ok(document(&self.title, &body));
        }
        let nav = format!(
            "<nav><span>{}</span><a href=\"index.html\">all pages</a><span>{}</span></nav>\n",
            link(before, "←"),
            link(after, "→")
        );
        Ok(document(&self.title, &format!("{nav}{body}{nav}")))
    }

    /// The target from the page of a link of the text: the page of a text, and other files as
    /// they are.
    fn target(&self, link: &str) -> String {
        if link.contains("://") || link.starts_with('#') {
            return link.to_owned();
        }
        let from_pages = match link.strip_prefix("../") {
            Some(rest) if !self.folder.is_empty() => rest.to_owned(),
            _ => format!("{}{link}", self.folder),
        };
        from_pages.strip_prefix("pages/").map_or(from_pages.clone(), |text| text.replace(".md", ".html"))
    }
}

/// The figures of each block of commands in a text.
fn blocks(text: &str) -> Result<Vec<Vec<Figure>>, String> {
    let (mut blocks, mut inside) = (Vec::new(), None);
    for event in Parser::new(text) {
        match event {
            Event::Start(Tag::CodeBlock(kind)) if is_of_commands(&kind) => inside = Some(String::new()),
            Event::Text(lines) => inside.iter_mut().for_each(|block| block.push_str(&lines)),
            Event::End(TagEnd::CodeBlock) => {
                blocks.extend(inside.take().map(|block| Figure::of_block(&block)))
            }
            _ => (),
        }
    }
    blocks.into_iter().collect()
}

fn is_of_commands(kind: &CodeBlockKind) -> bool {
    matches!(kind, CodeBlockKind::Fenced(info) if info.split(' ').next() == Some("sh"))
}

fn is_compared(kind: &CodeBlockKind) -> bool {
    matches!(kind, CodeBlockKind::Fenced(info) if info.split(' ').any(|word| word == "compared"))
}

fn document(title: &str, body: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<link rel=\"icon\" href=\"data:,\">\n\
         <title>{}</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escaped(title)
    )
}

#[cfg(test)]
mod tests {
    use super::super::nothing;
    use super::*;

    fn page(text: &str, folder: &'static str) -> Page {
        let blocks = blocks(text).unwrap();
        Page { title: "Title".into(), name: "a".into(), text: text.into(), folder, blocks }
    }

    #[test]
    fn commands_are_those_of_blocks_of_the_shell() {
        let text = "# Title\n\nSome text with `code`.\n\n```sh\n# A.\n# alt: a\nalhazen render a\n\
                    # B.\n# alt: b\n# thumbnail\nalhazen render b\n```\n\n```\nnot this\n```\n";
        let page = page(text, "pages/");
        assert_eq!(page.commands(), ["alhazen render a", "alhazen render b"]);
        assert_eq!(page.thumbnail(), Some("alhazen render b"));
        assert_eq!(page.words(), 4);
        let html = page.to_html(nothing, [None; 2]).unwrap();
        assert_eq!(html.matches("<figure>").count(), 2);
        assert!(html.contains("not this") && !html.contains("# alt"));
    }

    #[test]
    fn links_lead_from_pages_where_they_lead_from_texts() {
        let (text, index) = (page("", "pages/"), page("", ""));
        assert_eq!(text.target("08-shadows.md"), "08-shadows.html");
        assert_eq!(text.target("../../references.md"), "../references.md");
        assert_eq!(text.target("../../../crates/a/src/b.rs"), "../../crates/a/src/b.rs");
        assert_eq!(text.target("https://pbr-book.org/a.md"), "https://pbr-book.org/a.md");
        assert_eq!(index.target("pages/08-shadows.md"), "08-shadows.html");
        assert_eq!(index.target("../cli.md"), "../cli.md");
    }
}
