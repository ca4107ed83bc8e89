//! Sources of files. No other part of the crate reads files.

use std::collections::BTreeMap;
use std::io::{self, Read};
use std::path::{Path, PathBuf};

use flate2::read::MultiGzDecoder;

/// A source of files.
pub trait AssetSource: Sync {
    /// The whole content of a file.
    fn read(&self, path: &Path) -> io::Result<Vec<u8>>;

    /// Whether a file exists.
    fn exists(&self, path: &Path) -> bool;
}

/// The file system; the path `-` is standard input.
///
/// Streams without a length, such as pipes and standard input, are read up to 1 GiB. Devices are
/// refused.
#[derive(Clone, Copy, Debug, Default)]
pub struct Files;

impl Files {
    /// Most bytes read from a pipe, which may never end.
    const LONGEST_STREAM: u64 = 1 << 30;
}

impl AssetSource for Files {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        if path == Path::new("-") {
            return read_at_most(io::stdin().lock(), Self::LONGEST_STREAM);
        }
        let kind = std::fs::metadata(path)?.file_type();
        if kind.is_file() {
            return std::fs::read(path);
        }
        if kind.is_dir() {
            return Err(io::Error::new(io::ErrorKind::IsADirectory, "it is a folder"));
        }
        if is_device(kind) {
            return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is a device, not a file"));
        }
        read_at_most(std::fs::File::open(path)?, Self::LONGEST_STREAM)
    }

    fn exists(&self, path: &Path) -> bool {
        path == Path::new("-") || path.is_file()
    }
}

#[cfg(unix)]
fn is_device(kind: std::fs::FileType) -> bool {
    use std::os::unix::fs::FileTypeExt;
    kind.is_char_device() || kind.is_block_device()
}

#[cfg(not(unix))]
fn is_device(_: std::fs::FileType) -> bool {
    false
}

/// All bytes of a stream; an error if there are more than `limit`.
pub fn read_at_most(stream: impl Read, limit: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    stream.take(limit + 1).read_to_end(&mut bytes)?;
    if bytes.len() as u64 > limit {
        let message = format!("it has more than {} MiB", limit >> 20);
        return Err(io::Error::new(io::ErrorKind::FileTooLarge, message));
    }
    Ok(bytes)
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

/// Reads a file and unpacks it if its content is gzip, whatever its name. The content may be 64 MiB
/// or 256 times as long as the file, whichever is more, and 4 GiB at most.
pub fn read_unpacked(assets: &dyn AssetSource, path: &Path) -> io::Result<Vec<u8>> {
    /// Texts and meshes have smaller compression ratios than this.
    const GREATEST_RATIO: u64 = 256;
    const ALWAYS_ALLOWED: u64 = 64 << 20;
    const NEVER_ALLOWED: u64 = 4 << 30;

    let bytes = assets.read(path)?;
    if !bytes.starts_with(&[0x1f, 0x8b]) {
        return Ok(bytes);
    }
    let limit = (bytes.len() as u64 * GREATEST_RATIO).clamp(ALWAYS_ALLOWED, NEVER_ALLOWED);
    read_at_most(MultiGzDecoder::new(bytes.as_slice()), limit).map_err(|error| match error.kind() {
        io::ErrorKind::FileTooLarge => io::Error::new(
            io::ErrorKind::FileTooLarge,
            format!("unpacked, {error}, which is too much for {} packed bytes", bytes.len()),
        ),
        _ => error,
    })
}

/// The path of a file that another file names: beside that file if it is there, else beside the
/// scene's first file.
pub fn resolve(assets: &dyn AssetSource, name: &str, naming_file: &str, first_file: &str) -> PathBuf {
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
        assert_eq!(error.kind(), io::ErrorKind::FileTooLarge);
        assert!(error.to_string().starts_with("unpacked, it has more than 64 MiB"), "{error}");
    }

    #[test]
    fn endless_streams_are_cut_off() {
        let error = read_at_most(io::repeat(7), 3 << 20).unwrap_err();
        assert_eq!(error.to_string(), "it has more than 3 MiB");
        assert_eq!(read_at_most(&[7_u8; 100][..], 100).unwrap().len(), 100);
    }

    #[cfg(unix)]
    #[test]
    fn devices_are_no_files() {
        for path in ["/dev/zero", "/dev/null"] {
            assert!(Files.read(Path::new(path)).unwrap_err().to_string().contains("device"), "{path}");
        }
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
