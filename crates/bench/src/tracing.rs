//! Benchmarks of tracing: million rays per CPU second on one thread. The engines must find the same
//! hits.

use crate::building;
use crate::embree::{Embree, Quality, SceneOptions};
use crate::mesh::BenchMesh;
use crate::rays::{Answer, BenchRay, Query, RaySet, ray_sets};
use crate::table::{Table, ratios};
use crate::timing::in_turn;
use geometry::{BuildQuality, Hit, HitColumns, RayStats, World};
use math::Ray;
use std::error::Error;

/// Rays in a batch: a tile or row of pixels, and a wavefront of paths.
const BATCHES: [usize; 2] = [1024, 65536];

/// Measurements on one mesh.
pub struct Tracing {
    mesh: &'static str,
    sets: Vec<&'static str>,
    /// Our engine first.
    engines: Vec<Measured>,
}

/// Measurements of one engine, by set.
struct Measured {
    name: String,
    rates: Vec<f64>,
    answers: Vec<Answer>,
}

/// An engine's name, and a function that traces a set.
type Engine<'a> = (String, Box<dyn Fn(&RaySet) -> Answer + 'a>);

/// Traces `width`² primary rays and the sets derived from them with each engine in alternation,
/// `repeats` times.
pub fn measure(
    mesh: &BenchMesh,
    embree: Option<&Embree>,
    width: usize,
    repeats: usize,
) -> Result<Tracing, Box<dyn Error>> {
    let world = building::world(mesh.triangles()?, BuildQuality::Balanced);
    let sets = ray_sets(mesh, width, |ray| closest(&world, ray).map(|hit| (hit.t, hit.primitive as usize)));
    let device = embree.map(|embree| embree.device(1)).transpose()?;
    let mut engines: Vec<Engine> = vec![("alhazen".to_owned(), Box::new(|set| trace(&world, set)))];
    for size in BATCHES {
        let world = &world;
        engines.push((
            format!("alhazen, batches of {size}"),
            Box::new(move |set| trace_batches(world, set, size)),
        ));
    }
    if let Some(device) = &device {
        for (mode, robust) in [("", false), (", robust", true)] {
            let scene = device.prepare(mesh, SceneOptions { quality: Quality::Medium, robust })?.commit();
            engines
                .push((format!("Embree {}{mode}", device.version()), Box::new(move |set| scene.trace(set))));
        }
    }
    let mut measured: Vec<Measured> = engines
        .iter()
        .map(|(name, _)| Measured { name: name.clone(), rates: Vec::new(), answers: Vec::new() })
        .collect();
    for set in &sets {
        let runs: Vec<_> = engines.iter().map(|(_, trace)| || trace(set)).collect();
        for (engine, (seconds, answer)) in measured.iter_mut().zip(in_turn(&runs, repeats)) {
            engine.rates.push(set.rays.len() as f64 / seconds / 1e6);
            engine.answers.push(answer);
        }
    }
    Ok(Tracing { mesh: mesh.name, sets: sets.iter().map(|set| set.name).collect(), engines: measured })
}

impl Tracing {
    /// Million rays per CPU second, and the ratio of our engine to each other one.
    pub fn rates(&self) -> Table {
        let mut table = self.table("million rays per CPU second");
        for engine in &self.engines {
            table.row(&engine.name, engine.rates.iter().map(|rate| format!("{rate:.2}")));
        }
        for other in &self.engines[1..] {
            table.row(&format!("alhazen ÷ {}", other.name), ratios(&self.engines[0].rates, &other.rates));
        }
        table
    }

    /// The number of rays that hit something, and the sum of the distances.
    pub fn answers(&self) -> Table {
        let mut table = self.table("hits, Σt");
        for engine in &self.engines {
            table.row(&engine.name, engine.answers.iter().map(|a| format!("{}, {:.2}", a.hits, a.sum_t)));
        }
        table
    }

    /// An error where an engine's results differ from ours.
    pub fn check(&self) -> Result<(), String> {
        for other in &self.engines[1..] {
            for (set, (a, b)) in self.sets.iter().zip(self.engines[0].answers.iter().zip(&other.answers)) {
                if !a.agrees(b) {
                    let (mesh, name) = (self.mesh, &other.name);
                    return Err(format!("{mesh}, {set}: we find {a:?}, {name} finds {b:?}"));
                }
            }
        }
        Ok(())
    }

    fn table(&self, title: &str) -> Table {
        Table::new(std::iter::once(title).chain(self.sets.iter().copied()))
    }
}

/// Traces a set through our engine, ray by ray.
pub fn trace(world: &World, set: &RaySet) -> Answer {
    let mut answer = Answer::default();
    for ray in &*set.rays {
        match set.query {
            Query::Closest => {
                if let Some(hit) = closest(world, ray) {
                    answer.add(hit.t);
                }
            }
            Query::Any => answer.hits += u64::from(any(world, ray)),
        }
    }
    answer
}

/// Traces a set through our engine, `size` rays at a time.
pub fn trace_batches(world: &World, set: &RaySet, size: usize) -> Answer {
    let mut answer = Answer::default();
    let stats = &mut RayStats::default();
    let (mut hits, mut occluded) = (HitColumns::default(), vec![false; size]);
    let all = set.columns.columns();
    for first in (0..all.len()).step_by(size) {
        let rays = all.part(first, size);
        match set.query {
            Query::Closest => {
                world.intersect_batch(rays, &keep_all, &mut hits, stats);
                let found = hits.t.iter().zip(&hits.geometry).filter(|(_, id)| **id != HitColumns::NONE);
                found.for_each(|(t, _)| answer.add(*t));
            }
            Query::Any => {
                world.occluded_batch(rays, &keep_all, &mut occluded[..rays.len()], stats);
                answer.hits += occluded[..rays.len()].iter().filter(|hit| **hit).count() as u64;
            }
        }
    }
    answer
}

/// The nearest hit.
#[inline]
pub fn closest(world: &World, ray: &BenchRay) -> Option<Hit> {
    world.intersect(&ray.ray, ray.t_max, &keep_all, &mut RayStats::default())
}

#[inline]
fn any(world: &World, ray: &BenchRay) -> bool {
    world.occluded(&ray.ray, ray.t_max, &keep_all, &mut RayStats::default())
}

#[inline]
fn keep_all(_: &Hit, _: &Ray) -> bool {
    true
}
