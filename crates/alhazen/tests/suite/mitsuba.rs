//! Test scenes of Mitsuba and Ignis, converted, against their reference pictures or means by
//! Mitsuba.
//!
//! References are RGB where light is reflected once, for which spectral pictures agree with them,
//! and spectral elsewhere.

use std::path::Path;

use crate::common::{Estimate, data, render_text, shape, shrunk};
use alhazen::Overrides;
use alhazen::image::{self, Image};
use alhazen::spectrum::{RgbAlbedoSpectrum, RgbColorSpace};

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

/// A picture of the sky around, with +y up.
fn museum(folder: &Path) -> String {
    let file = folder.join("common/textures/museum.exr");
    format!(
        "AttributeBegin Transform [0 0 -1 0  1 0 0 0  0 1 0 0  0 0 0 1]\n\
         LightSource \"infinite\" \"string filename\" \"{}\" AttributeEnd\n",
        file.display()
    )
}

/// A spectrum in the syntax of the format, by two colours between 0 and 1.
fn spectrum([a, b]: [[f32; 3]; 2], value: impl Fn(f32, f32) -> f32) -> String {
    let [a, b] = [a, b].map(|colour| RgbAlbedoSpectrum::new(RgbColorSpace::srgb(), colour));
    let at = |lambda: f32| value(a.at(lambda), b.at(lambda));
    (360..=830).step_by(5).map(|lambda| format!("{lambda} {} ", at(lambda as f32))).collect()
}

/// The parameters of a medium with an extinction and an albedo.
fn medium(extinction: [f32; 3], albedo: [f32; 3], scale: f32) -> String {
    let colours = [extinction, albedo];
    let scattering = spectrum(colours, |sigma_t, albedo| scale * sigma_t * albedo);
    let absorption = spectrum(colours, |sigma_t, albedo| scale * sigma_t * (1.0 - albedo));
    format!("\"spectrum sigma_s\" [{scattering}] \"spectrum sigma_a\" [{absorption}]\n")
}

/// Media before a corner of checks under a picture of the sky. Mitsuba interpolates that picture's
/// spectra instead of its colours, which makes red brighter and blue darker by half a percent.
fn compare_in_media(folder: &Path, name: &str, text: &str) {
    let scene = folder.join("tests/scenes/participating_media");
    let text = head("0 0.5 4  0 -0.5 0  0 1 0", 34.0227, 48, 5, 64).replace("\"path\"", "\"volpath\"")
        + &museum(folder)
        + "Texture \"checks\" \"spectrum\" \"checkerboard\" \"float uscale\" 32 \"float vscale\" 32\n\
           \"rgb tex1\" [0.4 0.4 0.4] \"rgb tex2\" [0.2 0.2 0.2]\n\
           AttributeBegin Material \"diffuse\" \"texture reflectance\" \"checks\"\n"
        + &shape(&scene.join("meshes/background.obj"))
        + "AttributeEnd\n"
        + text;
    let expected = reference(&scene.join(format!("refs/test_{name}_ref_spectral.exr")));
    estimate(&text, 4).assert_parts(&expected, 12, 6e-3, 3, name);
}

/// A ball and its base, of a medium of coloured albedo, and of coloured extinction.
#[test]
fn homogeneous_media() {
    let Some(folder) = data("mitsuba-tests") else { return };
    let scene = folder.join("tests/scenes/participating_media/meshes");
    let (white, pale) = ([1.0; 3], [0.99, 0.5, 0.5]);
    for (name, parameters) in [
        ("homo_null_envmap", medium(white, pale, 3.0)),
        ("homo_spectral_sigmat", medium([1.0, 0.2, 1.0], [0.5, 0.5, 0.99], 10.0)),
    ] {
        let text = format!("MakeNamedMedium \"m\" \"string type\" \"homogeneous\" {parameters}")
            + "Material \"interface\" MediumInterface \"m\" \"\"\n"
            + &shape(&scene.join("sphere_tiny.obj"))
            + &shape(&scene.join("sphere_base.obj"));
        compare_in_media(&folder, name, &text);
    }
}

/// The side of the grid of densities, and how many voxels each of its voxels becomes along it.
const SIDE: usize = 16;
const FINER: usize = 4;

/// A grid of densities as one of more voxels, interpolated. Mitsuba continues the outermost
/// densities to the faces of the grid; those of the format fall off to half of them there, from the
/// centres of the outermost voxels on, which are nearer to the faces then.
fn finer(densities: &[f32]) -> impl Iterator<Item = f32> + '_ {
    let fine = 0..SIDE * FINER;
    let places = fine.clone().flat_map(move |z| {
        let fine = fine.clone();
        fine.clone().flat_map(move |y| fine.clone().map(move |x| [x, y, z]))
    });
    places.map(|place| {
        let at = place.map(|i| ((i as f32 + 0.5) / FINER as f32 - 0.5).clamp(0.0, (SIDE - 1) as f32));
        (0..8)
            .map(|corner| {
                let (mut index, mut weight) = (0, 1.0);
                for axis in [2, 1, 0] {
                    let low = (at[axis] as usize).min(SIDE - 2);
                    let (bit, t) = (corner >> axis & 1, at[axis] - low as f32);
                    index = SIDE * index + low + bit;
                    weight *= if bit == 1 { t } else { 1.0 - t };
                }
                weight * densities[index]
            })
            .sum()
    })
}

/// A grid of densities.
#[test]
fn a_grid_medium() {
    let Some(folder) = data("mitsuba-tests") else { return };
    let scene = folder.join("tests/scenes/participating_media");
    let bytes = std::fs::read(scene.join("textures/sigmat.vol")).expect("the volume is readable");
    // A header of 48 bytes is followed by 16³ floats.
    let densities = bytes[48..].chunks_exact(4).map(|value| f32::from_le_bytes(value.try_into().unwrap()));
    let densities: Vec<f32> = densities.collect();
    let densities: String = finer(&densities).map(|density| format!("{density} ")).collect();
    let side = SIDE * FINER;
    let text = format!(
        "AttributeBegin Translate -0.5 -0.5 -0.5 Scale 1.5 1.5 1.5\n\
         MakeNamedMedium \"m\" \"string type\" \"uniformgrid\"\n\
         \"integer nx\" {side} \"integer ny\" {side} \"integer nz\" {side} \"float density\" ["
    ) + &densities
        + "]\n"
        + &medium([1.0; 3], [0.99, 0.5, 0.5], 5.0)
        + "AttributeEnd\nAttributeBegin Scale 1.5 1.5 1.5\n\
           Material \"interface\" MediumInterface \"m\" \"\"\n"
        + &shape(&scene.join("meshes/unit_cube_centered.obj"))
        + "AttributeEnd\n"
        + &diffuse("0.5 0.5 0.5")
        + &shape(&scene.join("meshes/sphere_base.obj"));
    compare_in_media(&folder, "hetero_sigmat", &text);
}

/// A textured ball, lit by the sky, a point and a lamp.
#[test]
fn a_textured_ball() {
    let Some(folder) = data("mitsuba-tests") else { return };
    // The format divides a spectrum by its Y, which is the lamp's scale here.
    let text = head("-4 0 0  0 0 0  0 0 1", 34.0227, 48, 1, 64)
        + "AttributeBegin Translate -4 0 6 Scale 2 2 2 Rotate 120 0 1 0\n\
           Material \"diffuse\" \"rgb reflectance\" [0.78 0.78 0.78]\n\
           AreaLightSource \"diffuse\" \"spectrum L\" [400 0 500 8 600 15.6 700 18.4] \"float scale\" 12.36854\n"
        + &shape(&folder.join("common/meshes/rectangle.obj"))
        + "AttributeEnd\n"
        + &museum(&folder)
        + "LightSource \"point\" \"rgb I\" [300 300 300] \"point3 from\" [-4 0 -6]\n"
        + &format!(
            "Texture \"wood\" \"spectrum\" \"imagemap\" \"string filename\" \"{}\"\n\
             Material \"diffuse\" \"texture reflectance\" \"wood\"\n",
            folder.join("common/textures/wood.jpg").display()
        )
        + &shape(&folder.join("common/meshes/sphere.obj"));
    let refs = folder.join("tests/scenes/bsdf_spheres/refs");
    let expected = reference(&refs.join("test_textured_diffuse_ref_spectral.exr"));
    estimate(&text, 4).assert_parts(&expected, 12, 6e-3, 1, "textured ball");
}
