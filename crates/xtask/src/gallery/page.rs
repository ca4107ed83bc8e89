//! A page: its text, and the HTML with what its commands draw.

use std::fs;
use std::path::Path;

use pulldown_cmark::{CodeBlockKind, Event, Options, Parser, Tag, TagEnd, html};

use super::command::Drawn;

/// A text in Markdown, which begins with its title. Its blocks `sh` have a command in each line;
/// those of `sh compared` are compared with the last one of the block.
pub struct Page {
    /// The first heading.
    pub title: String,
    /// The name of its file without the extension.
    name: String,
    text: String,
}

/// The look of all pages.
const STYLE: &str = "\
body { margin: 2rem auto; max-width: 62rem; padding: 0 1rem; font: 17px/1.5 serif; color: #222; background: #fafaf7 }
h1, h2, nav { font-family: sans-serif } nav { font-size: 14px; display: flex; justify-content: space-between }
figure { margin: 0; flex: 1 1 24rem; max-width: 38rem } figure img { width: 100%; display: block; background: #000 }
figcaption { font: 13px/1.4 sans-serif; color: #555 } .pictures { display: flex; flex-wrap: wrap; gap: 1rem; margin: 1rem 0 }
pre { overflow-x: auto; background: #eee; padding: .5rem; font-size: 13px; white-space: pre-wrap } code { font-size: .9em }
.all { display: grid; grid-template-columns: repeat(auto-fill, minmax(16rem, 1fr)); gap: .5rem 2rem }";

impl Page {
    /// Reads a text.
    pub fn read(path: &Path) -> Result<Self, String> {
        let wrong = |problem: &str| format!("{}: {problem}", path.display());
        let text = fs::read_to_string(path).map_err(|error| wrong(&error.to_string()))?;
        let title = text.lines().next().and_then(|line| line.strip_prefix("# "));
        let title = title.ok_or_else(|| wrong("a page begins with its title"))?.to_owned();
        let name =
            path.file_stem().and_then(|stem| stem.to_str()).ok_or_else(|| wrong("no name"))?.to_owned();
        Ok(Self { title, name, text })
    }

    /// The name of its HTML file.
    pub fn file(&self) -> String {
        format!("{}.html", self.name)
    }

    /// Its commands in their order.
    pub fn commands(&self) -> Vec<String> {
        let (mut commands, mut inside) = (Vec::new(), false);
        for event in Parser::new(&self.text) {
            match event {
                Event::Start(Tag::CodeBlock(kind)) => inside = is_of_commands(&kind),
                Event::End(TagEnd::CodeBlock) => inside = false,
                Event::Text(lines) if inside => commands.extend(lines.lines().map(str::to_owned)),
                _ => (),
            }
        }
        commands
    }

    /// The page with what its commands draw, and links to its neighbours. The lines of a block are
    /// drawn together, and it is told whether they are compared.
    pub fn to_html(
        &self,
        draw: impl Fn(&[&str], bool) -> Result<Vec<Drawn>, String>,
        [before, after]: [Option<&Self>; 2],
    ) -> Result<String, String> {
        let (mut events, mut inside, mut compared) = (Vec::new(), false, false);
        for event in Parser::new_ext(&self.text, Options::ENABLE_TABLES) {
            match event {
                Event::Start(Tag::CodeBlock(kind)) if is_of_commands(&kind) => {
                    (inside, compared) = (true, is_compared(&kind));
                }
                Event::End(TagEnd::CodeBlock) if inside => inside = false,
                Event::Text(lines) if inside => {
                    let lines: Vec<&str> = lines.lines().collect();
                    let drawn = draw(&lines, compared)?;
                    let figures: String =
                        lines.into_iter().zip(drawn).map(|(line, drawn)| figure(line, drawn)).collect();
                    events.push(Event::Html(format!("<div class=\"pictures\">{figures}</div>\n").into()));
                }
                // Texts refer to texts, pages to pages.
                Event::Start(Tag::Link { link_type, dest_url, title, id }) => {
                    let dest_url = dest_url.replace(".md", ".html").into();
                    events.push(Event::Start(Tag::Link { link_type, dest_url, title, id }));
                }
                event => events.push(event),
            }
        }
        let mut body = String::new();
        html::push_html(&mut body, events.into_iter());
        let link = |page: Option<&Self>, arrow: &str| {
            page.map_or(String::new(), |page| {
                format!("<a href=\"{}\">{arrow} {}</a>", page.file(), page.title)
            })
        };
        let nav = format!(
            "<nav><span>{}</span><a href=\"index.html\">all pages</a><span>{}</span></nav>\n",
            link(before, "←"),
            link(after, "→")
        );
        Ok(document(&self.title, &format!("{nav}{body}{nav}")))
    }
}

fn is_of_commands(kind: &CodeBlockKind) -> bool {
    matches!(kind, CodeBlockKind::Fenced(info) if info.split(' ').next() == Some("sh"))
}

fn is_compared(kind: &CodeBlockKind) -> bool {
    matches!(kind, CodeBlockKind::Fenced(info) if info.split(' ').any(|word| word == "compared"))
}

/// A command with what it draws.
fn figure(line: &str, Drawn { picture, cost, text }: Drawn) -> String {
    let told = if text.is_empty() { text } else { format!("<pre>{}</pre>", escaped(&text)) };
    let (line, cost) = (escaped(line), escaped(&cost));
    format!(
        "<figure><pre>{line}</pre><img src=\"{picture}\" alt=\"what the command draws\">\
         <figcaption>{cost}</figcaption>{told}</figure>\n"
    )
}

/// The page with links to all others.
pub fn index(pages: &[Page]) -> String {
    let links: String = pages
        .iter()
        .map(|page| format!("<a href=\"{}\">{}</a>\n", page.file(), escaped(&page.title)))
        .collect();
    let body = format!("<h1>Ray tracing, picture by picture</h1>\n<div class=\"all\">\n{links}</div>\n");
    document("Ray tracing, picture by picture", &body)
}

fn document(title: &str, body: &str) -> String {
    format!(
        "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta name=\"viewport\" content=\"width=device-width\">\n<link rel=\"icon\" href=\"data:,\">\n\
         <title>{}</title>\n<style>\n{STYLE}\n</style>\n</head>\n<body>\n{body}</body>\n</html>\n",
        escaped(title)
    )
}

fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn commands_are_those_of_blocks_of_the_shell() {
        let text = "# Title\n\nText with `code`.\n\n```sh\nalhazen render a\nalhazen render b\n```\n\n```\nnot this\n```\n";
        let page = Page { title: "Title".into(), name: "a".into(), text: text.into() };
        assert_eq!(page.commands(), ["alhazen render a", "alhazen render b"]);
        assert!(index(&[page]).contains("<a href=\"a.html\">Title</a>"));
    }
}
