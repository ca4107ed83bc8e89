//! Paths by stages: `shaders/wavefront/`.
//!
//! In each turn of the stages paths begin, their rays are extended to the next surface, all are
//! shaded there, and their shadow rays are traced [Laine 2013]. Paths that go on are appended to
//! the queue of the next turn, and new ones take the places of those that have ended, so that
//! stages are full as long as there are samples [van Antwerpen 2011b]. Before they are shaded,
//! paths are sorted by the kinds of the materials that they have hit. The megakernel does the same
//! to each path by one thread, by the same functions.
//!
//! What is found for a sample does not depend on its place, nor on the order in queues. The device
//! counts the workgroups of each stage, and the host reads once in several turns whether any path
//! is left.

use std::ops::Range;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

use math::Bounds2i;

use super::kernels::Kernels;
use super::scene_buffers::SceneBuffers;
use crate::algorithm::Algorithm;
use crate::device::{Buffer, Copied, GpuError, Kernel, Workgroups};
use crate::flatten::Flat;
use crate::records::pixels::PixelSample;
use crate::records::wavefront::Batch;
use crate::shaders::{self, Parts};

/// Rows of the table of paths, of four words.
const ROWS: usize = 18;

/// The queues of `shaders/wavefront/queues.wgsl` before those of kinds of materials.
const QUEUES: usize = 4;

/// The queue of places of paths that have ended.
const ENDED: usize = 1;

/// The most paths at a time, by a GPU in software fewer.
const MAX_PATHS: usize = 1 << 18;
const MAX_PATHS_OF_SOFTWARE: usize = 1 << 14;

/// Turns between those after which the host reads what is left.
const TURNS: usize = 4;

/// The bytes of a number of workgroups, and of those for paths that begin, for all paths, and for
/// shadow rays.
const WORKGROUPS: u64 = 16;
const ALL_WORKGROUPS: u64 = 3 * WORKGROUPS;

/// The samples of a strip that are made together.
#[derive(Clone, Copy)]
pub(super) struct Size {
    /// The most pixels.
    pub pixels: usize,
    /// The most samples of each.
    pub samples: u32,
}

/// The kernels of the stages, and the paths of a strip.
pub(super) struct Wavefront {
    stages: [Arc<Kernel>; 5],
    batch: Buffer,
    table: Buffer,
    workgroups: Buffer,
    places: usize,
    /// The kinds of materials, a bit for each.
    kinds: u32,
    /// The number of samples of a pixel that are planned, and made together.
    planned: u32,
    together: u32,
    made: Mutex<Made>,
    bytes: usize,
}

/// Samples that are made.
#[derive(Default)]
struct Made {
    /// The indices of those that are in the table.
    indices: Range<u32>,
    /// The paths of all steps so far, and the places that there were for them.
    paths: u64,
    places: u64,
}

/// Features that the stages lack for a scene and an algorithm, if anything: few scenes have it.
pub fn lacking_stages(algorithm: &Algorithm, parts: Parts) -> Option<&'static str> {
    let Parts { media, subsurface, lenses, .. } = parts;
    let is_path = matches!(algorithm, Algorithm::Path(_) | Algorithm::VolPath(_));
    let lacking = [
        (!is_path, "this algorithm"),
        (media, "media and interfaces"),
        (subsurface, "paths under surfaces"),
        (lenses, "realistic cameras"),
    ];
    lacking.into_iter().find_map(|(is, what)| is.then_some(what))
}

impl Wavefront {
    /// For strips of at most this size.
    pub fn new(kernels: &Kernels, flat: &Flat, size: Size) -> Result<Self, GpuError> {
        let [begin, extend, shade, plan, connect] = shaders::wavefront(flat.parts);
        let stages = [
            kernels.get("begin", begin)?,
            kernels.get("extend", extend)?,
            kernels.get("shade", shade)?,
            kernels.get("plan", plan)?,
            kernels.get("connect", connect)?,
        ];
        let device = kernels.device();
        let most = if device.is_software() { MAX_PATHS_OF_SOFTWARE } else { MAX_PATHS };
        let together = size.samples.min(flat.passes).max(1);
        let samples = size.pixels.max(1) * together as usize;
        let places = samples.min(most);
        let queues = QUEUES + flat.kinds.count_ones() as usize;
        let batch_bytes = size_of::<Batch>() + 4 * queues * places;
        let table_bytes = samples * size_of::<PixelSample>() + 16 * ROWS * places;
        let batch = device.zeros("queues of paths", batch_bytes as u64)?;
        let table = device.zeros("paths", table_bytes as u64)?;
        let workgroups = device.workgroups(ALL_WORKGROUPS)?;
        Ok(Self {
            stages,
            batch,
            table,
            workgroups,
            places,
            kinds: flat.kinds,
            planned: flat.passes,
            together,
            made: Mutex::default(),
            bytes: batch_bytes + table_bytes + ALL_WORKGROUPS as usize,
        })
    }

    /// The bytes of its buffers.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// The paths of a step, relative to the places, in the mean of the steps so far.
    pub fn occupancy(&self) -> Option<f64> {
        let Made { paths, places, .. } = *self.made();
        (places > 0).then(|| paths as f64 / places as f64)
    }

    fn made(&self) -> MutexGuard<'_, Made> {
        self.made.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Makes the samples of an index of a strip, row by row, and starts to copy them. Those of the
    /// next indices may be made with them, for later calls.
    pub fn run(&self, index: u32, strip: &Bounds2i, scene: &SceneBuffers) -> Result<Copied, GpuError> {
        let mut made = self.made();
        // Strips are made one index at a time where there are several.
        if self.together == 1 || !made.indices.contains(&index) {
            let end = index.saturating_add(self.together).min(self.planned.max(index.saturating_add(1)));
            made.indices = 0..0;
            let batch = self.make(index..end, strip, scene)?;
            made.indices = index..end;
            made.paths += u64::from(batch.paths);
            made.places += u64::from(batch.turns) * u64::from(batch.places);
        }
        let bytes = strip.area() as u64 * size_of::<PixelSample>() as u64;
        scene.device().copy(&self.table, u64::from(index - made.indices.start) * bytes, bytes)
    }

    /// Makes the samples of these indices; the batch after the last turn.
    fn make(&self, indices: Range<u32>, strip: &Bounds2i, scene: &SceneBuffers) -> Result<Batch, GpuError> {
        let device = scene.device();
        let samples = strip.area() as u32 * indices.len() as u32;
        // Paths at one kind are not sorted.
        let kinds = self.kinds.count_ones();
        let mut batch = Batch {
            low: strip.min.map(|x| x as u32),
            size: [strip.width() as u32, strip.height() as u32],
            index: indices.start,
            samples,
            places: samples.min(self.places as u32),
            kinds: self.kinds,
            sorts: if kinds > 1 { 1 + kinds } else { 1 },
            ..Batch::default()
        };
        batch.lengths[ENDED] = batch.places;
        device.write(&self.batch, &[batch])?;
        let [begin, extend, shade, plan, connect] = &self.stages;
        let paths = [&self.batch, &self.table];
        let counted = |count| Workgroups::At(&self.workgroups, WORKGROUPS * count);
        let plans = [&self.batch, &self.workgroups];
        let plan = &scene.task(plan, plans, Workgroups::Of([1; 3]));
        let turn = [
            &scene.task(begin, paths, counted(0)),
            &scene.task(extend, paths, counted(1)),
            &scene.task(shade, paths, counted(1)),
            plan,
            &scene.task(connect, paths, counted(2)),
        ];
        device.run_tasks([plan])?;
        let mut before = None;
        loop {
            device.run_tasks(std::iter::repeat_n(turn, TURNS).flatten())?;
            let head = device.copy(&self.batch, 0, size_of::<Batch>() as u64)?;
            // While the host reads this, the device does the next turns.
            let Some(head) = before.replace(head) else { continue };
            let head: Batch = device.contents(&head, |bytes| *bytemuck::from_bytes(bytes))?;
            if head.going_on + head.beginning == 0 {
                return Ok(head);
            }
        }
    }
}
