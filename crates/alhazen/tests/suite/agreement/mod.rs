//! Integrators with the same expected value against each other: pictures of small scenes, as a
//! whole and by squares.

mod contract;
mod means;
mod scenes;

use std::sync::LazyLock;

use alhazen::Overrides;
use alhazen::image::Image;
use testkit::{Moments, welch_test};

use crate::common::{render_text, rgb_values};
use scenes::{MEDIA, POINT_LIGHT_IN_GLASS, SCENES, Scene};

/// Pictures of each algorithm, with a seed each.
const RUNS: i32 = 16;

/// Side of the squares of pixels that are compared, as single ones are too far from normally
/// distributed.
const SIDE: usize = 5;

/// The statistics of pictures: of the mean of each channel, over all and over each square.
struct Pictures(Vec<Moments>);

impl Pictures {
    fn new(
        scene: &Scene,
        integrator: &str,
        settings: &[(&str, &str)],
        samples: u32,
        first_seed: i32,
    ) -> Self {
        let text = scene.text();
        let mut pictures = Self(Vec::new());
        for seed in first_seed..first_seed + RUNS {
            let max_depth = scene.max_depth.to_string();
            let max_depth = [("maxdepth", max_depth.as_str())];
            let settings = settings.iter().chain(&max_depth);
            let overrides = Overrides {
                integrator: Some(integrator.into()),
                settings: settings.map(|&(name, value)| (name.into(), value.into())).collect(),
                samples_per_pixel: Some(samples),
                seed: Some(seed),
                ..Overrides::default()
            };
            let means = means(&render_text(&text, &overrides));
            pictures.0.resize(means.len(), Moments::default());
            pictures.0.iter_mut().zip(means).for_each(|(moments, mean)| moments.push(mean));
        }
        pictures
    }

    /// The significant differences from other pictures, as one of `tests` pairs.
    fn differences(&self, other: &Self, tests: usize) -> Vec<String> {
        let pairs = self.0.iter().zip(&other.0).enumerate();
        let tested = pairs.filter_map(|(index, (a, b))| {
            let difference = welch_test(a, b, self.0.len() * tests).err()?;
            Some(format!("channel {} of part {}: {difference}", index % 3, index / 3))
        });
        tested.collect()
    }
}

/// Means of the channels over a picture, then over its squares.
fn means(picture: &Image) -> Vec<f64> {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let squares = (width / SIDE) * (height / SIDE);
    let mut sums = vec![0.0; 3 * (1 + squares)];
    for (index, value) in rgb_values(picture).enumerate() {
        let (pixel, channel) = (index / 3, index % 3);
        let square = pixel / width / SIDE * (width / SIDE) + pixel % width / SIDE;
        sums[channel] += value / squares as f64;
        sums[3 * (1 + square) + channel] += value;
    }
    sums.iter().map(|sum| sum / (SIDE * SIDE) as f64).collect()
}

/// The statistics of path tracing for each scene.
static REFERENCES: LazyLock<Vec<Pictures>> = LazyLock::new(|| {
    let reference = |scene: &Scene| Pictures::new(scene, "vol-path", &[], scene.path_samples, 1000);
    SCENES.iter().chain(&MEDIA).map(reference).collect()
});

/// Tests an integrator against path tracing on every scene that it can render completely.
fn assert_agrees(integrator: &str, settings: &[(&str, &str)], samples: u32, can: impl Fn(&Scene) -> bool) {
    let scenes: Vec<_> =
        SCENES.iter().chain(&MEDIA).zip(&*REFERENCES).filter(|(scene, _)| can(scene)).collect();
    let mut failures = Vec::new();
    for &(scene, reference) in &scenes {
        let found = Pictures::new(scene, integrator, settings, samples, 0);
        let differences = found.differences(reference, scenes.len());
        failures.extend(differences.into_iter().map(|text| format!("{}, {text}", scene.name)));
    }
    assert!(failures.is_empty(), "{integrator} in\n{}", failures.join("\n"));
}

#[test]
fn bdpt_agrees_with_path_tracing() {
    assert_agrees("bdpt", &[], 8, |_| true);
}

#[test]
fn light_tracing_agrees_with_path_tracing() {
    assert_agrees("light-tracing", &[], 16, |scene| !scene.is_hidden_from_light);
}

#[test]
fn vcm_agrees_with_path_tracing() {
    assert_agrees("vcm", &[("radius", "0.03")], 8, |_| true);
}

#[test]
fn sppm_agrees_with_path_tracing() {
    // Photons on one side of a wall without thickness leak to the other, within the radius.
    let leaks = ["a door that is almost closed", "a plane without end"];
    let can =
        |scene: &Scene| !leaks.contains(&scene.name) && MEDIA.iter().all(|medium| medium.name != scene.name);
    assert_agrees("sppm", &[("radius", "0.03"), ("photons", "4000")], 8, can);
}

#[test]
fn light_paths_agree_on_caustics_of_delta_lights() {
    let scene = &POINT_LIGHT_IN_GLASS;
    let reference = Pictures::new(scene, "light-tracing", &[], 32, 1000);
    // So many that each square gets photons in most pictures, as its means have to be normal.
    let photons = [("radius", "0.03"), ("photons", "40000")];
    for (integrator, settings) in [("bdpt", &[][..]), ("vcm", &photons[..1]), ("sppm", &photons)] {
        let differences = Pictures::new(scene, integrator, settings, 16, 0).differences(&reference, 3);
        assert!(differences.is_empty(), "{integrator}: {}", differences.join("\n"));
    }
    let lost = Pictures::new(scene, "path", &[], 4, 0);
    assert!(lost.0.iter().all(|moments| moments.mean == 0.0));
}

/// How far the mean of photon mapping's pictures may be from that of path tracing's, beyond chance:
/// photons are blurred.
const BLUR: f64 = 0.02;

/// Tests the means of an integrator's pictures against path tracing's on every scene that it can
/// render completely.
fn assert_nearly_agrees(integrator: &str, settings: &[(&str, &str)], can: impl Fn(&Scene) -> bool) {
    let scenes = SCENES.iter().chain(&MEDIA).zip(&*REFERENCES).filter(|(scene, _)| can(scene));
    let mut failures = Vec::new();
    for (scene, reference) in scenes {
        let found = Pictures::new(scene, integrator, settings, 8, 0);
        for (channel, (a, b)) in found.0.iter().zip(&reference.0).take(3).enumerate() {
            let error = a.mean / b.mean - 1.0;
            let deviation = (a.variance_of_mean() + b.variance_of_mean()).sqrt() / b.mean;
            if error.abs() > BLUR + 4.0 * deviation {
                failures.push(format!("{}, channel {channel}: {error} ± {deviation}", scene.name));
            }
        }
    }
    assert!(failures.is_empty(), "{integrator} in\n{}", failures.join("\n"));
}

#[test]
fn photon_mapping_nearly_agrees_with_path_tracing() {
    // Photons leak under the door.
    let can = |scene: &Scene| !["a door that is almost closed", "a plane without end"].contains(&scene.name);
    let settings = [("photons", "2000"), ("causticphotons", "2000"), ("nearest", "20"), ("radius", "0.1")];
    assert_nearly_agrees("photon-mapping", &settings, can);
}

#[test]
fn sppm_nearly_agrees_with_path_tracing_in_media() {
    // In the small balls of a strict test photons are too few to be normally distributed.
    let in_media = |scene: &Scene| MEDIA.iter().any(|medium| medium.name == scene.name);
    assert_nearly_agrees("sppm", &[("radius", "0.1"), ("photons", "8000")], in_media);
}

#[test]
fn mlt_agrees_with_path_tracing() {
    // Where few paths carry light, the squares of so few chains are too far from normally
    // distributed.
    assert_agrees("mlt", &[], 32, |scene| scene.name != "a door that is almost closed");
}
