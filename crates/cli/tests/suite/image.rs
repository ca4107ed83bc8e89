//! Tests of `alhazen image`.

use crate::common::Folder;
use alhazen::image::{Image, WriteOptions, write};

/// A folder with two pictures, `a.exr` and a brighter `b.exr`.
fn with_pictures(name: &str) -> Folder {
    let folder = Folder::new(name);
    for (name, offset) in [("a.exr", 0.0), ("b.exr", 0.1)] {
        let picture =
            Image::from_fn(20, 10, ["R", "G", "B"], |x, y| [x as f32 / 20.0 + offset, y as f32 / 10.0, 0.5]);
        write(&picture, folder.path().join(name), &WriteOptions::default()).expect("a picture for the test");
    }
    folder
}

#[test]
fn differences_are_reported_and_drawn() {
    let folder = with_pictures("diff");
    for metric in ["mse", "relmse", "flip"] {
        let picture = format!("{metric}.png");
        let finished = folder
            .alhazen(&["image", "diff", "a.exr", "b.exr", "-o", &picture, "--metric", metric])
            .expect(0);
        assert!(finished.out.contains("MSE        3.33"), "{finished:?}");
        assert!(finished.out.contains("relMSE") && finished.out.contains("FLIP"), "{finished:?}");
        let error = folder.image(&picture);
        assert_eq!((error.width(), error.height()), (20, 10));
    }
    let json = folder.alhazen(&["image", "diff", "a.exr", "b.exr", "--json"]).expect(0).json();
    assert!((json["mse"].as_f64().expect("a number") - 0.01 / 3.0).abs() < 1e-6, "{json}");
    let same = folder.alhazen(&["image", "diff", "a.exr", "a.exr", "--json"]).expect(0).json();
    assert_eq!((&same["mse"], &same["flip"]), (&0.0.into(), &0.0.into()));
}

#[test]
fn pictures_that_cannot_be_compared_are_wrong_input() {
    let folder = with_pictures("sizes");
    let small = Image::from_fn(5, 5, ["R", "G", "B"], |_, _| [0.0; 3]);
    write(&small, folder.path().join("small.exr"), &WriteOptions::default()).expect("a picture for the test");
    let finished = folder.alhazen(&["image", "diff", "a.exr", "small.exr"]).expect(1);
    assert!(finished.err.contains("differ in size: 20 × 10 and 5 × 5"), "{finished:?}");
    folder.write("text.exr", "no picture");
    assert!(folder.alhazen(&["image", "diff", "a.exr", "text.exr"]).expect(1).err.contains("text.exr"));
    assert!(folder.alhazen(&["image", "diff", "a.exr", "none.exr"]).expect(1).err.contains("none.exr"));
}

#[test]
fn environment_maps_are_converted() {
    let folder = with_pictures("projection");
    let convert = ["image", "convert", "a.exr", "square.exr", "--projection", "equal-area"];
    let json = folder.alhazen(&[&convert[..], &["--json"]].concat()).expect(0).json();
    assert_eq!((&json["width"], &json["height"]), (&20.into(), &20.into()));
    // The middle of the square is up, the top row of the original.
    let up = folder.image("square.exr").rgb(10, 10);
    assert!(up[1] < 0.1, "{up:?}");
    let back = ["image", "convert", "square.exr", "back.exr", "--projection", "latitude-longitude"];
    folder.alhazen(&back).expect(0);
    let back = folder.image("back.exr");
    assert_eq!((back.width(), back.height()), (20, 10));
    let small = Image::from_fn(5, 4, ["R", "G", "B"], |_, _| [0.0; 3]);
    write(&small, folder.path().join("small.exr"), &WriteOptions::default()).expect("a picture for the test");
    let refused = ["image", "convert", "small.exr", "none.exr", "--projection", "equal-area"];
    let finished = folder.alhazen(&refused).expect(1);
    assert!(finished.err.contains("5 × 4") && finished.err.contains("2:1"), "{finished:?}");
}

#[test]
fn pictures_are_converted() {
    let folder = with_pictures("convert");
    for name in ["a.png", "a.pfm", "a.tif"] {
        folder.alhazen(&["image", "convert", "a.exr", name]).expect(0);
        let (from, to) = (folder.image("a.exr").rgb(7, 3), folder.image(name).rgb(7, 3));
        assert!((0..3).all(|c| (from[c] - to[c]).abs() < 0.01), "{name}: {from:?} {to:?}");
    }
    folder.alhazen(&["image", "convert", "a.exr", "deep.png", "--depth", "u16"]).expect(0);
    folder.alhazen(&["image", "convert", "a.exr", "none/a.png"]).expect(2);
    folder.alhazen(&["image", "convert", "a.exr", "float.png", "--depth", "f32"]).expect(1);
    let json = folder.alhazen(&["image", "convert", "a.exr", "b.png", "--json"]).expect(0).json();
    assert_eq!((&json["output"], &json["width"]), (&"b.png".into(), &20.into()));
}

#[test]
fn files_are_inspected() {
    let folder = Folder::new("info");
    let mut picture =
        Image::from_fn(20, 10, ["R", "G", "B", "albedo.R"], |x, _| [x as f32 / 8.0, 0.5, 0.25, 1.0]);
    picture.metadata.data_window = Some(alhazen::image::Window { min: [100, 50], max: [120, 60] });
    picture.metadata.display_window = Some(alhazen::image::Window::of_size(640, 480));
    picture.metadata.set("integrator", alhazen::image::Attribute::Text("path".into()));
    write(&picture, folder.path().join("a.exr"), &WriteOptions::default()).expect("a picture for the test");
    let told = folder.alhazen(&["image", "info", "a.exr"]).expect(0).out;
    for part in [
        "a.exr: EXR, 20 × 10 pixels, ",
        "data window     x 100 to 119, y 50 to 59\n",
        "display window  x 0 to 639, y 0 to 479\n",
        "compression     ZIP\n",
        "channels        B G R, 32-bit float\n",
        "layer albedo    R, 32-bit float\n",
        "integrator      path\n",
    ] {
        assert!(told.contains(part), "no `{part}` in {told}");
    }
    let json = folder.alhazen(&["image", "info", "a.exr", "--json"]).expect(0).json();
    assert_eq!((&json["format"], &json["width"], &json["height"]), (&"exr".into(), &20.into(), &10.into()));
    assert_eq!(json["layers"][1]["channels"][0]["name"], "albedo.R");
    assert_eq!(json["display_window"]["max"], serde_json::json!([640, 480]));
    assert_eq!(json["attributes"]["integrator"], "path");
    assert!(folder.alhazen(&["image", "info", "none.exr"]).expect(1).err.contains("none.exr"));
}

#[test]
fn pixels_are_read_at_their_place_in_the_frame() {
    let folder = Folder::new("pixel");
    let mut picture = Image::from_fn(20, 10, ["R", "G", "B"], |x, y| [x as f32 / 8.0, y as f32, f32::NAN]);
    picture.metadata.data_window = Some(alhazen::image::Window { min: [100, 50], max: [120, 60] });
    write(&picture, folder.path().join("a.exr"), &WriteOptions::default()).expect("a picture for the test");
    let told = folder.alhazen(&["image", "info", "a.exr", "--pixel", "104,53"]).expect(0).out;
    assert_eq!(told, "R          0.5\nG          3\nB          NaN\n");
    let json = folder.alhazen(&["image", "info", "a.exr", "--pixel", "104,53", "--json"]).expect(0).json();
    assert_eq!(json["values"], serde_json::json!({ "R": 0.5, "G": 3.0, "B": null }));
    let outside = folder.alhazen(&["image", "info", "a.exr", "--pixel", "4,3"]).expect(1);
    assert!(outside.err.contains("no pixel 4,3; it has x 100 to 119, y 50 to 59"), "{outside:?}");
    folder.alhazen(&["image", "convert", "a.exr", "a.png"]).expect(0);
    let codes = folder.alhazen(&["image", "info", "a.png", "--pixel", "8,0", "--json"]).expect(0).json();
    assert_eq!((&codes["codes"]["R"], &codes["values"]["R"]), (&255.into(), &1.0.into()));
}

#[test]
fn a_view_acts_on_files_for_displays_and_is_named_in_them() {
    let folder = Folder::with_scene("view");
    folder.alhazen(&["render", "scene.pbrt", "--quiet", "-o", "a.exr"]).expect(0);
    let convert = |output: &str, options: &[&str]| {
        folder.alhazen(&[&["image", "convert", "a.exr", output][..], options].concat())
    };
    let mut shown = Vec::new();
    for view in ["standard", "agx", "aces", "khronos-neutral", "filmic"] {
        let name = format!("{view}.png");
        convert(&name, &["--view", view, "--exposure", "-1", "--white-balance", "5000"]).expect(0);
        let bytes = std::fs::read(folder.path().join(&name)).unwrap();
        let text = format!("tEXtView\0{view}");
        assert!(bytes.windows(text.len()).any(|window| window == text.as_bytes()), "{view}");
        shown.push(folder.image(&name).rgb(12, 12));
    }
    assert!((1..5).all(|i| (0..i).all(|j| shown[i] != shown[j])), "{shown:?}");
    // The same by the render itself.
    let options = ["--view", "aces", "--exposure", "-1", "--white-balance", "5000"];
    folder.alhazen(&[&["render", "scene.pbrt", "--quiet", "-o", "b.png"][..], &options].concat()).expect(0);
    let close = |c: usize| (folder.image("b.png").rgb(12, 12)[c] - shown[2][c]).abs() < 0.01;
    assert!((0..3).all(close));
    let refused = convert("b.exr", &["--view", "agx"]).expect(2).err;
    assert!(refused.contains("other files stay linear"), "{refused}");
    let unknown = convert("c.png", &["--view", "srgb"]).expect(2).err;
    assert!(unknown.contains("standard, agx, aces, khronos-neutral, filmic"), "{unknown}");
}
