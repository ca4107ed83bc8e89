//! Scenes of files are the same after they were written.

use std::path::{Path, PathBuf};

use alhazen_pbrt::{Exported, read};
use assets::{Files, MemoryAssets};
use description::SceneDesc;
use testkit::data;

use crate::plain::difference;
use crate::round_trip;

fn files(folder: &Path, extensions: &[&str]) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).unwrap() {
        let path = entry.unwrap().path();
        if path.is_dir() {
            found.extend(files(&path, extensions));
        } else if path.extension().is_some_and(|found| extensions.iter().any(|wanted| found == *wanted)) {
            found.push(path);
        }
    }
    found.sort();
    found
}

/// Asserts that scenes are the same after they were written, and are then written the same again.
fn check(scenes: &[PathBuf]) {
    check_once(scenes, |path, exported, again| {
        assert_eq!(round_trip(again).0.text, exported.text, "{}", path.display());
    });
}

/// Asserts that scenes are the same after they were written, and then has a look at them.
fn check_once(scenes: &[PathBuf], look: impl Fn(&Path, &Exported, &SceneDesc)) {
    let mut wrong = Vec::new();
    for path in scenes {
        let imported = read(path, &Files);
        // A part of a scene, which the scene includes, has no `WorldBegin`.
        if imported.has_errors() {
            continue;
        }
        let (exported, again) = round_trip(&imported.desc);
        if let Some(difference) = difference(&imported.desc, &again) {
            wrong.push(format!("{}:\n{difference}", path.display()));
        }
        look(path, &exported, &again);
    }
    assert!(wrong.is_empty(), "{} of {}:\n{}", wrong.len(), scenes.len(), wrong.join("\n"));
}

#[test]
fn own_scenes_are_the_same() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes");
    let scenes = files(&folder, &["pbrt"]);
    assert!(scenes.len() > 40);
    check(&scenes);
}

#[test]
fn conformance_scenes_are_the_same() {
    let Some(folder) = data("pbrt-v4-conformance") else { return };
    check(&files(&folder, &["pbrt"]));
}

#[test]
fn larger_scenes_are_the_same() {
    for folder in ["pbrt-bitterli", "pbrt-v4-scenes"] {
        let Some(folder) = data(folder) else { continue };
        check_once(&files(&folder, &["pbrt"]), |_, _, _| ());
    }
}

#[test]
fn meshes_volumes_and_measured_materials_are_the_same() {
    let text = |path: &Path| {
        let name = path.file_name().unwrap().to_string_lossy().into_owned();
        let directive = match path.extension().unwrap().to_str().unwrap() {
            "nvdb" => "MakeNamedMedium \"smoke\" \"string type\" \"nanovdb\"",
            "bsdf" => "Material \"measured\"",
            _ => "Shape \"plymesh\"",
        };
        (name.clone(), format!("WorldBegin {directive} \"string filename\" \"{name}\" Shape \"sphere\""))
    };
    let kinds = [("meshes", &["ply", "obj"][..]), ("volumes", &["nvdb"]), ("measured/bsdf", &["bsdf"])];
    for (folder, extensions) in kinds {
        let Some(folder) = data(folder) else { continue };
        for path in files(&folder, extensions) {
            let (name, scene) = text(&path);
            let assets = MemoryAssets::default().with(name, std::fs::read(&path).unwrap());
            let desc = crate::read(&assets.with("scene.pbrt", scene));
            let (_, again) = round_trip(&desc);
            assert_eq!(difference(&desc, &again), None, "{}", path.display());
        }
    }
}
