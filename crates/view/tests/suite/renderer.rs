//! What is rendered, step by step, and in which resolution.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::{Duration, Instant};

use alhazen::integrators::Control;
use alhazen::math::Bounds2i;
use alhazen::{Job, system_clock};
use alhazen_view::{Frame, Pace, Renderer, Report, Shot, StepError};

use crate::{desc, world};

const TARGET: Duration = Duration::from_millis(33);

/// All frames until there is nothing more to do.
fn frames(renderer: &mut Renderer) -> Vec<Frame> {
    let mut frames = Vec::new();
    while !renderer.is_at_rest() {
        frames.extend(renderer.step(&Control::default()).unwrap());
    }
    frames
}

#[test]
fn a_camera_at_rest_gets_the_picture_of_a_render() {
    for (name, samples, per_pass) in [("cornell-box.pbrt", 5, 1), ("fog.pbrt", 4, 4), ("textures.pbrt", 3, 4)]
    {
        let desc = desc(name, samples);
        let mut job = Job::compile(desc.clone()).unwrap().job;
        job.render(&Control::default()).unwrap();
        let picture = job.picture().unwrap();

        let world = alhazen_view::World::new(desc).unwrap();
        let mut renderer = Renderer::new(Arc::new(world), TARGET);
        renderer.aim(Shot { samples: per_pass, ..renderer.shot().clone() });
        let frames = frames(&mut renderer);
        let sizes: Vec<_> = frames.iter().map(|frame| frame.n).collect();
        assert!(sizes.is_sorted_by(|a, b| a >= b) && sizes[0] > 1, "{sizes:?}");
        let last = frames.last().unwrap();
        assert_eq!((last.n, last.samples, last.planned), (1, job.planned(), job.planned()));
        let expected = (0..picture.height()).flat_map(|y| (0..picture.width()).map(move |x| (x, y)));
        for ((x, y), found) in expected.zip(&last.pixels) {
            assert_eq!(picture.rgb(x, y).map(f32::to_bits), found.map(f32::to_bits), "{name} {x} {y}");
        }
    }
}

#[test]
fn drafts_show_the_picture_in_large_pixels() {
    let mut renderer = Renderer::new(Arc::new(world(16)), TARGET);
    let frames = frames(&mut renderer);
    // Without the brightness of the light itself, which is in few pixels.
    let mean = |frame: &Frame| {
        let sum: f64 = frame.pixels.iter().flatten().map(|value| f64::from(value.min(1.0))).sum();
        sum / frame.pixels.len() as f64
    };
    let (first, last) = (&frames[0], frames.last().unwrap());
    assert!((mean(first) / mean(last) - 1.0).abs() < 0.3, "{} {}", mean(first), mean(last));
    assert_eq!((first.n, first.size), (3, [32, 24]));
    let bounds = renderer.world().bounds();
    assert_eq!(first.part(&bounds), [[0.0; 2], [1.0; 2]]);
    assert!(frames.iter().all(|frame| frame.rays > 0 && frame.time > Duration::ZERO));
}

#[test]
fn the_resolution_holds_the_frame_time() {
    let full = Bounds2i::new([0, 0], [1280, 720]);
    // Seconds per pixel, and a fixed part.
    for (cost, fixed) in [(1e-7, 0.0), (1e-6, 0.002), (2e-5, 0.004)] {
        let mut pace = Pace::new(TARGET, full);
        let mut time = 0.0;
        let mut sizes = Vec::new();
        for _ in 0..30 {
            let pixels = full.area() / (pace.n() * pace.n()) as usize;
            time = fixed + cost * pixels as f64;
            sizes.push(pace.n());
            pace.after(pixels, 1, Duration::from_secs_f64(time));
        }
        assert!(time < 1.15 * TARGET.as_secs_f64(), "{cost}: {time}");
        assert!(pace.n() == 1 || time > 0.3 * TARGET.as_secs_f64(), "{cost}: {time} {}", pace.n());
        assert!(sizes[20..].iter().all(|n| *n == sizes[29]), "{sizes:?}");
    }
    // However slow it is, something is left of the picture.
    let mut pace = Pace::new(TARGET, full);
    pace.after(100, 1, Duration::from_secs(60));
    assert_eq!(pace.n(), 30);
    // What only the first picture costs, such as the compilation of kernels, is forgotten at once.
    pace.after(1024, 1, Duration::from_micros(100));
    let mut other = Pace::new(TARGET, full);
    other.after(1024, 1, Duration::from_micros(100));
    assert_eq!(pace.n(), other.n());
}

#[test]
fn a_step_is_cancelled_promptly_and_nothing_is_lost() {
    let mut renderer = Renderer::new(Arc::new(world(4096)), TARGET);
    let cancel = Arc::new(AtomicBool::new(false));
    let control = Control::new(Arc::clone(&cancel), system_clock());
    renderer.step(&control).unwrap().unwrap();
    cancel.store(true, Ordering::SeqCst);
    let begin = Instant::now();
    assert_eq!(renderer.step(&control).err(), Some(StepError::Cancelled));
    assert!(begin.elapsed() < Duration::from_secs(1));
    cancel.store(false, Ordering::SeqCst);
    assert!(renderer.step(&control).unwrap().is_some());
}

#[cfg(feature = "gpu")]
#[test]
fn the_cpu_renders_until_kernels_are_compiled() {
    use alhazen::device::{Device, Kernels};
    use std::io::Write;

    let device = match Device::open("") {
        Ok(device) => device,
        Err(error) => {
            // Not by a macro, whose output the harness keeps to itself.
            let _ = writeln!(std::io::stderr(), "SKIPPED, not tested: {error}");
            return;
        }
    };
    let mut renderer = Renderer::new(Arc::new(world(1 << 24)), TARGET);
    let name = device.name().to_owned();
    renderer.move_to(Arc::new(Kernels::new(device)), None);
    let control = Control::default();
    let first = renderer.step(&control).unwrap().expect("a draft");
    assert!(first.stages.is_none() && renderer.device().is_none(), "the first picture does not wait");
    let begin = Instant::now();
    while renderer.step(&control).unwrap().is_none_or(|frame| frame.stages.is_none()) {
        assert!(begin.elapsed() < Duration::from_secs(300), "the device renders when it can");
    }
    assert_eq!(renderer.device(), Some(&*name));
}

#[test]
fn what_cannot_be_rendered_is_said() {
    let mut renderer = Renderer::new(Arc::new(world(1)), TARGET);
    renderer.aim(Shot { integrator: "magic".into(), ..renderer.shot().clone() });
    let Err(StepError::Problem(problem)) = renderer.step(&Control::default()) else { panic!() };
    assert!(problem.starts_with("no integrator is called `magic`"), "{problem}");
    assert!(renderer.is_at_rest());
}

#[test]
fn a_report_has_the_times_of_a_camera_path() {
    let world = world(64);
    let mut flight = world.flight();
    let home = flight.position();
    let mut renderer = Renderer::new(Arc::new(world), TARGET);
    let begin = Instant::now();
    let (report, last) = Report::of_orbit(&mut renderer, &mut flight, 8, begin, &Control::default()).unwrap();
    let image = last.expect("a frame").to_image();
    assert_eq!(Some(&[image.width(), image.height()]), report.sizes.last());
    assert!(flight.position().distance(home) < 1e-6 * home.length(), "the path is closed");
    assert_eq!((report.frames.len(), report.resolution), (8, [96, 72]));
    let [median, high, most] = [0.5, 0.95, 1.0].map(|share| report.quantile(share));
    assert!(Duration::ZERO < median && median <= high && high <= most);
    assert_eq!(report.frames.iter().max(), Some(&most));
    let json = report.to_json();
    assert_eq!((json["frames"].as_u64(), json["integrator"].as_str()), (Some(8), Some("path")));
    let ms = |value: &serde_json::Value| value.as_f64().unwrap();
    assert!((ms(&json["frame_ms"]["max"]) - most.as_secs_f64() * 1e3).abs() < 1e-9);
    assert!(ms(&json["fps"]) > 0.0 && ms(&json["rays_per_second"]) > 0.0);
    assert!(ms(&json["first_picture_ms"]) > 0.0);
}
