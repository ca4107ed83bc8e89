//! The rule of translated shaders: they are what `cargo xtask wgsl` makes of the laws.

use super::Finding;
use super::tree::Tree;

pub fn check(tree: &Tree) -> Vec<Finding> {
    let read = |path: &str| tree.text(path).map(str::to_owned).ok_or_else(|| format!("no file {path}"));
    match translate::generate(read) {
        Ok(files) => {
            let stale = files.iter().filter(|(path, text)| tree.text(path) != Some(text));
            let message = "not the translation of its law: run `cargo xtask wgsl`";
            let stale = stale.map(|(path, _)| Finding::new(path, 0, message));
            let is_law = |path: &str| path.starts_with(translate::FOLDER) && !files.contains_key(path);
            let extra = tree.texts().filter(|(path, _)| is_law(path));
            stale.chain(extra.map(|(path, _)| Finding::new(path, 0, "no law has this translation"))).collect()
        }
        Err(error) => vec![Finding::new("crates/translate/src/lib.rs", 0, error)],
    }
}
