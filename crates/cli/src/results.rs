//! The files of a render: the picture in one or more files, and the further files of its algorithm.

use std::path::{Path, PathBuf};

use alhazen::film::Film;
use alhazen::image::{DisplaySettings, PixelSource, replace_file};
use alhazen::integrators::OutputFile;
use alhazen::write_picture;

use crate::failure::{Failure, about_file};

/// Writes a picture to all outputs, and beside the first one the pictures on films of an algorithm;
/// returns the paths of the latter. The other files are written even if one cannot be.
pub fn write_results<'a>(
    picture: &dyn PixelSource,
    outputs: &[PathBuf],
    display: &DisplaySettings,
    films: impl IntoIterator<Item = (String, &'a Film)>,
    files: Vec<OutputFile>,
) -> Result<Vec<PathBuf>, Failure> {
    let mut unwritten = None;
    let mut write = |path: &Path, write: &dyn Fn() -> Result<(), Failure>| {
        let written = write();
        let is_written = written.is_ok();
        unwritten = unwritten.take().or(written.err());
        is_written.then(|| path.to_owned())
    };
    for path in outputs {
        write(path, &|| write_picture(picture, path, display).map_err(|error| about_file(path, error)));
    }
    let mut beside = Vec::new();
    for (name, film) in films {
        let path = named_beside(&outputs[0], &name);
        beside.extend(write(&path, &|| {
            write_picture(&film.development(), &path, display).map_err(|error| about_file(&path, error))
        }));
    }
    for OutputFile { path, contents } in &files {
        beside.extend(write(path, &|| replace_file(path, contents).map_err(|error| about_file(path, error))));
    }
    match unwritten {
        Some(failure) => Err(failure),
        None => Ok(beside),
    }
}

/// Writes a picture that a better one will replace. Errors are ignored: they recur at the end.
pub fn write_preview(picture: &dyn PixelSource, outputs: &[PathBuf], display: &DisplaySettings) {
    for path in outputs {
        let _ = write_picture(picture, path, display);
    }
}

/// "out/room.exr" and "s1-t3" give "out/room-s1-t3.exr".
fn named_beside(picture: &Path, name: &str) -> PathBuf {
    let part = |part: Option<&std::ffi::OsStr>| part.unwrap_or_default().to_string_lossy().into_owned();
    picture.with_file_name(format!("{}-{name}.{}", part(picture.file_stem()), part(picture.extension())))
}

/// "scenes/room.pbrt.gz" gives "room.exr".
pub fn named_after(scene: &Path, extension: &str) -> PathBuf {
    let name = scene.file_name().unwrap_or_default().to_string_lossy();
    let stem = name.split('.').next().filter(|stem| !stem.is_empty() && *stem != "-").unwrap_or("picture");
    PathBuf::from(format!("{stem}.{extension}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pictures_of_films_stand_beside_the_main_one() {
        assert_eq!(named_beside(Path::new("out/a.b.exr"), "s1-t3"), Path::new("out/a.b-s1-t3.exr"));
    }

    #[test]
    fn pictures_are_named_after_their_scenes() {
        for (scene, picture) in [
            ("scenes/room.pbrt.gz", "room.exr"),
            ("room.pbrt", "room.exr"),
            ("-", "picture.exr"),
            (".hidden", "picture.exr"),
            ("..", "picture.exr"),
        ] {
            assert_eq!(named_after(Path::new(scene), "exr"), Path::new(picture));
        }
    }
}
