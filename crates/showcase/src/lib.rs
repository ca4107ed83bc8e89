//! Scenes that are too large to be checked in, made of formulas and seeds alone: the same files
//! everywhere.

mod cage;
mod car;
mod forest;
mod head;
mod land;
mod mesh;
mod noise;
mod picture;
mod planet;
mod pond;
mod tree;

use std::io;
use std::path::Path;

/// How large scenes are made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Size {
    /// As users want them.
    Whole,
    /// So small that they take hardly any time, for tests of what is made of them.
    Small,
}

/// A scene of one or more pictures, in a folder of its own.
pub struct Scene {
    /// The name of the scene and of its folder.
    pub name: &'static str,
    make: fn(&Path, Size) -> io::Result<String>,
}

impl Scene {
    /// Writes the files of the scene into an existing folder; the result says how much there is.
    pub fn make(&self, folder: &Path, size: Size) -> io::Result<String> {
        (self.make)(folder, size)
    }
}

/// All scenes, by their names.
pub const SCENES: [Scene; 4] = [
    Scene { name: "car", make: |folder, size| car::make(folder, if size == Size::Whole { 5 } else { 2 }) },
    Scene {
        name: "forest",
        make: |folder, size| {
            forest::make(
                folder,
                if size == Size::Whole { forest::Detail::WHOLE } else { forest::Detail::SMALL },
            )
        },
    },
    Scene {
        name: "head",
        make: |folder, size| {
            head::make(folder, if size == Size::Whole { head::Detail::WHOLE } else { head::Detail::SMALL })
        },
    },
    Scene { name: "planet", make: planet::make },
];
