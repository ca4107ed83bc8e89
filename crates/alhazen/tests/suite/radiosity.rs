//! Radiosity: against path tracing, pass by pass, cancelled, and as a mesh.

use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

use alhazen::assets::{Files, read_ply};
use alhazen::image::Image;
use alhazen::import::import;
use alhazen::integrators::{Control, Limits, OutputFile, Session};
use alhazen::scene::View;
use alhazen::{Job, Overrides};

use crate::common::{render_scene, render_text, rgb_values};

fn scene(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name)
}

fn overrides(integrator: &str, size: i32, samples: u32, settings: &[(&str, &str)]) -> Overrides {
    let settings = [("filter", "box"), ("savefp16", "false")].iter().chain(settings);
    Overrides {
        integrator: Some(integrator.into()),
        settings: settings.map(|&(name, value)| (name.into(), value.into())).collect(),
        samples_per_pixel: Some(samples),
        resolution: Some([size, size]),
        ..Overrides::default()
    }
}

/// The means of all values, and of those of each square of a number of pixels.
fn means(image: &Image, side: usize) -> (f64, Vec<f64>) {
    let width = image.width() as usize;
    let columns = width / side;
    let mut squares = vec![0.0; columns * (image.height() as usize / side)];
    for (i, value) in rgb_values(image).enumerate() {
        let (x, y) = (i / 3 % width, i / 3 / width);
        squares[y / side * columns + x / side] += value / (3 * side * side) as f64;
    }
    (squares.iter().sum::<f64>() / squares.len() as f64, squares)
}

fn job(name: &str, overrides: &Overrides) -> Job {
    let mut desc = import(scene(name), &Files).desc;
    overrides.apply(&mut desc).unwrap();
    Job::compile(desc).unwrap().job
}

#[test]
fn a_gathered_picture_has_the_mean_of_path_tracing() {
    let settings = [("maxdepth", "5"), ("gather", "1"), ("tolerance", "0.004"), ("patchsize", "90")];
    let found = render_scene(&scene("cornell-box.pbrt"), &overrides("radiosity", 24, 128, &settings));
    let reference = overrides("path", 24, 2048, &[("maxdepth", "5"), ("sampler", "sobol")]);
    let reference = render_scene(&scene("cornell-box.pbrt"), &reference);
    let ((found, _), (expected, _)) = (means(&found, 24), means(&reference, 24));
    assert!((found / expected - 1.0).abs() < 0.005, "{found}, not {expected}");
}

#[test]
#[ignore = "slow: a path-traced picture without visible noise"]
fn a_gathered_picture_agrees_with_path_tracing() {
    let settings = [("maxdepth", "5"), ("gather", "1")];
    let found = render_scene(&scene("cornell-box.pbrt"), &overrides("radiosity", 64, 1024, &settings));
    let reference = overrides("path", 64, 8192, &[("maxdepth", "5"), ("sampler", "sobol")]);
    let reference = render_scene(&scene("cornell-box.pbrt"), &reference);
    let ((found, squares), (expected, expected_squares)) = (means(&found, 8), means(&reference, 8));
    assert!((found / expected - 1.0).abs() < 0.005, "{found}, not {expected}");
    for (i, (found, expected)) in squares.iter().zip(&expected_squares).enumerate() {
        assert!((found / expected - 1.0).abs() < 0.02, "square {i}: {found}, not {expected}");
    }
}

/// The squared difference of two pictures.
fn distance(a: &Image, b: &Image) -> f64 {
    rgb_values(a).zip(rgb_values(b)).map(|(a, b)| (a - b).powi(2)).sum()
}

#[test]
fn every_pass_is_better_than_the_last() {
    let settings = [
        ("tolerance", "0.02"),
        ("steps", "4"),
        ("patchsize", "150"),
        ("gradient", "0.3"),
        ("disablepixeljitter", "true"),
    ];
    let overrides = overrides("radiosity", 32, 1, &settings);
    let last = render_scene(&scene("cornell-box.pbrt"), &overrides);
    let mut distances = Vec::new();
    for passes in 1..=4 {
        let mut job = job("cornell-box.pbrt", &overrides);
        let control = Control::default();
        let mut cancel = |session: &Session| {
            control.cancel.store(session.progress().pass == passes, Ordering::Relaxed);
        };
        assert!(job.session.run(0..1, &Limits::default(), &control, &mut cancel).is_err());
        distances.push(distance(&job.picture().unwrap(), &last));
    }
    assert!(distances.is_sorted_by(|a, b| a > b), "{distances:?}");
}

#[test]
fn a_pass_can_be_cancelled() {
    // Shooting takes minutes in a single pass.
    let settings = [("tolerance", "0.000001"), ("steps", "1"), ("patchsize", "20"), ("maxdepth", "50")];
    let mut job = job("cornell-box.pbrt", &overrides("radiosity", 16, 1, &settings));
    let control = Control::default();
    let cancel = Arc::clone(&control.cancel);
    let brake = std::thread::spawn(move || {
        std::thread::sleep(Duration::from_millis(1500));
        cancel.store(true, Ordering::Relaxed);
        Instant::now()
    });
    assert!(job.render(&control).is_err());
    let took = brake.join().unwrap().elapsed();
    assert!(took < Duration::from_secs(20), "{took:?}");
}

#[test]
fn a_long_gather_can_be_cancelled() {
    let settings = [("gather", "2147483647"), ("steps", "1"), ("tolerance", "0.9"), ("patchsize", "3")];
    let mut job = job("radiosity-room.pbrt", &overrides("radiosity", 4, 1, &settings));
    let control = Control::default();
    // After shooting, the gather starts.
    let mut brake = |_: &Session| {
        let cancel = Arc::clone(&control.cancel);
        std::thread::spawn(move || {
            std::thread::sleep(Duration::from_millis(200));
            cancel.store(true, Ordering::Relaxed);
        });
    };
    assert!(job.session.run(0..1, &Limits::default(), &control, &mut brake).is_err());
}

/// A wall on an infinite floor, which has no patches, below a point light.
const FLOOR: &str = r#"LookAt 0 -3 4  0 0.5 0  0 0 1
    Camera "perspective" "float fov" 25
    Film "rgb" "integer xresolution" 24 "integer yresolution" 24 "bool savefp16" false
    PixelFilter "box" "float xradius" 0.5 "float yradius" 0.5
    Sampler "independent" "integer pixelsamples" 16
    Integrator "path"
    WorldBegin
    AttributeBegin
      Translate 0 -1 4
      LightSource "point" "rgb I" [ 20 20 20 ]
    AttributeEnd
    Material "diffuse" "rgb reflectance" [ 0.8 0.8 0.8 ]
    Shape "plane"
    Shape "trianglemesh" "point3 P" [ -3 3 0  3 3 0  3 3 6  -3 3 6 ] "integer indices" [ 0 1 2 0 2 3 ]"#;

#[test]
fn depth_counts_as_in_path_tracing() {
    let mean = |integrator: &str, depth: u32, gather: u32| {
        let mut settings = vec![("maxdepth".to_owned(), depth.to_string())];
        if integrator == "radiosity" {
            settings.push(("gather".into(), gather.to_string()));
        }
        let integrator = Some(integrator.to_owned());
        let samples_per_pixel = Some(if gather == 0 { 64 } else { 32 });
        let overrides = Overrides { integrator, settings, samples_per_pixel, ..Overrides::default() };
        means(&render_text(FLOOR, &overrides), 24).0
    };
    // Light from the floor to the wall and back is scattered three times.
    for depth in 0..=2 {
        let expected = mean("path", depth, 0);
        for gather in [0, 1] {
            let found = mean("radiosity", depth, gather);
            assert!(
                (found - expected).abs() <= 0.015 * expected,
                "{depth}, {gather}: {found}, not {expected}"
            );
        }
    }
}

/// A pass on its own equals the pass after all earlier ones.
#[test]
fn a_pass_depends_on_its_number_alone() {
    let settings = [("tolerance", "0.5"), ("steps", "2"), ("patchsize", "3"), ("subdivision", "1")];
    let mut desc = import(scene("radiosity-room.pbrt"), &Files).desc;
    overrides("radiosity", 16, 2, &settings).apply(&mut desc).unwrap();
    let scene = alhazen::scene::compile(desc.clone()).unwrap().scene;
    let view = View::compile(&desc, scene.world_from_render()).unwrap().view;
    let picture = |passes: &[u32]| {
        let mut integrator = alhazen::integrators::build(&desc).ok().unwrap().integrator;
        let mut film = alhazen::film::compile(&desc).unwrap().film;
        integrator.prepare(&scene, &view, &Control::default()).unwrap();
        for &pass in passes {
            integrator.pass(pass, &scene, &view, &mut film, &Control::default()).unwrap();
        }
        film
    };
    let values =
        |film: &alhazen::film::Film| film.develop().unwrap().values().map(f32::to_bits).collect::<Vec<_>>();
    // A better draft replaces the one before, and the first sample replaces the last.
    for passes in [0..=1, 0..=2] {
        let last = [*passes.end()];
        assert_eq!(values(&picture(&passes.collect::<Vec<_>>())), values(&picture(&last)));
    }
    // The samples of the finished solution add up, whoever takes them.
    let mut merged = picture(&[2]);
    merged.merge(&picture(&[3])).unwrap();
    assert_eq!(values(&merged), values(&picture(&[0, 1, 2, 3])));
}

#[test]
fn the_solution_is_saved_as_a_mesh() {
    let settings = [("mesh-out", "somewhere/room.ply"), ("tolerance", "0.5"), ("patchsize", "2")];
    let mut job = job("radiosity-room.pbrt", &overrides("radiosity", 16, 1, &settings));
    assert!(job.session.integrator().files().is_empty(), "no mesh before the first pass");
    let passes = (job.session.integrator().drafts(), job.planned());
    assert_eq!(passes, (8, 1), "shooting passes are not samples");
    job.render(&Control::default()).unwrap();
    let summary = job.session.integrator().summary();
    let told = |name: &str| summary.iter().find(|(known, _)| *known == name).unwrap().1.clone();
    assert!(told("elements").parse::<u32>().unwrap() > told("patches").parse::<u32>().unwrap());
    assert!(told("patch memory").ends_with(" MiB"));
    assert_eq!(job.session.state().film.sample_count(), 16 * 16, "one for each pixel, at all wavelengths");
    let files = job.session.integrator().files();
    let [OutputFile { path, contents }] = &files[..] else { panic!("one file") };
    assert_eq!(path, Path::new("somewhere/room.ply"));
    let mesh = read_ply(contents).unwrap();
    assert!(mesh.quads.is_empty() && mesh.triangles.len() > 1000);
    // In the world's coordinates, within the room.
    let inside = mesh.positions.iter().all(|p| {
        p.cmpge(alhazen::math::Vec3::splat(-1e-4)).all() && p.cmple(alhazen::math::Vec3::splat(6.001)).all()
    });
    assert!(inside);
    let area = |triangle: &[u32; 3]| {
        let [a, b, c] = triangle.map(|i| mesh.positions[i as usize]);
        0.5 * (b - a).cross(c - a).length()
    };
    let walls = 2.0 * (5.0 * 6.0 + 5.0 * 2.7 + 6.0 * 2.7);
    assert!(mesh.triangles.iter().map(area).sum::<f32>() > walls);
}
