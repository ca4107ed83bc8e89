//! Damaged, unusual and old third-party files, from import to a small picture where they are valid:
//! no panic, and bounded time.

use std::path::Path;
use std::time::{Duration, Instant};

use crate::common::{data, files_below, scene_text};
use alhazen::assets::{AssetSource, Files};
use alhazen::import::import;
use alhazen::integrators::Control;
use alhazen::{Job, Overrides};

const LIMIT: Duration = Duration::from_secs(2);

/// Imports a scene and renders a few pixels of it; whether that succeeded.
fn draws(path: &Path, assets: &dyn AssetSource) -> bool {
    let mut imported = import(path, assets);
    if imported.has_errors() {
        return false;
    }
    let small = Overrides { resolution: Some([8, 8]), samples_per_pixel: Some(1), ..Overrides::default() };
    small.apply(&mut imported.desc).expect("the changes make sense");
    let Ok(compiled) = Job::compile(imported.desc) else { return false };
    let mut job = compiled.job;
    job.render(&Control::default()).is_ok() && job.session.state().film.sample_count() > 0
}

/// Draws all files of some folders with one of the extensions, each in bounded time; returns the
/// number that could be drawn.
fn draw_all(folders: &[&str], extensions: &[&str], draw: impl Fn(&Path) -> bool) -> usize {
    let mut drawn = 0;
    for folder in folders.iter().filter_map(|folder| data(&format!("malformed/{folder}"))) {
        let files = files_below(&folder);
        let has = |path: &&std::path::PathBuf| {
            extensions.iter().any(|end| path.extension().is_some_and(|e| e == *end))
        };
        for path in files.iter().filter(has) {
            let start = Instant::now();
            let is_drawn = draw(path);
            let time = start.elapsed();
            assert!(time < LIMIT, "{} took {time:?}", path.display());
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            assert!(!(is_drawn && name.starts_with("invalid")), "{name} must be refused");
            drawn += usize::from(is_drawn);
        }
    }
    drawn
}

#[test]
fn meshes() {
    let folders = ["ply", "ply-assimp", "obj-tinyobj", "obj-magnum", "obj-assimp", "obj-fuzz"];
    let drawn = draw_all(&folders, &["ply", "obj"], |path| draws(path, &Files));
    assert!(data("malformed").is_none() || drawn > 0);
}

/// Meshes once more, as shapes of a scene.
#[test]
fn meshes_in_scenes() {
    draw_all(&["ply", "ply-assimp"], &["ply"], |path| {
        let text = format!("WorldBegin Shape \"plymesh\" \"string filename\" \"{}\"", path.display());
        let (name, assets) = scene_text(&text);
        draws(name, &assets)
    });
}

#[test]
fn images_as_textures() {
    draw_all(&["exr", "png", "tga", "bmp"], &["exr", "png", "tga", "bmp"], |path| {
        let text = format!(
            "LookAt 0 0 -2 0 0 0 0 1 0 Camera \"perspective\" WorldBegin LightSource \"infinite\"\n\
             Texture \"t\" \"spectrum\" \"imagemap\" \"string filename\" \"{}\"\n\
             Material \"diffuse\" \"texture reflectance\" \"t\" Shape \"sphere\"",
            path.display()
        );
        let (name, assets) = scene_text(&text);
        draws(name, &assets)
    });
}

/// Also as environment maps, which have further requirements.
#[test]
fn images_as_environment_maps() {
    draw_all(&["exr"], &["exr"], |path| {
        let text = format!("WorldBegin LightSource \"infinite\" \"string filename\" \"{}\"", path.display());
        let (name, assets) = scene_text(&text);
        draws(name, &assets)
    });
}

#[test]
fn scenes_of_older_formats() {
    let drawn = draw_all(&["pbrt-old-syntax"], &["pbrt"], |path| draws(path, &Files));
    assert_eq!(drawn, 0, "scenes of old syntax are refused");
}
