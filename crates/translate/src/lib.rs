//! A compiler from Rust to WGSL, for the laws that all engines share (`cargo xtask wgsl`).
//!
//! A law is written once, for numbers with lanes (`R: Real`); a GPU has one lane in each of its
//! threads. So `R` becomes `f32`, `R::Mask` `bool`, `R::Int` `u32`, a spectrum `vec4f`, a method a
//! function `Type_method`, and a tuple that a function returns a struct. Tuples, arrays of values,
//! closures and functions that take some are resolved by the translation.
//!
//! `LAWS` lists the roots. What they use is translated, too, so that all of it must be in the
//! files listed; nothing else is. What is not worth a translation is `BY_HAND`.
//!
//! The subset: structs, enums without data, constants; `let` with patterns, assignments, `if`,
//! `match` on enums and literals, `for` over ranges and arrays, `while`; operators, calls, methods
//! of the types in `intrinsics` and of the library; macros of one name that define items.
//! Anything else is an error.

mod body;
mod call;
mod expression;
mod intrinsics;
mod library;
mod names;
mod translator;
mod types;
mod value;

#[cfg(test)]
mod tests;

use std::collections::BTreeMap;

use body::Body;
use library::Library;
use translator::Translator;

/// The result of a translation, or what has none.
pub type Result<T> = std::result::Result<T, String>;

/// The files that hold laws, and after each the functions and methods of it that are wanted.
const LAWS: &str = include_str!("laws.txt");

/// Shaders with functions and types of laws by hand. Drivers simplify sums as if they were exact,
/// so that rounding by adding and subtracting a large number is lost; tables are packed, and are
/// records among those of a scene; loops are others in vectors.
const BY_HAND: [&str; 3] = [
    "crates/gpu/shaders/prelude.wgsl",
    "crates/gpu/shaders/measured_table.wgsl",
    "crates/gpu/shaders/openpbr_table.wgsl",
];

/// Where the translations are.
pub const FOLDER: &str = "crates/gpu/shaders/law";

/// The translations by their paths, given what reads a source.
pub fn generate(read: impl Fn(&str) -> Result<String>) -> Result<BTreeMap<String, String>> {
    let words = || LAWS.split_whitespace();
    let sources: Vec<&str> = words().filter(|word| word.ends_with(".rs")).collect();
    let mut library = Library::default();
    for path in &sources {
        library.add(path, &read(path)?)?;
    }
    let by_hand: String = BY_HAND.into_iter().map(&read).collect::<Result<_>>()?;
    let mut translator = Translator::new(&library, &by_hand);
    let mut source = 0;
    for word in words() {
        match sources.iter().position(|path| *path == word) {
            Some(next) => source = next,
            None => translator.root(source, word)?,
        }
    }
    translate(&mut translator)?;
    let mut files = BTreeMap::new();
    let mut add = |name: &str, origin: &str, items: Vec<&str>| {
        if !items.is_empty() {
            let head = format!("// {origin}\n// by `cargo xtask wgsl`, which translates it again.\n");
            files.insert(format!("{FOLDER}/{name}.wgsl"), format!("{head}\n{}", items.join("\n")));
        }
    };
    add("tuples", "Made", translator.texts_of(None));
    for (source, path) in sources.iter().enumerate() {
        add(stem(path), &format!("Translated from {path}"), translator.texts_of(Some(source)));
    }
    Ok(files)
}

/// Translates all that is requested, and what that requests.
fn translate(translator: &mut Translator) -> Result<()> {
    let library = translator.library;
    while let Some((index, owner, name)) = translator.pending.pop() {
        let definition = &library.definitions[index];
        let mut body = Body::new(translator, definition.source, owner.as_ref());
        let text = body.item(&definition.item, &name).map_err(|error| {
            let (source, line) = body.place;
            format!("{}:{line}: {error}, in {name}", library.sources[source])
        });
        translator.texts.insert((Some(index), name), text?);
    }
    Ok(())
}

/// The name of a file without folder and ending; that of its folder where it is the folder's.
fn stem(path: &str) -> &str {
    let path = path.strip_suffix("/mod.rs").unwrap_or(path.trim_end_matches(".rs"));
    path.rsplit('/').next().unwrap_or(path)
}
