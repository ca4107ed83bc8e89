//! Sketches: like the picture, without changing it.

use std::path::Path;
use std::sync::atomic::Ordering;

use alhazen::assets::Files;
use alhazen::image::{Image, Window};
use alhazen::import::import;
use alhazen::integrators::Control;
use alhazen::{Job, Overrides};

use crate::common::rgb_values;

/// A render of a small scene of all diffuse surfaces, with changes.
fn job(integrator: &str, overrides: Overrides) -> Job {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/cornell-box.pbrt");
    let mut desc = import(scene, &Files).desc;
    let overrides =
        Overrides { integrator: Some(integrator.into()), samples_per_pixel: Some(1), ..overrides };
    overrides.apply(&mut desc).unwrap();
    Job::compile(desc).unwrap().job
}

/// A picture whose sides are not multiples of the sketch's pixel size.
fn whole() -> Overrides {
    of_depth("3", Overrides { resolution: Some([401, 299]), ..Overrides::default() })
}

/// A crop that starts and ends between pixels of its sketch.
fn part() -> Overrides {
    let crop = Some([0.25, 0.87, 0.0053, 0.69]);
    of_depth("3", Overrides { resolution: Some([601, 451]), crop, ..Overrides::default() })
}

fn of_depth(depth: &str, overrides: Overrides) -> Overrides {
    let settings = [("maxdepth", depth), ("filter", "box"), ("savefp16", "false")];
    let settings = settings.map(|(name, value)| (name.into(), value.into())).to_vec();
    Overrides { settings, ..overrides }
}

fn sketch(job: &mut Job) -> Option<Image> {
    job.sketch(&Control::default())
}

/// The mean of each of 3 × 3 parts.
fn means(image: &Image) -> [f64; 9] {
    let (width, height) = (image.width() as usize, image.height() as usize);
    let (mut sums, mut counts) = ([0.0; 9], [0.0; 9]);
    for (i, value) in rgb_values(image).enumerate() {
        let (x, y) = (i / 3 % width, i / 3 / width);
        let part = 3 * y / height * 3 + 3 * x / width;
        sums[part] += value;
        counts[part] += 1.0;
    }
    std::array::from_fn(|part| sums[part] / counts[part])
}

#[test]
fn a_sketch_has_the_means_of_the_picture() {
    for overrides in [whole(), part()] {
        let mut path = job("path", overrides.clone());
        path.render(&Control::default()).unwrap();
        let picture = path.picture().unwrap();
        let expected = means(&picture);
        // Markov chains are correlated, the photons of a pass have four wavelengths, and large
        // patches blur shadows.
        for (integrator, tolerance) in [
            ("path", 0.2),
            ("light-tracing", 0.2),
            ("bdpt", 0.2),
            ("mlt", 0.5),
            ("photon-mapping", 0.5),
            ("sppm", 0.5),
            ("vcm", 0.5),
            ("radiosity", 0.5),
        ] {
            let sketch = sketch(&mut job(integrator, overrides.clone())).unwrap();
            assert_eq!(
                (sketch.data_window(), sketch.display_window()),
                (picture.data_window(), picture.display_window())
            );
            for (part, (found, expected)) in means(&sketch).into_iter().zip(expected).enumerate() {
                let error = (found / expected - 1.0).abs();
                assert!(error < tolerance, "{integrator}, part {part}: {found}, not {expected}");
            }
        }
    }
}

#[test]
fn a_sketch_has_media() {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes/fog.pbrt");
    let mut desc = import(scene, &Files).desc;
    Overrides { samples_per_pixel: Some(1), resolution: Some([320, 320]), ..Overrides::default() }
        .apply(&mut desc)
        .unwrap();
    let mut job = Job::compile(desc).unwrap().job;
    let sketch = sketch(&mut job).unwrap();
    job.render(&Control::default()).unwrap();
    let [found, expected] = [&sketch, &job.picture().unwrap()].map(|image| means(image).iter().sum::<f64>());
    assert!((found / expected - 1.0).abs() < 0.1, "{found}, not {expected}");
}

/// The centroid of the picture, in pixels.
fn middle(image: &Image) -> [f64; 2] {
    let width = image.width() as usize;
    let mut sums = [0.0; 3];
    for (i, value) in rgb_values(image).enumerate() {
        let (x, y) = (i / 3 % width, i / 3 / width);
        [1.0, x as f64, y as f64].into_iter().zip(&mut sums).for_each(|(part, sum)| *sum += part * value);
    }
    [sums[1] / sums[0], sums[2] / sums[0]]
}

#[test]
fn a_sketch_has_the_positions_of_the_picture() {
    for overrides in [whole(), part()] {
        // Only the light.
        let mut job = job("path", of_depth("0", overrides));
        let sketch = sketch(&mut job).unwrap();
        job.render(&Control::default()).unwrap();
        let [found, expected] = [&sketch, &job.picture().unwrap()].map(middle);
        assert!((0..2).all(|axis| (found[axis] - expected[axis]).abs() < 0.5), "{found:?}, not {expected:?}");
    }
}

#[test]
fn a_sketch_has_large_pixels() {
    let sketch = sketch(&mut job("random-walk", part())).unwrap();
    let Window { min, .. } = sketch.data_window();
    // Two pixels of the picture lie in one of the sketch.
    assert_eq!(min, [151, 3]);
    let same = |x: u32, y: u32| (0..4).all(|i| sketch.rgb(x + i % 2, y + i / 2) == sketch.rgb(x, y));
    let (columns, rows) = (1..sketch.width() - 1, 1..sketch.height() - 1);
    assert!(columns.step_by(2).all(|x| rows.clone().step_by(2).all(|y| same(x, y))));
}

#[test]
fn a_sketch_does_not_change_the_picture() {
    for integrator in ["path", "light-tracing", "mlt"] {
        let rendered = |with_sketch: bool| {
            let mut job = job(integrator, whole());
            assert!(!with_sketch || sketch(&mut job).is_some());
            job.render(&Control::default()).unwrap();
            let bits: Vec<u32> = job.picture().unwrap().values().map(f32::to_bits).collect();
            let progress = job.session.progress();
            (bits, progress.stats, progress.samples, job.session.integrator().summary())
        };
        assert!(rendered(true) == rendered(false), "{integrator}");
    }
}

#[test]
fn small_pictures_and_cancelled_renders_have_no_sketch() {
    let small = Overrides { resolution: Some([256, 256]), ..Overrides::default() };
    assert!(sketch(&mut job("path", small)).is_none());
    let few = Overrides { resolution: Some([4000, 4000]), pixel: Some([3999, 7]), ..Overrides::default() };
    assert!(sketch(&mut job("path", few)).is_none());
    let cancelled = Control::default();
    cancelled.cancel.store(true, Ordering::Relaxed);
    assert!(job("path", whole()).sketch(&cancelled).is_none());
}
