//! Tracing by wavefronts: many paths at once, one stage after another.
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
//! | `shade` | what the algorithm does at the hits: its [`WaveIntegrator`] |
//! | `connect` | shadow rays |
//! | `finish` | adds the paths' radiance to the film |
//!
//! Estimates and random numbers are those of the algorithm's [`RayIntegrator`], whichever paths
//! share a batch. An algorithm has one file.

mod all_lights;
mod ambient_occlusion;
mod area_lights;
mod batch;
mod begin;
mod bodies;
mod emission;
mod exits;
mod finish;
mod flights;
mod float_columns;
mod groups;
mod indices;
mod lights;
mod lights_in_turn;
mod materials;
mod media;
mod medium_vertices;
mod normals;
mod numbers;
mod pass;
mod path;
mod path_columns;
mod path_vertices;
mod queues;
mod ray_casting;
mod segment_columns;
mod shade;
mod shadows;
mod spectrum_column;
mod stage;
mod whitted;

use std::sync::{Mutex, MutexGuard, PoisonError};

use film::{Film, FilmTile, Filter};
use geometry::RayStats;
use lanes::InstructionSet;
use rayon::prelude::*;
use sampling::Sampler;
use scene::{Scene, View};

use self::area_lights::AreaLights;
use self::batch::{Batch, BatchColumns};
use self::materials::LaneMaterials;
use self::media::LaneMedia;
use self::pass::Pass;
use self::segment_columns::OptionalColumns;
use crate::adaptive::PixelIntegrator;
use crate::camera_paths::record;
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError, RayIntegrator, Record};

/// The most tiles of a batch: 4096 paths, whose state stays in the second-level cache.
const BATCH_TILES: usize = 16;

/// Batches per thread, so that threads end a pass at nearly the same time.
const BATCHES_PER_THREAD: usize = 4;

/// An algorithm that can be done to many paths at once.
pub trait WaveIntegrator: RayIntegrator {
    /// Whether it reads textures, for which camera rays have differentials.
    const READS_TEXTURES: bool = true;

    /// Whether it follows paths under surfaces whose boundaries are shaded in lanes, where it does
    /// not know media.
    const FOLLOWS_BODIES: bool = false;

    /// Whether it knows media, and a scene has them.
    fn knows_media(&self, _scene: &Scene) -> bool {
        false
    }

    /// Continues each active path from its hit: adds light, asks for shadow rays, and gives the
    /// paths that go on their next rays.
    fn shade(&self, batch: &mut Batch);
}

/// Runs a [`WaveIntegrator`] for each sample of each pixel.
pub struct Wavefront<A> {
    algorithm: A,
    sampler: Sampler,
    materials: LaneMaterials,
    media: LaneMedia,
    area_lights: AreaLights,
    instruction_set: InstructionSet,
    /// The columns of batches that have ended.
    spare: Mutex<Vec<BatchColumns>>,
}

impl<A: WaveIntegrator> Wavefront<A> {
    /// With as many passes as the sampler has samples per pixel.
    pub fn new(algorithm: A, sampler: Sampler) -> Self {
        Self {
            algorithm,
            sampler,
            materials: LaneMaterials::default(),
            media: LaneMedia::default(),
            area_lights: AreaLights::default(),
            instruction_set: InstructionSet::detect(),
            spare: Mutex::default(),
        }
    }

    /// With another instruction set, which gives the same picture.
    pub fn with_instruction_set(self, instruction_set: InstructionSet) -> Self {
        Self { instruction_set, ..self }
    }

    fn spare(&self) -> MutexGuard<'_, Vec<BatchColumns>> {
        self.spare.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Traces one path for each pixel of the tiles. After a cancellation nothing is added to them.
    fn trace(&self, batch: &mut Batch, mut tiles: Vec<FilmTile>) -> Result<(), Cancelled> {
        let control = batch.pass.control;
        let PixelSamples { scene, view, .. } = batch.pass.pixels;
        let with_differentials = A::READS_TEXTURES && scene.needs_footprints(view);
        let media = self.algorithm.knows_media(scene);
        batch.begin(&tiles, OptionalColumns { differentials: with_differentials, media });
        while !batch.columns.segments.rows.is_empty() {
            control.check()?;
            batch.extend();
            self.algorithm.shade(batch);
            batch.go_on();
            control.check()?;
            batch.connect();
            if media {
                batch.connect_through_media();
            }
        }
        control.check()?;
        batch.finish(&mut tiles)
    }
}

impl<A: WaveIntegrator> Integrator for Wavefront<A> {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        self.algorithm.prepare(scene, view, control)?;
        let follows_bodies = A::FOLLOWS_BODIES && !self.algorithm.knows_media(scene);
        self.materials = LaneMaterials::new(scene, view, follows_bodies);
        self.media = LaneMedia::new(scene);
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
        let (filter, sampler) = (&filter, &self.sampler);
        let pixels = PixelSamples { index: pass, scene, view, filter, sampler, counts: None };
        Ok(self.add(&pixels, film.tiles_mut()?, control)?)
    }

    fn record(
        &self,
        pixel: [i32; 2],
        index: u32,
        scene: &Scene,
        view: &View,
        filter: &Filter,
        control: &Control,
    ) -> Option<Result<Record, Cancelled>> {
        let pixels = PixelSamples { index, scene, view, filter, sampler: &self.sampler, counts: None };
        Some(record(&self.algorithm, &pixels, pixel, control))
    }
}

impl<A: WaveIntegrator> PixelIntegrator for Wavefront<A> {
    fn add(
        &self,
        samples: &PixelSamples,
        tiles: Vec<FilmTile>,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        let batches = BATCHES_PER_THREAD * rayon::current_num_threads();
        let batch_tiles = tiles.len().div_ceil(batches).clamp(1, BATCH_TILES);
        let pass = Pass {
            materials: &self.materials,
            media: &self.media,
            area_lights: &self.area_lights,
            pixels: samples,
            control,
            instruction_set: self.instruction_set,
        };
        let run = |tiles: Vec<FilmTile>| -> Result<RayStats, Cancelled> {
            let mut columns = self.spare().pop().unwrap_or_default();
            let mut batch = Batch::new(pass, &mut columns);
            let done = self.trace(&mut batch, tiles);
            let stats = batch.stats;
            control.count(&stats);
            done?;
            self.spare().push(columns);
            Ok(stats)
        };
        tiles.into_par_iter().chunks(batch_tiles).map(run).try_reduce(RayStats::default, |mut sum, stats| {
            sum += stats;
            Ok(sum)
        })
    }
}
