//! Tests of `alhazen render`.

use std::time::{Duration, Instant};

use crate::common::{Folder, SCENE};
use alhazen::image::{Attribute, Image, Pixels};

#[test]
fn pictures_are_written_in_every_format_asked_for() {
    let folder = Folder::with_scene("formats");
    let names = ["a.exr", "a.png", "a.pfm", "a.jpg", "a.hdr", "a.bmp", "a.tga", "a.qoi", "a.webp", "a.tif"];
    let mut arguments = vec!["render", "scene.pbrt"];
    names.iter().for_each(|name| arguments.extend(["-o", name]));
    let finished = folder.alhazen(&arguments).expect(0);
    let exr = folder.image("a.exr");
    assert!(exr.values().all(f32::is_finite) && exr.values().any(|value| value > 0.1));
    for name in names {
        let image = folder.image(name);
        assert_eq!((image.width(), image.height()), (24, 16), "{name}");
        assert!(finished.out.contains(&format!("picture  {name}")), "{finished:?}");
        // Of all pixels, as JPEG blurs the colours of neighbours.
        let mean = |image: &Image| {
            let pixels = (0..image.height()).flat_map(|y| (0..image.width()).map(move |x| (x, y)));
            let sum = pixels.fold([0.0; 3], |sum, (x, y)| {
                let rgb = image.rgb(x, y).map(|v| v.min(1.0));
                [sum[0] + rgb[0], sum[1] + rgb[1], sum[2] + rgb[2]]
            });
            sum.map(|sum| sum / (image.width() * image.height()) as f32)
        };
        let (found, expected) = (mean(&image), mean(&exr));
        let difference = (0..3).map(|c| (found[c] - expected[c]).abs()).fold(0.0, f32::max);
        assert!(difference < 0.01, "{name}: {found:?} is not {expected:?}");
    }
}

/// A named ball in front of a wall that fills the picture.
pub const LAYERED: &str = r#"
LookAt 0 0 -5  0 0 0  0 1 0
Camera "perspective" "float fov" 40
Film "rgb" "integer xresolution" 24 "integer yresolution" 16
Sampler "independent" "integer pixelsamples" 4
WorldBegin
LightSource "infinite" "rgb L" [ 1 1 1 ]
MakeNamedMaterial "chalk" "string type" "diffuse" "rgb reflectance" [ 0.5 0.5 0.5 ]
Shape "bilinearmesh" "point3 P" [ -9 -9 2  9 -9 2  -9 9 2  9 9 2 ]
ObjectBegin "ball"
NamedMaterial "chalk"
Shape "sphere" "float radius" 1
ObjectEnd
ObjectInstance "ball"
"#;

#[test]
fn layers_are_written_beside_the_colors() {
    let folder = Folder::new("layers");
    folder.write("scene.pbrt", LAYERED);
    let layers = ["--aov", "depth,normal,camera-normal,object-id", "--aov", "material-id,samples"];
    folder.alhazen(&[&["render", "scene.pbrt", "-o", "a.exr"], &layers[..]].concat()).expect(0);
    let image = folder.image("a.exr");
    let at = |[x, y]: [u32; 2], channel: &str| {
        let index = image.channel_index(channel);
        image.channel(x, y, index.unwrap_or_else(|| panic!("{channel} of {:?}", image.channels())))
    };
    let (ball, wall) = ([12, 8], [1, 1]);
    assert!((4.0..4.1).contains(&at(ball, "Z")), "{}", at(ball, "Z"));
    assert!((at(wall, "Z") - 7.0).abs() < 1e-5, "{}", at(wall, "Z"));
    for axis in ["N.Z", "Ncam.Z"] {
        assert!((at(wall, axis) + 1.0).abs() < 1e-6 && at(ball, axis) < -0.9);
    }
    assert_eq!(at(ball, "samples"), 4.0);
    let id = |pixel, layer: &str| at(pixel, &format!("{layer}00.r")).to_bits();
    let manifest = |layer: &str| {
        let is_manifest = |name: &str| name.starts_with("cryptomatte/") && name.ends_with("/manifest");
        let name = |key: &str| image.metadata.get(&key.replace("manifest", "name")).cloned();
        let found = image
            .metadata
            .attributes
            .iter()
            .find(|(key, _)| is_manifest(key) && name(key) == Some(Attribute::Text(layer.to_owned())));
        let Some((_, Attribute::Text(json))) = found else { panic!("no manifest of {layer}") };
        serde_json::from_str::<serde_json::Value>(json).expect("JSON")
    };
    let named = |pixel, layer| format!("{:08x}", id(pixel, layer));
    let objects = manifest("CryptoObject");
    assert_eq!(objects["ball/0"], named(ball, "CryptoObject"));
    assert_eq!(objects["shape-0"], named(wall, "CryptoObject"));
    let materials = manifest("CryptoMaterial");
    assert_eq!(materials["chalk"], named(ball, "CryptoMaterial"));
    assert_eq!(materials["default"], named(wall, "CryptoMaterial"));
}

#[test]
fn an_unknown_layer_is_refused_with_a_suggestion() {
    let folder = Folder::with_scene("unknown-layer");
    let refused = folder.alhazen(&["render", "scene.pbrt", "--aov", "dept", "-o", "a.exr"]).expect(2);
    assert!(refused.err.contains("no layer is called `dept`; did you mean `depth`?"), "{refused:?}");
}

#[test]
fn a_sketch_is_there_before_the_first_pass_is_done() {
    let folder = Folder::with_scene("sketch");
    // A single pass that takes minutes.
    let deep = ["--resolution", "4000x3000", "--set", "maxdepth=100", "--spp", "1", "-o", "a.pfm"];
    let arguments = ["render", "scene.pbrt", "--integrator", "bdpt", "--threads", "1"];
    let mut child = folder.command(&[&arguments[..], &deep].concat()).spawn().expect("the program runs");
    let deadline = Instant::now() + Duration::from_secs(60);
    while !folder.path().join("a.pfm").exists() && Instant::now() < deadline {
        std::thread::sleep(Duration::from_millis(20));
    }
    let is_at_it = child.try_wait().expect("the program is known").is_none();
    child.kill().expect("the program runs");
    child.wait().expect("the program ends");
    assert!(is_at_it, "the picture was done before");
    let sketch = folder.image("a.pfm");
    assert_eq!((sketch.width(), sketch.height()), (4000, 3000));
    // Larger pixels, 14 × 14 of the picture's.
    assert!((0..13).all(|i| sketch.rgb(2016 + i, 1512 + i) == sketch.rgb(2016, 1512)));
    assert!(sketch.rgb(2016, 1512) != sketch.rgb(2030, 1512));
}

#[test]
fn the_same_render_writes_the_same_bytes() {
    let folder = Folder::with_scene("bytes");
    let bytes = |name: &str| {
        folder.alhazen(&["render", "scene.pbrt", "--quiet", "-o", name]).expect(0);
        std::fs::read(folder.path().join(name)).expect("a picture")
    };
    let first = bytes("a.exr");
    assert!(["b.exr", "c.exr", "d.exr"].into_iter().all(|name| bytes(name) == first));
}

#[test]
fn pictures_of_strategies_end_at_eight_bounces() {
    let folder = Folder::with_scene("strategies");
    let arguments = ["render", "scene.pbrt", "--integrator", "bdpt", "--set", "techniques=true"];
    let deep = ["--set", "maxdepth=9", "--resolution", "4x4", "-o", "a.pfm"];
    let finished = folder.alhazen(&[&arguments[..], &deep].concat()).expect(0);
    assert!(
        finished.err.contains("no pictures of strategies for paths with more than 8 scattering events"),
        "{finished:?}"
    );
    assert_eq!(folder.files().len(), 2 + 2 * 53, "the scene, the picture and those of the strategies");
}

#[test]
fn an_algorithm_keeps_the_settings_of_the_scene() {
    let folder = Folder::new("kept");
    let sppm = "Integrator \"sppm\" \"integer photonsperiteration\" 50 \"float radius\" 0.7";
    folder.write("scene.pbrt", &SCENE.replace("Integrator \"path\"", sppm));
    let said = |integrator: &str| {
        folder.alhazen(&["render", "scene.pbrt", "--integrator", integrator]).expect(0).out
    };
    let sppm = said("sppm");
    assert!(sppm.contains("from 50 paths in a pass") && sppm.contains("0.7 in pass 1"), "{sppm}");
    assert!(said("vcm").contains("0.7 in pass 1"));
    assert!(said("photon-mapping").contains("0.700 at most"));
}

#[test]
fn the_summary_describes_the_render() {
    let folder = Folder::with_scene("summary");
    let said = folder.alhazen(&["render", "scene.pbrt", "--crop", "0,0.5,0,1"]).expect(0).out;
    for part in [
        "scene.pbrt: path, 2 samples per pixel, 24 × 16 pixels, of them x 0 to 11, y 0 to 15",
        "picture  scene.exr",
        "samples  384",
        "primitive tests per ray",
    ] {
        assert!(said.contains(part), "no `{part}` in {said}");
    }
    if cfg!(target_os = "linux") {
        assert!(said.contains("memory "), "{said}");
    }
    // This sampler arranges powers of two.
    let said =
        folder.alhazen(&["render", "scene.pbrt", "--spp", "3", "--set", "sampler=zsobol"]).expect(0).out;
    assert!(said.contains("3 samples per pixel"), "{said}");
}

#[test]
fn the_default_name_is_the_films_or_the_scenes() {
    let folder = Folder::with_scene("names");
    folder.alhazen(&["render", "scene.pbrt", "--quiet"]).expect(0);
    folder.write(
        "other.pbrt",
        &SCENE.replace("Film \"rgb\"", "Film \"rgb\" \"string filename\" \"named.png\""),
    );
    folder.alhazen(&["render", "other.pbrt", "--quiet"]).expect(0);
    folder.alhazen_reading(&["render", "-", "--quiet"], SCENE).expect(0);
    assert_eq!(folder.files(), ["named.png", "other.pbrt", "picture.exr", "scene.exr", "scene.pbrt"]);
}

#[test]
fn quiet_prints_nothing() {
    let folder = Folder::with_scene("quiet");
    let finished = folder.alhazen(&["render", "scene.pbrt", "--quiet"]).expect(0);
    assert_eq!((finished.out.as_str(), finished.err.as_str()), ("", ""));
}

#[test]
fn json_is_one_object_with_everything_in_it() {
    let folder = Folder::with_scene("json");
    let finished =
        folder.alhazen(&["render", "scene.pbrt", "--json", "--threads", "2", "-o", "a.exr"]).expect(0);
    let json = finished.json();
    assert_eq!(json["status"], "done");
    assert_eq!(json["outputs"], serde_json::json!(["a.exr"]));
    assert_eq!(json["integrator"], "path");
    assert_eq!(json["samples"], 24 * 16 * 2);
    assert_eq!(json["passes"], 2);
    assert_eq!(json["threads"], 2);
    assert_eq!(json["non_finite_samples"], 0);
    assert!(json["rays"].as_u64() >= Some(24 * 16 * 2), "{json}");
    assert!(json["extent_tests"].is_u64() && json["primitive_tests"].is_u64());
    assert!(json["seconds"]["total"].as_f64() > Some(0.0));
    assert_eq!(finished.err, "");
}

#[test]
fn options_change_the_picture() {
    let folder = Folder::with_scene("options");
    let run = |arguments: &[&str]| {
        folder
            .alhazen(&[&["render", "scene.pbrt", "-o", "a.exr", "--json"], arguments].concat())
            .expect(0)
            .json()
    };
    let json = run(&["--resolution", "40x20", "--spp", "3", "--integrator", "ray-casting", "--seed", "5"]);
    assert_eq!((&json["samples"], &json["integrator"]), (&(40 * 20 * 3).into(), &"ray-casting".into()));
    let image = folder.image("a.exr");
    assert_eq!((image.width(), image.height()), (40, 20));
    assert_eq!(image.metadata.get("integrator"), Some(&Attribute::Text("ray-casting".into())));
    assert_eq!(image.metadata.get("seed"), Some(&Attribute::Integer(5)));
    assert!(image.metadata.chromaticities.is_some() && image.metadata.get("worldToCamera").is_some());

    run(&["--crop", "0.5,1,0.25,0.5", "--set", "savefp16=false"]);
    let image = folder.image("a.exr");
    assert_eq!((image.data_window().min, image.data_window().max), ([12, 4], [24, 8]));
    assert_eq!(image.display_window().max, [24, 16]);
    assert!(matches!(image.pixels(), Pixels::F32(_)));

    run(&["--pixel", "7,3"]);
    let image = folder.image("a.exr");
    assert_eq!((image.data_window().min, image.width(), image.height()), ([7, 3], 1, 1));
}

#[test]
fn threads_never_change_a_bit_and_seeds_do() {
    let folder = Folder::with_scene("threads");
    let bits = |arguments: &[&str]| {
        let arguments =
            [&["render", "scene.pbrt", "-o", "a.pfm", "--quiet", "--resolution", "50x40"], arguments]
                .concat();
        folder.alhazen(&arguments).expect(0);
        folder.image("a.pfm").values().map(f32::to_bits).collect::<Vec<_>>()
    };
    let one = bits(&["--threads", "1"]);
    assert!(bits(&["--threads", "3"]) == one, "threads changed the picture");
    let pixel = bits(&["--threads", "3", "--pixel", "20,25"]);
    assert_eq!(pixel, one[(20 + 25 * 50) * 3..][..3], "a pixel alone is the pixel of the whole");
    assert!(bits(&["--threads", "1", "--seed", "1"]) != one, "the seed changed nothing");
}

/// The instruction set is a matter of speed alone.
#[test]
fn every_instruction_set_gives_the_same_file() {
    let folder = Folder::with_scene("instruction-set");
    let render = |set: &str, output: &str| {
        let mut command = folder.command(&["render", "scene.pbrt", "-o", output, "--quiet"]);
        command.env("ALHAZEN_INSTRUCTION_SET", set).output().expect("the program runs")
    };
    for (set, output) in [("portable", "a.pfm"), ("Scalar", "b.pfm")] {
        assert!(render(set, output).status.success());
    }
    folder.alhazen(&["render", "scene.pbrt", "-o", "c.pfm"]).expect(0);
    let file = |name: &str| std::fs::read(folder.path().join(name)).expect("a picture");
    assert!(file("a.pfm") == file("b.pfm") && file("b.pfm") == file("c.pfm"));
    let unknown = render("avx3", "d.pfm");
    assert_eq!(unknown.status.code(), Some(2));
    let message = String::from_utf8_lossy(&unknown.stderr).into_owned();
    assert!(message.contains("ALHAZEN_INSTRUCTION_SET: there is no instruction set \"avx3\""), "{message}");
}
