//! Scenes that are too large to be checked in, made of formulas and seeds alone: the same files
//! everywhere.

mod cage;
mod car;
mod forest;
mod head;
mod land;
mod mesh;
mod noise;
mod planet;
mod pond;
mod tree;

use std::io;
use std::path::Path;

/// How large scenes and pictures of them are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// As users want them.
    Whole,
    /// So small that they take hardly any time, for tests of what is made of them.
    Small,
}

impl Size {
    /// Where scenes of this size are, in the workspace.
    pub fn folder(self) -> &'static str {
        match self {
            Self::Whole => "target/scenes",
            Self::Small => "target/gallery/scenes",
        }
    }
}

/// Writes the files of a scene into a folder.
type Make = fn(&Path, Size) -> io::Result<()>;

const SCENES: [(&str, Make); 4] = [
    ("car", |folder, size| car::make(folder, if size == Size::Whole { 5 } else { 2 })),
    ("forest", |folder, size| {
        forest::make(folder, if size == Size::Whole { forest::Detail::WHOLE } else { forest::Detail::SMALL })
    }),
    ("head", |folder, size| {
        head::make(folder, if size == Size::Whole { head::Detail::WHOLE } else { head::Detail::SMALL })
    }),
    ("planet", planet::make),
];

/// Makes the scenes of these names, or all, in the [folder](Size::folder) of their size.
pub fn run(workspace: &Path, names: &[&str], size: Size) -> Result<(), String> {
    if let Some(name) = names.iter().find(|name| SCENES.iter().all(|(known, _)| known != *name)) {
        let known: Vec<&str> = SCENES.iter().map(|(name, _)| *name).collect();
        return Err(format!("there is no scene `{name}`, but {}", known.join(", ")));
    }
    for (name, make) in SCENES.into_iter().filter(|(name, _)| names.is_empty() || names.contains(name)) {
        let folder = workspace.join(size.folder()).join(name);
        let made = std::fs::create_dir_all(&folder).and_then(|()| make(&folder, size));
        made.map_err(|error| format!("{}: {error}", folder.display()))?;
        println!("{}", folder.display());
    }
    Ok(())
}
