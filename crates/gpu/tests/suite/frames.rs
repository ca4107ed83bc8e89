//! Pictures that are made at once.

use std::path::Path;
use std::sync::{Arc, OnceLock};

use alhazen_gpu::{Algorithm, Kernels, Realtime, Weights};
use description::TransformDesc;
use image::Image;
use math::{DMat4, DVec3};
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::View;

use crate::kernels::common;
use crate::pictures::{Case, SAMPLES};

/// The kernels of frames.
pub fn kernels() -> Option<Arc<Kernels>> {
    static KERNELS: OnceLock<Option<Arc<Kernels>>> = OnceLock::new();
    KERNELS.get_or_init(|| crate::device().map(|device| Arc::new(Kernels::new(device)))).clone()
}

fn realtime(case: &Case, kernels: &Arc<Kernels>, algorithm: &Algorithm) -> Realtime {
    sharing(case, kernels, algorithm, None)
}

/// The same, with samples of direct light that pixels and frames share.
pub fn sharing(
    case: &Case,
    kernels: &Arc<Kernels>,
    algorithm: &Algorithm,
    shared: Option<Weights>,
) -> Realtime {
    let ray_queries = kernels.device().has_ray_queries();
    let mut flat = case.flattened(algorithm, ray_queries).unwrap_or_else(|refusals| panic!("{refusals:?}"));
    flat.set_parts(common(flat.parts()));
    let mut realtime =
        Realtime::new(kernels.clone(), &flat, algorithm, shared).expect("a scene on the device");
    realtime.aim(&case.view, case.film().pixel_bounds()).expect("a camera");
    realtime
}

/// The picture of a camera at rest is that of the CPU: its samples have the same random numbers.
#[test]
fn a_camera_at_rest_gets_the_picture_of_the_cpu() {
    let Some(kernels) = kernels() else { return };
    for name in ["cornell-box", "depth-of-field", "prism"] {
        let case = Case::named(name);
        let algorithm = Algorithm::Path(case.path());
        let mut realtime = realtime(&case, &kernels, &algorithm);
        let mut shown = None;
        for sample in 1..=SAMPLES {
            shown = realtime.resting(1, sample == SAMPLES).expect("a frame");
        }
        let shown = shown.expect("a picture");
        assert_eq!(realtime.rested(), SAMPLES);
        assert!(shown.rays >= shown.pixels.len() as u64 / 4, "{} rays", shown.rays);
        let cpu: Vec<f32> = case.on_cpu(&algorithm, SAMPLES).values().collect();
        let mean = cpu.iter().sum::<f32>() / cpu.len() as f32;
        let pairs = shown.pixels.as_flattened().iter().zip(&cpu);
        let apart = |(a, b): &(&f32, &f32)| (*a - *b).abs() > 1e-3 * b.abs().max(mean / 10.0);
        let other = pairs.clone().filter(apart).count() as f32 / cpu.len() as f32;
        let difference = pairs.map(|(a, b)| a - b).sum::<f32>() / cpu.len() as f32 / mean;
        println!("{name}: {other:.4} apart, the mean by {difference:+.1e}, {:?}", shown.stages);
        assert!(other < 0.01 && difference.abs() < 5e-3, "{name}: {other} apart, by {difference}");
    }
}

/// A view of a case whose camera has moved to the right by a part of the scene's size.
pub fn moved(case: &Case, part: f64) -> View {
    let mut desc = case.desc.clone();
    let by = DVec3::new(-part * f64::from(case.scene.sphere().radius), 0.0, 0.0);
    let home = case.desc.camera.value.camera_from_world.start;
    desc.camera.value.camera_from_world = TransformDesc::fixed(DMat4::from_translation(by) * home);
    View::compile(&desc, case.scene.world_from_render()).expect("a view").view
}

/// The pixels of a picture.
pub fn colors(picture: &Image) -> Vec<[f32; 3]> {
    let values: Vec<f32> = picture.values().collect();
    values.as_chunks().0.to_vec()
}

/// The mean of squared errors relative to the reference, but for the pixels with the largest ones.
pub fn rel_mse(picture: &[[f32; 3]], reference: &[[f32; 3]]) -> f32 {
    let pairs = picture.as_flattened().iter().zip(reference.as_flattened());
    let mut errors: Vec<f32> = pairs.map(|(a, b)| (a - b).powi(2) / (b * b + 1e-2)).collect();
    errors.sort_by(f32::total_cmp);
    let kept = errors.len() - errors.len() / 100;
    errors[..kept].iter().sum::<f32>() / kept as f32
}

/// Writes pictures side by side, enlarged, into the folder of `ALHAZEN_PICTURES`, if that is set.
fn save(name: &str, pictures: &[&[[f32; 3]]], [width, height]: [u32; 2]) {
    let Ok(folder) = std::env::var("ALHAZEN_PICTURES") else { return };
    const ZOOM: u32 = 6;
    let all = width * pictures.len() as u32;
    let at = |x: u32, y: u32| {
        let (x, y) = (x / ZOOM, y / ZOOM);
        pictures[(x / width) as usize][(y * width + x % width) as usize]
    };
    let picture = Image::from_fn(ZOOM * all, ZOOM * height, ["R", "G", "B"], at);
    image::write(&picture, Path::new(&folder).join(name), &Default::default()).expect("a file");
}

/// Pictures of a moving camera have errors several times as small as their samples have, and those
/// of a camera at rest begin with less error and end with that of their samples.
#[test]
fn pictures_in_motion_are_better_than_their_samples() {
    let Some(kernels) = kernels() else { return };
    let mut case = Case::named("cornell-box");
    // Frames in motion see the middles of pixels, so that the whole error is that of light.
    case.desc.options.disable_pixel_jitter = true;
    case.view = moved(&case, 0.0);
    let algorithm = Algorithm::Path(case.path());
    let mut realtime = realtime(&case, &kernels, &algorithm);
    let pixels = case.film().pixel_bounds();
    let at_rest = |realtime: &mut Realtime, samples: u32| -> Vec<[f32; 3]> {
        realtime.resting(samples, true).expect("a frame").expect("a picture").pixels
    };
    let mut frames = Vec::new();
    const FRAMES: u32 = 12;
    for frame in 0..FRAMES {
        let view = moved(&case, 0.01 * f64::from(frame));
        realtime.aim(&view, pixels).expect("a camera");
        frames.push(realtime.moving(1).expect("a frame").expect("a picture"));
    }
    let first_at_rest = at_rest(&mut realtime, 1);
    // Another camera first, so that no filtered picture takes part.
    let mut plain = self::realtime(&case, &kernels, &algorithm);
    plain.aim(&moved(&case, 0.01 * f64::from(FRAMES - 1)), pixels).expect("a camera");
    let one = at_rest(&mut plain, 1);
    // The references have less than a hundredth of the error of a sample.
    case.sampler = Sampler::Independent(Independent::new(256, 9));
    let [reference_of_first, reference] = [0, FRAMES - 1].map(|frame| {
        case.view = moved(&case, 0.01 * f64::from(frame));
        colors(&case.on_cpu(&algorithm, 256))
    });
    let filtered = &frames[FRAMES as usize - 1];
    save("motion.png", &[&one, &frames[0].pixels, &filtered.pixels, &reference], [64, 48]);
    let errors = [&one, &filtered.pixels, &first_at_rest];
    println!("{:?}", filtered.stages);
    let [one, filtered, resting] = errors.map(|picture| rel_mse(picture, &reference));
    let first = rel_mse(&frames[0].pixels, &reference_of_first);
    println!("1 sample {one:.4}, first frame {first:.4}, filtered {filtered:.4}, first at rest {resting:.4}");
    assert!(filtered < one / 6.0 && first < one / 4.0 && resting < one / 6.0);
}
