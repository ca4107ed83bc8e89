//! A scanner that separates code from comments: comments and the contents of strings are blanked in
//! the code, everything but comments in the comments. Lines and columns are kept.

/// A source as code and comments, with the same lines and columns.
#[derive(Debug, PartialEq, Eq)]
pub struct Layers {
    /// Code, without comments and the contents of literals.
    pub code: String,
    /// Comments.
    pub comments: String,
}

/// The state of the scanner.
#[derive(Clone, Copy)]
enum State {
    Code,
    LineComment,
    /// With the depth of nesting.
    BlockComment(usize),
    Text,
    /// With the number of `#` that end it.
    RawText(usize),
}

/// Splits a source into its layers.
pub fn layers(source: &str) -> Layers {
    let chars: Vec<char> = source.chars().collect();
    let starts = |at: usize, word: &str| word.chars().enumerate().all(|(i, c)| chars.get(at + i) == Some(&c));
    let mut layers =
        Layers { code: String::with_capacity(source.len()), comments: String::with_capacity(source.len()) };
    let mut state = State::Code;
    let mut at = 0;
    while at < chars.len() {
        let (length, next, commented) = match state {
            State::Code if starts(at, "//") => (2, State::LineComment, true),
            State::Code if starts(at, "/*") => (2, State::BlockComment(1), true),
            State::Code if starts(at, "\"") => (1, State::Text, false),
            State::Code => match raw_text(&chars, at) {
                Some(hashes) => (hashes + 2, State::RawText(hashes), false),
                None => (character(&chars, at).unwrap_or(1), State::Code, false),
            },
            State::LineComment if chars[at] == '\n' => (1, State::Code, true),
            State::BlockComment(1) if starts(at, "*/") => (2, State::Code, true),
            State::BlockComment(depth) if starts(at, "*/") => (2, State::BlockComment(depth - 1), true),
            State::BlockComment(depth) if starts(at, "/*") => (2, State::BlockComment(depth + 1), true),
            State::Text if starts(at, "\\") => (2, State::Text, false),
            State::Text if starts(at, "\"") => (1, State::Code, false),
            State::RawText(hashes) if starts(at, &format!("\"{}", "#".repeat(hashes))) => {
                (hashes + 1, State::Code, false)
            }
            same => (1, same, matches!(same, State::LineComment | State::BlockComment(_))),
        };
        let in_code = matches!((state, next), (State::Code, State::Code)) && length == 1;
        for &c in chars.iter().skip(at).take(length) {
            let blank = if c == '\n' { '\n' } else { ' ' };
            layers.code.push(if in_code { c } else { blank });
            layers.comments.push(if commented { c } else { blank });
        }
        state = next;
        at += length;
    }
    layers
}

/// The number of `#` if a raw string begins here.
fn raw_text(chars: &[char], at: usize) -> Option<usize> {
    let within_word =
        at > 0 && (chars[at - 1].is_alphanumeric() || chars[at - 1] == '_') && chars[at - 1] != 'b';
    if chars[at] != 'r' || within_word {
        return None;
    }
    let hashes = chars[at + 1..].iter().take_while(|&&c| c == '#').count();
    (chars.get(at + 1 + hashes) == Some(&'"')).then_some(hashes)
}

/// The length of a character literal, if one begins here: not a lifetime.
fn character(chars: &[char], at: usize) -> Option<usize> {
    if chars[at] != '\'' {
        return None;
    }
    match chars.get(at + 1)? {
        '\\' => chars.iter().skip(at + 3).position(|&c| c == '\'').map(|end| end + 4),
        _ => (chars.get(at + 2) == Some(&'\'')).then_some(3),
    }
}

/// The code with every item under `#[cfg(test)]` blanked out too.
pub fn without_tests(code: &str) -> String {
    let mut kept = code.to_owned();
    while let Some(start) = kept.find("#[cfg(test)]") {
        let end = start + item_length(&kept[start..]);
        let blank: String = kept[start..end].chars().map(|c| if c == '\n' { '\n' } else { ' ' }).collect();
        kept.replace_range(start..end, &blank);
    }
    kept
}

/// The length of an item: to its closing brace, or to the semicolon that ends it.
fn item_length(item: &str) -> usize {
    let mut depth = 0;
    for (at, c) in item.char_indices() {
        match c {
            '{' => depth += 1,
            '}' => depth -= 1,
            _ => {}
        }
        if depth == 0 && matches!(c, '}' | ';') {
            return at + 1;
        }
    }
    item.len()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn comments_and_strings_are_not_code() {
        let Layers { code, comments } =
            layers("a(\"x // \\\" b\"); // c \"d\nlet e = r#\"f \" g\"#;/* h /* i */ j */k");
        assert_eq!(code.split_whitespace().collect::<Vec<_>>(), ["a(", ");", "let", "e", "=", ";", "k"]);
        assert_eq!(comments.split_whitespace().collect::<String>(), "//c\"d/*h/*i*/j*/");
        assert_eq!(code.lines().count(), 2);
    }

    #[test]
    fn lifetimes_are_not_characters() {
        let code = layers("fn f<'a>(x: &'a str) { g('\"', '\\'', '\\u{41}', h) }").code;
        assert!(
            code.contains("<'a>(x: &'a str)") && code.contains(", h) }") && !code.contains('"'),
            "{code}"
        );
    }

    #[test]
    fn test_items_are_blanked() {
        let code = "fn a() {}\n#[cfg(test)]\nmod tests { fn b() { { } } }\n#[cfg(test)]\nuse c;\nfn d() {}";
        let kept = without_tests(code);
        assert_eq!(kept.split_whitespace().collect::<String>(), "fna(){}fnd(){}");
        assert_eq!(kept.lines().count(), code.lines().count());
    }
}
