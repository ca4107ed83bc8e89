//! The photons of stochastic progressive photon mapping.
//!
//! As on the CPU (`integrators/src/photons/sppm.rs`), with the same random numbers: each pass has
//! photons of its own, and a radius that depends on its number alone. The device makes light paths,
//! each of which writes its photons to places of its own. Here they are sorted into a grid of
//! hashed cells in the order of their paths, so that nothing depends on the order of threads, and
//! are taken back to the device, where camera paths gather them.

use std::sync::Arc;

use description::{SppmDesc, merging_radius};
use math::Bounds2i;
use rayon::prelude::*;
use scene::{ShutterSample, View};

use super::scene_buffers::SceneBuffers;
use super::{WORKGROUP, workgroups};
use crate::device::{Buffer, GpuError, Kernel};
use crate::records::photons::Batch;

/// The most photons that light paths may make at a time, unless one path may make more.
const MAX_PHOTONS: usize = 1 << 20;

/// A little more than 1, to cover rounding errors.
const MARGIN: f32 = 1.000_001;

/// A photon, as the kernel writes and reads it.
type Photon = [[u32; 4]; 3];

/// Light paths, and the places of their photons.
pub(super) struct Photons {
    kernel: Arc<Kernel>,
    seed: u32,
    /// The light paths of a pass, and how many are made at a time.
    paths: usize,
    paths_at_a_time: usize,
    /// The most photons of a light path.
    most: usize,
    /// The radius of the first pass.
    radius: f32,
    places: Buffer,
    bytes: usize,
}

/// The photons of a pass on the device, sorted.
pub(super) struct PhotonGrid {
    kernel: Arc<Kernel>,
    batch: Batch,
    buffer: Buffer,
    /// The wavelengths of the pass.
    pub shutter: ShutterSample,
    /// The rays of its light paths.
    pub rays: u64,
}

impl Photons {
    /// Photons for a picture of so many pixels, of a scene whose sphere has this radius.
    pub fn new(
        scene: &SceneBuffers,
        kernel: Arc<Kernel>,
        settings: &SppmDesc,
        seed: u32,
        pixels: usize,
        scene_radius: f32,
    ) -> Result<Self, GpuError> {
        let paths = settings.light_paths(pixels);
        // Direct light is not merged, so that the first surface has no photon.
        let most = settings.max_depth.saturating_sub(1) as usize;
        let paths_at_a_time = paths.min(MAX_PHOTONS / most.max(1)).max(1);
        let photons = size_of::<Photon>().saturating_mul(paths_at_a_time.saturating_mul(most).max(1));
        let bytes = photons.saturating_add(size_of::<Batch>());
        let places = scene.device().zeros("photons", bytes as u64)?;
        let radius = settings.first_radius(paths, scene_radius);
        Ok(Self { kernel, seed, paths, paths_at_a_time, most, radius, places, bytes })
    }

    /// The bytes of their buffer.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Makes the photons of a pass; `None` if it was cancelled. `samples` is what the kernel has
    /// for pixels.
    pub fn shoot(
        &self,
        pass: u32,
        scene: &SceneBuffers,
        samples: &Buffer,
        view: &View,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<PhotonGrid>, GpuError> {
        let (device, shutter) = (scene.device(), ShutterSample::of_pass(view, self.seed, pass));
        let radius = merging_radius(self.radius, SppmDesc::ALPHA, pass);
        let shared = Batch {
            pass_number: pass,
            most: self.most as u32,
            radius,
            cells_per_length: 0.5 / (radius * MARGIN * MARGIN),
            merging: self.paths as f32 * (std::f32::consts::PI * radius * radius),
            lambda: *shutter.lambda.lambda(),
            pdf: shutter.lambda.pdf().0,
            ..Batch::default()
        };
        let (mut photons, mut rays): (Vec<Photon>, u64) = (Vec::new(), 0);
        for first in (0..self.paths).step_by(self.paths_at_a_time) {
            if is_cancelled() {
                return Ok(None);
            }
            let count = self.paths_at_a_time.min(self.paths - first);
            let height = count.div_ceil(WIDTH) as u32;
            let batch = Batch {
                size: [WIDTH as u32, height],
                makes_photons: 1,
                first: first as u32,
                count: count as u32,
                ..shared
            };
            device.write(&self.places, &[batch])?;
            scene.run(&self.kernel, [&self.places, samples], workgroups(batch.size))?;
            let head: Vec<Batch> = device.read_part(&self.places, 0, 1)?;
            rays += head.iter().map(|batch| u64::from(batch.rays)).sum::<u64>();
            let places: Vec<Photon> =
                device.read_part(&self.places, size_of::<Batch>() as u64, count * self.most)?;
            photons.extend(places.into_iter().filter(|photon| photon[1][3] != 0));
        }
        let (batch, words) = sorted(&photons, shared);
        let buffer = device.buffer("photons of a pass", &words)?;
        Ok(Some(PhotonGrid { kernel: self.kernel.clone(), batch, buffer, shutter, rays }))
    }
}

/// Light paths of a row of the rectangle in which the kernel makes them.
const WIDTH: usize = 16 * WORKGROUP as usize;

impl PhotonGrid {
    /// Starts the kernel for a strip of pixels.
    pub fn gather(&self, scene: &SceneBuffers, samples: &Buffer, strip: &Bounds2i) -> Result<(), GpuError> {
        let size = [strip.width() as u32, strip.height() as u32];
        let batch = Batch { low: strip.min.map(|x| x as u32), size, ..self.batch };
        scene.device().write(&self.buffer, &[batch])?;
        scene.run(&self.kernel, [&self.buffer, samples], workgroups(size))
    }
}

/// Photons in the order of the buckets of their cells, and within one in that of their paths: the
/// head and the words of the buffer. After the photons come the first of each bucket, and their
/// number.
fn sorted(photons: &[Photon], shared: Batch) -> (Batch, Vec<u32>) {
    let buckets = photons.len().next_power_of_two();
    let batch =
        Batch { buckets: buckets as u32, starts: (size_of::<Photon>() / 4 * photons.len()) as u32, ..shared };
    let key = |(i, photon): (usize, &Photon)| {
        let cell =
            [0, 1, 2].map(|axis| (f32::from_bits(photon[0][axis]) * shared.cells_per_length).floor() as i32);
        u64::from(bucket(cell, batch.buckets)) << 32 | i as u64
    };
    let mut keys: Vec<u64> = photons.par_iter().enumerate().map(key).collect();
    keys.par_sort_unstable();
    let mut words: Vec<u32> = bytemuck::pod_collect_to_vec(&[batch]);
    for key in &keys {
        words.extend(photons[*key as u32 as usize].as_flattened());
    }
    let mut begun = 0;
    for (place, key) in keys.iter().enumerate() {
        let bucket = (key >> 32) as usize;
        words.extend(std::iter::repeat_n(place as u32, bucket + 1 - begun));
        begun = bucket + 1;
    }
    words.extend(std::iter::repeat_n(photons.len() as u32, buckets + 1 - begun));
    // Whole quadruples.
    words.resize(words.len().next_multiple_of(4), 0);
    (batch, words)
}

/// The bucket of a cell: `bucket_of` of `shaders/photons.wgsl`.
fn bucket([x, y, z]: [i32; 3], buckets: u32) -> u32 {
    let mixed = (x as u32).wrapping_mul(0x8da6_b343)
        ^ (y as u32).wrapping_mul(0xd816_3841)
        ^ (z as u32).wrapping_mul(0xcb1a_b31f);
    let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x2c1b_3c6d);
    (mixed ^ mixed >> 16) & (buckets - 1)
}
