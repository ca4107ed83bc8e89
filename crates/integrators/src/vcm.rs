//! Vertex connection and merging: bidirectional path tracing and progressive photon mapping as one.
//!
//! A pass has two steps. First, light subpaths leave their vertices as photons ([`merging`](crate::merging)). Then every pixel
//! makes a pair of subpaths, as [`Bdpt`](crate::Bdpt) does, and connects them in all ways; and each vertex of the camera subpath is
//! merged with the photons within the radius. Merging is one more family of strategies: a path whose vertex x is made from both ends
//! is found if the two ends come within r of each other, so the density of such a path is that of its two subpaths,
//! times π r² (the chance to meet, if all is smooth), times the number of photon paths. With that, the balance heuristic weighs
//! merging against connecting as it weighs connections against each other:
//!
//! ```text
//! 1/w = 1 + (d_vcm/η + p←·d_vm)_light + (d_vcm/η + p←·d_vm)_camera,    η = n π r²
//! ```
//!
//! Merging can do what no connection can: a photon behind glass, seen through glass. Every pixel uses all photons, so it does not
//! mind how small the lamp is. Where connecting is good it is better, and gets the weight: η shrinks with the radius, and photons with
//! it. Without merging (r → 0) it is `bdpt`; with nothing but merging it would be photon mapping. Photons that come straight from a
//! light are not merged: a choice of a point on the light finds the same paths with less noise.
//!
//! What remains hard: a bright spot that is met by chance, as a caustic on the far wall is by a ray from the near one, brings all
//! its photons at once. The weights take them for independent ones, and single pixels are too bright until many passes are made.
//!
//! The photons' paths are not those that are connected: to make new ones costs the same as to make the old ones again, and
//! tells more. At most 2²⁰ paths of a pass leave photons, which bounds memory: 56 bytes and 4 to 8 of the table for each of at most
//! `max_depth` photons of a path, twice that while they are sorted.
//!
//! Biased: light that merging finds is blurred over the radius, which shrinks as `merging` says; consistent. Depth of field and
//! motion are right, because all paths of a pass have one time. Sources: [Georgiev 2012]; [Georgiev 2012b]; [Hachisuka 2012].

use film::Film;
use geometry::RayStats;
use sampling::Sampler;
use scene::Scene;
use spectrum::SampledSpectrum;

use crate::bidirectional::{Balance, Bidirectional, Lights, OnTheWay, Vertex};
use crate::merging::Merging;
use crate::pixel_loop::PixelSamples;
use crate::{Cancelled, Control, Integrator};

/// The most light subpaths that leave photons in a pass.
const MAX_PHOTON_PATHS: usize = 1 << 20;

/// The first radius as a part of that of the scene, as in [Georgiev 2012]. Where photons come through a narrow gap, a larger one lets them
/// seep far: three times this one is no better in a room of mirrors, and takes 18 times as long behind a door.
const SHARE_OF_SCENE: f32 = 0.003;

/// Settings of [`Vcm`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct VcmSettings {
    /// Most scattering events; default 5.
    pub max_depth: u32,
    /// Distance in the scene within which vertices are merged in the first pass, above 0; by default 0.003 of the scene's radius.
    pub radius: Option<f32>,
    /// How slowly the radius shrinks, in (0, 1]: its square goes with i^(α − 1) over the passes i; default 0.75.
    pub alpha: f32,
}

impl Default for VcmSettings {
    fn default() -> Self {
        Self { max_depth: 5, radius: None, alpha: 0.75 }
    }
}

/// Vertex connection and merging.
#[derive(Debug)]
pub struct Vcm {
    settings: VcmSettings,
    sampler: Sampler,
    light_sampler: Sampler,
    photon_seed: u32,
    lights: Lights,
    merging: Merging,
}

impl Vcm {
    /// With a sampler for each end of what is connected, and a seed for photons.
    pub fn new(settings: VcmSettings, sampler: Sampler, light_sampler: Sampler, photon_seed: u32) -> Self {
        let merging = Merging::new(settings.radius.unwrap_or(1.0), settings.alpha, photon_seed);
        Self { settings, sampler, light_sampler, photon_seed, lights: Lights::none(), merging }
    }
}

impl Integrator for Vcm {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn prepare(&mut self, scene: &Scene) {
        self.lights = Lights::of(scene);
        let radius = self.settings.radius.unwrap_or(SHARE_OF_SCENE * scene.sphere().radius);
        self.merging = Merging::new(radius, self.settings.alpha, self.photon_seed);
    }

    fn pass(
        &mut self,
        pass: u32,
        scene: &Scene,
        film: &mut Film,
        control: &Control,
    ) -> Result<RayStats, Cancelled> {
        let pixel_count = film.pixel_bounds().area();
        let photon_paths = pixel_count.min(MAX_PHOTON_PATHS);
        let paths = Bidirectional {
            scene,
            lights: &self.lights,
            balance: Balance::merging(pixel_count, photon_paths, self.merging.radius(pass)),
            max_depth: self.settings.max_depth,
            regularize: false,
        };
        let (photons, mut stats) =
            self.merging.shoot(&paths, photon_paths, pass, Vertex::can_merge, control)?;
        let moment = self.merging.moment(scene, pass);
        let filter = film.filter().clone();
        let (tiles, splatter) = film.tiles_and_splatter();
        let pixels = PixelSamples { index: pass, scene, filter: &filter, sampler: &self.sampler };
        stats += pixels.add_at(Some(&moment), tiles, control, |sample, sampler, stats| {
            let lambda = &sample.lambda;
            let mut light_sampler = self.light_sampler.clone();
            light_sampler.start_pixel_sample(sample.pixel, pass, 0);
            let mut light_subpath = Vec::new();
            paths.light_subpath(sample.time, lambda, &mut light_sampler, stats, |vertex, sampler, stats| {
                let u = sampler.get_2d();
                if let Some(seen) = paths.see(vertex, u, splatter.reach(), stats) {
                    seen.splat(&splatter, &seen.found.weighted(), lambda);
                }
                light_subpath.push(*vertex);
            });
            splatter.add_paths(1);

            let mut l = SampledSpectrum::ZERO;
            let Some(camera_ray) = &sample.camera_ray else { return l };
            paths.camera_subpath(camera_ray, lambda, sampler, stats, |on_the_way, sampler, stats| {
                match on_the_way {
                    OnTheWay::Light(found) => l += found.weighted(),
                    OnTheWay::Vertex(vertex) if vertex.is_connectible() => {
                        let depths = paths.max_depth - vertex.depth;
                        if let Some(found) = paths.direct(vertex, lambda, sampler, stats) {
                            l += found.weighted();
                        }
                        for light in light_subpath.iter().filter(|light| light.depth <= depths) {
                            if let Some(found) = paths.connect(vertex, light, stats) {
                                l += found.weighted();
                            }
                        }
                        photons.within(vertex.p.p, |photon| {
                            if u32::from(photon.depth) <= depths + 1 {
                                l += paths.merge(vertex, photon).weighted();
                            }
                        });
                    }
                    OnTheWay::Vertex(_) => (),
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
