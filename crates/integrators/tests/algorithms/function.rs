//! Integrals of functions by the samples of pixels.

use alhazen_integrators::{Control, Limits, Session, build};
use description::{FunctionDesc, FunctionKind, IntegratorDesc, SamplerKind, SceneDesc};
use image::{ReadOptions, read};

use crate::support::{finished, session};

const SIDE: i32 = 16;

fn desc(settings: FunctionDesc, mut sampler: SamplerKind, samples: u32) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.film.resolution = [SIDE; 2];
    desc.film.save_fp16 = false;
    desc.integrator.value = IntegratorDesc::Function(settings);
    sampler.set_samples_per_pixel(samples);
    desc.sampler.kind = sampler;
    desc
}

fn rendered(desc: &SceneDesc) -> Session {
    finished(desc, build(desc).ok().unwrap().integrator)
}

/// Red, green and blue of each pixel.
fn pixels(session: &Session) -> Vec<[f32; 3]> {
    let values: Vec<f32> = session.state().film.develop().unwrap().values().collect();
    values.chunks_exact(3).map(|rgb| [rgb[0], rgb[1], rgb[2]]).collect()
}

/// The lines of the only file: numbers of samples, and errors.
fn errors(session: &Session, path: &str) -> Vec<(u32, f64)> {
    let files = session.integrator().files();
    let [file] = &files[..] else { panic!("one file") };
    assert_eq!(file.path.to_str(), Some(path));
    let text = String::from_utf8(file.contents.clone()).unwrap();
    let line = |line: &str| {
        let (samples, error) = line.split_once(' ').unwrap();
        (samples.parse().unwrap(), error.parse().unwrap())
    };
    text.lines().map(line).collect()
}

fn pmj02bn() -> SamplerKind {
    SamplerKind::Pmj02Bn { pixel_samples: 1 }
}

#[test]
fn pixels_are_estimates_of_one() {
    for (function, name) in [
        (FunctionKind::Step, "step"),
        (FunctionKind::Diagonal, "diagonal"),
        (FunctionKind::Disk, "disk"),
        (FunctionKind::Checkerboard, "checkerboard"),
        (FunctionKind::RotatedCheckerboard, "rotatedcheckerboard"),
        (FunctionKind::Gaussian, "gaussian"),
    ] {
        let session = rendered(&desc(FunctionDesc { function, ..FunctionDesc::default() }, pmj02bn(), 64));
        let pixels = pixels(&session);
        for [r, g, b] in &pixels {
            assert!((r / g - 1.0).abs() < 5e-3 && (b / g - 1.0).abs() < 5e-3, "{name}: {r} {g} {b}");
        }
        let greens = pixels.iter().map(|[_, g, _]| f64::from(*g));
        let mean = greens.clone().sum::<f64>() / pixels.len() as f64;
        assert!((mean - 1.0).abs() < 0.005, "{name}: {mean}");
        let error = greens.map(|g| (g - 1.0).powi(2)).sum::<f64>() / pixels.len() as f64;
        let listed = errors(&session, &format!("{name}-mse.txt"));
        let samples: Vec<u32> = listed.iter().map(|line| line.0).collect();
        assert_eq!(samples, [1, 2, 4, 8, 16, 32, 64]);
        // The green of the picture's white is exact to within a thousandth.
        let rounding = 4e-3 * error.sqrt() + 4e-6;
        assert!((listed[6].1 - error).abs() < rounding, "{name}: {} and {error}", listed[6].1);
        // A scrambled net has at most e times the variance of independent samples.
        assert!(listed[6].1 < listed[0].1 / 15.0, "{name}: {listed:?}");
    }
}

#[test]
fn errors_are_listed_after_numbers_that_the_sampler_stratifies() {
    let listed = |sampler: SamplerKind, samples, skip_bad| {
        let settings = FunctionDesc {
            function: FunctionKind::Disk,
            filename: Some("disk.txt".into()),
            skip_bad,
            image_filename: None,
        };
        let lines = errors(&rendered(&desc(settings, sampler, samples)), "disk.txt");
        lines.into_iter().map(|line| line.0).collect::<Vec<_>>()
    };
    let halton = SamplerKind::Halton { pixel_samples: 1, randomization: Default::default() };
    assert_eq!(listed(halton.clone(), 40, true), [1, 6, 36]);
    assert_eq!(listed(halton, 9, false), [1, 2, 3, 4, 5, 6, 7, 8, 9]);
    assert_eq!(listed(SamplerKind::Stratified { strata: [1, 1], jitter: true }, 9, true), [9]);
    assert_eq!(listed(SamplerKind::Independent { pixel_samples: 1 }, 3, true), [1, 2, 3]);
}

#[test]
fn errors_do_not_depend_on_sessions_and_threads() {
    let desc = desc(FunctionDesc::default(), SamplerKind::Independent { pixel_samples: 1 }, 8);
    let whole = errors(&rendered(&desc), "step-mse.txt");
    let pool = rayon::ThreadPoolBuilder::new().num_threads(3).build().unwrap();
    let mut second = session(&desc, build(&desc).ok().unwrap().integrator);
    pool.install(|| second.run(4..8, &Limits::default(), &Control::default(), &mut |_| ())).unwrap();
    assert_eq!(errors(&second, "step-mse.txt"), whole);
}

#[test]
fn the_function_is_drawn_to_a_file() {
    let with_picture = |file: &str| {
        let settings = FunctionDesc {
            function: FunctionKind::Diagonal,
            image_filename: Some(file.into()),
            ..FunctionDesc::default()
        };
        desc(settings, pmj02bn(), 1)
    };
    let files = rendered(&with_picture("diagonal.pfm")).integrator().files();
    assert_eq!(files[1].path.to_str(), Some("diagonal.pfm"));
    let image = read(&files[1].contents, "diagonal.pfm", &ReadOptions::default()).unwrap();
    let values: Vec<f32> = image.values().step_by(3).collect();
    assert_eq!(values.len(), (SIDE * SIDE) as usize);
    // The top left pixel, the bottom right one, and one on the diagonal.
    assert_eq!([values[0], values[255]], [2.0, 0.0]);
    assert!((values[15] - 1.0).abs() < 0.1);
    let errors = build(&with_picture("diagonal.xyz")).err().unwrap();
    assert_eq!(errors[0].message, "cannot tell the format of diagonal.xyz");
}
