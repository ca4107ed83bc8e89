//! Scenes of any size: their coordinates may be as large or as small as squares of lengths are
//! floats, in the engines and the algorithms alike.

use crate::common::{render_text, scene_text};
use alhazen::image::Image;
use alhazen::import::import;
use alhazen::{Job, Overrides};

/// Algorithms and engines. The scalar engine has the other algorithms anyway.
const RENDERERS: [(&str, &str); 8] = [
    ("path", "wavefront"),
    ("vol-path", "wavefront"),
    ("whitted", "wavefront"),
    ("ray-casting", "wavefront"),
    ("path", "scalar"),
    ("bdpt", "scalar"),
    ("sppm", "scalar"),
    ("light-tracing", "scalar"),
];

fn render(text: &str, (integrator, engine): (&str, &str), settings: &[(&str, String)]) -> Image {
    let settings = settings.iter().map(|(name, value)| ((*name).into(), value.clone()));
    let overrides = Overrides {
        integrator: Some(integrator.into()),
        settings: settings.chain([("engine".into(), engine.into())]).collect(),
        ..Overrides::default()
    };
    render_text(text, &overrides)
}

/// The mean of a picture, and its smallest and largest value.
fn statistics(picture: &Image) -> [f32; 3] {
    let values = || picture.values();
    [
        values().sum::<f32>() / values().count() as f32,
        values().fold(f32::INFINITY, f32::min),
        values().fold(0.0, f32::max),
    ]
}

/// Numbers in units of `unit`.
fn scaled(unit: f32, numbers: &[f32]) -> String {
    numbers.iter().map(|x| format!("{:e} ", x * unit)).collect()
}

/// A room of a textured mesh, one with normals, a bilinear patch and spheres, with lamps of all
/// shapes, whose lengths are in units of `unit`.
fn room(unit: f32) -> String {
    let p = |numbers: &[f32]| scaled(unit, numbers);
    let ball = p(&[0.4]);
    format!(
        "LookAt {} {} 0 1 0 Camera \"perspective\" \"float fov\" 50\n\
         Film \"rgb\" \"integer xresolution\" 12 \"integer yresolution\" 12 \"bool savefp16\" false\n\
         PixelFilter \"box\" Sampler \"independent\" \"integer pixelsamples\" 4\n\
         Option \"disablewavelengthjitter\" true\nWorldBegin\n\
         Texture \"tiles\" \"spectrum\" \"checkerboard\" \"float uscale\" 8 \"float vscale\" 8\n\
         Material \"diffuse\" \"texture reflectance\" \"tiles\"\n\
         Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] \"point3 P\" [{}] \"point2 uv\" [0 0 0 1 1 1 1 0]\n\
         Material \"conductor\" \"float uroughness\" 0.3 \"float vroughness\" 0.1\n\
         Shape \"bilinearmesh\" \"point3 P\" [{}]\n\
         Material \"diffuse\"\n\
         Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [{}] \"normal N\" [0 0 1 0.2 0 1 0 0.3 1]\n\
         AttributeBegin Translate {} Shape \"sphere\" \"float radius\" {ball} AttributeEnd\n\
         ObjectBegin \"ball\" Shape \"sphere\" \"float radius\" {ball} ObjectEnd\n\
         AttributeBegin Translate {} Scale 0.5 1 0.5 ObjectInstance \"ball\" AttributeEnd\n\
         LightSource \"infinite\" \"float scale\" 0.1\n\
         LightSource \"point\" \"point3 from\" [{}] \"float scale\" {:e}\n\
         AreaLightSource \"diffuse\" \"float scale\" 3\n\
         Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [{}]\n\
         Shape \"bilinearmesh\" \"point3 P\" [{}]\n\
         Shape \"trianglemesh\" \"integer indices\" [0 1 2] \"point3 P\" [{}]\n\
         AttributeBegin Translate {} Shape \"sphere\" \"float radius\" {} AttributeEnd\n",
        p(&[0.0, 1.5, 4.0]),
        p(&[0.0, 0.75, 0.0]),
        p(&[-2.0, 0.0, -2.0, -2.0, 0.0, 2.0, 2.0, 0.0, 2.0, 2.0, 0.0, -2.0]),
        p(&[-2.0, 0.0, -2.0, 2.0, 0.0, -2.0, -2.0, 2.5, -2.0, 2.0, 2.25, -1.5]),
        p(&[-2.0, 0.0, -1.75, -1.0, 0.0, -1.75, -1.5, 1.0, -1.75]),
        p(&[-0.75, 0.5, 0.0]),
        p(&[0.75, 0.5, 0.25]),
        p(&[1.0, 2.0, 1.0]),
        unit * unit,
        p(&[-1.0, 2.5, -1.0, 0.0, 2.5, -1.0, -1.0, 2.5, 0.0]),
        p(&[0.5, 2.0, 0.0, 1.0, 2.0, 0.0, 0.5, 2.0, 0.5, 1.0, 2.0, 0.5]),
        p(&[0.0, 1.0, 0.0, 0.005, 1.0, 0.0, 0.0, 1.005, 0.0]),
        p(&[1.5, 0.25, 1.0]),
        p(&[0.125]),
    )
}

#[test]
fn a_room_scaled_by_a_power_of_two_gives_the_same_picture() {
    let mut wrong = Vec::new();
    for renderer in RENDERERS {
        let at = |exponent: i32| {
            let unit = 2f32.powi(exponent);
            let radius: &[(&str, String)] =
                if renderer.0 == "sppm" { &[("radius", format!("{:e}", 0.1 * unit))] } else { &[] };
            render(&room(unit), renderer, radius)
        };
        let plain = at(0);
        let [mean, ..] = statistics(&plain);
        assert!(mean > 0.05, "{renderer:?}: {mean}");
        for exponent in [-50, -40, -20, 20, 40, 55] {
            let found = at(exponent);
            let differing = found.values().zip(plain.values()).filter(|(a, b)| (a - b).abs() > 1e-3 * mean);
            let (count, all) = (differing.count(), plain.values().count());
            let error = (statistics(&found)[0] / mean - 1.0).abs();
            if count * 50 > all {
                let differs = format!("{count} of {all} values differ, and the mean by {error}");
                wrong.push(format!("{renderer:?}, 2^{exponent}: {differs}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

/// A view of `world`, lit at 45 degrees: radiance 1/2π · cos 45° leaves a horizontal surface.
fn lit(world: &str) -> String {
    format!(
        "LookAt 0 3 -4  0 0 0  0 1 0 Camera \"perspective\" \"float fov\" 30\n\
         Film \"rgb\" \"integer xresolution\" 6 \"integer yresolution\" 6 \"bool savefp16\" false\n\
         PixelFilter \"box\" Sampler \"stratified\" \"integer xsamples\" 8 \"integer ysamples\" 8\n\
         WorldBegin LightSource \"distant\" \"point3 from\" [0 1 0]\n\
         Material \"diffuse\" \"spectrum reflectance\" [360 0.5 830 0.5]\n{world}"
    )
}

/// Checks that ground fills the view.
fn assert_lit(world: &str, renderers: &[(&str, &str)]) {
    let text = lit(world);
    for &renderer in renderers {
        let [mean, least, most] = statistics(&render(&text, renderer, &[]));
        let expected = 0.5 / std::f32::consts::PI * std::f32::consts::FRAC_1_SQRT_2;
        assert!((mean / expected - 1.0).abs() < 0.01, "{renderer:?}: {mean}, not {expected}, of {world}");
        let is_random = renderer.0 == "light-tracing";
        assert!(is_random || least > 0.85 * expected && most < 1.15 * expected, "{renderer:?}: {world}");
    }
}

/// A square in the plane y = 0 of half the side `half`.
fn square(half: &str) -> String {
    let (low, high) = (format!("-{half}"), half);
    format!("\"point3 P\" [{low} 0 {low}  {low} 0 {high}  {high} 0 {high}  {high} 0 {low}]")
}

#[test]
fn ground_of_any_size_is_lit() {
    let renderers = &RENDERERS[..6];
    for half in ["5", "1e9", "3e9", "1e12", "1e15", "1e18"] {
        let triangles = format!("Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] {}", square(half));
        assert_lit(&triangles, renderers);
        assert_lit(&format!("{triangles} \"point2 uv\" [0 0 0 1 1 1 1 0]"), &renderers[..1]);
        assert_lit(&format!("{triangles} \"normal N\" [0 1 0 0 1 0 0 1 0 0 1 0]"), &renderers[..1]);
        assert_lit(&format!("Rotate 90 1 0 0 Shape \"disk\" \"float radius\" {half}"), &renderers[..1]);
        let patch = format!("-{half} 0 -{half}  {half} 0 -{half}  -{half} 0 {half}  {half} 0 {half}");
        assert_lit(&format!("Shape \"bilinearmesh\" \"point3 P\" [{patch}]"), renderers);
    }
}

#[test]
fn instances_of_any_scale_are_seen() {
    let renderers = &RENDERERS[..6];
    let object = |half: &str| {
        let mesh = format!("Shape \"trianglemesh\" \"integer indices\" [0 1 2 0 2 3] {}", square(half));
        format!("ObjectBegin \"square\" {mesh} ObjectEnd\n")
    };
    for (half, scale) in
        [("1", "20"), ("1", "3e7"), ("1", "1e9"), ("1", "1e12"), ("1e9", "1e-7"), ("1e14", "1e-12")]
    {
        let placed = format!("{}Scale {scale} {scale} {scale} ObjectInstance \"square\"", object(half));
        assert_lit(&placed, renderers);
    }
    // Objects defined far away, turned, within others, and moving past.
    let (object, far) = (object("5"), "1e6 3e5 -2e6");
    let back = "-1e6 -3e5 2e6";
    for world in [
        format!(
            "AttributeBegin Translate {far}\n{object}AttributeEnd Translate {back} ObjectInstance \"square\""
        ),
        format!("{object}Scale 1e8 1e8 1e8 Rotate 30 0 1 0 ObjectInstance \"square\""),
        format!(
            "{object}ObjectBegin \"outer\" Scale 1e4 1e4 1e4 ObjectInstance \"square\" ObjectEnd\nScale 1e4 1e4 1e4 ObjectInstance \"outer\""
        ),
        format!(
            "{object}ActiveTransform EndTime Translate 1 0 0 ActiveTransform All Scale 1e4 1e4 1e4 ObjectInstance \"square\""
        ),
    ] {
        assert_lit(&world, &renderers[..5]);
    }
}

#[test]
fn a_planet_under_the_scene_is_met_at_its_surface() {
    for radius in ["1e5", "6.371e6", "2e9", "1e12"] {
        let sphere =
            format!("Translate 0 -{radius} 0 Rotate -90 1 0 0 Shape \"sphere\" \"float radius\" {radius}");
        assert_lit(&sphere, &RENDERERS[..6]);
    }
    // Floats do not hold where the instance of a larger one is, of which there is a warning.
    let sphere = "Translate 0 -1e5 0 Rotate -90 1 0 0 Shape \"sphere\" \"float radius\" 1e5";
    let instance = format!("ObjectBegin \"planet\" {sphere} ObjectEnd ObjectInstance \"planet\"");
    assert_lit(&instance, &RENDERERS[..1]);
}

#[test]
fn lights_far_away_and_tiny_ones_shine() {
    let ground = "Shape \"bilinearmesh\" \"point3 P\" [-50 0 -50  50 0 -50  -50 0 50  50 0 50]\n";
    let renderers = &RENDERERS[..6];
    // Radiant intensity over the square of the distance is π/√2 · irradiance.
    for (distance, scale) in [(1e3f32, 1e6f32), (1e9, 1e18), (1e18, 1e36)] {
        let from = distance * std::f32::consts::FRAC_1_SQRT_2;
        let lamp = format!(
            "LightSource \"point\" \"point3 from\" [{from:e} {from:e} 0] \"float scale\" {scale:e}\n"
        );
        let text =
            lit(&format!("{lamp}{ground}")).replace("LightSource \"distant\" \"point3 from\" [0 1 0]", "");
        for &renderer in renderers.iter().filter(|renderer| renderer.0 != "sppm") {
            let [mean, ..] = statistics(&render(&text, renderer, &[]));
            let expected = 0.5 / std::f32::consts::PI * std::f32::consts::FRAC_1_SQRT_2;
            assert!((mean / expected - 1.0).abs() < 0.02, "{renderer:?}, {distance:e}: {mean}");
        }
    }
}

#[test]
fn instances_that_floats_misplace_are_warned_about() {
    for (radius, is_warned) in [("100", false), ("1e4", false), ("6.371e6", true), ("1e9", true)] {
        let unit = "ObjectBegin \"planet\" Shape \"sphere\" \"float radius\" 1 ObjectEnd";
        let text = lit(&format!(
            "{unit} Translate 0 -{radius} 0 Scale {radius} {radius} {radius} ObjectInstance \"planet\""
        ));
        let (path, assets) = scene_text(&text);
        let warnings = Job::compile(import(path, &assets).desc).ok().unwrap().warnings;
        let found = warnings.iter().find(|warning| warning.code == "coarse-instance");
        assert_eq!(found.is_some(), is_warned, "{radius}: {warnings:?}");
        assert!(found.is_none_or(|warning| !warning.labels[0].0.is_none()), "{warnings:?}");
    }
}
