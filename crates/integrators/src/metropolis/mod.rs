//! Metropolis light transport in primary sample space: Markov chains of paths, distributed in
//! proportion to their contribution.
//!
//! Where few paths carry light, independent samples seldom find them. A Markov chain proceeds from
//! path to path by small mutations, and visits each in proportion to its contribution. So it
//! explores the neighbourhood of a path that carries light, such as one through the gap of a door.
//!
//! The states of the chain are not paths but the random numbers from which they are sampled, the
//! *primary sample space* [Kelemen 2002]: the unit cube of a sampler's values. Another algorithm
//! maps each point u of it to a path, of contribution f(u) (radiance over density) to the film
//! position p(u). A pixel whose filter is h is then
//!
//! ```text
//! I = ∫ f(u) h(p(u)) du = b · E[ f(u)/c(u) · h(p(u)) ],   u of the density c/b,   b = ∫ c(u) du
//! ```
//!
//! for any number c(u) that is above 0 where f is; here it is the mean of f's X, Y and Z.
//! `chain.rs` describes the chain, [`PrimarySample`](sampling::sampler::PrimarySample) its
//! mutations. The algorithm that samples the paths, the `technique`, is
//!
//! - `path`: a camera path with all its contributions [Kelemen 2002];
//! - `bdpt`: one path sampled by one strategy (s, t) of bidirectional path tracing, which u chooses
//!   as well: multiplexed Metropolis [Hachisuka 2014]. The contribution is weighted by the balance
//!   heuristic and by the number of strategies, so a chain prefers strategies that are good for the
//!   paths around it, at the cost of one connection instead of all. The number of scattering
//!   events, which is fixed for a chain in the paper, is one more dimension; greater numbers have
//!   lower probabilities.
//!
//! Chains are many and short. Those of a pass start at points chosen in proportion to c among
//! uniform candidates of that pass alone; the mean of c over the candidates is the b of the pass.
//! Then b·(the mean of the chains) is unbiased, at every step and for any number of candidates,
//! without burn-in: the factor b removes the start-up bias [Veach 1997 §11.3.1]. So passes are
//! independent estimates of the picture, chains do not depend on threads, and the error converges
//! to zero with the number of passes.
//!
//! Directly visible lights are rendered by one camera ray per pixel and pass: camera rays find them
//! with little noise, and chains would spend most of their time on them.
//!
//! Unbiased up to `max_depth`, except with `regularize`. Its weaknesses: samples are correlated, so
//! that noise appears as blotches; the overall brightness has the error of b; open scenes, where
//! every path finds light, gain nothing; and paths that no large step finds are missing. Sources:
//! [Veach 1997 ch. 11]; [Kelemen 2002]; [Hachisuka 2014]; [Pharr 2016 §16.4].

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
    /// For the camera rays of directly visible lights.
    sampler: Sampler,
    /// Path tracing of depth 0, for directly visible lights.
    seen: Path,
    technique: Technique,
    chains: Chains,
}

/// The algorithm that samples paths, prepared for the scene.
#[derive(Debug)]
enum Technique {
    Path(Path),
    Bdpt(Lights),
}

/// Path tracing up to a depth.
fn paths(settings: &MltDesc, max_depth: u32) -> Path {
    let settings = PathDesc { max_depth, regularize: settings.regularize, ..PathDesc::default() };
    Path::new(settings, Interfaces::Pass)
}

impl Mlt {
    /// `sampler` is for the camera rays of directly visible lights.
    pub fn new(settings: MltDesc, sampler: Sampler, seed: u32) -> Self {
        let technique = match settings.technique {
            MltTechnique::Path => Technique::Path(paths(&settings, settings.max_depth)),
            MltTechnique::Bdpt => Technique::Bdpt(Lights::none()),
        };
        Self { settings, sampler, seen: paths(&settings, 0), technique, chains: Chains::new(settings, seed) }
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

        let pixels =
            PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler, counts: None };
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
                let light_goes_under = false;
                let paths =
                    Bidirectional { scene, view, lights, balance, max_depth, light_goes_under, regularize };
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
