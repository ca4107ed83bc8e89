//! Path tracing by wavefronts: many paths at once, one stage after another.
//!
//! The paths of a batch of tiles go through each stage together: all are extended by a ray, then
//! all are shaded, then all shadow rays are traced, and so on until none is left. A stage does one
//! thing to many paths, which keeps its code and data in the cache, lets rays be traced in batches,
//! and lets lanes of a vector each hold a path. [Laine 2013]
//!
//! | stage | what it does |
//! |---|---|
//! | `begin` | camera rays of one sample of each pixel |
//! | `extend` | the nearest hit of each path's ray |
//! | `emit` | emission at the hits of triangles and rectangles of one colour |
//! | `escape` | light from infinity, of paths without a hit |
//! | `shade` | other emission, light sample, BSDF sample and Russian roulette |
//! | `connect` | shadow rays to the light samples |
//! | `finish` | adds the paths' radiance to the film |
//!
//! Estimates and random numbers are those of [`Path`](crate::Path), whichever paths share a batch.

mod area_lights;
mod begin;
mod columns;
mod emission;
mod finish;
mod groups;
mod lights;
mod materials;
mod numbers;
mod pass;
mod paths;
mod queues;
mod shade;
mod stages;

use description::PathDesc;
use film::{Film, FilmTile};
use geometry::RayStats;
use lanes::InstructionSet;
use rayon::prelude::*;
use sampling::Sampler;
use scene::{Interfaces, Scene, View};

use self::area_lights::AreaLights;
use self::materials::LaneMaterials;
use self::pass::Pass;
use self::stages::Stages;
use crate::transport::direct::DirectLighting;
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError};

/// The most tiles of a batch: 4096 paths, whose state stays in the second-level cache.
const BATCH_TILES: usize = 16;

/// Batches per thread, so that threads end a pass at nearly the same time.
const BATCHES_PER_THREAD: usize = 4;

/// Path tracing by wavefronts.
#[derive(Clone, Debug)]
pub struct Wavefront {
    settings: PathDesc,
    interfaces: Interfaces,
    sampler: Sampler,
    direct: DirectLighting,
    materials: LaneMaterials,
    area_lights: AreaLights,
    instruction_set: InstructionSet,
}

impl Wavefront {
    /// Has no lights before [`prepare`](Integrator::prepare). `interfaces` says whether interfaces
    /// occlude delta lights.
    pub fn new(settings: PathDesc, interfaces: Interfaces, sampler: Sampler) -> Self {
        Self {
            settings,
            interfaces,
            sampler,
            direct: DirectLighting::none(),
            materials: LaneMaterials::default(),
            area_lights: AreaLights::default(),
            instruction_set: InstructionSet::detect(),
        }
    }

    /// With another instruction set, which gives the same picture.
    pub fn with_instruction_set(self, instruction_set: InstructionSet) -> Self {
        Self { instruction_set, ..self }
    }
}

impl Integrator for Wavefront {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        self.direct = DirectLighting::new(scene, self.settings.light_sampler, self.interfaces, control)?;
        self.materials = LaneMaterials::new(scene, view);
        self.area_lights = AreaLights::new(scene);
        Ok(())
    }

    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        view: &View,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, PassError> {
        let filter = film.filter().clone();
        let pixels = PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler };
        let tiles = film.tiles_mut()?;
        let batches = BATCHES_PER_THREAD * rayon::current_num_threads();
        let batch_tiles = tiles.len().div_ceil(batches).clamp(1, BATCH_TILES);
        let pass = Pass {
            settings: &self.settings,
            direct: &self.direct,
            materials: &self.materials,
            area_lights: &self.area_lights,
            pixels: &pixels,
            control,
            instruction_set: self.instruction_set,
        };
        let batch = |stages: &mut Stages, tiles: Vec<FilmTile>| {
            let done = stages.run(tiles);
            let stats = std::mem::take(&mut stages.stats);
            control.count(&stats);
            done.map(|()| stats)
        };
        let batches = tiles.into_par_iter().chunks(batch_tiles).map_init(|| Stages::new(pass), batch);
        Ok(batches.try_reduce(RayStats::default, |mut sum, stats| {
            sum += stats;
            Ok(sum)
        })?)
    }
}
