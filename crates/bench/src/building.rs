//! Benchmarks of building and refitting: time on one and two threads, and the memory of primitives
//! and tree.

use crate::embree::{Embree, Quality, SceneOptions};
use crate::mesh::{BenchMesh, spheres};
use crate::table::{Table, ratios};
use crate::timing::Seconds;
use geometry::{BuildQuality, Geometry, GeometryId, GroupId, RefitError, World};
use std::error::Error;

/// Embree's counterpart of our quality `Balanced`.
const MEDIUM: SceneOptions = SceneOptions { quality: Quality::Medium, robust: false };

/// A world of one geometry.
pub fn world(geometry: impl Into<Geometry>, quality: BuildQuality) -> World {
    let mut builder = World::builder().quality(quality);
    builder.add_geometry(GroupId::TOP, geometry);
    builder.build()
}

/// Builds with our engine and Embree in alternation, and returns a table of the medians.
pub fn table(mesh: &BenchMesh, embree: Option<&Embree>, repeats: usize) -> Result<Table, Box<dyn Error>> {
    let triangles = Geometry::from(mesh.triangles()?);
    let mut ours = Ours::default();
    let mut theirs = Runs::default();
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        for _ in 0..repeats {
            pool.install(|| ours.run(&triangles))?;
            if let Some(embree) = embree {
                let device = embree.device(threads)?;
                let prepared = device.prepare(mesh, MEDIUM)?;
                let (seconds, _scene) = Seconds::of(|| prepared.commit());
                theirs.push(seconds, device.bytes());
            }
        }
    }
    let mut table = ours.table(mesh.name);
    if embree.is_some() {
        table.row("Embree, medium", theirs.texts());
        for (name, runs) in [("balanced", &ours.balanced), ("fast", &ours.fast)] {
            table.row(&format!("alhazen, {name} ÷ Embree"), ratios(&runs.values(), &theirs.values()));
        }
    }
    Ok(table)
}

/// The same for a million spheres, with our engine alone.
pub fn spheres_table(repeats: usize) -> Result<Table, Box<dyn Error>> {
    let set = Geometry::from(spheres(1_000_000)?);
    let mut ours = Ours::default();
    for threads in [1, 2] {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build()?;
        for _ in 0..repeats {
            pool.install(|| ours.run(&set))?;
        }
    }
    Ok(ours.table("a million spheres"))
}

/// Measurements of our engine.
#[derive(Default)]
struct Ours {
    balanced: Runs,
    fast: Runs,
    refit: Runs,
}

impl Ours {
    fn run(&mut self, geometry: &Geometry) -> Result<(), RefitError> {
        let build = |quality, runs: &mut Runs| {
            let geometry = geometry.clone();
            let (seconds, world) = Seconds::of(|| world(geometry, quality));
            runs.push(seconds, world.bytes());
            world
        };
        build(BuildQuality::Fast, &mut self.fast);
        let mut world = build(BuildQuality::Balanced, &mut self.balanced);
        let (seconds, refitted) = Seconds::of(|| world.refit([(GeometryId(0), geometry.clone())]));
        self.refit.push(seconds, world.bytes());
        refitted
    }

    fn table(&self, what: &str) -> Table {
        let heads = ["1 thread, CPU s", "2 threads, s", "2 threads, CPU s", "memory, MB"];
        let mut table = Table::new([what].into_iter().chain(heads));
        let rows = [("balanced", &self.balanced), ("fast", &self.fast), ("refit", &self.refit)];
        for (name, runs) in rows {
            table.row(&format!("alhazen, {name}"), runs.texts());
        }
        table
    }
}

/// Measurements on one thread and on two.
#[derive(Default)]
struct Runs {
    seconds: Vec<Seconds>,
    bytes: usize,
}

impl Runs {
    fn push(&mut self, seconds: Seconds, bytes: usize) {
        self.seconds.push(seconds);
        self.bytes = bytes;
    }

    fn values(&self) -> [f64; 4] {
        let (one, two) = self.seconds.split_at(self.seconds.len() / 2);
        let [one, two] = [one, two].map(Seconds::median);
        [one.cpu, two.wall, two.cpu, self.bytes as f64 / 1e6]
    }

    fn texts(&self) -> [String; 4] {
        let [one, wall, two, megabytes] = self.values();
        let seconds = |seconds: f64| format!("{seconds:.4}");
        [seconds(one), seconds(wall), seconds(two), format!("{megabytes:.1}")]
    }
}
