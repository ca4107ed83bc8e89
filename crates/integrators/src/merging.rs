//! What methods that merge have in common: photons shot anew in each pass, and a radius that shrinks from pass to pass.
//!
//! The light that a surface at x scatters towards the camera is estimated from the n light subpaths of a pass by all their vertices
//! within the radius r, as if they had arrived at x itself:
//!
//! ```text
//! L ≈ 1/(n π r²) · Σ f(x, ωₒ, ω_p) Φ_p
//! ```
//!
//! That blurs light over the radius. The blur is a bias which goes with r² (with r beside edges and walls without thickness, through
//! which light leaks), while noise goes with 1/r²; both vanish if pass i has
//! the radius of [Knaus 2011]
//!
//! ```text
//! r_{i+1}² = r_i² · (i + α)/(i + 1)        so that r_i² ~ i^(α − 1)
//! ```
//!
//! and the picture is the mean of all passes: after N of them its bias is about N^(α − 1), its variance N^(−α) of that of the first.
//! The radius depends on nothing but the pass's number, so passes can be made in any order, anywhere, and again.
//!
//! Photons can be merged with a path from the camera only if both know of the same wavelengths, at the same time. So all paths
//! of a pass have one choice of both, spread evenly over the passes: each step goes on by an irrational part of the range. For
//! wavelengths that is a quarter of the golden ratio, because four of them, a quarter apart, are taken at once.
//!
//! Sources: [Knaus 2011]; [Hachisuka 2009].

use geometry::RayStats;
use rayon::prelude::*;
use sampling::sampler::PaddedSobol;
use sampling::{Randomize, Sampler};
use scene::Scene;

use crate::bidirectional::{Bidirectional, Vertex};
use crate::photon_grid::{Photon, PhotonGrid};
use crate::pixel_loop::Moment;
use crate::{Cancelled, Control};

/// Light subpaths that are followed between two looks at whether to go on.
const BATCH: usize = 1024;

/// Photons of passes, and the radius that they count within.
#[derive(Clone, Debug)]
pub(crate) struct Merging {
    /// The radius of the first pass.
    radius: f32,
    /// How slowly the radius shrinks, in (0, 1].
    alpha: f32,
    seed: u32,
    last: LastPass,
}

/// What the summary tells.
#[derive(Clone, Debug, Default)]
struct LastPass {
    passes: u32,
    radius: f32,
    paths: usize,
    photons: usize,
    bytes: usize,
}

impl Merging {
    /// With the radius of the first pass.
    pub fn new(radius: f32, alpha: f32, seed: u32) -> Self {
        Self { radius, alpha, seed, last: LastPass::default() }
    }

    /// Changes the radius of the first pass.
    pub fn begin_with(&mut self, radius: f32) {
        self.radius = radius;
    }

    /// The radius of a pass, which are counted from 0.
    pub fn radius(&self, pass: u32) -> f32 {
        let alpha = f64::from(self.alpha);
        let shrunk: f64 = (1..=pass).map(|i| (f64::from(i) + alpha) / (f64::from(i) + 1.0)).product();
        (f64::from(self.radius) * shrunk.sqrt()) as f32
    }

    /// The wavelengths and the time of a pass.
    pub fn moment(&self, scene: &Scene, pass: u32) -> Moment {
        Moment::of_pass(scene, self.seed, pass)
    }

    /// Follows a pass's light subpaths and keeps those of their vertices that are wanted. Each path takes a sample of one
    /// sequence, so that all the photons of a pass are well spread.
    pub fn shoot(
        &mut self,
        paths: &Bidirectional,
        count: usize,
        pass: u32,
        is_wanted: impl Fn(&Vertex) -> bool + Sync,
        control: &Control,
    ) -> Result<(PhotonGrid, RayStats), Cancelled> {
        let moment = self.moment(paths.scene, pass);
        let time = moment.time(paths.scene);
        let sampler = PaddedSobol::new(count as u32, Randomize::FastOwen, self.seed);
        let batch = |start: usize| {
            control.check()?;
            let mut sampler = Sampler::PaddedSobol(sampler.clone());
            let (mut photons, mut stats) = (Vec::new(), RayStats::default());
            for i in start..count.min(start + BATCH) {
                sampler.start_pixel_sample([pass as i32, 0], i as u32, 0);
                paths.light_subpath(time, &moment.lambda, &mut sampler, &mut stats, |vertex, _, _| {
                    if is_wanted(vertex) {
                        photons.push(Photon::from(vertex));
                    }
                });
            }
            control.count(&stats);
            Ok((photons, stats))
        };
        let starts = (0..count.div_ceil(BATCH)).into_par_iter().map(|i| i * BATCH);
        let batches: Vec<(Vec<Photon>, RayStats)> = starts.map(batch).collect::<Result<_, _>>()?;
        let mut stats = RayStats::default();
        let mut photons = Vec::with_capacity(batches.iter().map(|(photons, _)| photons.len()).sum());
        for (batch, of_batch) in batches {
            photons.extend(batch);
            stats += of_batch;
        }
        let radius = self.radius(pass);
        let grid = PhotonGrid::new(photons, radius);
        self.last =
            LastPass { passes: pass + 1, radius, paths: count, photons: grid.len(), bytes: grid.bytes() };
        Ok((grid, stats))
    }

    /// What the integrators tell of it.
    pub fn summary(&self) -> Vec<(&'static str, String)> {
        let &LastPass { passes, radius, paths, photons, bytes } = &self.last;
        if passes == 0 {
            return Vec::new();
        }
        let mebibytes = bytes as f64 / f64::from(1 << 20);
        vec![
            ("photons", format!("{photons} from {paths} paths in a pass, {mebibytes:.1} MiB")),
            ("radius", format!("{} in pass 1, {radius} in pass {passes}", self.radius)),
        ]
    }
}
