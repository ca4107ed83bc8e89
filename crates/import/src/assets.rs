//! Where files come from. This is the only door of the crate to the outside.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

/// A place that has files.
pub trait AssetSource: Sync {
    /// The whole content of a file.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;

    /// Whether a file is there.
    fn exists(&self, path: &Path) -> bool;
}

/// The file system; the path `-` is standard input.
#[derive(Clone, Copy, Debug, Default)]
pub struct Files;

impl AssetSource for Files {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        if path == Path::new("-") {
            let mut bytes = Vec::new();
            io::stdin().lock().read_to_end(&mut bytes)?;
            return Ok(bytes);
        }
        if path.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
        }
        std::fs::read(path)
    }

    fn exists(&self, path: &Path) -> bool {
        path == Path::new("-") || path.is_file()
    }
}

/// Files held in memory: for tests, archives and callers without a file system.
#[derive(Clone, Debug, Default)]
pub struct MemoryAssets {
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl MemoryAssets {
    /// Adds a file.
    pub fn with(mut self, path: impl Into<PathBuf>, content: impl Into<Vec<u8>>) -> Self {
        self.files.insert(path.into(), content.into());
        self
    }
}

impl AssetSource for MemoryAssets {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.files.get(path).cloned().ok_or_else(|| io::Error::new(io::ErrorKind::NotFound, "no such file"))
    }

    fn exists(&self, path: &Path) -> bool {
        self.files.contains_key(path)
    }
}

/// Reads a file and unpacks it if its content is gzip, whatever it is called.
pub(crate) fn read_unpacked(assets: &dyn AssetSource, path: &Path) -> io::Result<Vec<u8>> {
    /// No honest text or mesh is packed tighter than this many to one.
    const GREATEST_RATIO: u64 = 256;
    const ALWAYS_ALLOWED: u64 = 64 << 20;

    let bytes = assets.read(path)?;
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let limit = (bytes.len() as u64 * GREATEST_RATIO).max(ALWAYS_ALLOWED);
    let mut unpacked = Vec::new();
    MultiGzDecoder::new(bytes.as_slice()).take(limit + 1).read_to_end(&mut unpacked)?;
    if unpacked.len() as u64 > limit {
        return Err(io::Error::new(io::ErrorKind::InvalidData, "its packed content is unreasonably large"));
    }
    Ok(unpacked)
}

/// The path of a file that another file names: beside that file if it is there, else beside the
/// scene's first file.
pub(crate) fn resolve(assets: &dyn AssetSource, name: &str, naming_file: &str, first_file: &str) -> PathBuf {
    let beside = |file: &str| Path::new(file).parent().unwrap_or(Path::new("")).join(name);
    let (near, far) = (beside(naming_file), beside(first_file));
    if near != far && !assets.exists(&near) && assets.exists(&far) { far } else { near }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use flate2::{Compression, write::GzEncoder};

    use super::*;

    fn gzip(bytes: &[u8]) -> Vec<u8> {
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(bytes).unwrap();
        encoder.finish().unwrap()
    }

    #[test]
    fn packed_files_are_unpacked_by_content() {
        let assets = MemoryAssets::default().with("a", gzip(b"hello")).with("b", "hello");
        for path in ["a", "b"] {
            assert_eq!(read_unpacked(&assets, Path::new(path)).unwrap(), b"hello");
        }
    }

    #[test]
    fn a_gzip_bomb_is_refused() {
        let bomb = gzip(&vec![0; 80 << 20]);
        assert!(bomb.len() < 100_000);
        let assets = MemoryAssets::default().with("bomb", bomb);
        let error = read_unpacked(&assets, Path::new("bomb")).unwrap_err();
        assert_eq!(error.kind(), io::ErrorKind::InvalidData);
    }

    #[test]
    fn names_are_looked_up_beside_the_naming_file_first() {
        let assets = MemoryAssets::default().with("s/geometry/a.ply", "").with("s/b.ply", "");
        let path = |name| resolve(&assets, name, "s/geometry/part.pbrt", "s/scene.pbrt");
        assert_eq!(path("a.ply"), Path::new("s/geometry/a.ply"));
        assert_eq!(path("b.ply"), Path::new("s/b.ply"));
        assert_eq!(path("c.ply"), Path::new("s/geometry/c.ply"));
    }
}
