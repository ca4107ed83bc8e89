//! Test scenes of Mitsuba and Ignis, converted, against their reference pictures or means by
//! Mitsuba.
//!
//! The references are RGB, our pictures spectral: for light reflected once both agree.

use std::path::Path;

use crate::common::{Estimate, data, render_text, shape, shrunk};
use alhazen::Overrides;
use alhazen::image::{self, Image};

fn reference(path: &Path) -> Image {
    image::open(path).expect("the reference is readable")
}

/// The head of all scenes: a camera with Mitsuba's handedness, and a box filter.
fn head(look_at: &str, fov: f32, side: u32, max_depth: u32, samples: u32) -> String {
    format!(
        "Scale -1 1 1 LookAt {look_at}\nCamera \"perspective\" \"float fov\" {fov}\n\
         Film \"rgb\" \"integer xresolution\" {side} \"integer yresolution\" {side}\n\
         PixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\n\
         Sampler \"independent\" \"integer pixelsamples\" {samples}\n\
         Integrator \"path\" \"integer maxdepth\" {max_depth}\nWorldBegin\n"
    )
}

fn diffuse(reflectance: &str) -> String {
    format!("Material \"diffuse\" \"rgb reflectance\" [{reflectance}]\n")
}

fn estimate(text: &str, runs: i32) -> Estimate {
    Estimate::new(runs, |overrides: Overrides| render_text(text, &overrides))
}

/// Two planes, lit by a point or by each other.
#[test]
fn lit_planes() {
    let Some(folder) = data("ignis") else { return };
    let look_at = "0 0 -2  0 0 0  0 1 0";
    let bottom = diffuse("0.885809 0.698859 0.666422") + &shape(&folder.join("meshes/Bottom.ply"));
    let point = "LightSource \"point\" \"rgb I\" [1 1 1] \"point3 from\" [0 1 0]\n";
    let top =
        "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\nAreaLightSource \"diffuse\" \"rgb L\" [1 1 1]\n"
            .to_owned()
            + &shape(&folder.join("meshes/Top.ply"));
    for (name, light) in [("point", point), ("emissive-plane", &top)] {
        let text = head(look_at, 90.0, 64, 3, 16) + &bottom + light;
        let expected = reference(&folder.join(format!("references/ref-{name}-4096.exr")));
        estimate(&text, 4).assert_parts(&shrunk(&expected, 4), 8, 2e-3, 2, name);
    }
}

/// A plane under a white sky, with and without what it reflects.
#[test]
fn plane_under_the_sky() {
    let Some(folder) = data("ignis") else { return };
    let look_at = "278 273 -800  278 273 -799  0 1 0";
    for (name, max_depth) in [("plane-d1", 0), ("plane-d6", 5)] {
        let text = head(look_at, 39.3077, 64, max_depth, 16)
            + "LightSource \"infinite\" \"rgb L\" [1 1 1]\n"
            + &diffuse("0.885809 0.698859 0.666422")
            + &shape(&folder.join("meshes/cbox_floor.obj"));
        let expected = reference(&folder.join(format!("references/ref-{name}-4096.exr")));
        estimate(&text, 4).assert_parts(&shrunk(&expected, 4), 8, 2e-3, 2, name);
    }
}

/// A ball that casts its shadow from straight above.
#[test]
fn floating_sphere() {
    let Some(folder) = data("mitsuba-tests/tests/scenes/floating_sphere/refs") else { return };
    // What a lens of 50 mm sees of a frame of 24 × 36 mm, cut to a square of the same diagonal.
    let text = head("0 -5 1  0 0 0.5  0 0 1", 34.0227, 48, 1, 16)
        + "LightSource \"distant\" \"rgb L\" [1 1 1] \"point3 from\" [0 0 1] \"point3 to\" [0 0 0]\n"
        + &diffuse("1 1 1")
        + "Shape \"trianglemesh\" \"point3 P\" [-1 -1 0  1 -1 0  1 1 0  -1 1 0] \"integer indices\" [0 1 2 0 2 3]\n\
           Translate 0 0 1 Shape \"sphere\" \"float radius\" 0.1\n";
    let expected = reference(&folder.join("test_directional_ref_rgb.exr"));
    estimate(&text, 4).assert_parts(&expected, 8, 1e-2, 1, "floating sphere");
}

/// A group of two balls and a rectangle, three times, turned and scaled.
#[test]
fn instances_of_a_group() {
    let Some(folder) = data("mitsuba-tests/tests/scenes/instancing/refs") else { return };
    let text = head("-5 -6 0  0 0 0  0 0 1", 34.0227, 64, 1, 16)
        + "LightSource \"point\" \"rgb I\" [300 300 300] \"point3 from\" [-5 -6 0]\nObjectBegin \"group\"\n"
        + &diffuse("0.2 0.5 0.3")
        + "Shape \"sphere\" \"float radius\" 1\n"
        + &diffuse("0.9 0.5 0.3")
        + "AttributeBegin Translate -1 0 0 Shape \"sphere\" \"float radius\" 0.5 AttributeEnd\n"
        + &diffuse("0.9 0.5 0.9")
        + "AttributeBegin Rotate -80 0 1 0 Scale 1.2 1.2 1.2\n\
           Shape \"bilinearmesh\" \"point3 P\" [-1 -1 0  1 -1 0  -1 1 0  1 1 0] AttributeEnd\n\
           ObjectEnd\nObjectInstance \"group\"\n\
           AttributeBegin Translate 0 0 2 Scale 1.5 1.5 1.5 Rotate 45 0 1 0 ObjectInstance \"group\" AttributeEnd\n\
           AttributeBegin Translate 0 0 -2 Scale 1.5 1.5 1.5 Rotate -25 1 0 0 Rotate -45 0 1 0\n\
           ObjectInstance \"group\" AttributeEnd\n";
    let expected = reference(&folder.join("test_instancing_ref_rgb.exr"));
    estimate(&text, 4).assert_parts(&expected, 8, 1e-2, 1, "instances");
}

/// The Cornell box in its measured colours; the means were found by Mitsuba with colours as
/// spectra.
#[test]
fn cornell_box() {
    let Some(folder) = data("mitsuba-tests/scenes/cbox/meshes") else { return };
    let mut text = head("278 273 -800  278 273 -799  0 1 0", 39.3077, 64, 5, 16);
    for (name, reflectance) in [
        ("floor", "0.885809 0.698859 0.666422"),
        ("ceiling", "0.885809 0.698859 0.666422"),
        ("back", "0.885809 0.698859 0.666422"),
        ("greenwall", "0.105421 0.37798 0.076425"),
        ("redwall", "0.570068 0.0430135 0.0443706"),
        ("smallbox", "0.45 0.3 0.9"),
        ("largebox", "0.45 0.3 0.9"),
    ] {
        text += &(diffuse(reflectance) + &shape(&folder.join(format!("cbox_{name}.obj"))));
    }
    text += &(diffuse("0.936461 0.740433 0.705267")
        + "AreaLightSource \"diffuse\" \"rgb L\" [18.387 10.9873 2.75357] Translate 0 -0.5 0\n"
        + &shape(&folder.join("cbox_luminaire.obj")));
    estimate(&text, 4).assert_mean([0.20809, 0.10230, 0.02506], 2e-3, 1, "cornell box");
}
