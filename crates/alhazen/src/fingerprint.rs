//! A hash of all files of a scene, which identifies the scene of a saved render.

use std::collections::BTreeMap;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use assets::AssetSource;

/// An asset source that hashes all files that the importer reads: the scene, its includes, meshes
/// and images.
pub struct Fingerprint<'a> {
    assets: &'a dyn AssetSource,
    /// The scene's folder, to which paths are relative, so that a scene may be moved.
    folder: PathBuf,
    hashes: Mutex<BTreeMap<PathBuf, blake3::Hash>>,
}

impl<'a> Fingerprint<'a> {
    /// Hashes the files of the scene file `scene` among these assets.
    pub fn new(assets: &'a dyn AssetSource, scene: &Path) -> Self {
        let folder = scene.parent().unwrap_or(Path::new("")).to_owned();
        Self { assets, folder, hashes: Mutex::default() }
    }

    /// Hashes a file.
    pub fn add(&self, path: &Path, content: &[u8]) {
        let hash = blake3::hash(content);
        let relative = path.strip_prefix(&self.folder).unwrap_or(path).to_owned();
        self.hashes.lock().unwrap_or_else(PoisonError::into_inner).insert(relative, hash);
    }

    /// The hash of all files read so far: of their paths and contents, in any order.
    pub fn hash(&self) -> [u8; 32] {
        let hashes = self.hashes.lock().unwrap_or_else(PoisonError::into_inner);
        let mut all = blake3::Hasher::new();
        for (path, hash) in &*hashes {
            let path = path.to_string_lossy();
            all.update(&(path.len() as u64).to_le_bytes()).update(path.as_bytes()).update(hash.as_bytes());
        }
        *all.finalize().as_bytes()
    }
}

impl AssetSource for Fingerprint<'_> {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let bytes = self.assets.read(path)?;
        self.add(path, &bytes);
        Ok(bytes)
    }

    fn exists(&self, path: &Path) -> bool {
        self.assets.exists(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use assets::MemoryAssets;

    fn hash(scene: &str, files: &[(&str, &str)]) -> [u8; 32] {
        let assets = files.iter().fold(MemoryAssets::default(), |all, (path, text)| all.with(*path, *text));
        let fingerprint = Fingerprint::new(&assets, Path::new(scene));
        for (path, _) in files {
            fingerprint.read(Path::new(path)).unwrap();
        }
        fingerprint.hash()
    }

    #[test]
    fn the_hash_is_of_names_and_contents_not_folder_and_order() {
        let scene = hash("a/room.pbrt", &[("a/room.pbrt", "x"), ("a/wood.png", "y")]);
        assert_eq!(scene, hash("/b/c/room.pbrt", &[("/b/c/wood.png", "y"), ("/b/c/room.pbrt", "x")]));
        for other in [
            &[("a/room.pbrt", "x"), ("a/wood.png", "z")][..],
            &[("a/room.pbrt", "x"), ("a/tin.png", "y")],
            &[("a/room.pbrt", "y"), ("a/wood.png", "x")],
            &[("a/room.pbrt", "x")],
        ] {
            assert_ne!(scene, hash("a/room.pbrt", other));
        }
    }
}
