//! Direct light by samples that pixels and frames share, beside that of paths.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use alhazen_gpu::{Algorithm, Kernels, Realtime, Weights};
use assets::{Files, MemoryAssets};
use description::PathDesc;
use sampling::Sampler;
use sampling::sampler::Independent;
use scene::View;
use testkit::{Moments, welch_test};

use crate::frames::{colors, kernels, moved, rel_mse, sharing};
use crate::pictures::Case;

/// A floor with walls between lights of many strengths, in a row of rows.
fn lights(rows: u32) -> String {
    let mut text = String::from(
        "LookAt 0 6 -9  0 0 0  0 1 0\nCamera \"perspective\" \"float fov\" 45\n\
         PixelFilter \"box\" \"float xradius\" 0.5 \"float yradius\" 0.5\nWorldBegin\n\
         Material \"diffuse\" \"rgb reflectance\" [0.6 0.5 0.4]\n\
         Shape \"bilinearmesh\" \"point3 P\" [-8 0 -8  8 0 -8  -8 0 8  8 0 8]\n\
         Material \"conductor\" \"float roughness\" 0.3\n\
         Shape \"bilinearmesh\" \"point3 P\" [-2 0 1  -1 0 -1  -2 2 1  -1 2 -1]\n\
         Shape \"bilinearmesh\" \"point3 P\" [2 0 -2  1 0 1  2 2 -2  1 2 1]\n\
         Material \"diffuse\"\n",
    );
    for i in 0..rows * rows {
        let [x, z] = [i % rows, i / rows].map(|k| 6.0 * (f64::from(k) + 0.5) / f64::from(rows) - 3.0);
        let power = 40.0 * f64::from(1 + i * 7 % 11) / 9.0;
        let size = 0.3 / f64::from(rows);
        let height = 0.4 + 0.2 * f64::from(i % 3);
        writeln!(
            text,
            "AttributeBegin\nAreaLightSource \"diffuse\" \"rgb L\" [{} {power} {}]\n\
             Shape \"bilinearmesh\" \"point3 P\" [{} {height} {}  {} {height} {}  {} {height} {}  {} {height} {}]\n\
             AttributeEnd",
            power * f64::from(1 + i % 2), power * 0.8,
            x - size, z - size, x + size, z - size, x - size, z + size, x + size, z + size,
        )
        .expect("text");
    }
    text
}

/// A picture of the middles of pixels, as frames in motion see them.
fn case(rows: u32, size: [usize; 2]) -> Case {
    let path = Path::new("scene.pbrt");
    let assets = MemoryAssets::default().with(path, lights(rows));
    let mut case = Case::sized(path, &assets, size.map(|side| side as u32));
    case.desc.options.disable_pixel_jitter = true;
    case.view = moved(&case, 0.0);
    case
}

/// Direct light alone.
fn direct(case: &Case) -> Algorithm {
    Algorithm::Path(PathDesc { max_depth: 1, ..case.path() })
}

const BLOCK: usize = 8;
const SIZE: [usize; 2] = [32, 24];

/// The mean of each block of pixels, and that of all.
pub fn means(pixels: &[[f32; 3]], width: usize) -> Vec<f64> {
    let columns = width / BLOCK;
    let mut sums = vec![0.0; pixels.len() / (BLOCK * BLOCK)];
    for (i, pixel) in pixels.iter().enumerate() {
        let block = i / width / BLOCK * columns + i % width / BLOCK;
        sums[block] += pixel.iter().map(|&c| f64::from(c)).sum::<f64>() / (3 * BLOCK * BLOCK) as f64;
    }
    sums.push(sums.iter().sum::<f64>() / sums.len() as f64);
    sums
}

/// The means of many independent pictures.
pub fn moments(pictures: impl Iterator<Item = Vec<f64>>) -> Vec<Moments> {
    let mut moments = Vec::new();
    for means in pictures {
        moments.resize(means.len(), Moments::default());
        moments.iter_mut().zip(means).for_each(|(moments, mean)| moments.push(mean));
    }
    moments
}

/// Some pictures by paths of the CPU, of so many samples of each pixel.
fn by_paths(case: &mut Case, count: u32, samples: u32) -> Vec<Moments> {
    let algorithm = direct(case);
    let width = case.desc.film.resolution[0] as usize;
    moments((0..count).map(|seed| {
        case.sampler = Sampler::Independent(Independent::new(samples, 100 + seed));
        means(&colors(&case.on_cpu(&algorithm, samples)), width)
    }))
}

/// A frame from somewhere.
fn shown(realtime: &mut Realtime, case: &Case, view: &View) {
    realtime.aim(view, case.film().pixel_bounds()).expect("a camera");
    realtime.moving(1).expect("a frame").expect("a picture");
}

/// Some frames that share samples with two before, from a little to the side. What precedes these
/// sees nothing, so that frames are independent.
fn by_sharing(case: &Case, kernels: &Arc<Kernels>, weights: Weights, count: u32) -> Vec<Moments> {
    let mut realtime = sharing(case, kernels, &direct(case), Some(weights));
    let width = case.desc.film.resolution[0] as usize;
    let [nothing, near] = [20.0, 0.01].map(|part| moved(case, part));
    moments((0..count).map(|_| {
        for view in [&nothing, &near, &near, &case.view] {
            shown(&mut realtime, case, view);
        }
        means(&realtime.unfiltered().expect("light"), width)
    }))
}

/// Which means of two lists of pictures differ.
pub fn apart(a: &[Moments], b: &[Moments]) -> Vec<String> {
    a.iter().zip(b).filter_map(|(x, y)| welch_test(x, y, a.len()).err()).collect()
}

#[test]
fn shared_samples_have_the_mean_of_paths() {
    let Some(kernels) = kernels() else { return };
    let mut case = case(3, SIZE);
    // The mean of 64 frames has an error of 2.5 % in the unbiased form, whose frames have a
    // standard deviation of 20 %, as pixels near each other share samples; that of paths, 0.5 %. A
    // bias of an eighth is so found nine times of ten, by one of as many tests as there are means.
    let paths = by_paths(&mut case, 32, 16);
    let [unbiased, biased] =
        [Weights::Unbiased, Weights::Biased].map(|weights| by_sharing(&case, &kernels, weights, 64));
    let [of_paths, of_unbiased, of_biased] = [&paths, &unbiased, &biased].map(|list| list[list.len() - 1]);
    for whole in [of_unbiased, of_biased] {
        let error = (whole.variance_of_mean() + of_paths.variance_of_mean()).sqrt();
        println!("{:+.4} ± {:.4} of paths", whole.mean / of_paths.mean - 1.0, error / of_paths.mean);
    }
    let wrong = apart(&unbiased, &paths);
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
    assert!(of_biased.mean < of_paths.mean && welch_test(&of_biased, &of_paths, 1).is_err());
}

/// The picture of a camera that rests has the bits that it has without shared samples, also where
/// lights leave directions to the BSDF.
#[test]
fn a_camera_at_rest_shares_no_samples() {
    let Some(kernels) = kernels() else { return };
    let folder = concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes");
    let case = Case::sized(&Path::new(folder).join("environment.pbrt"), &Files, [16, 12]);
    let algorithm = direct(&case);
    let [plain, shared] = [None, Some(Weights::Unbiased)].map(|shared| {
        let mut realtime = sharing(&case, &kernels, &algorithm, shared);
        realtime.moving(1).expect("a frame").expect("a picture");
        let moving = realtime.unfiltered().expect("light");
        // So many samples that the filtered picture counts no more.
        let resting = realtime.resting(64, true).expect("a frame").expect("a picture").pixels;
        [moving, resting]
    });
    assert!(plain[0] != shared[0]);
    assert!(plain[1] == shared[1]);
}

/// The mean of squared errors of frames of so many lights in a row of rows, by each form of direct
/// light, as they are found and filtered; and how much darker the biased form is.
#[test]
#[ignore = "a measurement"]
fn error_of_a_thousand_lights() {
    let Some(kernels) = kernels() else { return };
    let mut case = case(32, [128, 96]);
    let algorithm = direct(&case);
    case.sampler = Sampler::Independent(Independent::new(1024, 5));
    let mut plain = sharing(&case, &kernels, &algorithm, None);
    let mut reference = Vec::new();
    while plain.rested() < 1024 {
        reference = plain.resting(128, true).expect("a frame").expect("a picture").pixels;
    }
    let mean = |pixels: &[[f32; 3]]| pixels.as_flattened().iter().map(|&c| f64::from(c)).sum::<f64>();
    for (name, shared) in
        [("path", None), ("unbiased", Some(Weights::Unbiased)), ("biased", Some(Weights::Biased))]
    {
        let mut realtime = sharing(&case, &kernels, &algorithm, shared);
        // The kernels are compiled by the first frame.
        shown(&mut realtime, &case, &moved(&case, 20.0));
        let mut sum = 0.0;
        for frame in 1..=16 {
            realtime.aim(&case.view, case.film().pixel_bounds()).expect("a camera");
            let picture = realtime.moving(1).expect("a frame").expect("a picture");
            let found = realtime.unfiltered().expect("light");
            sum += mean(&found) / mean(&reference);
            if [1, 4, 16].contains(&frame) {
                let [found, filtered] = [&found, &picture.pixels].map(|p| rel_mse(p, &reference));
                let trace = picture.stages.trace;
                println!("{name:8} frame {frame:2}: {found:.4}, filtered {filtered:.4}, {trace:?}");
            }
        }
        println!("{name:8} {:+.3} of the light", sum / 16.0 - 1.0);
    }
}
