//! Where the files are looked for that a scene names: as by pbrt-v4, beside the scene's first file,
//! then in the current folder; at last beside the file that names them, where it does not look.

use std::io;
use std::path::{Path, PathBuf};

use assets::AssetSource;

/// The path of a file that a scene file names; the one beside the first file if there is none.
pub(super) fn find(assets: &dyn AssetSource, name: &str, naming_file: &str, first_file: &str) -> PathBuf {
    let beside = |file: &str, name: &str| Path::new(file).parent().unwrap_or(Path::new("")).join(name);
    let first = beside(first_file, name);
    if assets.exists(&first) {
        return first;
    }
    // Names of Windows, on any system.
    let slashed = name.contains('\\').then(|| name.replace('\\', "/"));
    let names = [name].into_iter().chain(slashed.as_deref());
    let mut places =
        names.flat_map(|name| [beside(first_file, name), PathBuf::from(name), beside(naming_file, name)]);
    places.find(|place| assets.exists(place)).unwrap_or(first)
}

/// The files of a scene. That one is missing is told with the places where it was looked for.
pub(super) struct SceneFiles<'a> {
    assets: &'a dyn AssetSource,
    /// The folder of the first file.
    folder: &'a Path,
}

impl<'a> SceneFiles<'a> {
    pub fn new(assets: &'a dyn AssetSource, first_file: &'a Path) -> Self {
        Self { assets, folder: first_file.parent().unwrap_or(Path::new("")) }
    }
}

impl AssetSource for SceneFiles<'_> {
    fn read(&self, path: &Path) -> io::Result<Vec<u8>> {
        self.assets.read(path).map_err(|error| {
            let name = path.strip_prefix(self.folder).ok().filter(|_| !self.folder.as_os_str().is_empty());
            let mut message = error.to_string();
            match name {
                Some(name) if error.kind() == io::ErrorKind::NotFound => {
                    message += &format!(
                        "; nor is there `{}` in the current folder or beside the file that names it",
                        name.display()
                    );
                }
                _ if error.kind() != io::ErrorKind::NotFound => return error,
                _ => {}
            }
            if path.to_string_lossy().contains(char::is_control) {
                message += "; its name has escapes such as `\\n`: write `/` between folders";
            }
            io::Error::new(error.kind(), message)
        })
    }

    fn exists(&self, path: &Path) -> bool {
        self.assets.exists(path)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use assets::MemoryAssets;

    #[test]
    fn names_are_looked_up_beside_the_first_file_then_in_the_current_folder() {
        let assets = MemoryAssets::default()
            .with("s/parts/both.ply", "")
            .with("s/both.ply", "")
            .with("both.ply", "")
            .with("s/parts/near.ply", "")
            .with("near.ply", "")
            .with("s/parts/last.ply", "")
            .with("s/textures/metal.png", "")
            .with("/far/a.ply", "");
        let path = |name| find(&assets, name, "s/parts/list.pbrt", "s/scene.pbrt");
        for (name, place) in [
            ("both.ply", "s/both.ply"),
            ("near.ply", "near.ply"),
            ("last.ply", "s/parts/last.ply"),
            ("parts/both.ply", "s/parts/both.ply"),
            ("textures\\metal.png", "s/textures/metal.png"),
            ("/far/a.ply", "/far/a.ply"),
            ("none.ply", "s/none.ply"),
        ] {
            assert_eq!(path(name), Path::new(place), "{name}");
        }
        // A scene from standard input is in the current folder.
        assert_eq!(find(&assets, "near.ply", "-", "-"), Path::new("near.ply"));
    }

    #[test]
    fn missing_files_are_told_with_all_places() {
        let assets = MemoryAssets::default();
        let message = |path: &str| {
            SceneFiles::new(&assets, Path::new("s/a.pbrt")).read(Path::new(path)).unwrap_err().to_string()
        };
        let expected =
            "no such file; nor is there `b/c` in the current folder or beside the file that names it";
        assert_eq!(message("s/b/c"), expected);
        assert_eq!(message("/b"), "no such file");
        assert!(message("s/textures\normal.png").ends_with("write `/` between folders"));
    }
}
