//! Pictures that are made at once.

use std::sync::Arc;

use alhazen_gpu::{Algorithm, Kernels, Realtime};

use crate::pictures::{Case, SAMPLES, kernels};

fn realtime(case: &Case, kernels: &Arc<Kernels>, algorithm: &Algorithm) -> Realtime {
    let flat = case.flatten(algorithm).unwrap_or_else(|refusals| panic!("{refusals:?}"));
    let mut realtime = Realtime::new(kernels.clone(), &flat, algorithm).expect("a scene on the device");
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
        let cpu: Vec<f32> = case.on_cpu(&algorithm).values().collect();
        let mean = cpu.iter().sum::<f32>() / cpu.len() as f32;
        let pairs = shown.pixels.as_flattened().iter().zip(&cpu);
        let apart = |(a, b): &(&f32, &f32)| (*a - *b).abs() > 1e-3 * b.abs().max(mean / 10.0);
        let other = pairs.clone().filter(apart).count() as f32 / cpu.len() as f32;
        let difference = pairs.map(|(a, b)| a - b).sum::<f32>() / cpu.len() as f32 / mean;
        println!("{name}: {other:.4} apart, the mean by {difference:+.1e}, {:?}", shown.stages);
        assert!(other < 0.01 && difference.abs() < 5e-3, "{name}: {other} apart, by {difference}");
    }
}
