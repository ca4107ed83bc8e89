//! Building: seconds on one thread and on two, and the memory that mesh and tree take.

use crate::embree::{Embree, Quality, SceneOptions};
use crate::mesh::BenchMesh;
use crate::table::{Table, ratios};
use crate::timing::Seconds;
use geometry::{Geometry, GroupId, World};
use std::error::Error;

/// How Embree builds what we build balanced.
const MEDIUM: SceneOptions = SceneOptions { quality: Quality::Medium, robust: false };

/// A world of one geometry.
pub fn world(geometry: impl Into<Geometry>) -> World {
    let mut builder = World::builder();
    builder.add_geometry(GroupId::TOP, geometry);
    builder.build()
}

/// Builds in turn with us and with Embree, so many times, and makes a table of the medians.
pub fn table(mesh: &BenchMesh, embree: Option<&Embree>, repeats: usize) -> Result<Table, Box<dyn Error>> {
    let [mut ours, mut theirs] = [Run::default(); 2];
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        let [mut our_seconds, mut their_seconds] = [Vec::new(), Vec::new()];
        for _ in 0..repeats {
            let triangles = mesh.triangles()?;
            let (seconds, world) = Seconds::of(|| pool.install(|| world(triangles)));
            our_seconds.push(seconds);
            ours.bytes = world.bytes();
            drop(world);
            if let Some(embree) = embree {
                let device = embree.device(threads)?;
                let prepared = device.prepare(mesh, MEDIUM)?;
                let (seconds, _scene) = Seconds::of(|| prepared.commit());
                their_seconds.push(seconds);
                theirs.bytes = device.bytes();
            }
        }
        for (run, seconds) in [(&mut ours, our_seconds), (&mut theirs, their_seconds)] {
            run.seconds[threads - 1] = Seconds::median(&seconds);
        }
    }
    let mut table =
        Table::new(["building", "1 thread, CPU s", "2 threads, s", "2 threads, CPU s", "memory, MB"]);
    table.row("alhazen, balanced", ours.values().map(|v| format!("{v:.3}")));
    if embree.is_some() {
        table.row("Embree, medium", theirs.values().map(|v| format!("{v:.3}")));
        table.row("alhazen ÷ Embree", ratios(&ours.values(), &theirs.values()));
    }
    Ok(table)
}

#[derive(Clone, Copy, Default)]
struct Run {
    /// On one thread and on two.
    seconds: [Seconds; 2],
    bytes: usize,
}

impl Run {
    fn values(&self) -> [f64; 4] {
        let [one, two] = self.seconds;
        [one.cpu, two.wall, two.cpu, self.bytes as f64 / 1e6]
    }
}
