//! Lights in objects and in motion, from the text of a scene to the mean of its picture: the same
//! as the scene written out, and the mean of pictures at fixed times.

use crate::common::{means, render_text};
use alhazen::Overrides;
use testkit::{Moments, welch_test};

const INTEGRATORS: [&str; 3] = ["path", "bdpt", "light-tracing"];

/// Pictures of each scene, with a seed each.
const RUNS: i32 = 6;

/// A floor and a ball; the shutter is open for `duration` around a time. The shorter it is, the
/// more sensitive is the film.
fn scene(time: f32, duration: f32, world: &str) -> String {
    let (open, close, iso) = (time - 0.5 * duration, time + 0.5 * duration, 100.0 / duration);
    format!(
        "LookAt 0 -4 3  0 0 0.3  0 0 1 Camera \"perspective\" \"float fov\" 40\n\
         \"float shutteropen\" {open} \"float shutterclose\" {close}\n\
         Film \"rgb\" \"integer xresolution\" 16 \"integer yresolution\" 16 \"bool savefp16\" false \"float iso\" {iso}\n\
         PixelFilter \"box\" Sampler \"independent\" \"integer pixelsamples\" 16\n\
         Option \"disablewavelengthjitter\" true\nWorldBegin\n\
         Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
         Shape \"bilinearmesh\" \"point3 P\" [-2 -2 0  2 -2 0  -2 2 0  2 2 0]\n\
         AttributeBegin Translate 0.6 0.2 0.2 Shape \"sphere\" \"float radius\" 0.2 AttributeEnd\n{world}"
    )
}

/// The mean of pictures of these scenes, in their first channel.
fn mean(scenes: &[String], integrator: &str, first_seed: i32) -> Moments {
    let picture = |text: &String, seed| {
        let overrides = Overrides {
            integrator: Some(integrator.into()),
            settings: vec![("maxdepth".into(), "3".into())],
            seed: Some(seed),
            ..Overrides::default()
        };
        means(&render_text(text, &overrides))[0]
    };
    let of_seed = |seed| scenes.iter().map(|text| picture(text, seed)).sum::<f64>() / scenes.len() as f64;
    (first_seed..first_seed + RUNS).map(of_seed).collect()
}

fn assert_same(found: &[String], expected: &[String], what: &str) {
    for integrator in INTEGRATORS {
        let (found, expected) = (mean(found, integrator, 0), mean(expected, integrator, 100));
        assert!(expected.mean > 0.0);
        welch_test(&found, &expected, 9).unwrap_or_else(|e| panic!("{what}, {integrator}: {e}"));
    }
}

#[test]
fn instanced_area_lights_equal_separate_ones() {
    let lamps = "AreaLightSource \"diffuse\" \"rgb L\" [8 8 8]\n\
        Shape \"trianglemesh\" \"point3 P\" [-0.3 -0.3 0  -0.3 0.3 0  0.3 0.3 0  0.3 -0.3 0]\n\
        \"integer indices\" [0 1 2 0 2 3]\n\
        AttributeBegin Translate 0 0.8 0 Shape \"sphere\" \"float radius\" 0.1 AttributeEnd\n";
    // One is stretched; one lies in an object of its own.
    let (first, second) = ("Translate -0.8 0 1.2 Scale 1 0.7 1.4", "Translate 0.5 -0.3 1.5 Rotate 30 0 1 0");
    let written_out =
        format!("AttributeBegin {first}\n{lamps}AttributeEnd\nAttributeBegin {second}\n{lamps}AttributeEnd");
    let instanced = format!(
        "ObjectBegin \"lamps\"\n{lamps}ObjectEnd\n\
         ObjectBegin \"outer\" Rotate 30 0 1 0 ObjectInstance \"lamps\" ObjectEnd\n\
         AttributeBegin {first} ObjectInstance \"lamps\" AttributeEnd\n\
         AttributeBegin Translate 0.5 -0.3 1.5 ObjectInstance \"outer\" AttributeEnd"
    );
    assert_same(&[scene(0.5, 1.0, &instanced)], &[scene(0.5, 1.0, &written_out)], "instances");
}

/// Pictures with an open shutter against those taken shortly at the middles of eight parts of its
/// time.
fn assert_moves(world: &str, what: &str) {
    let fixed: Vec<String> = (0..8).map(|i| scene((i as f32 + 0.5) / 8.0, 1.0 / 64.0, world)).collect();
    assert_same(&[scene(0.5, 1.0, world)], &fixed, what);
}

#[test]
fn area_lights_move() {
    assert_moves(
        "ObjectBegin \"lamp\" AreaLightSource \"diffuse\" \"rgb L\" [8 8 8]\n\
         Shape \"disk\" \"float radius\" 0.3 ObjectEnd\n\
         AttributeBegin Translate 0 0 1.2 Rotate 150 1 0 0\n\
         ActiveTransform EndTime Translate 0.6 0.3 0 Rotate 60 0 1 0 ActiveTransform All\n\
         ObjectInstance \"lamp\" AttributeEnd\n\
         AttributeBegin AreaLightSource \"diffuse\" \"rgb L\" [8 8 8] Translate -0.6 0 0.8\n\
         ActiveTransform EndTime Translate 0 0.8 0.3 ActiveTransform All\n\
         Shape \"sphere\" \"float radius\" 0.15 AttributeEnd",
        "moving shapes",
    );
}

#[test]
fn delta_lights_move() {
    assert_moves(
        "AttributeBegin Translate -0.5 0 1\n\
         ActiveTransform EndTime Translate 1 0 0.3 ActiveTransform All\n\
         LightSource \"point\" \"rgb I\" [1 1 1] AttributeEnd\n\
         AttributeBegin ActiveTransform EndTime Rotate 20 0 1 0 ActiveTransform All\n\
         LightSource \"spot\" \"rgb I\" [3 3 3] \"point3 from\" [0 0 2] \"point3 to\" [0 0.2 0]\n\
         LightSource \"distant\" \"rgb L\" [0.3 0.3 0.3] \"point3 from\" [1 0 2] AttributeEnd",
        "moving delta lights",
    );
}

#[test]
fn environments_move() {
    let sky = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/assets/sky.exr");
    let turned = |turn: &str| format!("{turn} LightSource \"infinite\" \"string filename\" \"{sky}\"");
    let moving = turned("ActiveTransform EndTime Rotate 120 1 0.3 0 ActiveTransform All");
    let at_rest =
        |i: i32| scene(0.5, 1.0, &turned(&format!("Rotate {} 1 0.3 0", (i as f32 + 0.5) / 8.0 * 120.0)));
    let at_rest: Vec<String> = (0..8).map(at_rest).collect();
    assert_same(&[scene(0.5, 1.0, &moving)], &at_rest, "moving environments");
}
