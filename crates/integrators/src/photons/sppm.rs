//! Stochastic progressive photon mapping: new photons in every pass, within ever smaller radii.
//!
//! A pass emits photons and keeps those that arrive at a diffuse surface after at least one
//! scattering event ([`merging`](crate::photons::merging)). Then each pixel samples a camera path
//! through specular and glossy surfaces to the first diffuse one. There the path ends: direct light
//! is found by next-event estimation, all other light by merging with the photons within the
//! radius. On the way it looks for lights as path tracing does, by next-event estimation and by
//! chance, weighted by the balance heuristic; at the end by next-event estimation alone, so that
//! nothing counts twice. A surface with a specular lobe besides a diffuse one does not end the
//! path.
//!
//! It is at its best on caustics seen through glass or in a mirror, which no path from the camera
//! finds; all pixels share all photons. It is slow where photons are rare: in large scenes of which
//! the camera sees a corner. Caustics on glossy surfaces are left to chance.
//!
//! How it differs from [Hachisuka 2009], and so from pbrt-v4, whose parameters it has: there every
//! pixel has a radius of its own, which shrinks by what the pixel has found so far, as (N +
//! γM)/(N + M) with γ = 2/3. Here all share the radius that [Knaus 2011] give a pass by its number,
//! with α = γ, which is the same where photons are evenly distributed. What is lost is that radii
//! adapt to the density of photons. What is won is that a pass depends on no pass before it: a
//! render can be interrupted, resumed and merged from shards to the same bits, and neither threads
//! nor order matter. `max_depth` holds for the sum of both ends, as everywhere.
//!
//! Biased, as `merging` says; consistent. Sources: [Hachisuka 2009]; [Knaus 2011];
//! [Pharr 2016 §16.2].

use description::{Diagnostic, SppmDesc};
use film::Film;
use geometry::RayStats;
use sampling::sampler::PaddedSobol;
use sampling::{Randomize, Sampler};
use scene::{Scene, View};
use spectrum::SampledSpectrum;

use crate::bidirectional::LightVertex;
use crate::bidirectional::{Balance, Bidirectional, Encounter, Lights, Vertex};
use crate::light_paths::endless;
use crate::photons::merging::Merging;
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError};

/// How slowly the radius shrinks.
const ALPHA: f32 = 2.0 / 3.0;

/// The first radius, if it is not told, over that of the scene times √n for n light subpaths in a
/// pass: the more photons, the nearer they are. About thirty count for a point of a room, so that
/// few are black.
const SPACING: f32 = 5.0;

/// It is no larger part of the scene's than this.
const LARGEST_SHARE: f32 = 0.05;

/// Stochastic progressive photon mapping.
#[derive(Debug)]
pub struct Sppm {
    settings: SppmDesc,
    sampler: Sampler,
    lights: Lights,
    merging: Merging,
}

impl Sppm {
    /// With a sampler for what begins at the camera, and a seed for photons.
    pub fn new(settings: SppmDesc, sampler: Sampler, photon_seed: u32) -> Self {
        let merging = Merging::new(settings.radius.unwrap_or(1.0), ALPHA, photon_seed);
        Self { settings, sampler, lights: Lights::none(), merging }
    }
}

impl Integrator for Sppm {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn warnings(&self, scene: &Scene) -> Vec<Diagnostic> {
        endless::warnings(scene, "sppm")
    }

    fn prepare(&mut self, scene: &Scene, _view: &View, control: &Control) -> Result<(), Cancelled> {
        self.lights = Lights::of(scene, control)?;
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
        let pixel_count = film.pixel_bounds().area();
        let photon_paths = self.settings.photons_per_iteration.map_or(pixel_count, |count| count as usize);
        if self.settings.radius.is_none() {
            let share = (SPACING / (photon_paths as f32).sqrt()).min(LARGEST_SHARE);
            self.merging.begin_with(share * scene.sphere().radius);
        }
        let paths = Bidirectional {
            scene,
            view,
            lights: &self.lights,
            balance: Balance::at_the_end(photon_paths, self.merging.radius(pass)),
            max_depth: self.settings.max_depth,
            regularize: false,
        };
        let photon = |vertex: &Vertex, _: &mut Sampler| {
            (vertex.can_merge() && vertex.is_diffuse()).then(|| LightVertex::from(vertex))
        };
        // Each path takes a sample of one sequence, so that all the photons of a pass are well
        // spread.
        let sampler = PaddedSobol::new(photon_paths as u32, Randomize::FastOwen, self.merging.seed());
        let sampler = |path| {
            let mut sampler = Sampler::PaddedSobol(sampler.clone());
            sampler.start_pixel_sample([pass as i32, 0], path as u32, 0);
            sampler
        };
        let (subpaths, mut stats) =
            self.merging.shoot(&paths, photon_paths, pass, sampler, photon, control)?;
        let photons = self.merging.sort(subpaths.vertices, photon_paths, 0, pass);
        let shutter = self.merging.shutter(view, pass);
        let filter = film.filter().clone();
        let pixels = PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler };
        stats += pixels.add_at(Some(&shutter), film.tiles_mut()?, control, |sample, tracer| {
            let mut l = SampledSpectrum::ZERO;
            let Some(camera_ray) = &sample.camera_ray else { return l };
            let lambda = &sample.lambda;
            paths.camera_subpath_to(Vertex::is_diffuse, camera_ray, lambda, tracer, |encounter, tracer| {
                match encounter {
                    Encounter::Light(found) => l += found.weighted(),
                    Encounter::Vertex(vertex) if vertex.is_connectible() => {
                        let direct = paths.direct(vertex, lambda, tracer);
                        if !vertex.is_diffuse() {
                            l += direct.map_or(SampledSpectrum::ZERO, |found| found.weighted());
                            return;
                        }
                        l += direct.map_or(SampledSpectrum::ZERO, |found| found.l);
                        let depths = paths.max_depth - vertex.depth;
                        photons.within(vertex.p.p, |photon| {
                            if u32::from(photon.depth) <= depths + 1 {
                                l += paths.merged(vertex, photon);
                            }
                        });
                    }
                    Encounter::Vertex(_) => (),
                }
            });
            l
        })?;
        Ok(stats)
    }

    fn summary(&self) -> Vec<(&'static str, String)> {
        self.merging.summary()
    }
}
