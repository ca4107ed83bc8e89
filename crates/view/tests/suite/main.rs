//! Scenes that are walked through.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod engine;
mod flight;
mod knobs;
mod paths;
mod picture;
mod renderer;

use std::path::Path;

use alhazen::Overrides;
use alhazen::assets::Files;
use alhazen::description::SceneDesc;
use alhazen::import::import;
use alhazen_view::World;

/// A scene of this repository, small.
fn desc(name: &str, samples: u32) -> SceneDesc {
    let scene = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../scenes").join(name);
    let mut desc = import(scene, &Files).desc;
    let overrides =
        Overrides { samples_per_pixel: Some(samples), resolution: Some([96, 72]), ..Overrides::default() };
    overrides.apply(&mut desc).unwrap();
    desc
}

/// The Cornell box.
fn world(samples: u32) -> World {
    World::new(desc("cornell-box.pbrt", samples)).unwrap()
}
