//! Bidirectional path tracing: paths from both ends, connected in all ways.
//!
//! For each sample of a pixel a light subpath and a camera subpath are sampled. Every vertex of the
//! one is connected to every vertex of the other; camera subpaths may also hit lights or end in
//! next-event estimation, and light subpaths are connected to the camera. A path of k edges is thus
//! found by up to k + 1 strategies, each with a low variance for other paths: caustics, light
//! through a gap, reflections in mirrors. Their estimates are weighted by the balance heuristic;
//! `bidirectional/partial.rs` describes how the weights are computed along the subpaths.
//!
//! Paths with specular surfaces on both sides of the only vertex that could be connected remain
//! difficult: a caustic seen in a mirror, the ground under water. They are noisy with small lights
//! and black with lights at a point; merging finds them (`vcm`).
//!
//! With `techniques` there is a picture for each strategy: its unweighted estimate, and its
//! weighted contribution. Arranged by path length they are the pyramid of [Veach 1997 fig. 10.3].
//! Paths with more than 8 scattering events are left out of them.
//!
//! Unbiased up to `max_depth`, except with `regularize`. Sources: [Veach 1997 ch. 10];
//! [Lafortune 1993].

pub(crate) mod techniques;

use description::BdptDesc;
use film::Film;
use geometry::RayStats;
use sampling::Sampler;
use scene::{Scene, View};
use spectrum::SampledSpectrum;

use techniques::Techniques;

use crate::bidirectional::{Balance, Bidirectional, Encounter, Found, Lights};
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Integrator, PassError, Tracer};

/// Bidirectional path tracing.
#[derive(Debug)]
pub struct Bdpt {
    settings: BdptDesc,
    sampler: Sampler,
    light_sampler: Sampler,
    lights: Lights,
    techniques: Techniques,
}

impl Bdpt {
    /// `sampler` is for camera subpaths, `light_sampler` for light subpaths.
    pub fn new(settings: BdptDesc, sampler: Sampler, light_sampler: Sampler) -> Self {
        let techniques =
            Techniques::new(settings.max_depth, settings.visualize_strategies, settings.visualize_weights);
        Self { settings, sampler, light_sampler, lights: Lights::none(), techniques }
    }

    /// Memory of the strategies' pictures of `pixels` pixels, in bytes.
    pub fn technique_bytes(&self, pixels: usize) -> usize {
        self.techniques.bytes(pixels)
    }
}

impl Integrator for Bdpt {
    fn passes(&self) -> u32 {
        self.sampler.samples_per_pixel()
    }

    fn splats(&self) -> bool {
        true
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
        let paths = Bidirectional {
            scene,
            view,
            lights: &self.lights,
            balance: Balance::connecting(pixel_count as f32),
            max_depth: self.settings.max_depth,
            light_goes_under: false,
            regularize: self.settings.regularize,
        };
        let filter = film.filter().clone();
        let techniques = self.techniques.open(film)?;
        let (tiles, splatter) = film.tiles_and_splatter()?;
        let pixels =
            PixelSamples { index: pass, scene, view, filter: &filter, sampler: &self.sampler, counts: None };
        // On films of splats, the sample of a pixel is one of as many paths as there are pixels.
        let per_sample = pixel_count as f32 / filter.integral();
        let stats = pixels.add(tiles, control, |sample, tracer| {
            let lambda = &sample.lambda;
            let mut light_sampler = self.light_sampler.clone();
            light_sampler.start_pixel_sample(sample.pixel, pass, 0);
            let mut light_subpath = Vec::new();
            tracer.with_sampler(&mut light_sampler, |tracer| {
                paths.light_subpath(sample.time, lambda, tracer, |vertex, tracer| {
                    let u = tracer.sampler.get_2d();
                    if let Some(seen) = paths.connect_to_camera(vertex, u, splatter.reach(), lambda, tracer) {
                        seen.splat_parts(&splatter, lambda, scene);
                        techniques.add(&seen.found, |splatter, l| seen.splat(splatter, l, lambda));
                    }
                    light_subpath.push(*vertex);
                });
            });
            splatter.add_paths(1);
            techniques.add_path();

            let mut l = SampledSpectrum::ZERO;
            let mut add = |found: &Found, tracer: &mut Tracer| {
                l += found.weighted();
                tracer.take_part(found.light, &found.first, found.events(), found.weighted());
                let scale = sample.filter_weight * per_sample;
                techniques
                    .add(found, |splatter, l| splatter.add_to_pixel(sample.pixel, &(*l * scale), lambda));
            };
            if let Some(camera_ray) = &sample.camera_ray {
                paths.camera_subpath(camera_ray, lambda, tracer, |encounter, tracer| match encounter {
                    Encounter::Light(found) => add(&found, tracer),
                    Encounter::Vertex(vertex) if vertex.is_connectible() => {
                        paths.connect_each(vertex, light_subpath.iter(), lambda, tracer, &mut add);
                    }
                    Encounter::Vertex(_) => (),
                });
            }
            l
        })?;
        Ok(stats)
    }

    fn films(&self) -> Vec<(String, &Film)> {
        self.techniques.films().collect()
    }

    fn set_films(&mut self, films: Vec<(String, Film)>) {
        self.techniques.set_films(films);
    }
}
