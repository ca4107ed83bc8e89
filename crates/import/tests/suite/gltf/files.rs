//! Files of other authors, valid and damaged, and files damaged at random.

use std::path::Path;
use std::time::Instant;

use super::File;
use crate::corpora::{data, files, shown};
use alhazen_import::import;
use assets::{Files, MemoryAssets};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use serde_json::json;

fn both(folder: &Path) -> Vec<std::path::PathBuf> {
    ["gltf", "glb"].into_iter().flat_map(|extension| files(folder, extension)).collect()
}

#[test]
fn samples_are_read() {
    let Some(folder) = data("gltf") else { return };
    let found = both(&folder);
    assert!(found.len() > 30);
    for path in found {
        let imported = import(&path, &Files);
        // Some need features that the program may have been built without.
        let mut errors = imported.diagnostics.iter().filter(|diagnostic| diagnostic.is_error());
        let is_read = errors.all(|error| error.message.contains("built without the cargo feature"));
        assert!(is_read, "{}:\n{}", path.display(), shown(&imported));
    }
}

#[test]
fn damaged_files_are_refused_or_read() {
    let Some(folder) = data("malformed") else { return };
    let found: Vec<_> =
        both(&folder).into_iter().filter(|path| path.to_string_lossy().contains("gltf-")).collect();
    assert!(found.len() > 200);
    let (start, mut refused) = (Instant::now(), 0);
    for path in &found {
        let imported = import(path, &Files);
        let name = path.file_name().expect("a name").to_string_lossy();
        // What the validator of the format calls an error, or has no report about.
        let report = std::fs::read_to_string(path.with_added_extension("report.json")).unwrap_or_default();
        if name.contains("invalid") && !report.contains("\"numErrors\": 0") {
            assert!(imported.has_errors(), "{} is read:\n{}", path.display(), shown(&imported));
        }
        refused += usize::from(imported.has_errors());
        // Every message names its place.
        for diagnostic in imported.diagnostics.iter().filter(|diagnostic| diagnostic.is_error()) {
            let is_whole = ["invalid-glb", "invalid-json"].contains(&diagnostic.code);
            let is_outline = ["`asset` is missing", "the text is not a JSON object"];
            let message = diagnostic.message.as_str();
            let is_placed = message.starts_with('/') || is_whole || is_outline.contains(&message);
            assert!(is_placed, "{}: {message}", path.display());
        }
    }
    eprintln!("{refused} of {} refused in {:?}", found.len(), start.elapsed());
    assert!(start.elapsed().as_secs() < 60);
}

/// A file that uses much of the format.
fn rich() -> Vec<u8> {
    let mut file = File::quad(json!({
        "normalTexture": {"index": 0},
        "emissiveTexture": {"index": 0, "extensions": {"KHR_texture_transform": {"rotation": 1}}},
        "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}, "KHR_materials_volume": {"thicknessFactor": 1}},
    }))
    .textured(&[[255, 0, 99, 40]; 3]);
    let targets = file.floats("VEC3", &[0.5; 12]);
    let (times, values) = (file.floats("SCALAR", &[0., 1.]), file.floats("VEC3", &[0.5; 6]));
    let joints = file.view(&[0; 16]);
    let weights = file.floats("VEC4", &[0.25; 16]);
    file.json["accessors"]
        .as_array_mut()
        .unwrap()
        .push(json!({"bufferView": joints, "componentType": 5121, "count": 4, "type": "VEC4"}));
    let primitive = &mut file.json["meshes"][0]["primitives"][0];
    primitive["targets"] = json!([{"POSITION": targets}]);
    primitive["attributes"]["JOINTS_0"] = json!(weights + 1);
    primitive["attributes"]["WEIGHTS_0"] = json!(weights);
    file.json["skins"] = json!([{"joints": [1]}]);
    file.json["cameras"] = json!([{"type": "perspective", "perspective": {"yfov": 1}}]);
    file.json["nodes"] = json!([{"mesh": 0, "skin": 0}, {"camera": 0, "children": [0]}, {"mesh": 0}]);
    file.json["scenes"] = json!([{"nodes": [1, 2]}]);
    file.json["animations"] = json!([{
        "samplers": [{"input": times, "output": values}],
        "channels": [{"sampler": 0, "target": {"node": 0, "path": "scale"}}],
    }]);
    file.glb()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 400, rng_seed: RngSeed::Fixed(7), failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn files_damaged_at_random_do_no_harm(
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..12),
        digits in prop::collection::vec((any::<prop::sample::Index>(), b'0'..=b'9'), 0..6),
        end in any::<prop::sample::Index>(),
        is_cut in prop::bool::weighted(0.1),
    ) {
        let mut bytes = rich();
        for (at, byte) in changes.iter().take(usize::from(digits.is_empty()) * 12) {
            let at = at.index(bytes.len());
            bytes[at] = *byte;
        }
        // Digits are changed to others, so that the text stays one.
        let places: Vec<_> = (0..bytes.len()).filter(|&at| bytes[at].is_ascii_digit()).collect();
        for (at, digit) in &digits {
            bytes[places[at.index(places.len())]] = *digit;
        }
        if is_cut {
            bytes.truncate(end.index(bytes.len()));
        }
        import("a.glb#time=0.5,shutter=0.1", &MemoryAssets::default().with("a.glb", bytes));
    }
}

#[test]
fn a_rich_file_is_sound() {
    let imported = import("a.glb", &MemoryAssets::default().with("a.glb", rich()));
    assert!(!imported.has_errors(), "{}", shown(&imported));
}
