//! `alhazen view`, without a window.

use crate::common::{Finished, Folder};

#[test]
fn a_camera_path_is_reported() {
    let folder = Folder::with_scene("view");
    let arguments = ["view", "scene.pbrt", "--headless", "--frames", "5"];
    let text = folder.alhazen(&arguments).expect(0).out;
    assert!(text.starts_with("path, 5 frames of 24 × 16 "), "{text}");
    let json = folder.alhazen(&[&arguments[..], &["--json"]].concat()).expect(0).json();
    assert_eq!((json["status"].as_str(), json["frames"].as_u64()), (Some("done"), Some(5)));
    assert_eq!(json["resolution"], serde_json::json!([24, 16]));
    assert!(json["fps"].as_f64().unwrap() > 0.0);
    assert_eq!(folder.files(), ["scene.pbrt"], "nothing is written");
}

#[test]
fn without_a_display_the_error_names_the_way_without_one() {
    let folder = Folder::with_scene("view");
    let mut command = folder.command(&["view", "scene.pbrt"]);
    command.env_remove("DISPLAY").env_remove("WAYLAND_DISPLAY").env_remove("WAYLAND_SOCKET");
    let Finished { code, err, .. } = command.output().unwrap().into();
    assert!(code != Some(0) && err.starts_with("error: ") && err.contains("--headless"), "{err}");
    folder.alhazen(&["view", "scene.pbrt", "--frames", "5"]).expect(2);
}

#[test]
fn scenes_with_errors_are_reported_as_by_check() {
    let folder = Folder::new("view");
    folder.write("scene.pbrt", "WorldBegin\nShape \"ball\"\n");
    let report = |arguments: &[&str]| folder.alhazen(arguments).expect(1).err;
    assert_eq!(report(&["view", "scene.pbrt", "--headless"]), report(&["scene", "check", "scene.pbrt"]));
}
