//! Metropolis light transport in primary sample space: Markov chains of paths that visit paths in
//! proportion to the light that they carry.
//!
//! Where few paths carry light, independent samples find each of them by chance and forget it at
//! once. A Markov chain goes from path to path, each a small mutation of the one before, and visits
//! each in proportion to its contribution. So it explores the neighbourhood of what has been found:
//! all the light that comes through the gap of a door, once one path has found the gap.
//!
//! The states of the chain are not paths but the random numbers that they are made of, the *primary
//! sample space* [Kelemen 2002]: the unit cube of all that a sampler may return. Each point u of it
//! is a path that some other algorithm makes, of contribution f(u) (radiance over density) to the
//! film position p(u). A pixel whose filter is h is then
//!
//! ```text
//! I = ∫ f(u) h(p(u)) du = b · E[ f(u)/c(u) · h(p(u)) ],   u of the density c/b,   b = ∫ c(u) du
//! ```
//!
//! for any number c(u) that is above 0 where f is; here it is the mean of f's X, Y and Z.
//! `chain.rs` says how a chain comes to that density,
//! [`PrimarySample`](sampling::sampler::PrimarySample) how it mutates. The algorithm that makes the
//! paths, the `technique`, is
//!
//! - `path`: a camera path with all the light that it finds [Kelemen 2002];
//! - `bdpt`: one path made by one strategy (s, t) of bidirectional path tracing, which u chooses as
//!   well: multiplexed Metropolis [Hachisuka 2014]. What the strategy finds is weighted by the
//!   balance heuristic and by the number of strategies, so a chain stays with those that are good
//!   for the paths around it, and pays for one connection instead of all. The number of scattering
//!   events, which is fixed for a chain in the paper, is one more dimension, and the greater the
//!   less likely.
//!
//! Chains are many and short. Those of a pass start at points chosen in proportion to c among
//! uniform candidates of that pass alone; the mean of c over the candidates is the b of the pass.
//! Then b·(the mean of the chains) is unbiased, at every step and for any number of candidates,
//! without a burn-in to be discarded: b makes up for what the choice of starts favours
//! [Veach 1997 §11.3.1]. So passes are independent pictures, chains are independent of threads, and
//! the error falls with the number of passes without limit.
//!
//! Lights that the camera sees directly are left to one camera ray for each pixel and pass: they
//! are found without chance, and so bright that chains would spend most of their time on them.
//!
//! Unbiased up to `max_depth`, except with `regularize`. What it is bad at: noise is not that of
//! independent samples but comes in blotches, where a chain stayed; the overall brightness is only
//! as certain as b; open scenes, which every path sees, gain nothing; and what no large step ever
//! finds stays black. Sources: [Veach 1997 ch. 11]; [Kelemen 2002]; [Hachisuka 2014];
//! [Pharr 2016 §16.4].

mod chain;
mod chains;
mod target;

use description::{MltDesc, MltTechnique, PathDesc};
use film::Film;
use geometry::RayStats;
use sampling::Sampler;
use scene::{Interfaces, Scene, View};
use spectrum::SampledSpectrum;

use chains::{Chains, Targeted};
use target::{CameraPaths, ConnectedPaths, FilmDomain, Target};

use crate::bidirectional::{Balance, Bidirectional, Lights};
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError, Path, RayIntegrator};

/// Metropolis light transport.
#[derive(Debug)]
pub struct Mlt {
    settings: MltDesc,
    /// Of the camera rays that see lights.
    sampler: Sampler,
    /// Paths that do not scatter.
    seen: Path,
    technique: Technique,
    chains: Chains,
}

/// What makes paths, prepared for the scene.
#[derive(Debug)]
enum Technique {
    Path(Path),
    Bdpt(Lights),
}

impl Mlt {
    /// With a sampler of the camera rays that see lights.
    pub fn new(settings: MltDesc, sampler: Sampler, seed: u32) -> Self {
        let path = |max_depth| {
            let regularize = settings.regularize;
            Path::new(PathDesc { max_depth, regularize, ..PathDesc::default() }, Interfaces::Stop)
        };
        let technique = match settings.technique {
            MltTechnique::Path => Technique::Path(path(settings.max_depth)),
            MltTechnique::Bdpt => Technique::Bdpt(Lights::none()),
        };
        Self { settings, sampler, seen: path(0), technique, chains: Chains::new(settings, seed) }
    }
}

impl Integrator for Mlt {
    fn passes(&self) -> u32 {
        self.settings.mutations_per_pixel
    }

    fn splats(&self) -> bool {
        true
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        match &mut self.technique {
            Technique::Path(path) => path.prepare(scene, view, control)?,
            Technique::Bdpt(lights) => *lights = Lights::of(scene, control)?,
        }
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
        let MltDesc { max_depth, regularize, .. } = self.settings;
        let filter = film.filter().clone();
        let mutations = film.pixel_bounds().area();
        let (tiles, splatter) = film.tiles_and_splatter()?;
        let domain = FilmDomain::new(&splatter);

        let pixels = PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler };
        let mut stats = pixels.add(tiles, control, |sample, tracer| {
            let Some(camera_ray) = sample.camera_ray else { return SampledSpectrum::ZERO };
            self.seen.li(tracer, camera_ray.ray, &mut sample.lambda) * camera_ray.weight
        })?;
        if max_depth == 0 {
            return Ok(stats);
        }
        let target: &dyn Target = match &self.technique {
            Technique::Path(path) => &CameraPaths { film: domain, path },
            Technique::Bdpt(lights) => {
                let balance = Balance::connecting(domain.area());
                let paths = Bidirectional { scene, view, lights, balance, max_depth, regularize };
                &ConnectedPaths { film: domain, paths }
            }
        };
        stats += self.chains.run(pass, &Targeted { scene, view, target }, mutations, &splatter, control)?;
        Ok(stats)
    }

    fn summary(&self) -> Vec<(&'static str, String)> {
        self.chains.summary()
    }
}
