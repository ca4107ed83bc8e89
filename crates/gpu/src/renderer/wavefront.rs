//! Paths by stages: `shaders/wavefront/`.
//!
//! The stages of the paths of a strip follow each other until no path is left: their rays are
//! extended to the next surface, all are shaded there, and their shadow rays are traced [Laine
//! 2013]. Paths that go on are appended to the queue of the next stage, so that those that have
//! ended leave no gap [van Antwerpen 2011b]. The megakernel does the same to each path by one
//! thread, by the same functions.

use std::sync::Arc;

use math::Bounds2i;

use super::kernels::Kernels;
use super::scene_buffers::SceneBuffers;
use super::strip::PixelSample;
use crate::device::{Buffer, Copied, GpuError, Kernel};
use crate::flatten::Flat;
use crate::shaders;

/// Rows of the table of paths, of four words.
const ROWS: usize = 20;

/// Threads of a workgroup.
const WORKGROUP: u32 = 64;

/// The bindings that camera rays need nothing of: trees, triangles, shapes and texels; and that of
/// trees, which no ray of a shaded point is traced through.
const WITHOUT_RAYS: [u32; 4] = [1, 2, 3, 7];
const WITHOUT_TREES: [u32; 1] = [1];

/// What the kernels are to do: `Batch` of `shaders/wavefront/paths.wgsl`, which the queues follow.
#[repr(C)]
#[derive(Clone, Copy, Default, bytemuck::Pod, bytemuck::Zeroable)]
struct Batch {
    low: [u32; 2],
    size: [u32; 2],
    index: u32,
    count: u32,
    turn: u32,
    unused: u32,
    /// Of the two queues of paths, and of that of shadow rays.
    lengths: [u32; 4],
}

/// The kernels of the stages, and the paths of a strip.
pub(super) struct Wavefront {
    stages: [Arc<Kernel>; 4],
    batch: Buffer,
    table: Buffer,
    bytes: usize,
}

impl Wavefront {
    /// For strips of at most so many pixels.
    pub fn new(kernels: &Kernels, flat: &Flat, pixels: usize) -> Result<Self, GpuError> {
        let [begin, extend, shade, connect] = shaders::wavefront(flat.parts);
        let stages = [
            kernels.get("begin", begin)?,
            kernels.get("extend", extend)?,
            kernels.get("shade", shade)?,
            kernels.get("connect", connect)?,
        ];
        let (batch_bytes, table_bytes) = (size_of::<Batch>() + 12 * pixels.max(1), 16 * ROWS * pixels.max(1));
        let device = kernels.device();
        let batch = device.zeros("queues of paths", batch_bytes as u64)?;
        let table = device.zeros("paths", table_bytes as u64)?;
        Ok(Self { stages, batch, table, bytes: batch_bytes + table_bytes })
    }

    /// The bytes of its buffers.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Makes the samples of an index of a strip, row by row, and starts to copy them.
    pub fn run(&self, index: u32, strip: &Bounds2i, scene: &SceneBuffers) -> Result<Copied, GpuError> {
        let [begin, extend, shade, connect] = &self.stages;
        let (device, count) = (scene.device(), strip.area() as u32);
        let mut batch = Batch {
            low: strip.min.map(|x| x as u32),
            size: [strip.width() as u32, strip.height() as u32],
            index,
            count,
            lengths: [count, 0, 0, 0],
            ..Batch::default()
        };
        let start = |kernel, unused: &[u32], threads: u32| {
            let buffers = [&self.batch, &self.table];
            scene.run_without(unused, kernel, buffers, [threads.div_ceil(WORKGROUP), 1])
        };
        device.write(&self.batch, &[batch])?;
        start(begin, &WITHOUT_RAYS, count)?;
        while let length @ 1.. = batch.lengths[batch.turn as usize] {
            start(extend, &[], length)?;
            start(shade, &WITHOUT_TREES, length)?;
            let found: Vec<Batch> = device.read_part(&self.batch, 0, 1)?;
            batch.lengths = found.first().map_or([0; 4], |batch| batch.lengths);
            if let shadows @ 1.. = batch.lengths[2] {
                start(connect, &[], shadows)?;
            }
            // The queue that was read is the next one to be filled.
            batch.lengths[batch.turn as usize] = 0;
            batch.lengths[2] = 0;
            batch.turn = 1 - batch.turn;
            device.write(&self.batch, &[batch])?;
        }
        // The first two rows.
        device.copy(&self.table, 0, u64::from(count) * size_of::<PixelSample>() as u64)
    }
}
