//! The stages.

use description::PathDesc;
use film::FilmTile;
use geometry::{Hit, RayStats};
use math::{Point3, Ray, Vector3};
use scattering::{Bsdf, each_bxdf};
use scene::{Interfaces, SurfaceInteraction};
use spectrum::SampledSpectrum;

use super::paths::PathRecord;
use crate::transport::direct::{Connection, DirectLighting, light_context};
use crate::transport::path_state::{PathState, Scattered};
use crate::transport::pixel_samples::PixelSamples;
use crate::{Cancelled, Control, Tracer};

/// The stages of one batch, with their queues.
pub(super) struct Stages<'a> {
    settings: &'a PathDesc,
    direct: &'a DirectLighting,
    pixels: &'a PixelSamples<'a>,
    control: &'a Control,
    paths: Vec<PathRecord>,
    /// The paths under way.
    active: Vec<u32>,
    rays: Vec<(Ray, f32)>,
    hits: Vec<Option<Hit>>,
    /// Shadow rays, apart for the two kinds of `Interfaces`.
    shadows: [Vec<Shadow>; 2],
    occluded: Vec<bool>,
    /// Counts the rays.
    pub stats: RayStats,
}

/// A shadow ray in its queue.
struct Shadow {
    path: u32,
    l: SampledSpectrum,
    ray: Ray,
    t_max: f32,
}

impl<'a> Stages<'a> {
    pub fn new(
        settings: &'a PathDesc,
        direct: &'a DirectLighting,
        pixels: &'a PixelSamples,
        control: &'a Control,
    ) -> Self {
        Self {
            settings,
            direct,
            pixels,
            control,
            paths: Vec::new(),
            active: Vec::new(),
            rays: Vec::new(),
            hits: Vec::new(),
            shadows: [Vec::new(), Vec::new()],
            occluded: Vec::new(),
            stats: RayStats::default(),
        }
    }

    /// Traces one path for each pixel of the tiles. After a cancellation nothing is added to them.
    pub fn run(&mut self, mut tiles: Vec<FilmTile>) -> Result<(), Cancelled> {
        self.begin(&tiles);
        while !self.active.is_empty() {
            self.control.check()?;
            self.extend();
            self.shade();
            self.control.check()?;
            self.connect();
        }
        self.finish(&mut tiles)
    }

    /// Starts a path for each pixel.
    fn begin(&mut self, tiles: &[FilmTile]) {
        for (tile, bounds) in tiles.iter().map(FilmTile::bounds).enumerate() {
            for y in bounds.min[1]..bounds.max[1] {
                for x in bounds.min[0]..bounds.max[0] {
                    let mut sampler = self.pixels.sampler.clone();
                    let sample = self.pixels.begin(None, [x, y], &mut sampler);
                    let (ray, l) =
                        (sample.camera_ray.as_ref().map(|camera| camera.ray), SampledSpectrum::ZERO);
                    if ray.is_some() {
                        self.active.push(self.paths.len() as u32);
                    }
                    let nowhere = Ray::new(Point3::ZERO, Vector3::Z, 0.0).into();
                    let state = PathState::new(ray.unwrap_or(nowhere), 0);
                    self.paths.push(PathRecord { tile, sample, sampler, state, l, rough_before: false });
                }
            }
        }
    }

    /// Finds the nearest hit of each path's ray.
    fn extend(&mut self) {
        self.rays.clear();
        let rays = self.active.iter().map(|&path| (self.paths[path as usize].state.ray.ray, f32::INFINITY));
        self.rays.extend(rays);
        self.hits.clear();
        self.hits.resize(self.rays.len(), None);
        self.pixels.scene.hit_batch(&self.rays, &mut self.hits, &mut self.stats);
    }

    /// Continues each path from its hit.
    fn shade(&mut self) {
        let mut active = std::mem::take(&mut self.active);
        let mut turn = 0;
        active.retain(|&path| {
            let hit = self.hits[turn].take();
            turn += 1;
            self.shade_path(path, hit)
        });
        self.active = active;
    }

    /// Shades one path; whether it goes on.
    fn shade_path(&mut self, index: u32, hit: Option<Hit>) -> bool {
        let (scene, direct) = (self.pixels.scene, self.direct);
        let path = &mut self.paths[index as usize];
        let lambda = &mut path.sample.lambda;
        let Some(hit) = hit else {
            let (ray, origin) = (&path.state.ray, path.state.origin.as_ref());
            path.l += path.state.beta * direct.escaped(scene, ray, origin, lambda);
            return false;
        };
        let mut surface: SurfaceInteraction =
            scene.interaction(&hit, scene.world().surface(&path.state.ray.ray, &hit));
        path.l += path.state.beta * direct.emitted(scene, &surface, path.state.origin.as_ref(), lambda);
        let view = self.pixels.view;
        let Some(mut bsdf) = scene.bsdf(view, &mut surface, &path.state.ray, lambda, &mut path.sampler)
        else {
            path.state.pass_through(&surface, hit.t);
            return true;
        };
        if path.state.depth == self.settings.max_depth {
            return false;
        }
        path.state.depth += 1;
        if self.settings.regularize && path.rough_before {
            bsdf.regularize();
        }
        let context = light_context(&surface, bsdf.flags());
        let scattered = each_bxdf!(bsdf.bxdf, bxdf => {
            let bsdf = Bsdf { bxdf, frame: bsdf.frame };
            if bsdf.flags().is_non_specular() {
                let vertex = (&surface, &context);
                let connection = direct.connect(scene, &mut path.sampler, vertex, &bsdf, lambda);
                if let Some(Connection { ray, t_max, interfaces, l }) = connection {
                    let queue = &mut self.shadows[(interfaces == Interfaces::Pass) as usize];
                    queue.push(Shadow { path: index, l: path.state.beta * l, ray, t_max });
                }
            }
            Scattered::sample(&surface, &bsdf, &mut path.sampler)
        });
        let Some(scattered) = scattered else { return false };
        path.rough_before |= !scattered.sample.flags.is_specular();
        path.state.scatter(&surface, context, &scattered);
        path.state.survives(&mut path.sampler)
    }

    /// Traces the shadow rays.
    fn connect(&mut self) {
        for (queue, interfaces) in self.shadows.iter_mut().zip([Interfaces::Stop, Interfaces::Pass]) {
            self.rays.clear();
            self.rays.extend(queue.iter().map(|shadow| (shadow.ray, shadow.t_max)));
            self.occluded.clear();
            self.occluded.resize(queue.len(), false);
            let scene = self.pixels.scene;
            scene.occluded_batch(&self.rays, interfaces, &mut self.occluded, &mut self.stats);
            for (shadow, occluded) in queue.drain(..).zip(&self.occluded) {
                if !occluded {
                    self.paths[shadow.path as usize].l += shadow.l;
                }
            }
        }
    }

    /// Adds the radiance of all paths to the film.
    fn finish(&mut self, tiles: &mut [FilmTile]) -> Result<(), Cancelled> {
        let PixelSamples { scene, view, .. } = *self.pixels;
        for path in &mut self.paths {
            let (tile, sample) = (&mut tiles[path.tile], &path.sample);
            let mut tracer = Tracer::new(scene, view, self.control, &mut path.sampler, &mut self.stats);
            let first_hit = self.pixels.first_hit(tile, sample, &sample.lambda, &mut tracer);
            tracer.finish()?;
            let l = path.l * sample.camera_ray.as_ref().map_or(0.0, |camera| camera.weight);
            let alpha = if first_hit.is_some() { 1.0 } else { 0.0 };
            let radiance = film::Sample::new(&l, &sample.lambda, sample.filter_weight);
            tile.add(sample.pixel, &film::Sample { alpha, first_hit, ..radiance });
        }
        Ok(())
    }
}
