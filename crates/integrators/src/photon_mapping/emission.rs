//! Photons leave the lights.
//!
//! Light subpaths start at lights in proportion to their power and go on as the BSDFs say, so that all photons carry about the same
//! power and lie where there is light. The first surface of a subpath that is not purely specular tells what its photons are: direct light
//! if nothing lies between, a caustic if only specular surfaces do, and indirect light from there on.

use geometry::RayStats;
use rayon::prelude::*;
use sampling::sampler::PaddedSobol;
use sampling::{Randomize, Sampler};
use spectrum::SampledWavelengths;

use crate::bidirectional::{Bidirectional, Vertex, Walk};
use crate::{Cancelled, Control};

/// Subpaths that one thread follows at a time.
const CHUNK: u32 = 2048;

/// Which photons a map keeps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Kind {
    /// Those that have met specular surfaces alone, and at least one.
    Caustic,
    /// Those that have been scattered by a surface that is not specular.
    Indirect,
    /// All.
    All,
}

impl Kind {
    /// Whether to keep a photon, the first of its subpath or not.
    fn keeps(self, vertex: &Vertex, first: bool) -> bool {
        match self {
            Self::Caustic => first && vertex.depth > 1,
            Self::Indirect => !first,
            Self::All => true,
        }
    }

    /// The sampler's pixel: one for each kind of map.
    fn pixel(self) -> i32 {
        match self {
            Self::Caustic => 1,
            Self::Indirect | Self::All => 0,
        }
    }
}

/// What emits photons.
pub(super) struct Emission<'a> {
    pub paths: &'a Bidirectional<'a>,
    pub lambda: SampledWavelengths,
    pub seed: u32,
    /// Which photons, of all that the seed has.
    pub generation: u32,
}

impl Emission<'_> {
    /// What `keep` makes of the photons of so many subpaths, in their order.
    pub fn emit<T: Send>(
        &self,
        kind: Kind,
        paths: u32,
        control: &Control,
        keep: impl Fn(&Vertex, &mut Sampler, &mut RayStats) -> T + Sync,
    ) -> Result<(Vec<T>, RayStats), Cancelled> {
        // Arranged for all subpaths of the generation at once, which makes their order in one coordinate no hint at the next.
        let sampler = Sampler::PaddedSobol(PaddedSobol::new(paths, Randomize::FastOwen, self.seed));
        let chunks: Vec<_> = (0..paths.div_ceil(CHUNK))
            .into_par_iter()
            .map(|chunk| {
                control.check()?;
                let (mut kept, mut stats) = (Vec::new(), RayStats::default());
                let mut sampler = sampler.clone();
                let start = chunk * CHUNK;
                for path in start..paths.min(start.saturating_add(CHUNK)) {
                    sampler.start_pixel_sample([self.generation as i32, kind.pixel()], path, 0);
                    self.follow(kind, &mut sampler, &mut stats, |vertex, sampler, stats| {
                        kept.push(keep(vertex, sampler, stats));
                    });
                }
                Ok((kept, stats))
            })
            .collect::<Result<_, _>>()?;
        let mut all = Vec::with_capacity(chunks.iter().map(|(kept, _)| kept.len()).sum());
        let mut sum = RayStats::default();
        for (kept, stats) in chunks {
            all.extend(kept);
            sum += stats;
        }
        Ok((all, sum))
    }

    /// Follows a subpath as far as it may leave photons.
    fn follow(
        &self,
        kind: Kind,
        sampler: &mut Sampler,
        stats: &mut RayStats,
        mut visit: impl FnMut(&Vertex, &mut Sampler, &mut RayStats),
    ) {
        let time = self.paths.scene.camera().sample_time(sampler.get_1d());
        let Some(mut walk) = Walk::from_light(self.paths, time, self.lambda, sampler) else { return };
        let mut first = true;
        while walk.depth < self.paths.max_depth {
            let Some(mut surface) = walk.meet(stats) else { return };
            let Some(vertex) = walk.arrive(&mut surface, sampler) else { continue };
            if vertex.is_connectible() {
                if kind.keeps(&vertex, first) {
                    visit(&vertex, sampler, stats);
                }
                if kind == Kind::Caustic {
                    return;
                }
                first = false;
            }
            if !walk.leave(&vertex, &surface, sampler) {
                return;
            }
        }
    }
}
