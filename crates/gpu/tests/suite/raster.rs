//! Rasterised pictures beside what rays find, and beside closed forms.

use std::fmt::Write;
use std::path::Path;
use std::sync::{Arc, OnceLock};

use alhazen_gpu::{Device, DrawError, Drawing, Rasterizer};
use assets::MemoryAssets;
use film::Film;
use image::Image;
use import::import;
use math::{Bounds2i, Vec2};
use sampling::Rng;
use scene::camera::CameraSample;
use scene::{RayStats, Scene, View};

const SIZE: [i32; 2] = [48, 32];

/// A view along y from a height of 2, and a sky of radiance 1.
const HEAD: &str = "LookAt 0 -6 2  0 0 2  0 0 1\nCamera \"perspective\" \"float fov\" 40\n";
const SKY: &str = "WorldBegin\nLightSource \"infinite\" \"rgb L\" [ 1 1 1 ]\n";

/// The first device.
fn device() -> Option<Arc<Device>> {
    static DEVICE: OnceLock<Option<Arc<Device>>> = OnceLock::new();
    DEVICE.get_or_init(|| crate::device().map(Arc::new)).clone()
}

struct Case {
    scene: Scene,
    view: View,
    film: Film,
}

impl Case {
    fn new(text: &str) -> Self {
        let path = Path::new("scene.pbrt");
        let imported = import(path, &MemoryAssets::default().with(path, text));
        let errors: Vec<_> = imported.diagnostics.iter().filter(|d| d.is_error()).collect();
        assert!(errors.is_empty(), "{errors:?}");
        let mut desc = imported.desc;
        desc.film.resolution = SIZE;
        let scene = scene::compile(desc.clone()).expect("a scene").scene;
        let view = View::compile(&desc, scene.world_from_render()).expect("a view").view;
        let film = film::compile(&desc).expect("a film").film;
        Self { scene, view, film }
    }

    fn draw(&self, device: &Arc<Device>) -> Result<Drawing, DrawError> {
        let mut rasterizer = Rasterizer::new(device.clone(), &self.scene, &self.view, &self.film)?;
        assert!(rasterizer.notes().is_empty(), "{:?}", rasterizer.notes());
        rasterizer.draw(&self.view, Bounds2i::new([0, 0], SIZE))
    }

    fn picture(&self, device: &Arc<Device>) -> Image {
        self.draw(device).unwrap_or_else(|error| panic!("{error}")).image
    }

    /// Whether a surface is at a film position.
    fn is_hit(&self, film: Vec2) -> bool {
        let sample = CameraSample { film, lens: Vec2::splat(0.5), time: 0.5, filter_weight: 1.0 };
        let ray = self.view.camera.generate_ray(&sample).expect("a ray").ray;
        self.scene.hit(&ray, f32::INFINITY, &mut RayStats::default()).is_some()
    }
}

fn pixels() -> impl Iterator<Item = [u32; 2]> {
    (0..SIZE[1] as u32).flat_map(|y| (0..SIZE[0] as u32).map(move |x| [x, y]))
}

fn assert_close(found: [f32; 3], wanted: [f32; 3], tolerance: f32, what: &dyn std::fmt::Debug) {
    let is_close = found.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= tolerance);
    assert!(is_close, "{what:?}: {found:?} is not {wanted:?}");
}

fn mean(image: &Image) -> [f32; 3] {
    let count = pixels().count() as f32;
    [0, 1, 2].map(|c| pixels().map(|[x, y]| image.channel(x, y, c)).sum::<f32>() / count)
}

#[test]
fn triangles_are_where_rays_hit_them() {
    let Some(device) = device() else { return };
    let triangles = "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]
        Shape \"trianglemesh\" \"point3 P\" [ -1.7 0 0.4  1.3 -1 1.1  0.2 2 3.4 ] \"integer indices\" [ 0 1 2 ]
        Translate 1.4 0 1.2 Shape \"sphere\" \"float radius\" 0.6";
    let case = Case::new(&format!("{HEAD}{SKY}{triangles}"));
    let image = case.picture(&device);
    let (mut inside, mut outside) = (0, 0);
    for [x, y] in pixels() {
        let place = |i: u32| Vec2::new(x as f32 + (i % 4) as f32 / 3.0, y as f32 + (i / 4) as f32 / 3.0);
        let hits = (0..16).filter(|i| case.is_hit(place(*i))).count();
        // Under the whole sky a surface has its reflectance.
        match hits {
            16 => (inside, _) = (inside + 1, assert_close(image.rgb(x, y), [0.5; 3], 0.01, &[x, y])),
            0 => (outside, _) = (outside + 1, assert_close(image.rgb(x, y), [1.0; 3], 0.01, &[x, y])),
            _ => {}
        }
    }
    assert!(inside > 100 && outside > 400, "{inside} {outside}");
}

#[test]
fn fog_is_what_beers_law_says() {
    let Some(device) = device() else { return };
    let wall = "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]
        Shape \"bilinearmesh\" \"point3 P\" [ -9 4 -9  9 4 -9  -9 4 9  9 4 9 ]";
    let fog = |absorbed: f32, scattered: f32| {
        format!(
            "MakeNamedMedium \"fog\" \"string type\" \"homogeneous\" \"spectrum sigma_a\" [ 300 {absorbed} 900 {absorbed} ]
             \"spectrum sigma_s\" [ 300 {scattered} 900 {scattered} ] MediumInterface \"\" \"fog\"\n"
        )
    };
    for (absorbed, scattered) in [(0.1, 0.0), (0.0, 0.1), (0.06, 0.02)] {
        let case = Case::new(&format!("{}{HEAD}{SKY}{wall}", fog(absorbed, scattered)));
        let image = case.picture(&device);
        for [x, y] in pixels() {
            let sample = CameraSample {
                film: Vec2::new(x as f32 + 0.5, y as f32 + 0.5),
                lens: Vec2::splat(0.5),
                time: 0.5,
                filter_weight: 1.0,
            };
            let ray = case.view.camera.generate_ray(&sample).expect("a ray").ray;
            let hit = case.scene.hit(&ray, f32::INFINITY, &mut RayStats::default()).expect("the wall");
            let passes = (-(absorbed + scattered) * hit.t).exp();
            let albedo = scattered / (absorbed + scattered);
            let wanted = 0.5 * passes + albedo * (1.0 - passes);
            assert_close(image.rgb(x, y), [wanted; 3], 0.01, &(absorbed, scattered, [x, y]));
        }
    }
}

#[test]
fn still_water_shows_what_the_mirrored_camera_sees() {
    let Some(device) = device() else { return };
    let object = "Material \"diffuse\" \"rgb reflectance\" [ 0.7 0.2 0.1 ]
        Shape \"trianglemesh\" \"point3 P\" [ -1.5 2 0.3  1.2 3 0.5  0.2 2 2.4 ] \"integer indices\" [ 0 1 2 ]\n";
    let water = "Material \"dielectric\" \"float eta\" 1.333
        Shape \"trianglemesh\" \"point3 P\" [ -90 -90 0  90 -90 0  90 90 0  -90 90 0 ]
        \"integer indices\" [ 0 1 2  0 2 3 ] \"normal N\" [ 0 0 1  0 0 1  0 0 1  0 0 1 ]";
    let camera = "Camera \"perspective\" \"float fov\" 40\n";
    let above = format!("LookAt 0 -6 2  0.3 0 -1  0 0 1\n{camera}{SKY}{object}");
    let below = format!("LookAt 0 -6 -2  0.3 0 1  0 0 -1\n{camera}{SKY}{object}");
    let (case, mirrored) = (Case::new(&format!("{above}{water}")), Case::new(&below));
    let (image, plain, mirrored) =
        (case.picture(&device), Case::new(&above).picture(&device), mirrored.picture(&device));
    let mut count = 0;
    for [x, y] in pixels() {
        let film = Vec2::new(x as f32 + 0.5, y as f32 + 0.5);
        let sample = CameraSample { film, lens: Vec2::splat(0.5), time: 0.5, filter_weight: 1.0 };
        let d = case.view.camera.generate_ray(&sample).expect("a ray").ray.d;
        // Only where nothing is before the water, and the mirror has no edge.
        let near = |image: &Image| {
            let at = |dx: u32, dy: u32| image.rgb((x + dx).clamp(1, 48) - 1, (y + dy).clamp(1, 32) - 1);
            (0..9).all(|i| at(i % 3, i / 3) == at(1, 1))
        };
        let is_water = d.z < -0.1 && plain.rgb(x, y)[1] > 0.9;
        let flipped = SIZE[0] as u32 - 1 - x;
        if !is_water || !near(&plain) {
            continue;
        }
        let cos = -d.z;
        let g = (1.333_f32 * 1.333 - 1.0 + cos * cos).sqrt();
        let (a, b) = ((g - cos) / (g + cos), (cos * (g + cos) - 1.0) / (cos * (g - cos) + 1.0));
        let share = 0.5 * a * a * (1.0 + b * b);
        let seen = mirrored.rgb(flipped, y);
        let neighbours = [-1_i32, 1].map(|dx| mirrored.rgb((flipped as i32 + dx).clamp(0, 47) as u32, y));
        if neighbours.iter().any(|other| (other[1] - seen[1]).abs() > 0.01) {
            continue;
        }
        // Shading is anywhere within the pixel.
        assert_close(image.rgb(x, y), seen.map(|l| l * share), 0.02, &[x, y]);
        count += 1;
    }
    assert!(count > 300, "{count}");
}

/// A bush of leaves at random, as an object or as it is.
fn bush(is_instanced: bool) -> String {
    let mut rng = Rng::from_sequence(5);
    let (mut points, mut indices) = (String::new(), String::new());
    for i in 0..900 {
        let mut around = |size: f32| [0; 3].map(|_| (rng.uniform_f32() - 0.5) * size);
        let center = around(2.0);
        for _ in 0..3 {
            let corner = around(0.4);
            (0..3).for_each(|c| write!(points, "{} ", center[c] + corner[c]).expect("text"));
        }
        write!(indices, "{} {} {} ", 3 * i, 3 * i + 1, 3 * i + 2).expect("text");
    }
    let shape = format!(
        "Material \"diffusetransmission\" \"rgb reflectance\" [ 0.2 0.4 0.1 ] \"rgb transmittance\" [ 0.1 0.3 0.05 ]
         Shape \"trianglemesh\" \"point3 P\" [ {points}] \"integer indices\" [ {indices}]\n"
    );
    let place = "Translate 0.5 0 2 Rotate 50 0.3 0.2 1";
    if is_instanced {
        format!("ObjectBegin \"bush\"\n{shape}ObjectEnd\n{place} ObjectInstance \"bush\"\n")
    } else {
        format!("{place}\n{shape}")
    }
}

#[test]
fn a_sprite_looks_like_its_triangles() {
    let Some(device) = device() else { return };
    let [whole, sprite] = [false, true].map(|is| Case::new(&format!("{HEAD}{SKY}{}", bush(is))));
    let [whole, sprite] =
        [whole, sprite].map(|case| case.draw(&device).unwrap_or_else(|error| panic!("{error}")));
    assert_eq!([whole.triangles, whole.sprites, sprite.triangles, sprite.sprites], [900, 0, 0, 1]);
    let [a, b] = [&whole.image, &sprite.image].map(mean);
    for c in 0..3 {
        // What the bush takes from the sky.
        let [a, b] = [1.0 - a[c], 1.0 - b[c]];
        assert!((a - b).abs() < 0.1 * a, "{c}: {a} {b}");
    }
}

#[test]
fn cameras_that_are_not_perspective_are_refused() {
    let Some(device) = device() else { return };
    let case = Case::new(&format!("Camera \"spherical\"\n{SKY}Shape \"sphere\""));
    assert!(matches!(case.draw(&device), Err(DrawError::Camera)));
}

#[test]
fn a_rasteriser_leaves_out_what_the_camera_does_not_see() {
    let Some(device) = device() else { return };
    let grey = "Material \"diffuse\" \"rgb reflectance\" [ 0.5 0.5 0.5 ]\n";
    let wall = |indices: &str| {
        format!(
            "Shape \"trianglemesh\" \"point3 P\" [ -9 4 -9  9 4 -9  9 4 9  -9 4 9 ] \"integer indices\" [ {indices} ]
             \"bool singlesided\" true\n"
        )
    };
    // Corners run counter-clockwise about the front: towards the camera, or away from it.
    let (front, back) = (wall("0 1 2  0 2 3"), wall("0 2 1  0 3 2"));
    let ball = "Translate 0 0 2 Shape \"sphere\" \"float radius\" 9 \"bool singlesided\" true";
    let instance = |shape: &str| {
        format!("ObjectBegin \"wall\"\n{shape}ObjectEnd\nScale -1 1 1 ObjectInstance \"wall\"\n")
    };
    for (shape, is_seen) in [
        (front.clone(), true),
        (back.clone(), false),
        (instance(&front), true),
        (instance(&back), false),
        (format!("ReverseOrientation {front}"), false),
        (format!("Scale 1 1 -1 {front}"), true),
        (format!("ReverseOrientation {ball}"), true),
        (ball.to_owned(), false),
    ] {
        let case = Case::new(&format!("{HEAD}{SKY}{grey}{shape}"));
        let wanted = if is_seen { 0.5 } else { 1.0 };
        let image = case.picture(&device);
        assert_eq!(case.is_hit(Vec2::splat(20.0)), is_seen, "{shape}");
        assert_close(image.rgb(20, 20), [wanted; 3], 0.01, &shape);
    }
}
