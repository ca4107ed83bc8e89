//! The files of a scene: layers and images, each alone or in a package (`room.usdz[wood.png]`).
//!
//! The crate that composes layers owns its source of files, and so cannot refer to ours. It asks by
//! a channel, and the thread that started the import answers.

use std::collections::HashMap;
use std::io::{self, Cursor};
use std::path::{Component, Path, PathBuf};
use std::sync::mpsc::{Receiver, Sender, channel};
use std::sync::{Mutex, MutexGuard};
use std::time::SystemTime;

use openusd::ar::{self, Asset, ResolvedPath};

use super::layer;
use crate::archive;
use crate::log::Fault;
use assets::AssetSource;

/// The files beside a scene.
pub(super) struct Files<'a> {
    assets: &'a dyn AssetSource,
    packages: Mutex<HashMap<String, Option<archive::Zip>>>,
    /// The layers that were read.
    layers: Mutex<Vec<String>>,
}

impl<'a> Files<'a> {
    pub fn new(assets: &'a dyn AssetSource) -> Self {
        Self { assets, packages: Mutex::default(), layers: Mutex::default() }
    }

    /// The content of a file.
    pub fn read(&self, name: &str) -> io::Result<Vec<u8>> {
        match ar::split_package_relative_path_outer(name) {
            None => self.assets.read(Path::new(name)),
            Some((package, inner)) => {
                let missing = || io::Error::new(io::ErrorKind::NotFound, "not in the package");
                let zip = self.package(&package).ok_or_else(missing)?;
                let index = archive::normalized(Path::new(&inner)).and_then(|name| zip.index_for_name(&name));
                archive::entry(&zip, index.ok_or_else(missing)?)
            }
        }
    }

    fn exists(&self, name: &str) -> bool {
        match ar::split_package_relative_path_outer(name) {
            None => self.assets.exists(Path::new(name)),
            Some((package, inner)) => {
                let name = archive::normalized(Path::new(&inner));
                let zip = self.package(&package);
                zip.is_some_and(|zip| name.is_some_and(|name| zip.index_for_name(&name).is_some()))
            }
        }
    }

    /// A package, which is opened once.
    fn package(&self, name: &str) -> Option<archive::Zip> {
        let open = || archive::open(self.assets.read(Path::new(name)).ok()?).ok();
        lock(&self.packages).entry(name.to_owned()).or_insert_with(open).clone()
    }

    /// Where texts that were read are no USD, of which the stage tells no places.
    pub fn text_faults(&self) -> Vec<Fault> {
        let mut names = std::mem::take(&mut *lock(&self.layers));
        names.sort();
        names.dedup();
        let fault = |name: String| {
            let bytes = self.read(&name).ok()?;
            let (place, message) = layer::text_error(&bytes)?;
            Some(Fault::new("invalid-usd", format!("{name}:{place}"), message))
        };
        names.into_iter().filter_map(fault).collect()
    }

    /// Answers until nobody can ask any more.
    pub fn answer(&self, questions: &Receiver<Question>) {
        for question in questions {
            // Who asked may be gone, as after a panic.
            match question {
                Question::Exists(name, reply) => _ = reply.send(self.exists(&name)),
                Question::Read(name, reply) => {
                    let checked = self.read(&name).and_then(|bytes| {
                        let invalid = |message| {
                            io::Error::new(io::ErrorKind::InvalidData, format!("{name}: {message}"))
                        };
                        layer::check(&bytes).map_err(invalid)?;
                        Ok(bytes)
                    });
                    // A file refused unread is not parsed to find its faults, either.
                    if checked.is_ok() {
                        lock(&self.layers).push(name);
                    }
                    _ = reply.send(checked);
                }
            }
        }
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(|poisoned| poisoned.into_inner())
}

/// What is asked about a file.
pub(super) enum Question {
    Exists(String, Sender<bool>),
    /// Its content, which is a layer or a package of them.
    Read(String, Sender<io::Result<Vec<u8>>>),
}

/// Asks for the files of a scene.
pub(super) struct Resolver(Sender<Question>);

impl Resolver {
    /// A resolver, and what it will ask.
    pub fn new() -> (Self, Receiver<Question>) {
        let (sender, receiver) = channel();
        (Self(sender), receiver)
    }

    fn ask<T>(&self, question: impl FnOnce(Sender<T>) -> Question) -> io::Result<T> {
        let (sender, receiver) = channel();
        let gone = || io::Error::other("the import has ended");
        self.0.send(question(sender)).map_err(|_| gone())?;
        receiver.recv().map_err(|_| gone())
    }
}

impl ar::Resolver for Resolver {
    fn create_identifier(&self, name: &str, anchor: Option<&ResolvedPath>) -> String {
        match anchor.and_then(|anchor| anchor.to_str()) {
            Some(anchor) if !name.is_empty() => beside(anchor, name),
            _ => name.to_owned(),
        }
    }

    fn resolve(&self, name: &str) -> Option<ResolvedPath> {
        let exists = self.ask(|reply| Question::Exists(name.to_owned(), reply)).ok()?;
        exists.then(|| ResolvedPath::new(name))
    }

    fn resolve_for_new_asset(&self, _: &str) -> Option<ResolvedPath> {
        None
    }

    fn open_asset(&self, path: &ResolvedPath) -> io::Result<Box<dyn Asset>> {
        let name = path.to_string_lossy().into_owned();
        let bytes = self.ask(|reply| Question::Read(name, reply))??;
        Ok(Box::new(Cursor::new(bytes)))
    }

    fn get_modification_timestamp(&self, _: &str, _: &ResolvedPath) -> Option<SystemTime> {
        None
    }
}

/// The name of a file that another file names: beside that file, in its package if it is in one.
fn beside(anchor: &str, name: &str) -> String {
    if Path::new(name).is_absolute() {
        return name.to_owned();
    }
    if let Some((package, inner)) = ar::split_package_relative_path_inner(anchor) {
        return ar::join_package_relative_path(&package, &joined(&inner, name));
    }
    if let Some((package, inner)) = ar::split_package_relative_path_outer(name) {
        return ar::join_package_relative_path(&joined(anchor, &package), &inner);
    }
    let is_package =
        Path::new(anchor).extension().is_some_and(|extension| extension.eq_ignore_ascii_case("usdz"));
    match is_package {
        true => ar::join_package_relative_path(anchor, &joined("", name)),
        false => joined(anchor, name),
    }
}

/// A path in the folder of a file, without `.`, and with `..` only at the start.
fn joined(file: &str, name: &str) -> String {
    let folder = Path::new(file).parent().unwrap_or(Path::new(""));
    let mut path = PathBuf::new();
    for component in folder.join(name.replace('\\', "/")).components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir if matches!(path.components().next_back(), Some(Component::Normal(_))) => {
                path.pop();
            }
            component => path.push(component),
        }
    }
    path.to_string_lossy().into_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn files_are_named_from_where_they_are_named() {
        for (anchor, name, expected) in [
            ("a/room.usda", "./b/chair.usda", "a/b/chair.usda"),
            ("a/room.usda", "../wood.png", "wood.png"),
            ("room.usda", "../wood.png", "../wood.png"),
            ("a/room.usda", "/b/c.usd", "/b/c.usd"),
            ("a/room.usda", "chair.usdz[leg.usd]", "a/chair.usdz[leg.usd]"),
            ("a/room.usdz", "leg.usd", "a/room.usdz[leg.usd]"),
            ("a/room.usdz[b/leg.usd]", "../c.png", "a/room.usdz[c.png]"),
        ] {
            assert_eq!(beside(anchor, name), expected, "{anchor} {name}");
        }
    }
}
