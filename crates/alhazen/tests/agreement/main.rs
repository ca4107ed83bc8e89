//! Algorithms that claim the same light, against each other: pictures of small scenes, part by part and as a whole.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

#[path = "../common/mod.rs"]
mod common;
mod promises;
mod scenes;

use alhazen::Overrides;
use alhazen::image::Image;
use testkit::{Moments, welch_test};

use common::{render_text, rgb_values};
use scenes::{SCENES, Scene};

/// Pictures of each algorithm, with a seed each.
const RUNS: i32 = 16;

/// Side of the squares of pixels that are compared, as single ones are too far from normally distributed.
const SIDE: usize = 5;

/// The statistics of pictures: of the mean of each channel, over all and over each square.
struct Pictures(Vec<Moments>);

impl Pictures {
    fn new(scene: &Scene, integrator: &str, samples: u32, first_seed: i32) -> Self {
        let text = scene.text();
        let mut pictures = Self(Vec::new());
        for seed in first_seed..first_seed + RUNS {
            let overrides = Overrides {
                integrator: Some(integrator.into()),
                settings: vec![("maxdepth".into(), scene.max_depth.to_string())],
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

    /// What differs from other pictures beyond chance, as one of `tests` pairs.
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

/// Holds an algorithm to path tracing on every scene that it can see all of.
fn assert_agrees(integrator: &str, samples: u32, can: impl Fn(&Scene) -> bool) {
    let scenes: Vec<_> = SCENES.iter().filter(|scene| can(scene)).collect();
    let mut failures = Vec::new();
    for scene in &scenes {
        let reference = Pictures::new(scene, "vol-path", scene.path_samples, 1000);
        let found = Pictures::new(scene, integrator, samples, 0);
        let differences = found.differences(&reference, scenes.len());
        failures.extend(differences.into_iter().map(|text| format!("{}, {text}", scene.name)));
    }
    assert!(failures.is_empty(), "{integrator} in\n{}", failures.join("\n"));
}

#[test]
fn bidirectional_paths_find_what_path_tracing_finds() {
    assert_agrees("bdpt", 8, |_| true);
}

#[test]
fn light_finds_what_path_tracing_finds() {
    assert_agrees("light-tracing", 16, |scene| !scene.has_mirrors);
}
