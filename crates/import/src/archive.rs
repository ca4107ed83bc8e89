//! Archives of scenes: ZIP files of a scene and all files that it needs.
//!
//! The entry `alhazen.json` names the scene file, and has the entries of the files that the scene
//! names by absolute paths:
//!
//! ```json
//! { "scene": "room/room.pbrt", "absolute": { "/textures/wood.png": "absolute/0-wood.png" } }
//! ```
//!
//! An archive without it was packed by hand; its scene is the only `.pbrt` file of its uppermost
//! folder that has one.

use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::io::{self, Cursor};
use std::path::{Component, Path, PathBuf};
use std::sync::Arc;

use description::{SceneDesc, SourceMap, Span};
use serde_json::{Value, json};
use zip::ZipArchive;
use zip::result::ZipError;

use crate::import_file;
use assets::{AssetSource, read_at_most};
use description::DiagnosticList;
use description::Imported;

/// What an archive holds.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Manifest {
    /// The entry of the scene file.
    pub scene: String,
    /// The entries of files that are named by absolute paths.
    pub absolute: BTreeMap<PathBuf, String>,
}

impl Manifest {
    /// The name of its entry.
    pub const NAME: &str = "alhazen.json";

    /// The text of its entry.
    pub fn to_json(&self) -> String {
        let absolute: BTreeMap<_, _> =
            self.absolute.iter().map(|(path, entry)| (path.to_string_lossy(), entry)).collect();
        json!({ "scene": self.scene, "absolute": absolute }).to_string()
    }

    /// Parses the text of [`to_json`](Self::to_json).
    fn from_json(text: &[u8]) -> Option<Self> {
        let json: Value = serde_json::from_slice(text).ok()?;
        let absolute = json["absolute"].as_object()?.iter();
        Some(Self {
            scene: json["scene"].as_str()?.to_owned(),
            absolute: absolute
                .map(|(path, entry)| Some((path.into(), entry.as_str()?.to_owned())))
                .collect::<Option<_>>()?,
        })
    }
}

/// Whether a path is that of an archive, by its extension.
pub fn is_archive(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("zip"))
}

/// Reads the scene of an archive.
pub(crate) fn read(path: &Path, assets: &dyn AssetSource) -> Imported {
    match Archive::open(assets, path) {
        Ok(archive) => import_file(Path::new(&archive.manifest.scene), &archive),
        Err(error) => {
            let mut report = DiagnosticList::default();
            let message = format!("cannot read the archive `{}`: {error}", path.display());
            report.error("unreadable-archive", message, Span::NONE);
            let (desc, sources) = (SceneDesc::default(), SourceMap::default());
            Imported { desc, sources, diagnostics: report.finish() }
        }
    }
}

/// The files of an archive. Relative paths begin at its root.
struct Archive {
    zip: Zip,
    manifest: Manifest,
}

impl Archive {
    fn open(assets: &dyn AssetSource, path: &Path) -> io::Result<Self> {
        let zip = open(assets.read(path)?)?;
        let mut archive =
            Self { zip, manifest: Manifest { scene: String::new(), absolute: BTreeMap::new() } };
        archive.manifest = match archive.zip.index_for_name(Manifest::NAME) {
            Some(index) => {
                let text = entry(&archive.zip, index)?;
                let damaged = || io::Error::new(io::ErrorKind::InvalidData, "its alhazen.json is damaged");
                Manifest::from_json(&text).ok_or_else(damaged)?
            }
            None => Manifest { scene: archive.only_scene()?, absolute: BTreeMap::new() },
        };
        // An archive in an archive could hold itself.
        if is_archive(Path::new(&archive.manifest.scene)) {
            return Err(io::Error::new(io::ErrorKind::InvalidData, "its scene is an archive"));
        }
        Ok(archive)
    }

    /// The scene of an archive that was packed by hand.
    fn only_scene(&self) -> io::Result<String> {
        let names = self.zip.file_names().map(|name| name.map(|name| name.into_owned()));
        let names: Vec<String> = names.collect::<Result<_, _>>().map_err(invalid)?;
        let depth = |name: &&String| name.matches('/').count();
        let scenes = names.iter().filter(|name| Path::new(name).extension() == Some(OsStr::new("pbrt")));
        let top = scenes.clone().map(|name| depth(&name)).min();
        let mut scenes = scenes.filter(|name| Some(depth(name)) == top);
        match (scenes.next(), scenes.next()) {
            (Some(scene), None) => Ok(scene.clone()),
            (first, second) => {
                let candidates: Vec<_> = first.into_iter().chain(second).chain(scenes).take(8).collect();
                let problem = match candidates[..] {
                    [] => "it has neither an alhazen.json nor a .pbrt file".to_owned(),
                    _ => format!("it has no alhazen.json that says which is its scene: {candidates:?}"),
                };
                Err(io::Error::new(io::ErrorKind::InvalidData, problem))
            }
        }
    }

    fn find(&self, path: &Path) -> Option<usize> {
        let name = match path.is_absolute() {
            true => self.manifest.absolute.get(path)?.clone(),
            false => normalized(path)?,
        };
        self.zip.index_for_name(&name)
    }
}

/// An archive whose copies share its bytes.
pub(crate) type Zip = ZipArchive<Cursor<Arc<[u8]>>>;

/// Opens an archive.
pub(crate) fn open(bytes: Vec<u8>) -> io::Result<Zip> {
    ZipArchive::new(Cursor::new(bytes.into())).map_err(invalid)
}

/// The content of an entry, as long as it says it is. That length is at most 64 MiB, or what
/// DEFLATE can make of the packed bytes.
pub(crate) fn entry(zip: &Zip, index: usize) -> io::Result<Vec<u8>> {
    const GREATEST_RATIO: u64 = 1032;
    const ALWAYS_ALLOWED: u64 = 64 << 20;
    let mut zip = zip.clone();
    let file = zip.by_index(index).map_err(invalid)?;
    let limit = file.compressed_size().saturating_mul(GREATEST_RATIO).max(ALWAYS_ALLOWED);
    let size = file.size().min(limit);
    read_at_most(file, size)
}

impl AssetSource for Archive {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        let index = self.find(path);
        let missing = || io::Error::new(io::ErrorKind::NotFound, "not in the archive");
        entry(&self.zip, index.ok_or_else(missing)?)
    }

    fn exists(&self, path: &Path) -> bool {
        self.find(path).is_some()
    }
}

/// The name of the entry of a relative path: without `.` and `..`, with `/` between names; `None`
/// if it leaves the archive.
pub(crate) fn normalized(path: &Path) -> Option<String> {
    let mut names: Vec<&str> = Vec::new();
    for component in path.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => _ = names.pop()?,
            Component::Normal(name) => names.push(name.to_str()?),
            Component::Prefix(_) | Component::RootDir => return None,
        }
    }
    Some(names.join("/"))
}

fn invalid(error: ZipError) -> io::Error {
    match error {
        ZipError::Io(error) => error,
        ZipError::InvalidArchive(_) => {
            io::Error::new(io::ErrorKind::InvalidData, "it is no ZIP archive, or is not whole")
        }
        error => io::Error::new(io::ErrorKind::InvalidData, error.to_string()),
    }
}

#[cfg(test)]
mod tests {
    use std::io::Write;

    use zip::write::{SimpleFileOptions, ZipWriter};

    use super::*;
    use assets::MemoryAssets;

    const ROOM: &str = "Include \"../parts/light.pbrt\" WorldBegin Shape \"sphere\"";

    fn zip(entries: &[(&str, &str)]) -> Vec<u8> {
        let mut writer = ZipWriter::new(Cursor::new(Vec::new()));
        for (name, text) in entries {
            writer.start_file(*name, SimpleFileOptions::default()).unwrap();
            writer.write_all(text.as_bytes()).unwrap();
        }
        writer.finish().unwrap().into_inner()
    }

    fn read_bytes(bytes: Vec<u8>) -> Imported {
        read(Path::new("a.zip"), &MemoryAssets::default().with("a.zip", bytes))
    }

    fn refusal(bytes: Vec<u8>) -> String {
        read_bytes(bytes).diagnostics.into_iter().find(|found| found.is_error()).unwrap().message
    }

    #[test]
    fn an_archive_that_is_cut_off_is_refused_in_words() {
        let whole = zip(&[("a.pbrt", "WorldBegin")]);
        for bytes in [&whole[..whole.len() - 4], b"PK", b""] {
            let message = refusal(bytes.to_vec());
            assert_eq!(message, "cannot read the archive `a.zip`: it is no ZIP archive, or is not whole");
        }
    }

    #[test]
    fn files_are_found_beside_the_scene_and_by_absolute_paths() {
        let include = std::path::absolute("far.pbrt").unwrap();
        let light = format!("Include {:?}", include.to_string_lossy());
        let manifest = Manifest {
            scene: "room/room.pbrt".into(),
            absolute: [(include, "absolute/0-far.pbrt".to_owned())].into(),
        };
        let imported = read_bytes(zip(&[
            (Manifest::NAME, &manifest.to_json()),
            ("room/room.pbrt", ROOM),
            ("parts/light.pbrt", &light),
            ("absolute/0-far.pbrt", "Camera \"orthographic\""),
        ]));
        assert!(!imported.has_errors(), "{:?}", imported.diagnostics);
        assert_eq!(imported.desc.shapes.len(), 1);
        let kind = &imported.desc.camera.kind;
        assert!(matches!(kind, description::CameraKind::Orthographic { .. }), "{kind:?}");
    }

    #[test]
    fn an_archive_packed_by_hand_has_one_scene_nearest_to_its_root() {
        let part = ("s/parts/a.pbrt", "");
        let found = read_bytes(zip(&[("s/a.pbrt", "WorldBegin Shape \"sphere\""), part]));
        assert_eq!(found.desc.shapes.len(), 1);
        let two = refusal(zip(&[("s/a.pbrt", ""), ("s/b.pbrt", ""), part]));
        assert!(two.contains(r#"["s/a.pbrt", "s/b.pbrt"]"#), "{two}");
        assert!(refusal(zip(&[("a.txt", "")])).contains("nor a .pbrt file"));
    }

    #[test]
    fn what_is_no_archive_of_a_scene_is_refused() {
        assert!(refusal(b"PK\x03\x04".to_vec()).contains("cannot read the archive `a.zip`"));
        assert!(refusal(zip(&[(Manifest::NAME, "{}")])).contains("alhazen.json is damaged"));
        let nested = r#"{"scene": "b.zip", "absolute": {}}"#;
        assert!(refusal(zip(&[(Manifest::NAME, nested)])).contains("its scene is an archive"));
        let outside = r#"{"scene": "../b.pbrt", "absolute": {}}"#;
        assert!(refusal(zip(&[(Manifest::NAME, outside)])).contains("not in the archive"));
    }

    #[test]
    fn damaged_entries_are_errors() {
        let text = format!("WorldBegin {}", "Shape \"sphere\" ".repeat(40));
        let bytes = zip(&[("a.pbrt", &text)]);
        for at in (0..bytes.len()).step_by(3) {
            let mut damaged = bytes.clone();
            damaged[at] ^= 0x10;
            // Either way it ends: some bytes, such as dates, do not matter.
            let _ = read_bytes(damaged);
        }
        let mut damaged = bytes.clone();
        damaged[40] ^= 0x10;
        assert!(read_bytes(damaged).has_errors());
        assert!(!read_bytes(bytes).has_errors());
    }
}
