//! Every scene in `scenes/` renders without diagnostics.

use std::path::{Path, PathBuf};

use alhazen::assets::Files;
use alhazen::description::Imported;
use alhazen::description::{AcceleratorDesc, Diagnostic, SceneDesc};
use alhazen::import::import;
use alhazen::integrators::Control;
use alhazen::{CompiledJob, Job, Overrides};

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes")
}

/// The scenes' files and names; the parts that they share are in a folder of their own.
pub fn scenes() -> Vec<(PathBuf, String)> {
    let entries = std::fs::read_dir(folder()).expect("the folder of scenes");
    let paths = entries.map(|entry| entry.expect("an entry of the folder").path());
    let mut scenes: Vec<_> = paths
        .filter_map(|path| {
            let name = path.file_name()?.to_str()?.strip_suffix(".pbrt")?.to_owned();
            Some((path, name))
        })
        .collect();
    scenes.sort();
    scenes
}

fn silent(name: &str, diagnostics: &[Diagnostic]) {
    let messages: Vec<_> = diagnostics.iter().map(|diagnostic| &diagnostic.message).collect();
    assert!(messages.is_empty(), "{name}: {messages:?}");
}

#[test]
fn every_scene_renders_without_diagnostics() {
    let scenes = scenes();
    assert!(scenes.len() > 15, "only {} scenes in {}", scenes.len(), folder().display());
    let small = Overrides { resolution: Some([16, 16]), samples_per_pixel: Some(1), ..Overrides::default() };
    for (path, name) in &scenes {
        let Imported { mut desc, diagnostics, .. } = import(path, &Files);
        silent(name, &diagnostics);
        assert_eq!(desc.film.filename, format!("{name}.png"));
        small.apply(&mut desc).expect("changes that every scene can take");
        let CompiledJob { mut job, warnings } = match Job::compile(desc.clone()) {
            Ok(compiled) => compiled,
            Err(errors) => return silent(name, &errors),
        };
        silent(name, &warnings);
        job.render(&Control::default()).expect("not cancelled");
        let values: Vec<f32> = job.picture().unwrap().values().collect();
        assert!(values.iter().all(|value| value.is_finite()), "{name} has values that are no numbers");
        assert!(values.iter().any(|&value| value > 0.01), "{name} is black");
        assert_eq!(job.session.state().film.rejected().count, 0, "{name} has samples that are no numbers");
    }
}

/// Where every ray is tested against every primitive, pictures are the same.
#[test]
fn accelerators_never_change_a_bit() {
    let small = Overrides {
        integrator: Some("vol-path".into()),
        resolution: Some([16, 16]),
        samples_per_pixel: Some(1),
        ..Overrides::default()
    };
    for (path, name) in scenes() {
        let mut desc = import(&path, &Files).desc;
        small.apply(&mut desc).expect("changes that every scene can take");
        let picture = |accelerator: AcceleratorDesc| {
            let desc = SceneDesc { accelerator: accelerator.into(), ..desc.clone() };
            let mut job = Job::compile(desc).expect("a scene").job;
            job.render(&Control::default()).expect("not cancelled");
            let values: Vec<f32> = job.picture().expect("a picture").values().collect();
            (values, job.session.progress().stats.extents)
        };
        let (values, extents) = picture(AcceleratorDesc::None);
        assert_eq!(extents, 0);
        assert_eq!(values, picture(desc.accelerator.value.clone()).0, "{name}");
    }
}

#[test]
fn the_readme_lists_every_scene() {
    let table = std::fs::read_to_string(folder().join("README.md")).expect("the table of scenes");
    for (_, name) in scenes() {
        assert!(table.contains(&format!("| `{name}.pbrt` |")), "{name}.pbrt is not in scenes/README.md");
    }
}
