//! The chains of a pass: their starts, and their contributions to the film.

use description::MltDesc;
use film::Splatter;
use geometry::RayStats;
use rayon::prelude::*;
use sampling::sampler::PrimarySample;
use sampling::{Sampler, hash, hash_float, resample};
use scene::{Scene, View};

use super::chain::{Acceptance, Chain, Steps, Streams};
use super::target::{Contribution, Target};
use crate::transport::Tracer;
use crate::{Cancelled, Control};

/// Runs the chains of passes, and keeps their statistics.
#[derive(Debug)]
pub(super) struct Chains {
    settings: MltDesc,
    seed: u32,
    b0: Option<f32>,
    passes: u32,
    /// Sum of the estimates b of these passes.
    b_sum: f64,
    /// Mutations in the last pass.
    mutations: usize,
    acceptance: Acceptance,
}

/// A number beyond those of passes, for the candidates that estimate b₀.
const B0_PASS: u32 = u32::MAX;

/// Minimum number of mutations per candidate. A larger one leaves so few candidates that chains
/// often start at the same one.
const MUTATIONS_PER_CANDIDATE: usize = 4;

/// Minimum number of mutations per chain; shorter chains stay too close to their start.
const MIN_MUTATIONS: usize = 256;

/// Number of candidates per parallel task.
const CANDIDATES_PER_TASK: usize = 256;

/// A target in a view of a scene.
pub(super) struct Targeted<'a> {
    pub scene: &'a Scene,
    pub view: &'a View,
    pub target: &'a dyn Target,
}

impl Targeted<'_> {
    /// The contribution of the point of primary sample space in the streams.
    fn contribution(
        &self,
        [first, others @ ..]: &mut Streams,
        stats: &mut RayStats,
        control: &Control,
    ) -> Contribution {
        let mut tracer = Tracer::new(self.scene, self.view, control, first, stats);
        self.target.contribution(&mut tracer, others)
    }
}

impl Chains {
    pub fn new(settings: MltDesc, seed: u32) -> Self {
        Self {
            settings,
            seed,
            b0: None,
            passes: 0,
            b_sum: 0.0,
            mutations: 0,
            acceptance: Acceptance::default(),
        }
    }

    /// The numbers of candidates and of chains of a pass.
    fn starts(&self, mutations: usize) -> (usize, usize) {
        let MltDesc { bootstrap_samples, chains, .. } = self.settings;
        let candidates = (bootstrap_samples as usize).min(mutations / MUTATIONS_PER_CANDIDATE);
        (candidates.max(1), (chains as usize).min(mutations / MIN_MUTATIONS).max(1))
    }

    /// Runs the chains of a pass, for `mutations` steps in total.
    pub fn run(
        &mut self,
        pass: u32,
        target: &Targeted,
        mutations: usize,
        splatter: &Splatter,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        let mut stats = RayStats::default();
        let (count, chains) = self.starts(mutations);
        let mut bootstrap = |pass| {
            let (candidates, more) = self.bootstrap(pass, count, target, control)?;
            stats += more;
            Ok((mean(&candidates), candidates))
        };
        let b0 = match self.b0 {
            Some(b0) => b0,
            None => bootstrap(B0_PASS)?.0,
        };
        let (b, candidates) = bootstrap(pass)?;
        self.b0 = Some(b0);

        let steps = Steps { large: self.settings.large_step_probability, b, b0 };
        let starts = resample(&candidates, chains, hash_float(&[self.seed, pass]));
        let chain = |(k, &start): (usize, &u32)| {
            let mut stats = RayStats::default();
            let mut evaluate = |streams: &mut Streams| {
                let contribution = target.contribution(streams, &mut stats, control);
                (contribution, contribution.c())
            };
            let mut streams = self.streams();
            start_at(&mut streams, pass, start);
            let mut chain = Chain::new(streams, hash(&[self.seed, pass, k as u32]), &mut evaluate);
            control.check()?;
            let length = mutations * (k + 1) / chains - mutations * k / chains;
            for _ in 0..length {
                let (contribution, weight) = chain.step(&steps, &mut evaluate);
                // Checked before splatting, as the contribution of a cancelled path is incomplete.
                control.check()?;
                contribution.splat(weight, splatter);
                splatter.add_paths(1);
            }
            let ((contribution, weight), acceptance) = chain.end();
            contribution.splat(weight, splatter);
            control.count(&stats);
            Ok((stats, acceptance))
        };
        let nothing = || (RayStats::default(), Acceptance::default());
        let (more, acceptance) =
            starts.par_iter().enumerate().map(chain).try_reduce(nothing, |mut all, one| {
                all.0 += one.0;
                all.1 += one.1;
                Ok(all)
            })?;
        self.passes += 1;
        self.mutations = mutations;
        self.b_sum += f64::from(b);
        self.acceptance += acceptance;
        stats += more;
        Ok(stats)
    }

    /// The importances of the candidates of a pass.
    fn bootstrap(
        &self,
        pass: u32,
        count: usize,
        target: &Targeted,
        control: &Control,
    ) -> Result<(Vec<f32>, RayStats), Cancelled> {
        let mut candidates = vec![0.0; count];
        let row = |(row, candidates): (usize, &mut [f32])| {
            let (mut streams, mut stats) = (self.streams(), RayStats::default());
            for (i, c) in candidates.iter_mut().enumerate() {
                start_at(&mut streams, pass, (row * CANDIDATES_PER_TASK + i) as u32);
                *c = target.contribution(&mut streams, &mut stats, control).c();
                control.check()?;
            }
            control.count(&stats);
            Ok(stats)
        };
        let rows = candidates.par_chunks_mut(CANDIDATES_PER_TASK).enumerate();
        let stats = rows.map(row).try_reduce(RayStats::default, |mut sum, stats| {
            sum += stats;
            Ok(sum)
        })?;
        Ok((candidates, stats))
    }

    fn streams(&self) -> Streams {
        let MltDesc { mutations_per_pixel, sigma, .. } = self.settings;
        [0, 1, 2].map(|stream| {
            let seed = hash(&[self.seed, stream]) as u32;
            Sampler::PrimarySample(PrimarySample::new(mutations_per_pixel, sigma, seed))
        })
    }

    /// Statistics of the chains.
    pub fn summary(&self) -> Vec<(&'static str, String)> {
        if self.passes == 0 {
            return Vec::new();
        }
        let Acceptance { proposed, accepted } = self.acceptance;
        let share = |kind: usize| 100.0 * accepted[kind] as f64 / proposed[kind].max(1) as f64;
        let (candidates, chains) = self.starts(self.mutations);
        let kib = (size_of::<f32>() * candidates + size_of::<u32>() * chains).div_ceil(1024);
        vec![
            (
                "b",
                format!(
                    "{:.6e}, the mean contribution of independent paths",
                    self.b_sum / f64::from(self.passes)
                ),
            ),
            ("accepted", format!("{:.1} % of small steps, {:.1} % of large ones", share(0), share(1))),
            ("starts", format!("{chains} of {candidates} paths in each pass, in {kib} KiB")),
        ]
    }
}

/// Sets the samplers to a uniform point.
fn start_at(streams: &mut Streams, pass: u32, index: u32) {
    streams.iter_mut().for_each(|stream| stream.start_pixel_sample([index as i32, pass as i32], 0, 0));
}

fn mean(values: &[f32]) -> f32 {
    (values.iter().map(|&value| f64::from(value)).sum::<f64>() / values.len() as f64) as f32
}
