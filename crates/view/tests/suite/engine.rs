//! The engine as the window uses it.

use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

use alhazen::description::{LightKind, SceneDesc};
use alhazen::image::DisplaySettings;
use alhazen::math::Point3;
use alhazen_view::{Engine, Output, Renderer, Shot, World};

use crate::{desc, world};

const TARGET: Duration = Duration::from_millis(33);

/// An engine, and what it calls when there is something new.
fn engine(world: World) -> (Engine, Receiver<()>) {
    let (sender, receiver) = channel();
    let tell = move || {
        // Nobody listens once the test is over.
        let _ = sender.send(());
    };
    (Engine::start(Renderer::new(Arc::new(world), TARGET), tell), receiver)
}

/// Waits until the output is as expected.
fn wait((engine, news): &(Engine, Receiver<()>), is_expected: impl Fn(&Output) -> bool) -> Output {
    let begin = Instant::now();
    loop {
        let output = engine.output();
        if is_expected(&output) {
            return output;
        }
        assert!(begin.elapsed() < Duration::from_secs(60), "{:?}", output.problem);
        // Whatever was new may have come before.
        let _ = news.recv_timeout(Duration::from_millis(200));
    }
}

#[test]
fn pictures_appear_while_the_camera_moves() {
    let world = world(1 << 20);
    let (shot, mut flight) = (world.shot(), world.flight());
    let engine = engine(world);
    let mut before = None;
    for _ in 0..20 {
        flight.orbit(0.1, 0.0);
        engine.0.show(Shot { camera: flight.camera().clone(), ..shot.clone() });
        let is_new = |output: &Output| match (&output.frame, &before) {
            (Some(frame), Some(before)) => !Arc::ptr_eq(frame, before),
            (frame, _) => frame.is_some(),
        };
        before = wait(&engine, is_new).frame;
    }
    // At rest it becomes the whole picture, sample by sample.
    wait(&engine, |output| output.frame.as_ref().is_some_and(|frame| frame.n == 1 && frame.samples > 3));
    let begin = Instant::now();
    drop(engine);
    assert!(begin.elapsed() < Duration::from_secs(2), "a million samples are not waited for");
}

#[test]
fn a_scene_with_an_error_keeps_the_last_picture() {
    let (good, other) = (desc("cornell-box.pbrt", 2), desc("cornell-box.pbrt", 2));
    let engine = engine(World::new(good).unwrap());
    let world = wait(&engine, |output| output.frame.is_some()).world;
    // A spot light that shines nowhere.
    let mut bad: SceneDesc = other.clone();
    let spot = LightKind::Spot {
        intensity: 1.0.into(),
        power: None,
        from: Point3::ZERO,
        to: Point3::ZERO,
        cone_angle: 30.0,
        cone_delta_angle: 5.0,
    };
    bad.lights.push(spot.into());
    engine.0.replace(bad);
    let output = wait(&engine, |output| output.problem.is_some());
    assert!(Arc::ptr_eq(&output.world, &world) && output.frame.is_some());
    // The scene before goes on to its end, and another change is taken.
    wait(&engine, |output| output.frame.as_ref().is_some_and(|frame| frame.samples == 2));
    engine.0.replace(other);
    let output = wait(&engine, |output| !Arc::ptr_eq(&output.world, &world));
    assert_eq!(output.problem, None);
}

#[test]
fn paths_and_files_are_made_beside_the_picture() {
    let engine = engine(world(2));
    let folder = std::env::temp_dir().join(format!("alhazen-view-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    engine.0.trace([48, 36], 3);
    engine.0.save(folder.join("a.exr"), DisplaySettings::default());
    let output = wait(&engine, |output| output.trace.is_some() && output.note.is_some());
    assert_eq!(output.trace.unwrap().samples.len(), 3);
    assert!(output.note.unwrap().ends_with("samples per pixel"));
    assert_eq!(alhazen::image::open(folder.join("a.exr")).unwrap().width(), 96);
    engine.0.trace([96, 0], 1);
    let output = wait(&engine, |output| output.problem.is_some());
    assert_eq!(output.problem.as_deref(), Some("there is no such pixel"));
    engine.0.save(folder.join("missing/a.exr"), DisplaySettings::default());
    wait(&engine, |output| output.problem.as_ref().is_some_and(|problem| problem.contains("missing")));
    std::fs::remove_dir_all(folder).unwrap();
}
