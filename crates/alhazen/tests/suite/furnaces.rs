//! Closed furnaces, and lossless objects under a uniform sky, from the text of a scene to the
//! picture file.
//!
//! Where every path carries the same radiance, a pixel's only noise is that of its wavelengths. The
//! sky alone, seen with the same seed, has the same wavelengths: so each pixel, not only their
//! mean, has a known value, and a single leaking ray is detected.

use std::sync::atomic::{AtomicU32, Ordering};

use crate::common::{Estimate, means, render_text, rgb_values};
use alhazen::image::{self, Image};
use alhazen::{Overrides, write_picture};

/// Where each reflection halves the throughput, the rest after this depth is less than rounding.
const IN_FURNACE: u32 = 24;

/// Light is trapped in glass for long where it hits the surface at grazing angles.
const IN_GLASS: u32 = 1000;

/// The picture of a world, written to a file and read again.
fn picture(integrator: &str, samples: u32, world: &str, overrides: &Overrides) -> Image {
    static COUNT: AtomicU32 = AtomicU32::new(0);
    let text = format!(
        "LookAt 0.1 0.2 -0.1  0.3 -0.2 1  0 1 0 Camera \"perspective\" \"float fov\" 90\n\
         Film \"rgb\" \"integer xresolution\" 32 \"integer yresolution\" 32 \"bool savefp16\" false\n\
         Sampler \"independent\" \"integer pixelsamples\" {samples} Integrator {integrator}\nWorldBegin\n{world}"
    );
    let name =
        format!("alhazen-furnace-{}-{}.exr", std::process::id(), COUNT.fetch_add(1, Ordering::Relaxed));
    let path = std::env::temp_dir().join(name);
    write_picture(&render_text(&text, overrides), &path, &Default::default())
        .expect("the picture is written");
    let picture = image::open(&path).expect("the picture is read");
    std::fs::remove_file(path).expect("the picture is removed");
    picture
}

/// A picture by BSDF sampling only: every path has the same throughput.
fn exact(max_depth: u32, world: &str) -> Image {
    let integrator = format!("\"simplepath\" \"integer maxdepth\" {max_depth} \"bool samplelights\" false");
    picture(&integrator, 64, world, &Overrides::default())
}

fn sky() -> Image {
    exact(0, SKY)
}

const SKY: &str = "LightSource \"infinite\" \"rgb L\" [1 1 1]\n";

/// Emission and reflectance of one half on both sides: L = ½ / (1 − ½) = 1.
const WALL: &str = "Material \"diffuse\" \"rgb reflectance\" [0.5 0.5 0.5]\n\
    AreaLightSource \"diffuse\" \"rgb L\" [0.5 0.5 0.5] \"bool twosided\" true\n";

/// Emission alone: L = 1.
const BLACK_WALL: &str = "Material \"diffuse\" \"rgb reflectance\" [0 0 0]\n\
    AreaLightSource \"diffuse\" \"rgb L\" [1 1 1] \"bool twosided\" true\n";

const SPHERE: &str = "Shape \"sphere\" \"float radius\" 2\n";

const SPHERES: &str = "Shape \"spheres\" \"point3 P\" [0 0 0  1 0 -1  0 -1.5 1] \"float radius\" [2 1.5 1]\n";

const BOX: &str = "Shape \"trianglemesh\"\n\
    \"point3 P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]\n\
    \"integer indices\" [0 1 3 0 3 2  4 5 7 4 7 6  0 1 5 0 5 4  2 3 7 2 7 6  0 2 6 0 6 4  1 3 7 1 7 5]\n";

const PATCHES: &str = "Shape \"bilinearmesh\"\n\
    \"point3 P\" [-1 -1 -1  1 -1 -1  -1 1 -1  1 1 -1  -1 -1 1  1 -1 1  -1 1 1  1 1 1]\n\
    \"integer indices\" [0 1 2 3  4 5 6 7  0 1 4 5  2 3 6 7  0 2 4 6  1 3 5 7]\n";

const DRUM: &str = "Shape \"cylinder\" \"float radius\" 1.5 \"float zmin\" -1 \"float zmax\" 2\n\
    Shape \"disk\" \"float radius\" 1.5 \"float height\" -1\n\
    Shape \"disk\" \"float radius\" 1.5 \"float height\" 2\n";

/// Everything closed around the camera.
fn walls() -> Vec<(&'static str, String)> {
    let turned = "Rotate 33 1 2 3 Scale 1.5 2 1.1\n";
    vec![
        ("a sphere", format!("{WALL}{SPHERE}")),
        ("a set of spheres", format!("{WALL}Rotate 33 1 2 3 Scale 1.5 1.5 1.5\n{SPHERES}")),
        ("a box of triangles", format!("{WALL}{turned}{BOX}")),
        ("a box of patches", format!("{WALL}{turned}{PATCHES}")),
        ("a drum", format!("{WALL}Rotate 33 1 2 3\n{DRUM}")),
        ("a box far away", format!("{WALL}Translate 900 -700 -1000 Scale 2000 2000 2000\n{BOX}")),
    ]
}

/// Asserts that each pixel is that of the sky.
fn assert_uniform(found: &Image, sky: &Image, name: &str) {
    for (i, (found, sky)) in rgb_values(found).zip(rgb_values(sky)).enumerate() {
        let (x, y) = (i / 3 % 32, i / 96);
        assert!((found / sky - 1.0).abs() < 2e-5, "{name}: pixel {x}, {y} shows {found}, not {sky}");
    }
}

#[test]
fn no_pixel_of_a_closed_furnace_leaks() {
    let sky = sky();
    for (name, wall) in walls() {
        assert_uniform(&exact(IN_FURNACE, &wall), &sky, name);
    }
}

/// Instances of glass, mirrors and white objects in front of the camera.
fn things() -> Vec<(&'static str, String)> {
    let ball = "Translate 0.4 -0.2 1 Shape \"sphere\" \"float radius\" 0.4\n";
    let balls = "Shape \"spheres\" \"point3 P\" [0.4 -0.2 1  -0.5 0.1 1.4  0.2 0.4 1.2] \"float radius\" [0.4 0.3 0.2]\n";
    let cube = format!("Translate 0.4 -0.2 1.2 Rotate 33 1 2 3 Scale 0.3 0.3 0.3\n{BOX}");
    let drop = format!(
        "ObjectBegin \"drop\"\n{ball}ObjectEnd\nScale 1 1.5 1 Translate 0 0.1 0.3 ObjectInstance \"drop\"\n"
    );
    let glass = "Material \"dielectric\" \"float eta\" 1.5\n";
    let pane = "Material \"thindielectric\" \"float eta\" 1.5\n";
    let white = "Material \"diffuse\" \"rgb reflectance\" [1 1 1]\n";
    vec![
        ("a glass ball", format!("{glass}{ball}")),
        ("an instance of glass", format!("{glass}{drop}")),
        ("a soap bubble", format!("{pane}{ball}")),
        ("a set of glass balls", format!("{glass}{balls}")),
        ("a white ball", format!("{white}{ball}")),
        ("a white cube", format!("{white}{cube}")),
    ]
}

#[test]
fn lossless_materials_are_invisible_under_a_uniform_sky() {
    let sky = sky();
    for (name, thing) in things() {
        assert_uniform(&exact(IN_GLASS, &format!("{SKY}{thing}")), &sky, name);
    }
}

#[test]
fn lossless_materials_are_invisible_in_a_furnace() {
    let sky = sky();
    for (name, thing) in things() {
        let world = format!("AttributeBegin\n{BLACK_WALL}{SPHERE}AttributeEnd\n{thing}");
        assert_uniform(&exact(IN_GLASS, &world), &sky, name);
    }
}

/// With light sampling, pixels are noisy, but their mean is not.
#[test]
fn a_furnace_has_radiance_one() {
    let walls = walls();
    for (name, wall) in &walls {
        let estimate =
            Estimate::new(2, |overrides| picture(r#""path" "integer maxdepth" 24"#, 32, wall, &overrides));
        estimate.assert_mean([1.0; 3], 1e-5, walls.len(), name);
    }
}

#[test]
fn a_white_sky_has_radiance_one() {
    let even = Overrides { settings: vec![("sampler".into(), "zsobol".into())], ..Overrides::default() };
    let found = means(&picture("\"path\"", 256, SKY, &even));
    assert!(found.iter().all(|mean| (mean - 1.0).abs() < 5e-5), "{found:?}");
}
