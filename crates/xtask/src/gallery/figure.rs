//! The figures of a page: each a command, with the words that its author puts above it.
//!
//! In a block `sh` every line that is no comment is a command. The comments above it are its
//! caption, but for `# alt: …`, a description of the picture for who does not see it, and
//! `# thumbnail`, which makes it the picture of the page in the index.

use std::collections::HashMap;

/// A command and its words.
#[derive(Debug, Default, PartialEq)]
pub struct Figure {
    /// The command as a reader would type it.
    pub command: String,
    caption: String,
    alt: String,
    /// Whether its picture stands for the page in the index.
    pub is_thumbnail: bool,
}

/// A picture and what the program says of it.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Drawn {
    /// The picture as a data URI without its scheme.
    pub picture: String,
    /// Counts or, of a trace, events, as the content of an HTML element `details`.
    pub notes: String,
}

/// Before a picture, and before and after the notes of a figure.
const PICTURE: &str = "src=\"data:";
const NOTES: [&str; 2] = ["<details>", "</details>"];

impl Figure {
    /// The figures of a block.
    pub fn of_block(block: &str) -> Result<Vec<Self>, String> {
        let (mut figures, mut next) = (Vec::new(), Self::default());
        for line in block.lines().map(str::trim).filter(|line| !line.is_empty()) {
            let Some(comment) = line.strip_prefix('#').map(str::trim) else {
                let figure = Self { command: line.to_owned(), ..std::mem::take(&mut next) };
                if figure.caption.is_empty() || figure.alt.is_empty() {
                    return Err(format!("`{line}` has no caption (`# …`) or no description (`# alt: …`)"));
                }
                figures.push(figure);
                continue;
            };
            if comment == "thumbnail" {
                next.is_thumbnail = true;
            } else if let Some(alt) = comment.strip_prefix("alt:") {
                next.alt = alt.trim().to_owned();
            } else {
                next.caption += if next.caption.is_empty() { "" } else { " " };
                next.caption += comment;
            }
        }
        Ok(figures)
    }

    /// With what the command draws.
    pub fn to_html(&self, Drawn { picture, notes }: &Drawn) -> String {
        let [command, caption, alt] = [&self.command, &self.caption, &self.alt].map(|text| escaped(text));
        let [open, close] = NOTES;
        format!(
            "<figure><img {PICTURE}{picture}\" alt=\"{alt}\">\n<figcaption>{caption}</figcaption>\n\
             <pre>{command}</pre>\n{open}{notes}{close}</figure>\n"
        )
    }
}

/// The pictures of a page, by command.
pub fn drawn(html: &str) -> HashMap<String, Drawn> {
    let figure = |part: &str| {
        let between =
            |[open, close]: [&str; 2]| Some(part.split_once(open)?.1.split_once(close)?.0.to_owned());
        let drawn = Drawn { picture: between([PICTURE, "\""])?, notes: between(NOTES)? };
        Some((unescaped(&between(["<pre>", "</pre>"])?), drawn))
    };
    html.split("<figure>").skip(1).filter_map(figure).collect()
}

/// A page without what its commands drew.
pub fn without_drawings(html: &str) -> String {
    without(&without(html, [PICTURE, "\""]), NOTES)
}

/// A text without what is between two marks.
fn without(text: &str, [open, close]: [&str; 2]) -> String {
    let mut parts = text.split(open);
    let first = parts.next().unwrap_or_default().to_owned();
    let rest =
        parts.map(|part| part.split_once(close).map_or(String::new(), |(_, rest)| open.to_owned() + rest));
    first + &rest.collect::<String>()
}

/// A text within HTML.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;").replace('"', "&quot;")
}

fn unescaped(html: &str) -> String {
    html.replace("&quot;", "\"").replace("&gt;", ">").replace("&lt;", "<").replace("&amp;", "&")
}

#[cfg(test)]
mod tests {
    use super::*;

    const BLOCK: &str =
        "# A caption of\n# two lines.\n# alt: two balls\n# thumbnail\nalhazen render a --set \"b\"\n";

    #[test]
    fn comments_are_the_words_of_the_command_below() {
        let figures = Figure::of_block(BLOCK).unwrap();
        let expected = Figure {
            command: "alhazen render a --set \"b\"".into(),
            caption: "A caption of two lines.".into(),
            alt: "two balls".into(),
            is_thumbnail: true,
        };
        assert_eq!(figures, [expected]);
    }

    #[test]
    fn a_command_needs_a_caption_and_a_description() {
        let two = format!("{BLOCK}# alt: a box\nalhazen render b\n");
        assert!(Figure::of_block(&two).unwrap_err().contains("`alhazen render b` has no caption"));
        assert!(Figure::of_block("# Caption.\nalhazen render b\n").is_err());
    }

    #[test]
    fn drawings_are_read_back_and_left_out_of_comparisons() {
        let figure = &Figure::of_block(BLOCK).unwrap()[0];
        let [old, new] = ["a", "b"].map(|text| Drawn { picture: text.into(), notes: text.into() });
        let [old_html, new_html] = [&old, &new].map(|drawn| figure.to_html(drawn));
        assert_eq!(drawn(&old_html)[&figure.command], old);
        assert_eq!(drawn(&format!("{old_html}{new_html}"))[&figure.command], new);
        assert_eq!(without_drawings(&old_html), without_drawings(&new_html));
        assert_ne!(without_drawings(&old_html), without_drawings(&old_html.replace("balls", "boxes")));
        assert_ne!(without_drawings(&old_html), without_drawings(&old_html.replace("render", "view")));
    }
}
