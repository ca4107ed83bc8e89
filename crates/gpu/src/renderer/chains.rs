//! The chains of Metropolis light transport: their starts, and what they bring to the film.
//!
//! As on the CPU (`integrators/src/metropolis`) the chains of a pass start at points chosen among
//! uniform candidates of that pass alone, so that passes are independent estimates of the picture
//! and nothing of a chain outlives its pass. The device evaluates candidates, sums and choices are
//! made here. Settings mean the same, and the mean of the picture is the same; random numbers are
//! others, functions of (pass, chain, step, dimension).
//!
//! A chain takes 24 + 6d words for paths of up to d scattering events, 480 bytes for the 16 that
//! there may be. As it is at least 256 mutations long, all chains together take less than two bytes
//! for each pixel.

use std::sync::Arc;

use description::MltDesc;
use film::Splatter;
use math::Vec2;
use rayon::prelude::*;
use sampling::{hash, hash_float, resample};
use scene::{ShutterSample, View};
use spectrum::SampledSpectrum;

use super::Kernels;
use super::scene_buffers::SceneBuffers;
use crate::device::{Buffer, GpuError, Kernel};
use crate::flatten::Flat;
use crate::records::chains::{Batch, Splat};
use crate::shaders;
use crate::tags::ChainRow;

/// A number beyond those of passes, for the candidates of the estimate that is independent of them.
const B0_PASS: u32 = u32::MAX;

/// The fewest mutations for each candidate, and of a chain, as on the CPU.
const MUTATIONS_PER_CANDIDATE: usize = 4;
const MIN_MUTATIONS: usize = 256;

/// The most candidates that are evaluated at a time; the most steps that chains take at a time, and
/// the most splats of these steps, unless there are more chains. Mesa's software GPU ends the loops
/// of a thread, without an error, when all of them together have run 65,535 times, of which a step
/// may take thousands.
const MAX_CANDIDATES: usize = 1 << 14;
const MAX_STEPS: usize = 64;
const MAX_STEPS_OF_SOFTWARE: usize = 8;
const MAX_SPLATS: usize = 1 << 20;

/// Chains of a workgroup.
const WORKGROUP: usize = 64;

/// The splats that a thread adds at a time.
const SPLATS_OF_A_THREAD: usize = 1 << 12;

/// The chains of passes.
pub(super) struct Chains {
    kernel: Arc<Kernel>,
    settings: MltDesc,
    seed: u32,
    /// The mutations, candidates and chains of a pass.
    mutations: usize,
    candidates: usize,
    count: usize,
    /// The steps that chains take at a time.
    steps: usize,
    batch: Buffer,
    table: Buffer,
    bytes: usize,
    /// The estimate of the mean scalar contribution that weights have.
    b0: f32,
}

impl Chains {
    /// Chains with so many mutations in a pass.
    pub fn new(
        kernels: &Kernels,
        scene: &SceneBuffers,
        flat: &Flat,
        settings: MltDesc,
        seed: u32,
        mutations: usize,
    ) -> Result<Self, GpuError> {
        let kernel = kernels.get("chains", shaders::chains(flat.parts))?;
        let candidates =
            (settings.bootstrap_samples as usize).min(mutations / MUTATIONS_PER_CANDIDATE).max(1);
        let count = (settings.chains as usize).min(mutations / MIN_MUTATIONS).max(1);
        let device = scene.device();
        let most_steps = if device.is_software() { MAX_STEPS_OF_SOFTWARE } else { MAX_STEPS };
        let steps = (MAX_SPLATS / count).clamp(1, most_steps);
        let columns = candidates.min(MAX_CANDIDATES).max(count);
        let table_bytes = 4 * columns * (ChainRow::Point as usize + dimensions(settings.max_depth as usize));
        let batch_bytes = size_of::<Batch>() + size_of::<Splat>() * columns.max(count * steps);
        let batch = device.zeros("splats of chains", batch_bytes as u64)?;
        let table = device.zeros("chains", table_bytes as u64)?;
        let bytes = batch_bytes + table_bytes;
        let mut chains = Self {
            kernel,
            settings,
            seed,
            mutations,
            candidates,
            count,
            steps,
            batch,
            table,
            bytes,
            b0: 0.0,
        };
        chains.b0 = mean(&chains.candidates(scene, B0_PASS)?.0);
        Ok(chains)
    }

    /// The bytes of their buffers.
    pub fn bytes(&self) -> usize {
        self.bytes
    }

    /// Runs the chains of a pass, until `is_cancelled`. Returns the number of rays, or `None` if
    /// steps are missing.
    pub fn run(
        &self,
        pass: u32,
        scene: &SceneBuffers,
        view: &View,
        splatter: &Splatter,
        is_cancelled: impl Fn() -> bool,
    ) -> Result<Option<u64>, GpuError> {
        let (candidates, mut rays) = self.candidates(scene, pass)?;
        let starts = resample(&candidates, self.count, hash_float(&[self.seed, pass]));
        self.write_row(scene, ChainRow::Start, &starts)?;
        self.write_row(scene, ChainRow::Rays, &vec![0; self.count])?;
        let (mutations, longer) = (self.mutations / self.count, self.mutations % self.count);
        // Before the mutations is the start, and after them the end.
        let last = mutations + usize::from(longer > 0) + 1;
        for first in (0..=last).step_by(self.steps) {
            if is_cancelled() {
                return Ok(None);
            }
            let batch = Batch {
                count: self.count as u32,
                step: first as u32,
                steps: self.steps.min(last + 1 - first) as u32,
                mutations: mutations as u32,
                longer: longer as u32,
                b: mean(&candidates),
                b0: self.b0,
                ..self.batch(pass)
            };
            self.start(scene, &batch)?;
            let count = (batch.steps * batch.count) as usize;
            let splats: Vec<Splat> =
                scene.device().read_part(&self.batch, size_of::<Batch>() as u64, count)?;
            splats.par_chunks(SPLATS_OF_A_THREAD).for_each(|splats| {
                for splat in splats.iter().filter(|splat| splat.l != [0.0; 4]) {
                    let lambda = ShutterSample::wavelengths(view, splat.wavelength);
                    splatter.add(Vec2::from_array(splat.film), &SampledSpectrum::new(splat.l), &lambda);
                }
            });
            let mutating = |step: usize| match step {
                0 => 0,
                step if step <= mutations => self.count,
                step if step == mutations + 1 => longer,
                _ => 0,
            };
            let end = first + batch.steps as usize;
            splatter.add_paths((first..end).map(mutating).sum::<usize>() as u64);
        }
        rays += sum(&self.read_row(scene, ChainRow::Rays, self.count)?);
        Ok(Some(rays))
    }

    /// The scalar contributions of the candidates of a pass, and the number of their rays.
    fn candidates(&self, scene: &SceneBuffers, pass: u32) -> Result<(Vec<f32>, u64), GpuError> {
        let (mut scalars, mut rays) = (Vec::with_capacity(self.candidates), 0);
        while scalars.len() < self.candidates {
            let first = scalars.len();
            let end = self.candidates.min(first + MAX_CANDIDATES);
            let count = end - first;
            let batch = Batch { count: count as u32, steps: 1, ..self.batch(pass) };
            let starts: Vec<u32> = (first as u32..end as u32).collect();
            self.write_row(scene, ChainRow::Start, &starts)?;
            self.write_row(scene, ChainRow::Rays, &vec![0; count])?;
            self.start(scene, &batch)?;
            scalars.extend(self.read_row(scene, ChainRow::Scalar, count)?.into_iter().map(f32::from_bits));
            rays += sum(&self.read_row(scene, ChainRow::Rays, count)?);
        }
        Ok((scalars, rays))
    }

    /// What all batches of a pass share.
    fn batch(&self, pass: u32) -> Batch {
        let [candidate_key, key] = [0, 1].map(|kind| hash(&[self.seed, pass, kind]) as u32);
        let MltDesc { sigma, large_step_probability, .. } = self.settings;
        Batch { candidate_key, key, sigma, large: large_step_probability, ..Batch::default() }
    }

    fn start(&self, scene: &SceneBuffers, batch: &Batch) -> Result<(), GpuError> {
        scene.device().write(&self.batch, &[*batch])?;
        let workgroups = [batch.count.div_ceil(WORKGROUP as u32), 1];
        scene.run(&self.kernel, [&self.batch, &self.table], workgroups)
    }

    /// Replaces a row of the table, of which a row is as long.
    fn write_row(&self, scene: &SceneBuffers, row: ChainRow, words: &[u32]) -> Result<(), GpuError> {
        scene.device().write_at(&self.table, (4 * words.len() * row as usize) as u64, words)
    }

    /// A row of a table of so many columns.
    fn read_row(&self, scene: &SceneBuffers, row: ChainRow, columns: usize) -> Result<Vec<u32>, GpuError> {
        scene.device().read_part(&self.table, (4 * columns * row as usize) as u64, columns)
    }
}

/// The coordinates of a point: of the choice of a strategy and of the camera, of the camera's
/// subpath, of the light's, and of the connection.
fn dimensions(max_depth: usize) -> usize {
    8 + 3 * max_depth + (5 + 3 * max_depth.saturating_sub(1)) + 3
}

fn mean(values: &[f32]) -> f32 {
    (values.iter().map(|&value| f64::from(value)).sum::<f64>() / values.len() as f64) as f32
}

fn sum(counts: &[u32]) -> u64 {
    counts.iter().map(|&count| u64::from(count)).sum()
}
