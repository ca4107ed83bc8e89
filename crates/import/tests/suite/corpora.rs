//! Scenes and meshes of other authors: valid ones are read without errors, damaged ones are refused
//! with a message, in bounded time.
//!
//! The files are looked for in `$ALHAZEN_DATA` or in `../shared/data` beside the workspace.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use alhazen_import::{Files, Imported, MemoryAssets, import, read_obj, read_ply};

fn data(folder: &str) -> Option<PathBuf> {
    let root = std::env::var_os("ALHAZEN_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data"), PathBuf::from);
    let path = root.join(folder);
    if path.is_dir() {
        return Some(path);
    }
    eprintln!("skipped: {} is not there (set ALHAZEN_DATA)", path.display());
    None
}

fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
    let mut found = Vec::new();
    for entry in std::fs::read_dir(folder).expect("the folder is there") {
        let path = entry.expect("the entry is there").path();
        if path.is_dir() {
            found.extend(files(&path, extension));
        } else if path.extension().is_some_and(|found| found == extension) {
            found.push(path);
        }
    }
    found.sort();
    found
}

fn shown(imported: &Imported) -> String {
    let mut text = String::new();
    for diagnostic in &imported.diagnostics {
        let span = diagnostic.span();
        let position = imported.sources.position(span);
        let file = imported.sources.name(span.file);
        text += &format!(
            "{file}:{}:{}: {:?} [{}] {} ({})\n",
            position.line,
            position.column,
            diagnostic.severity,
            diagnostic.code,
            diagnostic.message,
            diagnostic.help.as_deref().unwrap_or("")
        );
    }
    text
}

/// The light of luminaires, integrated over the angles of their files by the trapezoidal rule.
const LUMENS: [(&str, f32); 6] = [
    ("007cfb11e343e2f42e3b476be4ab684e", 321.25),
    ("01dac7d6c646814dcda6780e7b7b4566", 941.10),
    ("0646706b3d2d9658994fc4ad80681dec", 1219.08),
    ("108b32f07d6d38a7a6528a6d307440df", 40.01),
    ("1aec5958092c236d005093ca27ebe378", 2342.05),
    ("ASA_15M_R2", 9560.83),
];

#[test]
fn photometric_files_have_their_light() {
    let Some(folder) = data("measured/ies") else { return };
    let scene = "WorldBegin LightSource \"goniometric\" \"string filename\" \"lamp.ies\"";
    for (name, expected) in LUMENS {
        let lamp = std::fs::read(folder.join(name).with_extension("ies")).expect("the file is there");
        let assets = MemoryAssets::default().with("a.pbrt", scene).with("lamp.ies", lamp);
        let imported = import("a.pbrt", &assets);
        assert!(!imported.has_errors(), "{}", shown(&imported));
        let (_, desc) = imported.desc.images.iter().next().expect("an image");
        let pixels = (desc.image.width() * desc.image.height()) as f32;
        let lumens = desc.image.values().sum::<f32>() / pixels * 4.0 * std::f32::consts::PI;
        assert!((lumens / expected - 1.0).abs() < 0.01, "{name}: {lumens} lm, not {expected}");
    }
}

#[test]
fn good_scenes_are_read_without_errors() {
    for folder in ["pbrt-v4-conformance", "pbrt-bitterli", "pbrt-v4-scenes"] {
        let Some(folder) = data(folder) else { continue };
        let scenes = files(&folder, "pbrt");
        assert!(!scenes.is_empty());
        for path in scenes {
            let text = std::fs::read(&path).unwrap();
            if !text.windows(10).any(|bytes| bytes == b"WorldBegin") {
                continue; // A part of a scene, which the scene includes.
            }
            let imported = import(&path, &Files);
            assert!(!imported.has_errors(), "{}:\n{}", path.display(), shown(&imported));
            let desc = &imported.desc;
            assert!(desc.shapes.len() + desc.instances.len() > 0, "{} is empty", path.display());
        }
    }
}

fn in_time<T>(path: &Path, work: impl FnOnce() -> T) -> T {
    let start = Instant::now();
    let result = work();
    assert!(start.elapsed() < Duration::from_secs(2), "{} took {:?}", path.display(), start.elapsed());
    result
}

#[test]
fn old_scenes_are_refused_with_located_messages() {
    let Some(folder) = data("malformed/pbrt-old-syntax") else { return };
    for path in files(&folder, "pbrt") {
        let imported = in_time(&path, || import(&path, &Files));
        assert!(imported.has_errors(), "{} has no errors", path.display());
        assert!(imported.diagnostics.iter().all(|diagnostic| !diagnostic.message.is_empty()));
        let located = imported.diagnostics.iter().filter(|diagnostic| !diagnostic.span().is_none()).count();
        assert!(located > 0, "{}:\n{}", path.display(), shown(&imported));
    }
}

#[test]
fn damaged_meshes_end_in_a_message() {
    for (folder, extension) in [
        ("malformed/ply", "ply"),
        ("malformed/ply-assimp", "ply"),
        ("malformed/obj-tinyobj", "obj"),
        ("malformed/obj-magnum", "obj"),
        ("malformed/obj-assimp", "obj"),
        ("malformed/obj-fuzz", "obj"),
    ] {
        let Some(folder) = data(folder) else { continue };
        for path in files(&folder, extension) {
            let bytes = std::fs::read(&path).unwrap();
            let mesh =
                in_time(&path, || if extension == "ply" { read_ply(&bytes) } else { read_obj(&bytes) });
            let scene = in_time(&path, || import(&path, &Files));
            assert_eq!(mesh.is_err(), scene.has_errors(), "{}", path.display());
            let name = path.file_name().unwrap().to_string_lossy().into_owned();
            assert!(!name.starts_with("invalid") || mesh.is_err(), "{name} was read");
        }
    }
}

#[test]
fn good_meshes_are_read() {
    let Some(folder) = data("meshes") else { return };
    for path in files(&folder, "ply").into_iter().chain(files(&folder, "obj")) {
        let scene = import(&path, &Files);
        assert!(!scene.has_errors(), "{}:\n{}", path.display(), shown(&scene));
        assert_eq!(scene.desc.lights.len(), 1);
    }
}
