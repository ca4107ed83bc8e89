//! A scene packed into one archive, with all files that it needs.
//!
//! The archive is a ZIP file with relative paths as they are, so that it can be unpacked and
//! rendered, too. The same files give the same bytes, and thus the same hash, wherever they are.

use std::collections::BTreeMap;
use std::io::{self, Write};
use std::path::{Component, Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use assets::{AssetSource, MemoryAssets};
use description::Imported;
use description::SceneDesc;
use import::{Manifest, import, is_archive};
use pbrt::{ExportError, export};
use zip::result::ZipError;
use zip::write::{SimpleFileOptions, ZipWriter};
use zip::{CompressionMethod, DateTime};

/// What [`pack`] has written.
#[derive(Clone, Debug)]
pub struct Packed {
    /// The files, in the order of the archive. The first is the scene.
    pub files: Vec<PathBuf>,
    /// The BLAKE3 hash of the archive.
    pub hash: [u8; 32],
    /// Its length in bytes.
    pub bytes: u64,
}

/// Why a scene is not packed.
#[derive(Debug)]
pub enum PackError {
    /// It has errors.
    Scene(Box<Imported>),
    /// A file cannot be read again, or the scene is an archive itself.
    File(PathBuf, io::Error),
    /// The archive cannot be written.
    Output(io::Error),
}

impl From<io::Error> for PackError {
    fn from(error: io::Error) -> Self {
        Self::Output(error)
    }
}

/// Writes a scene with its includes, meshes, images and all other files that it reads.
pub fn pack(scene: &Path, assets: &dyn AssetSource, output: impl Write) -> Result<Packed, PackError> {
    if is_archive(scene) {
        let problem = io::Error::new(io::ErrorKind::InvalidInput, "it is an archive already");
        return Err(PackError::File(scene.to_owned(), problem));
    }
    let folder = scene.parent().unwrap_or(Path::new(""));
    let name = PathBuf::from(scene.file_name().unwrap_or_default());
    let recorder = Recorder { assets, folder, read: Mutex::default() };
    let imported = import(&name, &recorder);
    if imported.has_errors() {
        return Err(PackError::Scene(Box::new(imported)));
    }
    let read = recorder.read.into_inner().unwrap_or_else(PoisonError::into_inner);
    let here = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    let here = std::path::absolute(here).map_err(|error| PackError::File(here.to_owned(), error))?;
    let (manifest, entries) = entries(&here, &name, &read);

    let mut archive = ZipWriter::new_stream(Hashing::new(output));
    let mut add = |name: &str, content: &[u8]| {
        let options = SimpleFileOptions::default()
            .compression_method(CompressionMethod::Deflated)
            .last_modified_time(DateTime::default())
            .unix_permissions(0o644)
            .large_file(content.len() >= 1 << 31);
        archive.start_file(name, options).map_err(output_error)?;
        archive.write_all(content).map_err(PackError::Output)
    };
    add(Manifest::NAME, manifest.to_json().as_bytes())?;
    for (entry, path) in &entries {
        let content = assets.read(path).map_err(|error| PackError::File(path.clone(), error))?;
        add(entry, &content)?;
    }
    let mut written = archive.finish().map_err(output_error)?.into_inner();
    written.flush().map_err(PackError::Output)?;
    Ok(Packed {
        files: entries.into_iter().map(|(_, path)| path).collect(),
        hash: *written.hasher.finalize().as_bytes(),
        bytes: written.bytes,
    })
}

/// Writes the archive of a description that has no files: it is converted to the pbrt-v4 format.
pub fn pack_converted(desc: &SceneDesc, output: impl Write) -> Result<Packed, ConvertError> {
    const SCENE: &str = "scene.pbrt";
    let mut files = MemoryAssets::default();
    let exported = export(desc, "assets", &mut |name, bytes| {
        files = std::mem::take(&mut files).with(format!("assets/{name}"), bytes);
        Ok(())
    })
    .map_err(ConvertError::Export)?;
    pack(Path::new(SCENE), &files.with(SCENE, exported.text), output).map_err(ConvertError::Pack)
}

/// Why a description is not packed.
#[derive(Debug)]
pub enum ConvertError {
    /// The format cannot express it.
    Export(ExportError),
    /// The archive is not written.
    Pack(PackError),
}

/// The manifest, and the name and source of each entry, the scene first. `absolute` is the scene's
/// folder.
fn entries(
    absolute: &Path,
    scene: &Path,
    read: &BTreeMap<PathBuf, PathBuf>,
) -> (Manifest, Vec<(String, PathBuf)>) {
    let inside: Vec<_> = absolute.components().filter_map(name_of).collect();
    let relative = read.keys().filter(|path| !path.is_absolute());
    let highest = relative.map(|path| resolved(path).0).max().unwrap_or(0).min(inside.len());
    let inside = &inside[inside.len() - highest..];
    let entry = |path: &Path| {
        let (up, names) = resolved(path);
        let names = inside[..highest - up.min(highest)].iter().cloned().chain(names);
        names.collect::<Vec<_>>().join("/")
    };
    let mut manifest = Manifest { scene: entry(scene), absolute: BTreeMap::new() };
    let mut entries = BTreeMap::new();
    for (path, source) in read {
        if path.is_absolute() {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let entry = format!("absolute/{}-{name}", manifest.absolute.len());
            manifest.absolute.insert(path.clone(), entry.clone());
            entries.insert(entry, source.clone());
        } else {
            entries.insert(entry(path), source.clone());
        }
    }
    let first = entries.remove(&manifest.scene).map(|path| (manifest.scene.clone(), path));
    (manifest, first.into_iter().chain(entries).collect())
}

/// A relative path without `.` and `..`: the number of folders that it goes up, and the names that
/// it then goes down.
fn resolved(path: &Path) -> (usize, Vec<String>) {
    let (mut up, mut names) = (0, Vec::new());
    for component in path.components() {
        match component {
            Component::ParentDir if names.pop().is_none() => up += 1,
            component => names.extend(name_of(component)),
        }
    }
    (up, names)
}

fn name_of(component: Component) -> Option<String> {
    match component {
        Component::Normal(name) => Some(name.to_string_lossy().into_owned()),
        _ => None,
    }
}

fn output_error(error: ZipError) -> PackError {
    PackError::Output(match error {
        ZipError::Io(error) => error,
        error => io::Error::other(error),
    })
}

/// Records which files are read: those of a folder, and those that are not in it but in the current
/// one, which are beside the scene in the archive.
struct Recorder<'a> {
    assets: &'a dyn AssetSource,
    folder: &'a Path,
    /// Paths as the scene names them, and where they are.
    read: Mutex<BTreeMap<PathBuf, PathBuf>>,
}

impl Recorder<'_> {
    fn place(&self, path: &Path) -> PathBuf {
        let beside = self.folder.join(path);
        if !self.assets.exists(&beside) && self.assets.exists(path) { path.to_owned() } else { beside }
    }
}

impl AssetSource for Recorder<'_> {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let place = self.place(path);
        let bytes = self.assets.read(&place)?;
        self.read.lock().unwrap_or_else(PoisonError::into_inner).insert(path.to_owned(), place);
        Ok(bytes)
    }

    fn exists(&self, path: &Path) -> bool {
        self.assets.exists(&self.place(path))
    }
}

/// Hashes what is written. It keeps an error of the output until it is flushed: a `ZipWriter` that
/// cannot write prints that to standard error.
struct Hashing<W> {
    output: W,
    hasher: blake3::Hasher,
    bytes: u64,
    error: Option<io::Error>,
}

impl<W> Hashing<W> {
    fn new(output: W) -> Self {
        Self { output, hasher: blake3::Hasher::new(), bytes: 0, error: None }
    }
}

impl<W: Write> Write for Hashing<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.error.is_none() {
            self.error = self.output.write_all(bytes).err();
        }
        self.hasher.update(bytes);
        self.bytes += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        match self.error.take() {
            Some(error) => Err(error),
            None => self.output.flush(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A scene in a folder that reads files of its folder, of the one above, and of elsewhere.
    fn room(folder: &str) -> (PathBuf, MemoryAssets) {
        let folder = std::path::absolute(folder).unwrap();
        let far = std::path::absolute("elsewhere/far.pbrt").unwrap();
        let text = format!(
            "Include \"near.pbrt\" Include \"../shared/./above.pbrt\" WorldBegin Include {:?}",
            far.to_string_lossy()
        );
        let assets = MemoryAssets::default()
            .with(folder.join("room.pbrt"), text)
            .with(folder.join("near.pbrt"), "Camera \"orthographic\"")
            .with(folder.join("../shared/./above.pbrt"), "Film \"rgb\" \"integer xresolution\" 7")
            // Read again by the path without the dot.
            .with(folder.join("../shared/above.pbrt"), "Film \"rgb\" \"integer xresolution\" 7")
            .with(far, "Shape \"sphere\"");
        (folder.join("room.pbrt"), assets)
    }

    #[test]
    fn a_packed_scene_is_the_scene() {
        let (scene, assets) = room("x/y");
        let mut bytes = Vec::new();
        let packed = pack(&scene, &assets, &mut bytes).unwrap();
        assert_eq!(packed.files.len(), 4);
        assert_eq!(packed.files[0], scene);
        assert_eq!((packed.bytes, packed.hash), (bytes.len() as u64, *blake3::hash(&bytes).as_bytes()));
        let there = MemoryAssets::default().with("there.zip", bytes);
        let imported = import("there.zip", &there);
        assert!(!imported.has_errors(), "{:?}", imported.diagnostics);
        assert_eq!(imported.desc.film.resolution[0], 7);
        assert_eq!(imported.desc.shapes.len(), 1);
    }

    #[test]
    fn files_of_the_current_folder_are_beside_the_packed_scene() {
        let assets = MemoryAssets::default()
            .with("s/a.pbrt", "WorldBegin Include \"assets/shape.pbrt\"")
            .with("assets/shape.pbrt", "Shape \"sphere\"");
        let mut bytes = Vec::new();
        let packed = pack(Path::new("s/a.pbrt"), &assets, &mut bytes).unwrap();
        assert_eq!(packed.files, ["s/a.pbrt", "assets/shape.pbrt"].map(PathBuf::from));
        let imported = import("there.zip", &MemoryAssets::default().with("there.zip", bytes));
        assert!(!imported.has_errors(), "{:?}", imported.diagnostics);
        assert_eq!(imported.desc.shapes.len(), 1);
    }

    #[test]
    fn the_same_scene_elsewhere_has_the_same_hash() {
        let hash = |folder| {
            let (scene, assets) = room(folder);
            pack(&scene, &assets, io::sink()).unwrap().hash
        };
        assert_eq!(hash("x/y"), hash("z/y"));
    }

    #[test]
    fn descriptions_and_scenes_without_a_folder_are_packed() {
        let assets = MemoryAssets::default().with("a.pbrt", "WorldBegin Shape \"sphere\"");
        let packed = pack(Path::new("a.pbrt"), &assets, io::sink()).unwrap();
        assert_eq!(packed.files, [PathBuf::from("a.pbrt")]);
        let mut bytes = Vec::new();
        pack_converted(&import("a.pbrt", &assets).desc, &mut bytes).unwrap();
        let converted = import("b.zip", &MemoryAssets::default().with("b.zip", bytes));
        assert!(!converted.has_errors(), "{:?}", converted.diagnostics);
        assert_eq!(converted.desc.shapes.len(), 1);
    }

    #[test]
    fn scenes_with_errors_are_not_packed() {
        let assets = MemoryAssets::default().with("a.pbrt", "WorldBegin Shape \"spere\"");
        let packed = pack(Path::new("a.pbrt"), &assets, io::sink());
        assert!(matches!(packed, Err(PackError::Scene(imported)) if imported.has_errors()));
    }

    #[test]
    fn a_full_disk_is_an_error() {
        struct Full;
        impl Write for Full {
            fn write(&mut self, _: &[u8]) -> io::Result<usize> {
                Err(io::ErrorKind::StorageFull.into())
            }
            fn flush(&mut self) -> io::Result<()> {
                Ok(())
            }
        }
        let (scene, assets) = room("x/y");
        let packed = pack(&scene, &assets, Full);
        assert!(
            matches!(packed, Err(PackError::Output(error)) if error.kind() == io::ErrorKind::StorageFull)
        );
    }
}
