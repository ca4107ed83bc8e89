//! The stages of a batch.

use film::FilmTile;
use geometry::{Hit, HitColumns, PointColumns, RayStats};
use sampling::Sampler;
use scattering::{Bsdf, each_bxdf};
use scene::Interfaces;
use scene::light::LightId;
use scene::material::{Material, MaterialId, MaterialModel};
use spectrum::SampledSpectrum;

use super::begin::Begin;
use super::emission::{Emit, Escape, LightHit};
use super::finish::{Finish, finish_with_first_hits};
use super::groups::Groups;
use super::lights::Samples;
use super::materials::Shading;
use super::pass::Pass;
use super::paths::Paths;
use super::queues::Queues;
use super::shade::Shade;
use crate::Cancelled;
use crate::transport::direct::{Connection, light_context};
use crate::transport::path_state::Scattered;
use crate::transport::pixel_samples::PixelSamples;

/// The stages of one batch.
pub(super) struct Stages<'a> {
    pass: Pass<'a>,
    sampler: Sampler,
    paths: Paths,
    queues: Queues,
    /// The paths under way.
    active: Vec<u32>,
    hits: HitColumns,
    points: PointColumns,
    /// Hits to be shaded in lanes.
    lanes: Groups,
    /// The paths that have left the scene.
    escaped: Vec<u32>,
    /// Hits of lights that shine in lanes.
    lit: Vec<LightHit>,
    occluded: Vec<bool>,
    light_samples: Samples,
    /// Counts the rays.
    pub stats: RayStats,
}

impl<'a> Stages<'a> {
    pub fn new(pass: Pass<'a>) -> Self {
        Self {
            pass,
            sampler: pass.pixels.sampler.clone(),
            paths: Paths::default(),
            queues: Queues::default(),
            active: Vec::new(),
            hits: HitColumns::default(),
            points: PointColumns::default(),
            lanes: Groups::default(),
            escaped: Vec::new(),
            lit: Vec::new(),
            occluded: Vec::new(),
            light_samples: Samples::default(),
            stats: RayStats::default(),
        }
    }

    /// Traces one path for each pixel of the tiles. After a cancellation nothing is added to them.
    pub fn run(&mut self, mut tiles: Vec<FilmTile>) -> Result<(), Cancelled> {
        self.begin(&tiles);
        while !self.active.is_empty() {
            self.pass.control.check()?;
            self.extend();
            self.shade();
            self.pass.control.check()?;
            self.connect();
        }
        self.finish(&mut tiles)
    }

    /// Starts a path for each pixel.
    fn begin(&mut self, tiles: &[FilmTile]) {
        let Pass { pixels, instruction_set, .. } = self.pass;
        let with_differentials = pixels.scene.needs_footprints(pixels.view);
        self.paths.start(tiles.iter().map(FilmTile::bounds), with_differentials);
        instruction_set.dispatch(Begin { pass: self.pass, paths: &mut self.paths, with_differentials });
        self.active.clear();
        self.active.extend(0..self.paths.len() as u32);
    }

    /// Finds the nearest hit of each path's ray.
    fn extend(&mut self) {
        let rays = self.paths.rays(&self.active);
        self.pass.pixels.scene.hit_batch(rays, &mut self.hits, &mut self.stats);
    }

    /// Continues each path from its hit.
    fn shade(&mut self) {
        let scene = self.pass.pixels.scene;
        self.lanes.clear(scene.materials().len());
        self.lit.clear();
        self.escaped.clear();
        for (turn, (&row, &geometry)) in self.active.iter().zip(&self.hits.geometry).enumerate() {
            let turn = turn as u32;
            let Some(entry) = scene.geometries().get(geometry as usize) else {
                self.escaped.push(row);
                continue;
            };
            let light = match entry.first_light {
                Some(first) => self.pass.area_lights.light_of(first, &self.hits, turn),
                None => None,
            };
            if let Some(LightId(light)) = light {
                self.lit.push(LightHit { row, turn, light });
            }
            let is_emitted = entry.first_light.is_none() || light.is_some();
            let is_last = self.paths.depth[row as usize] == self.pass.settings.max_depth;
            if is_emitted && is_last && scene.materials()[entry.material.0 as usize].material.stops() {
                continue;
            }
            let shading = self.pass.materials.shading(entry.material, self.paths.has_differentials(row));
            if is_emitted && !is_last && shading != Shading::Scalar {
                self.lanes.push(entry.material, turn, row);
            } else {
                self.queues.scalar.push((row, turn));
            }
        }
        self.emit();
        self.escape();
        self.lanes.sort();
        let lanes = std::mem::take(&mut self.lanes);
        for (material, turns, rows) in lanes.iter() {
            self.shade_in_lanes(material, turns, rows);
        }
        self.lanes = lanes;
        let scalar = std::mem::take(&mut self.queues.scalar);
        for &(row, turn) in &scalar {
            let hit = self.hits.get(turn as usize).expect("invariant: paths without hit have ended");
            self.shade_path(row, &hit);
        }
        self.queues.scalar = scalar;
        self.queues.scalar.clear();
        self.active.clear();
        std::mem::swap(&mut self.active, &mut self.queues.next);
    }

    /// Adds the emission at hits of lights that shine in lanes.
    fn emit(&mut self) {
        self.pass.instruction_set.dispatch(Emit {
            pass: self.pass,
            hits: &self.hits,
            found: &self.lit,
            paths: &mut self.paths,
        });
    }

    /// Adds the light from infinity to the paths that have left the scene.
    fn escape(&mut self) {
        let Pass { direct, pixels: &PixelSamples { scene, .. }, .. } = self.pass;
        let (queue, paths) = (&self.escaped, &mut self.paths);
        if Escape::is_enough(scene) {
            self.pass.instruction_set.dispatch(Escape { scene, queue, paths });
            return;
        }
        for row in queue.iter().map(|&row| row as usize) {
            let (state, lambda) = (paths.state(row), paths.lambda(row));
            let l = state.beta * direct.escaped(scene, &state.ray, state.origin.as_ref(), &lambda);
            paths.add_light(row, l);
        }
    }

    /// Shades hits of one material.
    fn shade_in_lanes(&mut self, id: MaterialId, turns: &[u32], rows: &[u32]) {
        self.pass.pixels.scene.world().points(&self.hits, turns, &mut self.points);
        let with_footprint = self.pass.materials.shading(id, false) == Shading::LanesWithFootprint;
        match &self.pass.pixels.scene.materials()[id.0 as usize].material {
            Material::Diffuse(material) => self.dispatch(material, with_footprint, turns, rows),
            Material::DiffuseTransmission(material) => self.dispatch(material, with_footprint, turns, rows),
            Material::Conductor(material) => self.dispatch(material, with_footprint, turns, rows),
            Material::Dielectric(material) => self.dispatch(material, with_footprint, turns, rows),
            Material::ThinDielectric(material) => self.dispatch(material, with_footprint, turns, rows),
            Material::Mix(_) | Material::Interface => {
                unreachable!("invariant: mixes and interfaces are not shaded in lanes")
            }
        }
    }

    fn dispatch<M: MaterialModel>(
        &mut self,
        material: &'a M,
        with_footprint: bool,
        turns: &[u32],
        rows: &[u32],
    ) {
        self.pass.instruction_set.dispatch(Shade {
            pass: self.pass,
            material,
            with_footprint,
            points: &self.points,
            turns,
            rows,
            paths: &mut self.paths,
            queues: &mut self.queues,
            light_samples: &mut self.light_samples,
        });
    }

    /// Shades one path.
    fn shade_path(&mut self, path: u32, hit: &Hit) {
        let Pass { settings, direct, area_lights, pixels, .. } = self.pass;
        let &PixelSamples { scene, view, index, .. } = pixels;
        let row = path as usize;
        let mut state = self.paths.state(row);
        let mut lambda = self.paths.lambda(row);
        let mut surface = scene.interaction(hit, scene.world().surface(&state.ray.ray, hit));
        if surface.area_light.is_some_and(|light| !area_lights.contains(light)) {
            let l = state.beta * direct.emitted(scene, &surface, state.origin.as_ref(), &lambda);
            self.paths.add_light(row, l);
        }
        let pixel = self.paths.pixel.each_ref().map(|column| column[row] as i32);
        self.sampler.start_pixel_sample(pixel, index, self.paths.dimension[row]);
        let sampler = &mut self.sampler;
        let Some(mut bsdf) = scene.bsdf(view, &mut surface, &state.ray, &mut lambda, sampler) else {
            state.pass_through(&surface, hit.t);
            self.paths.set_state(row, &state);
            self.queues.next.push(path);
            return;
        };
        if state.depth == settings.max_depth {
            self.paths.set_lambda(row, &lambda);
            return;
        }
        state.depth += 1;
        bsdf.regularize(settings.regularize && self.paths.rough_before[row]);
        let context = light_context(&surface, bsdf.flags());
        let scattered = each_bxdf!(bsdf.bxdf, bxdf => {
            let bsdf = Bsdf { bxdf, frame: bsdf.frame };
            if bsdf.flags().is_non_specular() {
                let connection = direct.connect(scene, sampler, (&surface, &context), &bsdf, &lambda);
                if let Some(Connection { ray, t_max, interfaces, l }) = connection {
                    let queue = &mut self.queues.shadows[(interfaces == Interfaces::Pass) as usize];
                    queue.push(path, state.beta * l, &ray, t_max);
                }
            }
            Scattered::sample(&surface, &bsdf, sampler)
        });
        self.paths.set_lambda(row, &lambda);
        let Some(scattered) = scattered else { return };
        self.paths.rough_before[row] |= !scattered.sample.flags.is_specular();
        state.scatter(&surface, context, &scattered);
        if state.survives(sampler) {
            self.paths.dimension[row] = sampler.dimension();
            self.paths.set_state(row, &state);
            self.queues.next.push(path);
        }
    }

    /// Traces the shadow rays.
    fn connect(&mut self) {
        for (queue, interfaces) in self.queues.shadows.iter_mut().zip([Interfaces::Stop, Interfaces::Pass]) {
            self.occluded.clear();
            self.occluded.resize(queue.paths.len(), false);
            let scene = self.pass.pixels.scene;
            scene.occluded_batch(queue.rays.columns(), interfaces, &mut self.occluded, &mut self.stats);
            for (shadow, (&path, occluded)) in queue.paths.iter().zip(&self.occluded).enumerate() {
                if !occluded {
                    self.paths.add_light(path as usize, SampledSpectrum(queue.l.row(shadow)));
                }
            }
            queue.clear();
        }
    }

    /// Adds the radiance of all paths to the film.
    fn finish(&mut self, tiles: &mut [FilmTile]) -> Result<(), Cancelled> {
        let mut first = 0;
        for tile in tiles {
            let (pixels, with_first_hits) = (tile.bounds().area(), tile.wants_first_hit());
            let finish = Finish { paths: &self.paths, first, tile };
            if with_first_hits {
                finish_with_first_hits(&self.pass, &mut self.sampler, &mut self.stats, finish)?;
            } else {
                self.pass.instruction_set.dispatch(finish);
            }
            first += pixels;
        }
        Ok(())
    }
}
