//! Scenes that are too large to be checked in, made of formulas and seeds alone: the same files
//! everywhere.

mod cage;
mod car;
mod forest;
mod head;
mod mesh;
mod noise;
mod planet;
mod tree;

use std::io;
use std::path::Path;

/// Writes the files of a scene into a folder.
type Make = fn(&Path) -> io::Result<()>;

const SCENES: [(&str, Make); 4] = [
    ("car", |folder| car::make(folder, 5)),
    ("forest", forest::make),
    ("head", |folder| head::make(folder, head::Detail::WHOLE)),
    ("planet", planet::make),
];

/// Makes the scenes of these names, or all, in `target/scenes`.
pub fn run(workspace: &Path, names: &[&str]) -> Result<(), String> {
    if let Some(name) = names.iter().find(|name| SCENES.iter().all(|(known, _)| known != *name)) {
        let known: Vec<&str> = SCENES.iter().map(|(name, _)| *name).collect();
        return Err(format!("there is no scene `{name}`, but {}", known.join(", ")));
    }
    for (name, make) in SCENES.into_iter().filter(|(name, _)| names.is_empty() || names.contains(name)) {
        let folder = workspace.join("target/scenes").join(name);
        let made = std::fs::create_dir_all(&folder).and_then(|()| make(&folder));
        made.map_err(|error| format!("{}: {error}", folder.display()))?;
        println!("{}", folder.display());
    }
    Ok(())
}
