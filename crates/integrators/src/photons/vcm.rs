//! Vertex connection and merging: bidirectional path tracing combined with progressive photon
//! mapping.
//!
//! A pass has two steps. First, light subpaths are sampled, one for each pixel, and their vertices
//! are stored as photons ([`merging`](crate::photons::merging)). Then every pixel samples a camera
//! subpath and connects it to its light subpath at all pairs of vertices, like
//! [`Bdpt`](crate::Bdpt); vertices of the camera subpath are also merged with the photons within
//! the radius. Merging is one more family of strategies: a path whose vertex x is sampled from both
//! ends is found if the two ends lie within r of each other, so its density is that of the two
//! subpaths, times π r² (the probability of that distance, for locally constant densities), times
//! the number n of photon paths. (If x has an alpha below 1, both subpaths must hit it, and alpha
//! is one more factor of η.) The balance heuristic weights merges and connections alike:
//!
//! ```text
//! 1/w = 1 + [(d_vcm + p←·(d_vc + d_vm))_light + (d_vcm + p←·(d_vc + d_vm))_camera] / η
//! η   = n π r²
//! ```
//!
//! Merging finds paths that no connection can: a caustic seen through glass. Every pixel uses all
//! photons, so that small lights are no problem. Where connections have a low variance they get
//! most of the weight: η shrinks with the radius, and the weight of merges with it. Without merging
//! (r → 0) this is `bdpt`; with merging only it would be photon mapping. Photons of direct light
//! are not merged: next-event estimation finds the same paths with less noise.
//!
//! Nor are vertices beyond the first diffuse surface of a camera subpath merged. If such a vertex
//! hits a bright spot, such as the caustic on the far wall, merging would add all photons of the
//! spot at once. They share one camera subpath, but the balance heuristic treats them as thousands
//! of independent samples and gives merging nearly all the weight, which makes fireflies.
//! [Grittmann 2021] account for this correlation by a factor for each merge that depends on the
//! densities of both subpaths; here the factor is 1 or 0, which the recursion of a subpath can
//! compute. The other strategies find the same paths: photons scattered from the bright spot to the
//! first diffuse surface, and connections. In the mirror room, at 300 × 200 pixels, the variance is
//! half of what it is with merges everywhere.
//!
//! Purely specular paths are found by camera rays only, which get more samples
//! ([`specular_paths`](crate::photons::specular_paths)). In the mirror room at 96 × 64 pixels they
//! made nine tenths of the error, and five rays instead of one reduce it by a third or more for a
//! seventh more time.
//!
//! The choice of the radius remains difficult. In the mirror room one of three times the default
//! leaves a third of the variance; behind a door, light then leaks under it.
//!
//! At most [`MAX_PHOTON_PATHS`] paths of a pass store photons, which bounds memory: some hundred
//! bytes for each of at most `max_depth` vertices of a path, and 68 to 72 for its photon, 64 more
//! while they are sorted. In larger pictures the other pixels sample their light subpaths on
//! demand.
//!
//! Biased: merging blurs light over the radius, which shrinks as `merging` describes; consistent.
//! Depth of field and motion blur are correct, because all paths of a pass share one time. Sources:
//! [Georgiev 2012]; [Georgiev 2012b]; [Hachisuka 2012]; [Grittmann 2021].

use description::VcmDesc;
use film::Film;
use geometry::RayStats;
use math::Vec2;
use sampling::Sampler;
use scene::{Scene, View};
use spectrum::SampledSpectrum;

use crate::bidirectional::LightVertex;
use crate::bidirectional::{Balance, Bidirectional, Encounter, Found, Lights, Vertex};
use crate::photons::merging::Merging;
use crate::photons::specular_paths::{SpecularChain, SpecularPaths};
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError, Tracer};

/// The radius of the first pass as a fraction of that of the scene, as in [Georgiev 2012]. Light
/// through a narrow gap leaks with a larger one: behind a door, 2.4 times this radius has 70 times
/// the squared bias in 64 passes.
const SHARE_OF_SCENE: f32 = 0.003;

/// Maximum number of light subpaths of a pass that store photons, which bounds memory.
pub const MAX_PHOTON_PATHS: usize = 1 << 19;

/// Vertex connection and merging.
#[derive(Debug)]
pub struct Vcm {
    settings: VcmDesc,
    photon_paths: usize,
    sampler: Sampler,
    light_sampler: Sampler,
    specular_paths: SpecularPaths,
    photon_seed: u32,
    lights: Lights,
    merging: Merging,
}

impl Vcm {
    /// Takes the samplers of camera and light subpaths, the seed of photons and specular paths, and
    /// the maximum number of light subpaths of a pass that store photons, above 0;
    /// [`MAX_PHOTON_PATHS`] is usual.
    pub fn new(
        settings: VcmDesc,
        sampler: Sampler,
        light_sampler: Sampler,
        photon_seed: u32,
        photon_paths: usize,
    ) -> Self {
        let merging = Merging::new(settings.radius.unwrap_or(1.0), settings.alpha, photon_seed);
        let specular_paths = SpecularPaths::new(light_sampler.samples_per_pixel(), !photon_seed);
        let lights = Lights::none();
        Self { settings, photon_paths, sampler, light_sampler, specular_paths, photon_seed, lights, merging }
    }
}

impl Integrator for Vcm {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn splats(&self) -> bool {
        true
    }

    fn prepare(&mut self, scene: &Scene, _view: &View, control: &Control) -> Result<(), Cancelled> {
        self.lights = Lights::of(scene, control)?;
        self.specular_paths.prepare(scene);
        let radius = self.settings.radius.unwrap_or(SHARE_OF_SCENE * scene.sphere().radius);
        self.merging = Merging::new(radius, self.settings.alpha, self.photon_seed);
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
        let bounds = film.pixel_bounds();
        let pixel_count = bounds.area();
        let photon_paths = pixel_count.min(self.photon_paths);
        let paths = Bidirectional {
            scene,
            view,
            lights: &self.lights,
            balance: Balance::merging(pixel_count, photon_paths, self.merging.radius(pass)),
            max_depth: self.settings.max_depth,
            light_goes_under: false,
            regularize: false,
        };
        let light_sampler = |pixel| {
            let mut sampler = self.light_sampler.clone();
            sampler.start_pixel_sample(pixel, pass, 0);
            sampler
        };
        let sampler_of = |path: usize| {
            let (width, path) = (bounds.width(), path as i32);
            light_sampler([bounds.min[0] + path % width, bounds.min[1] + path / width])
        };
        let (subpaths, mut stats) =
            self.merging.shoot(&paths, photon_paths, pass, sampler_of, keep, control)?;
        let photons = subpaths.vertices.iter().map(|(vertex, _)| vertex).filter(|vertex| vertex.can_merge());
        let photons = photons.map(LightVertex::from).collect();
        let photons = self.merging.sort(photons, photon_paths, subpaths.bytes(), pass);
        let shutter = self.merging.shutter(view, pass);
        let filter = film.filter().clone();
        let (tiles, splatter) = film.tiles_and_splatter()?;
        let pixels =
            PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler, counts: None };
        stats += pixels.add_at(Some(&shutter), tiles, control, |sample, tracer| {
            let lambda = &sample.lambda;
            let [x, y] = sample.pixel;
            let index = (y - bounds.min[1]) * bounds.width() + (x - bounds.min[0]);
            let mut made = Vec::new();
            let light_subpath = subpaths.get(index as usize).unwrap_or_else(|| {
                tracer.with_sampler(&mut light_sampler(sample.pixel), |tracer| {
                    paths.light_subpath(sample.time, lambda, tracer, |vertex, tracer| {
                        made.extend(keep(vertex, tracer.sampler));
                    });
                });
                &made
            });
            for (vertex, u) in light_subpath {
                if let Some(seen) = paths.connect_to_camera(vertex, *u, splatter.reach(), lambda, tracer) {
                    seen.splat_parts(&splatter, lambda, scene);
                }
            }
            splatter.add_paths(1);

            let (mut l, mut chain) = (SampledSpectrum::ZERO, SpecularChain::default());
            let Some(camera_ray) = &sample.camera_ray else { return l };
            let mut add = |found: &Found, tracer: &mut Tracer| {
                l += found.weighted();
                tracer.take_part(found.light, &found.first, found.events(), found.weighted());
            };
            paths.camera_subpath(camera_ray, lambda, tracer, |encounter, tracer| {
                if let Encounter::Vertex(vertex) = encounter {
                    chain.visit(vertex);
                }
                match encounter {
                    Encounter::Light(found) if chain.add(&found) => (),
                    Encounter::Light(found) => add(&found, tracer),
                    Encounter::Vertex(vertex) if vertex.is_connectible() => {
                        let lights = light_subpath.iter().map(|(light, _)| light);
                        paths.connect_each(vertex, lights, lambda, tracer, &mut add);
                        if vertex.can_merge() {
                            photons.within(vertex.p.p, |photon| {
                                if paths.may_merge(vertex, photon) {
                                    add(&paths.merge(vertex, photon, tracer), tracer);
                                }
                            });
                        }
                    }
                    Encounter::Vertex(_) => (),
                }
            });
            l + self.specular_paths.radiance(chain, sample, &pixels, &shutter, &paths, tracer)
        })?;
        Ok(stats)
    }

    fn summary(&self) -> Vec<(&'static str, String)> {
        self.merging.summary()
    }
}

/// A vertex of a light subpath, with the sample value of the lens point that it is connected to.
fn keep<'a>(vertex: &Vertex<'a>, sampler: &mut Sampler) -> Option<(Vertex<'a>, Vec2)> {
    Some((*vertex, sampler.get_2d()))
}
