//! Tests of `alhazen scene convert` and `alhazen scene pack`.

use crate::common::{Folder, SCENE};
use serde_json::json;

/// A folder with a bare mesh of more than 64 triangles.
fn with_mesh(name: &str) -> Folder {
    let folder = Folder::new(name);
    let vertices: String = (0..40).map(|i| format!("v {i} {} 0\nv {i} {} 1\n", i * i, i + 2)).collect();
    let faces: String = (1..78).map(|i| format!("f {i} {} {}\n", i + 1, i + 2)).collect();
    folder.write("mesh.obj", &(vertices + &faces));
    folder
}

#[test]
fn a_converted_scene_renders_to_the_same_bits() {
    let folder = with_mesh("convert");
    let finished = folder.alhazen(&["scene", "convert", "mesh.obj", "a.pbrt"]).expect(0);
    assert!(finished.out.starts_with("a.pbrt: 2 shapes, 2 materials, 1 light; 2 files, "), "{finished:?}");
    assert!(finished.out.ends_with(" in a.assets\n") && finished.err.is_empty(), "{finished:?}");
    assert_eq!(folder.files(), ["a.assets", "a.pbrt", "mesh.obj"]);
    for (scene, picture) in [("mesh.obj", "mesh.exr"), ("a.pbrt", "a.exr")] {
        let small = ["--resolution", "16x12", "--spp", "1", "--quiet", "-o", picture];
        folder.alhazen(&[&["render", scene], &small[..]].concat()).expect(0);
    }
    let values = |name: &str| folder.image(name).values().map(f32::to_bits).collect::<Vec<_>>();
    assert_eq!(values("mesh.exr"), values("a.exr"));

    // The same scene gives the same bytes, under any name of the output's folder.
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).expect("a file that was written");
    let before = [bytes("a.pbrt"), bytes("a.assets/mesh-1.ply"), bytes("a.assets/image-1.exr")];
    folder.write("a.assets/other", "stays");
    folder.alhazen(&["scene", "convert", "mesh.obj", "./a.pbrt"]).expect(0);
    assert_eq!(before, [bytes("a.pbrt"), bytes("a.assets/mesh-1.ply"), bytes("a.assets/image-1.exr")]);
    assert_eq!(bytes("a.assets/other"), b"stays");
}

#[test]
fn what_pbrt_does_not_know_is_reported() {
    let folder = Folder::new("extensions");
    folder.write("scene.pbrt", &format!("{SCENE}Material \"openpbr\" Shape \"plane\""));
    let finished = folder.alhazen(&["scene", "convert", "scene.pbrt", "b.pbrt"]).expect(0);
    let expected = "pbrt-v4 itself does not know what alhazen does: material openpbr, shape plane\n";
    assert!(finished.out.ends_with(expected), "{finished:?}");
    let json = folder.alhazen(&["scene", "convert", "scene.pbrt", "b.pbrt", "--json"]).expect(0).json();
    let expected = json!({
        "status": "done", "output": "b.pbrt", "files": [], "errors": [], "warnings": [],
        "extensions": ["material openpbr", "shape plane"],
    });
    assert_eq!(json, expected);
    assert_eq!(folder.files(), ["b.pbrt", "scene.pbrt"]);
}

#[test]
fn nothing_is_written_where_it_should_not_be() {
    let folder = with_mesh("refused");
    folder.write("scene.pbrt", SCENE);
    folder.write("b.assets", "a file");
    folder.write("wrong.pbrt", "WorldBegin Shape \"cube\"");
    for (arguments, code, message) in [
        (["mesh.obj", "a.ply"], 2, "needs the extension .pbrt"),
        (["mesh.obj", "missing/a.pbrt"], 2, "missing does not exist"),
        (["scene.pbrt", "./scene.pbrt"], 2, "it is the scene that is converted"),
        (["mesh.obj", "b.pbrt"], 2, "b.assets: it is not a folder"),
        (["wrong.pbrt", "a.pbrt"], 1, "there is no shape `cube`"),
        (["none.pbrt", "a.pbrt"], 1, "none.pbrt"),
    ] {
        let finished = folder.alhazen(&[&["scene", "convert"], &arguments[..]].concat()).expect(code);
        assert!(finished.err.contains(message), "{finished:?}");
        assert_eq!(folder.files(), ["b.assets", "mesh.obj", "scene.pbrt", "wrong.pbrt"]);
    }
}

#[cfg(target_os = "linux")]
#[test]
fn a_file_that_cannot_be_written_is_an_error_and_leaves_the_old_scene() {
    let folder = with_mesh("cut");
    folder.write("a.pbrt", "the old scene");
    // A folder cannot be replaced by a file.
    std::fs::create_dir_all(folder.path().join("a.assets/mesh-1.ply")).expect("a folder for the test");
    let finished = folder.alhazen(&["scene", "convert", "mesh.obj", "a.pbrt"]).expect(1);
    assert!(finished.err.contains("a.assets/mesh-1.ply: "), "{finished:?}");
    assert_eq!(std::fs::read_to_string(folder.path().join("a.pbrt")).expect("a file"), "the old scene");
}

#[test]
fn an_archive_is_a_scene_with_all_its_files() {
    let folder = with_mesh("pack");
    std::fs::create_dir(folder.path().join("room")).expect("a new folder");
    folder.write("room/scene.pbrt", &format!("{SCENE}Include \"../mesh.pbrt\""));
    folder.write("mesh.pbrt", "Shape \"trianglemesh\" \"point3 P\" [0 0 0 1 0 0 0 1 0]");
    let finished = folder.alhazen(&["scene", "pack", "room/scene.pbrt"]).expect(0);
    assert!(finished.out.starts_with("scene.zip: 2 files, ") && finished.err.is_empty(), "{finished:?}");
    let json =
        folder.alhazen(&["scene", "pack", "room/scene.pbrt", "-o", "b.zip", "--json"]).expect(0).json();
    assert_eq!(json["files"].as_array().map(Vec::len), Some(2), "{json}");
    let bytes = |name: &str| std::fs::read(folder.path().join(name)).expect("a file that was written");
    assert_eq!(bytes("scene.zip"), bytes("b.zip"));
    let hash = json["blake3"].as_str().expect("a hash");
    assert!(finished.out.contains(hash), "{finished:?}");

    std::fs::create_dir(folder.path().join("away")).expect("a new folder");
    std::fs::rename(folder.path().join("b.zip"), folder.path().join("away/c.zip")).expect("a file to move");
    for (scene, picture) in [("room/scene.pbrt", "a.exr"), ("away/c.zip", "b.exr")] {
        let small = ["--resolution", "16x12", "--spp", "1", "--quiet", "-o", picture];
        folder.alhazen(&[&["render", scene], &small[..]].concat()).expect(0);
    }
    let values = |name: &str| folder.image(name).values().map(f32::to_bits).collect::<Vec<_>>();
    assert_eq!(values("a.exr"), values("b.exr"));

    let refused = folder.alhazen(&["scene", "pack", "away/c.zip"]).expect(1);
    assert!(refused.err.contains("it is an archive already"), "{refused:?}");
    folder.write("wrong.pbrt", "WorldBegin Shape \"cube\"");
    let refused = folder.alhazen(&["scene", "pack", "wrong.pbrt"]).expect(1);
    assert!(refused.err.contains("wrong.pbrt:1"), "{refused:?}");
    assert!(!folder.files().contains(&"wrong.zip".to_owned()));
    folder.alhazen(&["scene", "pack", "-"]).expect(2);
    let refused = folder.alhazen(&["scene", "pack", "room/scene.pbrt", "-o", "b.tar"]).expect(2);
    assert!(refused.err.contains(".zip") && !folder.files().contains(&"b.tar".to_owned()), "{refused:?}");
    let refused = folder.alhazen(&["scene", "pack", "room/none.pbrt"]).expect(1);
    assert!(refused.err.contains("room/none.pbrt"), "{refused:?}");
}
