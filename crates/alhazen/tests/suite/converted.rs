//! Scenes that were written as pbrt-v4 render to the same bits.

use std::path::{Path, PathBuf};

use alhazen::assets::{Files, MemoryAssets};
use alhazen::description::SceneDesc;
use alhazen::import::import;
use alhazen::integrators::Control;
use alhazen::pbrt::export;
use alhazen::{Job, Overrides};

use crate::common::{data, files_below};
use crate::scenes::scenes;

/// The bits of a picture.
fn picture(desc: SceneDesc) -> Vec<u32> {
    let mut job = Job::compile(desc).expect("a scene").job;
    job.render(&Control::default()).expect("not cancelled");
    job.picture().expect("a picture").values().map(f32::to_bits).collect()
}

fn converted(desc: &SceneDesc) -> SceneDesc {
    let mut assets = MemoryAssets::default();
    let mut sink = |name: &str, bytes: &[u8]| {
        assets = std::mem::take(&mut assets).with(format!("files/{name}"), bytes);
        Ok(())
    };
    let text = export(desc, "files", &mut sink).expect("a scene of the format").text;
    let imported = import("scene.pbrt", &assets.with("scene.pbrt", text));
    assert!(!imported.has_errors(), "{:?}", imported.diagnostics);
    imported.desc
}

/// Renders them by an integrator instead of theirs, if one is given.
fn check(paths: impl IntoIterator<Item = PathBuf>, integrator: Option<&str>) {
    let small = Overrides {
        integrator: integrator.map(Into::into),
        resolution: Some([12, 12]),
        samples_per_pixel: Some(1),
        ..Overrides::default()
    };
    for path in paths {
        let mut imported = import(&path, &Files);
        assert!(!imported.has_errors(), "{}", path.display());
        // Before it is written, as only cameras of an importer follow the size of the film.
        small.apply(&mut imported.desc).expect("changes that every scene can take");
        let again = converted(&imported.desc);
        assert_eq!(picture(imported.desc), picture(again), "{}", path.display());
    }
}

/// Without what maps of photons and radiosities cost; that integrators are written is a test of
/// `export`.
#[test]
fn own_scenes_render_to_the_same_bits() {
    check(scenes().into_iter().map(|(path, _)| path), Some("vol-path"));
}

#[test]
fn conformance_scenes_render_to_the_same_bits() {
    let Some(folder) = data("pbrt-v4-conformance") else { return };
    let is_scene =
        |path: &Path| path.parent() == Some(&folder) && path.extension().is_some_and(|e| e == "pbrt");
    let scenes: Vec<_> = files_below(&folder).into_iter().filter(|path| is_scene(path)).collect();
    assert!(scenes.len() > 100);
    check(scenes, None);
}

#[test]
fn bare_meshes_render_to_the_same_bits() {
    let Some(folder) = data("meshes") else { return };
    check(["spot.obj", "platonic_shelf.ply"].map(|name| folder.join(name)), None);
}
