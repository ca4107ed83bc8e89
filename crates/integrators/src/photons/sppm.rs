//! Stochastic progressive photon mapping: new photons in every pass, with a shrinking radius.
//!
//! A pass emits photons and stores those that arrive at a diffuse surface after at least one
//! scattering event ([`merging`](crate::photons::merging)). Then each pixel samples a camera path
//! through specular and glossy surfaces to the first diffuse one. There the path ends: direct light
//! is estimated by next-event estimation, all other light by merging with the photons within the
//! radius. Before its end the path samples lights like path tracing, by next-event estimation and
//! by BSDF sampling, weighted by the balance heuristic; at its end by next-event estimation only,
//! so that no light path counts twice. A surface with a specular lobe besides a diffuse one does
//! not end the path. Where a path leaves a body it ends as at a diffuse
//! surface; photons go under surfaces, too.
//!
//! Its strength is caustics seen through glass or in a mirror; all pixels share all photons. It is
//! slow where photons are rare: in large scenes of which the camera sees a small part. Caustics on
//! glossy surfaces are found only by paths that hit lights.
//!
//! How it differs from [Hachisuka 2009], and so from pbrt-v4, whose parameters it has: there every
//! pixel has its own radius, which shrinks with the photons found so far, as (N + γM)/(N + M) with
//! γ = 2/3. Here all pixels share the radius of [Knaus 2011] for the number of the pass, with α =
//! γ, which is the same for a uniform density of photons. The disadvantage is that radii do not
//! adapt to the density of photons. The advantage is that passes are independent: a render can be
//! interrupted, resumed and merged from shards to the same bits, and neither threads nor order
//! matter. `max_depth` limits the sum of both subpaths, as everywhere.
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
use crate::light_paths::unbounded;
use crate::photons::merging::Merging;
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError};

/// Stochastic progressive photon mapping.
#[derive(Debug)]
pub struct Sppm {
    settings: SppmDesc,
    sampler: Sampler,
    lights: Lights,
    merging: Merging,
}

impl Sppm {
    /// `sampler` is for camera paths, `photon_seed` for photons.
    pub fn new(settings: SppmDesc, sampler: Sampler, photon_seed: u32) -> Self {
        // Each pass begins with the radius that its film and scene give.
        let merging = Merging::new(1.0, SppmDesc::ALPHA, photon_seed);
        Self { settings, sampler, lights: Lights::none(), merging }
    }
}

impl Integrator for Sppm {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn warnings(&self, scene: &Scene) -> Vec<Diagnostic> {
        unbounded::warnings(scene, "sppm")
    }

    fn prepare(&mut self, scene: &Scene, view: &View, control: &Control) -> Result<(), Cancelled> {
        self.lights = Lights::and_media(scene, view, control)?;
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
        let photon_paths = self.settings.light_paths(film.pixel_bounds().area());
        self.merging.begin_with(self.settings.first_radius(photon_paths, scene.sphere().radius));
        let paths = Bidirectional {
            scene,
            view,
            lights: &self.lights,
            balance: Balance::at_the_end(photon_paths, self.merging.radius(pass)),
            max_depth: self.settings.max_depth,
            light_goes_under: true,
            regularize: false,
        };
        let photon = |vertex: &Vertex, _: &mut Sampler| {
            let may_end_there = vertex.is_diffuse() || vertex.body().is_some();
            (vertex.can_merge() && vertex.takes_photons() && may_end_there).then(|| LightVertex::from(vertex))
        };
        // All paths take samples of one sequence, so that the photons of a pass are stratified.
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
        let pixels =
            PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler, counts: None };
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
                        photons.within(vertex.p.p, |photon| {
                            if paths.may_merge(vertex, photon) {
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
