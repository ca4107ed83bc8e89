//! Progressive photon merging: new photons in each pass, and a radius that shrinks from pass to
//! pass.
//!
//! The radiance that a surface at x scatters towards the camera is estimated from the n light
//! subpaths of a pass by all their vertices within the radius r, as if they had arrived at x
//! itself:
//!
//! ```text
//! L ≈ 1/(n π r²) · Σ f(x, ωₒ, ω_p) Φ_p/α_p
//! ```
//!
//! where α_p, usually 1, is the alpha of the surface at the photon's position: only the share α_p
//! of light subpaths hits the surface, while the camera subpath has hit it already.
//!
//! The estimate blurs light over the radius. The bias is proportional to r² (to r at edges and thin
//! walls, through which light leaks), the variance to 1/r²; both vanish if pass i has the radius of
//! [Knaus 2011]
//!
//! ```text
//! r_{i+1}² = r_i² · (i + α)/(i + 1)        so that r_i² ~ i^(α − 1)
//! ```
//!
//! and the picture is the mean of all passes: after N passes the bias is about N^(α − 1) and the
//! variance N^(−α) of that of the first. The radius depends only on the number of the pass, so
//! passes can be rendered in any order and on any machine.
//!
//! Photons and camera paths must have the same wavelengths and time to be merged. So all paths of a
//! pass share one [`ShutterSample`].
//!
//! Sources: [Knaus 2011]; [Hachisuka 2009].

use description::merging_radius;
use geometry::RayStats;
use image::require_memory;
use rayon::prelude::*;
use sampling::Sampler;
use scene::{ShutterSample, View};

use crate::bidirectional::{Bidirectional, LightVertex, Vertex};
use crate::photons::photon_grid::PhotonGrid;
use crate::transport::Tracer;
use crate::{Cancelled, Control, PassError};

/// Number of light subpaths per parallel task.
const BATCH: usize = 1024;

/// The photons of passes, and their radius.
#[derive(Clone, Debug)]
pub(crate) struct Merging {
    /// The radius of the first pass, in scene units.
    radius: f32,
    /// The α of the radius, in (0, 1]; 1 keeps it constant.
    alpha: f32,
    seed: u32,
    last: LastPass,
}

/// Statistics for the summary.
#[derive(Clone, Debug, Default)]
struct LastPass {
    passes: u32,
    radius: f32,
    paths: usize,
    photons: usize,
    bytes: usize,
}

/// Data stored for the vertices of light subpaths, in path order.
#[derive(Clone, Debug)]
pub(crate) struct LightSubpaths<V> {
    /// The vertices of all paths.
    pub vertices: Vec<V>,
    /// The end of each path in that list.
    ends: Vec<usize>,
}

impl<V> Default for LightSubpaths<V> {
    fn default() -> Self {
        Self { vertices: Vec::new(), ends: Vec::new() }
    }
}

impl<V> LightSubpaths<V> {
    /// The data of one path; `None` beyond the last.
    pub fn get(&self, path: usize) -> Option<&[V]> {
        let &end = self.ends.get(path)?;
        let start = if path == 0 { 0 } else { self.ends[path - 1] };
        Some(&self.vertices[start..end])
    }

    /// Memory taken, in bytes.
    pub fn bytes(&self) -> usize {
        size_of_val(&*self.vertices) + size_of_val(&*self.ends)
    }
}

impl Merging {
    /// `radius` is that of the first pass, in scene units.
    pub fn new(radius: f32, alpha: f32, seed: u32) -> Self {
        Self { radius, alpha, seed, last: LastPass::default() }
    }

    /// Sets the radius of the first pass.
    pub fn begin_with(&mut self, radius: f32) {
        self.radius = radius;
    }

    /// The seed of the wavelengths and times of passes.
    pub fn seed(&self) -> u32 {
        self.seed
    }

    /// The radius of a pass, counted from 0.
    pub fn radius(&self, pass: u32) -> f32 {
        merging_radius(self.radius, self.alpha, pass)
    }

    /// The wavelengths and the time of a pass.
    pub fn shutter(&self, view: &View, pass: u32) -> ShutterSample {
        ShutterSample::of_pass(view, self.seed, pass)
    }

    /// Samples the light subpaths of a pass and stores the values that `keep` returns for their
    /// vertices. `sampler` returns the sampler of a path.
    pub fn shoot<'a, V: Send>(
        &self,
        paths: &'a Bidirectional,
        count: usize,
        pass: u32,
        sampler: impl Fn(usize) -> Sampler + Sync,
        keep: impl Fn(&Vertex<'a>, &mut Sampler) -> Option<V> + Sync,
        control: &Control,
    ) -> Result<(LightSubpaths<V>, RayStats), PassError> {
        // A subpath stores about two vertices, which are copied once.
        require_memory((4 * size_of::<V>() + size_of::<usize>()).saturating_mul(count))?;
        let shutter = self.shutter(paths.view, pass);
        let time = shutter.time(paths.view);
        let batch = |first: usize| {
            control.check()?;
            let (mut subpaths, mut stats) = (LightSubpaths::default(), RayStats::default());
            for path in first..count.min(first + BATCH) {
                let mut sampler = sampler(path);
                let mut tracer = Tracer::new(paths.scene, paths.view, control, &mut sampler, &mut stats);
                paths.light_subpath(time, &shutter.lambda, &mut tracer, |vertex, tracer| {
                    subpaths.vertices.extend(keep(vertex, tracer.sampler));
                });
                tracer.finish()?;
                subpaths.ends.push(subpaths.vertices.len());
            }
            control.count(&stats);
            Ok((subpaths, stats))
        };
        let batches = (0..count.div_ceil(BATCH)).into_par_iter().map(|i| i * BATCH);
        let batches: Vec<(LightSubpaths<V>, RayStats)> =
            batches.map(batch).collect::<Result<_, Cancelled>>()?;
        let mut stats = RayStats::default();
        let mut all = LightSubpaths {
            vertices: Vec::with_capacity(batches.iter().map(|(batch, _)| batch.vertices.len()).sum()),
            ends: Vec::with_capacity(count),
        };
        for (batch, of_batch) in batches {
            let before = all.vertices.len();
            all.ends.extend(batch.ends.iter().map(|end| before + end));
            all.vertices.extend(batch.vertices);
            stats += of_batch;
        }
        Ok((all, stats))
    }

    /// Sorts the photons of the `paths` light subpaths of a pass into a grid; `bytes` is the memory
    /// of their vertices.
    pub fn sort(&mut self, photons: Vec<LightVertex>, paths: usize, bytes: usize, pass: u32) -> PhotonGrid {
        let radius = self.radius(pass);
        let grid = PhotonGrid::new(photons, radius);
        let bytes = bytes + grid.bytes();
        self.last = LastPass { passes: pass + 1, radius, paths, photons: grid.len(), bytes };
        grid
    }

    /// Statistics for the summary of an integrator.
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
