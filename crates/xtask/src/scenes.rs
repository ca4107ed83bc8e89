//! `cargo xtask scenes`: makes the showcase's scenes.

use std::path::Path;

use showcase::{SCENES, Size};

/// Where scenes of a size are, in the workspace.
pub fn folder(size: Size) -> &'static str {
    match size {
        Size::Whole => "target/scenes",
        Size::Small => "target/gallery/scenes",
    }
}

/// Makes the scenes of these names, or all, in the [folder] of their size.
pub fn run(workspace: &Path, names: &[&str], size: Size) -> Result<(), String> {
    if let Some(name) = names.iter().find(|name| SCENES.iter().all(|scene| scene.name != **name)) {
        let known = SCENES.map(|scene| scene.name);
        return Err(format!("there is no scene `{name}`, but {}", known.join(", ")));
    }
    for scene in SCENES.iter().filter(|scene| names.is_empty() || names.contains(&scene.name)) {
        let folder = workspace.join(folder(size)).join(scene.name);
        let made = std::fs::create_dir_all(&folder).and_then(|()| scene.make(&folder, size));
        println!("{}", made.map_err(|error| format!("{}: {error}", folder.display()))?);
        println!("{}", folder.display());
    }
    Ok(())
}
