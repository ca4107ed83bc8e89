//! Integrators with the same expected value against each other: pictures of small scenes, as a
//! whole and by squares.

mod contract;
mod means;
mod scenes;

use std::sync::OnceLock;

use alhazen::Overrides;
use alhazen::image::Image;
use testkit::{Moments, welch_test};

use crate::common::{render_text, rgb_values};
use scenes::{MEDIA, POINT_LIGHT_IN_GLASS, SCENES, Scene};

/// Pictures of each algorithm, with a seed each.
const RUNS: i32 = 16;

/// How closely pictures are compared. The means of squares of pixels are, as single ones are too
/// far from normally distributed; a square has as many samples in both.
#[derive(Clone, Copy)]
enum Precision {
    /// A quarter of the samples, in squares of four times as many pixels: what every run can wait
    /// for.
    Coarse,
    /// All samples, which halve the error of a picture's mean.
    Fine,
}

impl Precision {
    /// The side of the squares.
    fn side(self) -> usize {
        match self {
            Self::Coarse => 10,
            Self::Fine => 5,
        }
    }

    fn samples(self, samples: u32) -> u32 {
        match self {
            Self::Coarse => samples / 4,
            Self::Fine => samples,
        }
    }
}

/// The statistics of pictures: of the mean of each channel, over all and over each square.
struct Pictures(Vec<Moments>);

impl Pictures {
    fn new(
        precision: Precision,
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
                samples_per_pixel: Some(precision.samples(samples)),
                seed: Some(seed),
                ..Overrides::default()
            };
            let means = means(&render_text(&text, &overrides), precision.side());
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
fn means(picture: &Image, side: usize) -> Vec<f64> {
    let (width, height) = (picture.width() as usize, picture.height() as usize);
    let squares = (width / side) * (height / side);
    let mut sums = vec![0.0; 3 * (1 + squares)];
    for (index, value) in rgb_values(picture).enumerate() {
        let (pixel, channel) = (index / 3, index % 3);
        let square = pixel / width / side * (width / side) + pixel % width / side;
        sums[channel] += value / squares as f64;
        sums[3 * (1 + square) + channel] += value;
    }
    sums.iter().map(|sum| sum / (side * side) as f64).collect()
}

/// The statistics of path tracing for each scene.
fn references(precision: Precision) -> &'static [Pictures] {
    static REFERENCES: [OnceLock<Vec<Pictures>>; 2] = [const { OnceLock::new() }; 2];
    REFERENCES[precision as usize].get_or_init(|| {
        let reference =
            |scene: &Scene| Pictures::new(precision, scene, "vol-path", &[], scene.path_samples, 1000);
        SCENES.iter().chain(&MEDIA).map(reference).collect()
    })
}

/// An algorithm that is compared with path tracing.
struct Compared {
    integrator: &'static str,
    settings: &'static [(&'static str, &'static str)],
    samples: u32,
    /// The scenes that it can render completely.
    can: fn(&Scene) -> bool,
}

impl Compared {
    /// Pictures of all its scenes, each with the reference.
    fn pictures(
        &self,
        precision: Precision,
    ) -> impl Iterator<Item = (&'static Scene, Pictures, &'static Pictures)> {
        let scenes = SCENES.iter().chain(&MEDIA).zip(references(precision));
        scenes.filter(|(scene, _)| (self.can)(scene)).map(move |(scene, reference)| {
            let found = Pictures::new(precision, scene, self.integrator, self.settings, self.samples, 0);
            (scene, found, reference)
        })
    }

    /// Tests all means of parts of pictures.
    fn assert_agrees(&self, precision: Precision) {
        let scenes = SCENES.iter().chain(&MEDIA).filter(|scene| (self.can)(scene)).count();
        let failures = self.pictures(precision).flat_map(|(scene, found, reference)| {
            let differences = found.differences(reference, scenes);
            differences.into_iter().map(|text| format!("{}, {text}", scene.name))
        });
        self.assert_none(failures);
    }

    /// Tests the means of pictures, up to a blur.
    fn assert_nearly_agrees(&self, precision: Precision) {
        let mut failures = Vec::new();
        for (scene, found, reference) in self.pictures(precision) {
            for (channel, (a, b)) in found.0.iter().zip(&reference.0).take(3).enumerate() {
                let error = a.mean / b.mean - 1.0;
                let deviation = (a.variance_of_mean() + b.variance_of_mean()).sqrt() / b.mean;
                if error.abs() > BLUR + 4.0 * deviation {
                    failures.push(format!("{}, channel {channel}: {error} ± {deviation}", scene.name));
                }
            }
        }
        self.assert_none(failures.into_iter());
    }

    fn assert_none(&self, failures: impl Iterator<Item = String>) {
        let failures: Vec<_> = failures.collect();
        assert!(failures.is_empty(), "{} in\n{}", self.integrator, failures.join("\n"));
    }
}

/// How far the mean of photon mapping's pictures may be from that of path tracing's, beyond chance:
/// photons are blurred.
const BLUR: f64 = 0.02;

/// The leaks of photons through what has no thickness, within the radius.
fn leaks(scene: &Scene) -> bool {
    ["a door that is almost closed", "a plane without end"].contains(&scene.name)
}

fn in_media(scene: &Scene) -> bool {
    MEDIA.iter().any(|medium| medium.name == scene.name)
}

fn bdpt(precision: Precision) {
    Compared { integrator: "bdpt", settings: &[], samples: 8, can: |_| true }.assert_agrees(precision);
}

fn light_tracing(precision: Precision) {
    let can = |scene: &Scene| !scene.is_hidden_from_light;
    Compared { integrator: "light-tracing", settings: &[], samples: 16, can }.assert_agrees(precision);
}

fn vcm(precision: Precision) {
    let settings = &[("radius", "0.03")];
    Compared { integrator: "vcm", settings, samples: 8, can: |_| true }.assert_agrees(precision);
}

fn sppm(precision: Precision) {
    let settings = &[("radius", "0.03"), ("photons", "4000")];
    let can = |scene: &Scene| !leaks(scene) && !in_media(scene);
    Compared { integrator: "sppm", settings, samples: 8, can }.assert_agrees(precision);
}

fn sppm_in_media(precision: Precision) {
    // In the small balls of a strict test photons are too few to be normally distributed.
    let settings = &[("radius", "0.1"), ("photons", "8000")];
    Compared { integrator: "sppm", settings, samples: 8, can: in_media }.assert_nearly_agrees(precision);
}

fn photon_mapping(precision: Precision) {
    let settings = &[("photons", "2000"), ("causticphotons", "2000"), ("nearest", "20"), ("radius", "0.1")];
    let can = |scene: &Scene| !leaks(scene);
    Compared { integrator: "photon-mapping", settings, samples: 8, can }.assert_nearly_agrees(precision);
}

fn mlt(precision: Precision) {
    // Where few paths carry light, the squares of so few chains are too far from normally
    // distributed.
    let can = |scene: &Scene| scene.name != "a door that is almost closed";
    let settings = match precision {
        Precision::Coarse => &[("bootstrapsamples", "25000")],
        Precision::Fine => &[("bootstrapsamples", "100000")],
    };
    Compared { integrator: "mlt", settings, samples: 32, can }.assert_agrees(precision);
}

fn delta_lights(precision: Precision) {
    let scene = &POINT_LIGHT_IN_GLASS;
    let reference = Pictures::new(precision, scene, "light-tracing", &[], 32, 1000);
    // So many that each square gets photons in most pictures, as its means have to be normal.
    let photons = [("radius", "0.03"), ("photons", "40000")];
    for (integrator, settings) in [("bdpt", &[][..]), ("vcm", &photons[..1]), ("sppm", &photons)] {
        let found = Pictures::new(precision, scene, integrator, settings, 16, 0);
        let differences = found.differences(&reference, 3);
        assert!(differences.is_empty(), "{integrator}: {}", differences.join("\n"));
    }
    let lost = Pictures::new(precision, scene, "path", &[], 4, 0);
    assert!(lost.0.iter().all(|moments| moments.mean == 0.0));
}

#[test]
fn bdpt_agrees_with_path_tracing() {
    bdpt(Precision::Coarse);
}

#[test]
fn light_tracing_agrees_with_path_tracing() {
    light_tracing(Precision::Coarse);
}

#[test]
fn vcm_agrees_with_path_tracing() {
    vcm(Precision::Coarse);
}

#[test]
fn sppm_agrees_with_path_tracing() {
    sppm(Precision::Coarse);
}

#[test]
fn light_paths_agree_on_caustics_of_delta_lights() {
    delta_lights(Precision::Coarse);
}

#[test]
fn photon_mapping_nearly_agrees_with_path_tracing() {
    photon_mapping(Precision::Coarse);
}

#[test]
fn sppm_nearly_agrees_with_path_tracing_in_media() {
    sppm_in_media(Precision::Coarse);
}

#[test]
fn mlt_agrees_with_path_tracing() {
    mlt(Precision::Coarse);
}

#[test]
#[ignore = "slow: three minutes of one core"]
fn all_agree_with_path_tracing_in_small_squares() {
    for compare in [bdpt, light_tracing, vcm, sppm, delta_lights, photon_mapping, sppm_in_media, mlt] {
        compare(Precision::Fine);
    }
}
