//! Scenes and meshes of other authors: valid ones are read without errors, damaged ones are refused
//! with a message, in bounded time.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use alhazen_import::import;
use assets::{Files, MemoryAssets, read_obj, read_ply};
use description::Imported;
use description::MaterialKind;
use math::spherical_direction;
use scattering::{Directions, Measured, Scatter, TransportMode};
use spectrum::{RgbColorSpace, RgbUnboundedSpectrum, SampledWavelengths};
pub(crate) use testkit::data;

pub(crate) fn files(folder: &Path, extension: &str) -> Vec<PathBuf> {
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

pub(crate) fn shown(imported: &Imported) -> String {
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

/// Directions as (θ, φ) of `wo` and of `wi`, and what Mitsuba 3 has there: the BRDF in red, green
/// and blue, and the density of samples.
type Scattered = ([f32; 4], [f32; 3], f32);

const PAPER: [Scattered; 6] = [
    ([0.05, 0.3, 0.4, 2.0], [0.269543, 0.274407, 0.322723], 0.301724),
    ([0.5, 1.0, 0.55, 4.3], [0.284608, 0.288479, 0.335017], 0.291115),
    ([1.0, -2.0, 0.3, 0.5], [0.268376, 0.271546, 0.314188], 0.29572),
    ([1.2, 0.7, 1.1, 3.6], [0.39192, 0.389459, 0.422749], 0.200664),
    ([0.8, 3.0, 0.75, 3.1], [0.251208, 0.255789, 0.301453], 0.217656),
    ([0.3, -1.0, 1.45, 2.0], [0.32228, 0.327153, 0.383541], 0.046434),
];

const VINYL: [Scattered; 6] = [
    ([0.05, 0.3, 0.4, 2.0], [0.189356, 0.105111, 0.13686], 0.783994),
    ([0.5, 1.0, 0.55, 4.3], [1.96466, 0.777273, 0.956316], 5.59934),
    ([1.0, -2.0, 0.3, 0.5], [0.0221861, 0.00904098, 0.00497709], 0.0510341),
    ([1.2, 0.7, 1.1, 3.6], [0.802144, 0.504755, 0.188186], 0.966753),
    ([1.4, 0.0, 0.2, -1.0], [0.00427855, 0.00153517, 2.14595e-5], 0.00515412),
    ([0.3, -1.0, 1.45, 2.0], [0.0078775, 0.00296807, 0.000735182], 0.00310128),
];

#[test]
fn measured_files_have_the_values_of_mitsuba() {
    let Some(folder) = data("measured/bsdf") else { return };
    let scene = "WorldBegin Material \"measured\" \"string filename\" \"a.bsdf\" Shape \"sphere\"";
    let lambda = SampledWavelengths::new([450.0, 530.0, 600.0, 680.0], [1.0; 4]);
    for (name, scattered) in [("paper_white_rgb", PAPER), ("cc_ibiza_sunset_rgb", VINYL)] {
        let file = std::fs::read(folder.join(name).with_extension("bsdf")).expect("the file is there");
        let assets = MemoryAssets::default().with("a.pbrt", scene).with("a.bsdf", file);
        let imported = import("a.pbrt", &assets);
        assert!(!imported.has_errors(), "{}", shown(&imported));
        let (_, material) = imported.desc.materials.iter().next().expect("a material");
        let MaterialKind::Measured { table } = &material.kind else { panic!("{:?}", material.kind) };
        let bxdf = Measured::new(table, &lambda);
        for (angles, rgb, density) in scattered {
            let [wo, wi] = [&angles[..2], &angles[2..]]
                .map(|angles| spherical_direction(angles[0].sin(), angles[0].cos(), angles[1]));
            let expected = RgbUnboundedSpectrum::new(RgbColorSpace::srgb(), rgb);
            let found = bxdf.f(wo, wi, TransportMode::Radiance);
            for (&lambda, found) in lambda.lambda().iter().zip(found.0) {
                let expected = expected.at(lambda);
                assert!((found / expected - 1.0).abs() < 5e-3, "{name}: {found}, not {expected}");
            }
            let found = bxdf.pdf(wo, wi, TransportMode::Radiance, Directions::All);
            assert!((found / density - 1.0).abs() < 5e-3, "{name}: density {found}, not {density}");
        }
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
    for path in ["ply", "obj", "stl"].into_iter().flat_map(|extension| files(&folder, extension)) {
        let scene = import(&path, &Files);
        assert!(!scene.has_errors(), "{}:\n{}", path.display(), shown(&scene));
        assert_eq!(scene.desc.lights.len(), 1);
    }
}
