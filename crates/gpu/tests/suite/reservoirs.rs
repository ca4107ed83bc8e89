//! Direct light by samples that pixels and frames share, beside that of paths.

use std::fmt::Write;
use std::path::Path;
use std::sync::Arc;

use alhazen_gpu::{Algorithm, Kernels, Weights};
use description::PathDesc;
use import::MemoryAssets;
use sampling::Sampler;
use sampling::sampler::Independent;

use crate::pictures::{Case, kernels};
use crate::realtime::{rel_mse, sharing};

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

fn case(rows: u32) -> Case {
    let path = Path::new("scene.pbrt");
    Case::sized(path, &MemoryAssets::default().with(path, lights(rows)), SIZE.map(|side| side as u32))
}

const BLOCK: usize = 4;
const SIZE: [usize; 2] = [32, 24];

/// The mean of each block of pixels.
fn blocks(pixels: &[[f32; 3]]) -> Vec<f64> {
    let columns = SIZE[0] / BLOCK;
    let mut sums = vec![0.0; columns * SIZE[1] / BLOCK];
    for (i, pixel) in pixels.iter().enumerate() {
        let block = i / SIZE[0] / BLOCK * columns + i % SIZE[0] / BLOCK;
        sums[block] += pixel.iter().map(|&c| f64::from(c)).sum::<f64>() / (3 * BLOCK * BLOCK) as f64;
    }
    sums
}

/// Mean and variance of the mean of the blocks of independent renders.
fn renders(case: &mut Case, kernels: &Arc<Kernels>, shared: Option<Weights>, samples: u32) -> Vec<[f64; 2]> {
    const RENDERS: u32 = 8;
    let algorithm = Algorithm::Path(PathDesc { max_depth: 1, ..case.path() });
    let renders: Vec<Vec<f64>> = (0..RENDERS)
        .map(|seed| {
            case.sampler = Sampler::Independent(Independent::new(samples, 100 + seed));
            let mut realtime = sharing(case, kernels, &algorithm, shared);
            let mut shown = None;
            while realtime.rested() < samples {
                let step = if shared.is_some() { 1 } else { samples };
                let is_last = realtime.rested() + step == samples;
                shown = realtime.resting(step, is_last).expect("a frame");
            }
            blocks(&shown.expect("a picture").pixels)
        })
        .collect();
    let n = f64::from(RENDERS);
    let of_block = |block: usize| {
        let mean = renders.iter().map(|render| render[block]).sum::<f64>() / n;
        let squares = renders.iter().map(|render| (render[block] - mean).powi(2)).sum::<f64>();
        [mean, squares / (n - 1.0) / n]
    };
    (0..renders[0].len()).map(of_block).collect()
}

/// How far the blocks of two lists of renders are apart: the root of the mean square of z, the
/// largest, and that of all together.
fn apart(a: &[[f64; 2]], b: &[[f64; 2]]) -> [f64; 3] {
    let z = a.iter().zip(b).map(|(a, b)| (a[0] - b[0]) / (a[1] + b[1] + 1e-12).sqrt());
    let squares = z.clone().map(|z| z * z).sum::<f64>() / a.len() as f64;
    let sum = |list: &[[f64; 2]], i: usize| list.iter().map(|block| block[i]).sum::<f64>();
    println!("all together {:+.4}", sum(a, 0) / sum(b, 0) - 1.0);
    let together = (sum(a, 0) - sum(b, 0)) / (sum(a, 1) + sum(b, 1)).sqrt();
    [squares.sqrt(), z.map(f64::abs).fold(0.0, f64::max), together]
}

#[test]
fn shared_samples_have_the_mean_of_paths() {
    let Some(kernels) = kernels() else { return };
    let mut case = case(3);
    let paths = renders(&mut case, &kernels, None, 64);
    let unbiased = renders(&mut case, &kernels, Some(Weights::Unbiased), 16);
    let biased = renders(&mut case, &kernels, Some(Weights::Biased), 16);
    let [z, largest, together] = apart(&unbiased, &paths);
    println!("unbiased: z {z:.2}, at most {largest:.2}, together {together:+.2}");
    let [z_of_biased, _, darker] = apart(&biased, &paths);
    println!("biased: z {z_of_biased:.2}, together {darker:+.2}");
    // Of z by 8 renders each, 14 degrees of freedom: √(14/12) in the mean, and more as few samples
    // have large weights.
    assert!(z < 2.0 && largest < 6.0 && together.abs() < 4.0, "{z}, {largest}, {together}");
    assert!(z_of_biased > 2.0 && darker < 0.0, "{z_of_biased}, {darker}");
}

/// One of a thousand lights is seldom the one that counts.
#[test]
#[ignore = "a measurement"]
fn error_of_a_thousand_lights() {
    let Some(kernels) = kernels() else { return };
    let mut case = case(32);
    case.sampler = Sampler::Independent(Independent::new(4096, 5));
    let algorithm = Algorithm::Path(PathDesc { max_depth: 1, ..case.path() });
    let mut plain = sharing(&case, &kernels, &algorithm, None);
    let mut reference = None;
    for _ in 0..8 {
        reference = plain.resting(128, true).expect("a frame");
    }
    let reference = reference.expect("a picture").pixels;
    for (name, shared) in
        [("path", None), ("unbiased", Some(Weights::Unbiased)), ("biased", Some(Weights::Biased))]
    {
        case.sampler = Sampler::Independent(Independent::new(64, 77));
        let mut realtime = sharing(&case, &kernels, &algorithm, shared);
        // The kernels are compiled by the first frame.
        realtime.resting(1, true).expect("a frame");
        realtime.aim(&case.view, case.film().pixel_bounds()).expect("a camera");
        let begin = std::time::Instant::now();
        for frame in 1..=32 {
            let shown = realtime.resting(1, true).expect("a frame").expect("a picture");
            if [1, 4, 16, 32].contains(&frame) {
                let error = rel_mse(&shown.pixels, &reference);
                let ms = begin.elapsed().as_secs_f64() * 1e3;
                println!(
                    "{name:8} {frame:2} frames, {ms:.0} ms: {error:.5}, {:.5} · s",
                    error * ms as f32 / 1e3
                );
            }
        }
    }
}
