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

#[test]
fn a_walk_over_a_planet_is_reported() {
    let folder = Folder::new("view");
    let settings = ["--set", "film.xresolution=32", "--set", "film.yresolution=24"];
    let arguments = ["view", "--planet", "500", "--headless", "--frames", "4"];
    let arguments = [&arguments[..], &settings].concat();
    let text = folder.alhazen(&arguments).expect(0).out;
    assert!(text.starts_with("whitted, 4 frames of 32 × 24, 1 samples per pixel"), "{text}");
    let json = folder.alhazen(&[&arguments[..], &["--json"]].concat()).expect(0).json();
    assert_eq!((json["status"].as_str(), json["spheres"].as_u64()), (Some("done"), Some(500)));
    assert!(json["moving"]["max"].as_u64().unwrap() > 20 && json["fps"].as_f64().unwrap() > 0.0);
    folder.alhazen(&["view", "--headless"]).expect(2);
    folder.alhazen(&["view", "scene.pbrt", "--planet", "500", "--headless"]).expect(2);
    folder.alhazen(&["view", "--planet", "5", "--headless"]).expect(2);
}

#[test]
fn a_planet_is_rendered_by_a_gpu_or_the_cpu_says_why_not() {
    if cfg!(not(feature = "gpu")) {
        return;
    }
    let folder = Folder::new("view");
    let settings = ["--set", "film.xresolution=16", "--set", "film.yresolution=12"];
    let arguments = ["view", "--planet", "100", "--headless", "--frames", "2", "--json", "--device", "gpu"];
    let arguments = [&arguments[..], &settings].concat();
    let json = folder.alhazen(&arguments).expect(0).json();
    let reasons = json["not_on_gpu"].as_array().unwrap();
    assert_eq!(json["device"] == "CPU", !reasons.is_empty(), "{json}");
    assert_eq!(json["frames"], 2);
    // The loader of Vulkan finds no driver.
    let mut command = folder.command(&arguments);
    command.env("VK_DRIVER_FILES", "none").env("VK_ICD_FILENAMES", "none");
    let Finished { code, out, .. } = command.output().unwrap().into();
    assert_eq!(code, Some(0), "{out}");
    if cfg!(target_os = "linux") {
        let json: serde_json::Value = serde_json::from_str(&out).unwrap();
        assert_eq!(json["device"], "CPU", "{json}");
        assert!(json["not_on_gpu"][0].as_str().unwrap().contains("no GPU"), "{json}");
    }
}

#[test]
fn the_last_frame_is_written() {
    let folder = Folder::with_scene("last-frame");
    folder.alhazen(&["view", "scene.pbrt", "-o", "frame.png"]).expect(2);
    let arguments = ["view", "scene.pbrt", "--headless", "--frames", "2", "-o", "frame.png", "--json"];
    assert_eq!(folder.alhazen(&arguments).expect(0).json()["frames"].as_u64(), Some(2));
    assert_eq!(folder.files(), ["frame.png", "scene.pbrt"]);
    let smooth = ["view", "scene.pbrt", "--headless", "--frames", "1", "--moving-spp", "4", "--json"];
    let json = folder.alhazen(&smooth).expect(0).json();
    assert_eq!(json["samples_per_pixel"].as_u64(), Some(4));
    folder.alhazen(&["view", "scene.pbrt", "--headless", "--moving-spp", "0"]).expect(2);
    let missing = ["view", "scene.pbrt", "--headless", "--frames", "1", "-o", "missing/frame.png"];
    folder.alhazen(&missing).expect(1);
}

#[test]
fn a_split_view_reports_both_sides() {
    let folder = Folder::with_scene("view");
    let arguments =
        ["view", "scene.pbrt", "--headless", "--frames", "2", "--split", "-o", "both.png", "--json"];
    let finished = folder.alhazen(&arguments);
    if cfg!(not(feature = "gpu")) {
        finished.expect(2);
    } else if finished.code == Some(0) {
        let json = finished.json();
        assert_eq!((json["status"].as_str(), json["frames"].as_u64()), (Some("done"), Some(2)));
        assert!(json["rasterized"]["frame_ms"]["median"].as_f64().unwrap() > 0.0);
        assert_eq!(folder.files(), ["both.png", "scene.pbrt"]);
    } else {
        assert!(finished.out.contains("no GPU"), "{}", finished.out);
    }
    for share in ["2", "-0.1", "nan", "x"] {
        let split = format!("--split={share}");
        let wrong = folder.alhazen(&["view", "scene.pbrt", "--headless", "--frames", "1", &split]).expect(2);
        assert!(wrong.err.contains("expected a number from 0 to 1"), "{wrong:?}");
    }
}
