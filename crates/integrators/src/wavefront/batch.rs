//! A batch of paths, and the stages that it goes through whatever the algorithm.

use film::FilmTile;
use geometry::{Hit, HitColumns, PointColumns, RayStats};
use sampling::Sampler;
use scattering::{Bsdf, Bxdf};
use scene::light::LightId;
use scene::material::{Material, MaterialId, MaterialModel};
use scene::{Interfaces, SurfaceInteraction};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::begin::Begin;
use super::emission::{Emit, Escape, LightHit};
use super::finish::{Finish, finish_with_first_hits};
use super::groups::{Grouping, Groups};
use super::lights::Samples;
use super::materials::Shading;
use super::pass::Pass;
use super::paths::Paths;
use super::queues::Queues;
use super::segments::Segments;
use super::shade::{AtVertices, Shade};
use crate::Cancelled;
use crate::transport::direct::DirectLighting;
use crate::transport::path_state::PathState;
use crate::transport::pixel_samples::PixelSamples;

/// The paths of some tiles, one for each pixel. Between the stages here an algorithm
/// [shades](super::WaveIntegrator::shade) the hits.
pub struct Batch<'a> {
    pub(super) pass: Pass<'a>,
    pub(super) sampler: Sampler,
    pub(super) paths: Paths,
    pub(super) queues: Queues,
    /// The paths whose rays are traced, in the order of their hits.
    pub(super) segments: Segments,
    pub(super) hits: HitColumns,
    /// Surface points of some of the hits.
    pub(super) points: PointColumns,
    /// Hits to be shaded in lanes.
    pub(super) lanes: Groups,
    /// The turns of paths that have left the scene.
    escaped: Vec<u32>,
    /// Hits whose group depends on more than their geometry.
    left: Vec<u32>,
    /// Hits of lights that shine in lanes.
    lit: Vec<LightHit>,
    occluded: Vec<bool>,
    pub(super) light_samples: Samples,
    /// Counts the rays.
    pub(super) stats: RayStats,
}

/// A vertex of one path.
pub(super) struct Vertex<'a> {
    /// The path before it scatters there.
    pub state: PathState,
    pub lambda: SampledWavelengths,
    pub surface: SurfaceInteraction,
    pub bsdf: Bsdf<Bxdf<'a>>,
}

impl<'a> Batch<'a> {
    pub(super) fn new(pass: Pass<'a>) -> Self {
        Self {
            pass,
            sampler: pass.pixels.sampler.clone(),
            paths: Paths::default(),
            queues: Queues::default(),
            segments: Segments::default(),
            hits: HitColumns::default(),
            points: PointColumns::default(),
            lanes: Groups::default(),
            escaped: Vec::new(),
            left: Vec::new(),
            lit: Vec::new(),
            occluded: Vec::new(),
            light_samples: Samples::default(),
            stats: RayStats::default(),
        }
    }

    /// Starts a path for each pixel, whose camera ray may have differentials.
    pub(super) fn begin(&mut self, tiles: &[FilmTile], with_differentials: bool) {
        let instruction_set = self.pass.instruction_set;
        let with_weights = !self.pass.pixels.view.camera.is_unweighted();
        let Self { pass, paths, segments, queues, .. } = self;
        paths.start(tiles.iter().map(FilmTile::bounds), with_weights);
        segments.start_from_camera(paths.len(), with_differentials);
        queues.next.start(paths.len(), with_differentials);
        instruction_set.dispatch(Begin { pass: *pass, paths, segments, with_differentials });
        queues.waiting.clear();
        if with_weights {
            // Rays that the camera's lens blocks are not traced.
            for row in 0..paths.len() {
                if paths.camera_weight[row] > 0.0 {
                    queues.next.push(row as u32, &segments.state(row));
                }
            }
            self.go_on();
        }
    }

    /// Finds the nearest hit of each path's ray.
    pub(super) fn extend(&mut self) {
        let rays = self.segments.rays();
        self.pass.pixels.scene.hit_batch(rays, &mut self.hits, &mut self.stats);
    }

    /// Sorts the hits into those to be shaded in lanes, grouped by material, and those to be shaded
    /// one by one (`queues.scalar`). Adds the light from infinity, and that of the lights that
    /// shine in lanes. Paths of `max_depth` scattering events end where no more than this happens.
    pub(super) fn classify(&mut self, max_depth: u32, direct: &DirectLighting) {
        let scene = self.pass.pixels.scene;
        self.lanes.clear(scene.materials().len());
        self.lit.clear();
        self.escaped.clear();
        let mut left = std::mem::take(&mut self.left);
        self.pass.instruction_set.dispatch(Grouping {
            materials: self.pass.materials,
            segments: &self.segments,
            geometries: &self.hits.geometry,
            max_depth,
            groups: &mut self.lanes,
            escaped: &mut self.escaped,
            left: &mut left,
        });
        for turn in left.drain(..) {
            let (row, geometry) = (self.segments.rows[turn as usize], self.hits.geometry[turn as usize]);
            let entry = &scene.geometries()[geometry as usize];
            let light = match entry.first_light {
                Some(first) => self.pass.area_lights.light_of(first, &self.hits, turn),
                None => None,
            };
            if let Some(LightId(light)) = light {
                self.lit.push(LightHit { row, turn, light });
            }
            let is_emitted = entry.first_light.is_none() || light.is_some();
            let is_last = self.segments.depth[turn as usize] == max_depth;
            if is_emitted
                && is_last
                && scene.materials()[entry.material.0 as usize].material.stops(scene.textures())
            {
                continue;
            }
            let shading = self.pass.materials.shading(entry.material, self.segments.has_differentials(turn));
            if is_emitted && !is_last && shading != Shading::Scalar {
                self.lanes.push(entry.material, turn, row);
            } else {
                self.queues.scalar.push((row, turn));
            }
        }
        self.left = left;
        self.emit(direct);
        self.escape(direct);
    }

    /// Adds the emission at hits of lights that shine in lanes.
    fn emit(&mut self, direct: &DirectLighting) {
        self.pass.instruction_set.dispatch(Emit {
            pass: self.pass,
            direct,
            hits: &self.hits,
            found: &self.lit,
            segments: &self.segments,
            paths: &mut self.paths,
        });
    }

    /// Adds the light from infinity to the paths that have left the scene.
    fn escape(&mut self, direct: &DirectLighting) {
        let &PixelSamples { scene, .. } = self.pass.pixels;
        let Self { escaped: queue, segments, paths, .. } = self;
        if Escape::is_enough(scene) {
            self.pass.instruction_set.dispatch(Escape { scene, direct, queue, segments, paths });
            return;
        }
        for turn in queue.iter().map(|&turn| turn as usize) {
            let row = segments.rows[turn] as usize;
            let (state, lambda) = (segments.state(turn), paths.lambda(row));
            let l = state.beta * direct.escaped(scene, &state.ray, state.origin.as_ref(), &lambda);
            paths.add_light(row, l);
        }
    }

    /// Shades the hits that are shaded in lanes.
    pub(super) fn shade_in_lanes<A: AtVertices>(&mut self, algorithm: &A) {
        let scene = self.pass.pixels.scene;
        let lanes = std::mem::take(&mut self.lanes);
        for (id, turns, rows) in lanes.iter() {
            scene.world().points(&self.hits, turns, &mut self.points);
            match &scene.materials()[id.0 as usize].material {
                Material::Diffuse(material) => self.dispatch(algorithm, (id, material), turns, rows),
                Material::DiffuseTransmission(material) => {
                    self.dispatch(algorithm, (id, material), turns, rows);
                }
                Material::Conductor(material) => self.dispatch(algorithm, (id, material), turns, rows),
                Material::Dielectric(material) => self.dispatch(algorithm, (id, material), turns, rows),
                Material::ThinDielectric(material) => self.dispatch(algorithm, (id, material), turns, rows),
                Material::CoatedDiffuse(material) => self.dispatch(algorithm, (id, material), turns, rows),
                Material::CoatedConductor(material) => {
                    self.dispatch(algorithm, (id, material), turns, rows);
                }
                Material::Hair(_)
                | Material::Measured(_)
                | Material::Subsurface(_)
                | Material::OpenPbr(_)
                | Material::Mix(_)
                | Material::Interface => {
                    unreachable!("invariant: LaneMaterials has all others in no lanes")
                }
            }
        }
        self.lanes = lanes;
    }

    fn dispatch<M: MaterialModel, A: AtVertices>(
        &mut self,
        algorithm: &A,
        (id, material): (MaterialId, &M),
        turns: &[u32],
        rows: &[u32],
    ) {
        let with_footprint = self.pass.materials.shading(id, false) == Shading::LanesWithFootprint;
        self.pass.instruction_set.dispatch(Shade {
            pass: self.pass,
            algorithm,
            material,
            with_footprint,
            points: &self.points,
            turns,
            rows,
            segments: &self.segments,
            paths: &mut self.paths,
            queues: &mut self.queues,
            light_samples: &mut self.light_samples,
        });
    }

    /// Calls `shade` with each path whose hit is not shaded in lanes, its turn, and the hit.
    pub(super) fn shade_others(&mut self, shade: impl Fn(&mut Self, (u32, u32), &Hit)) {
        let mut scalar = std::mem::take(&mut self.queues.scalar);
        for (path, turn) in scalar.drain(..) {
            let hit = self.hits.get(turn as usize).expect("invariant: paths without hit have ended");
            shade(self, (path, turn), &hit);
        }
        self.queues.scalar = scalar;
    }

    /// The vertex of a path at a hit, to which the batch's sampler has gone on. Adds emission.
    /// `None` where the ray passes through the surface.
    pub(super) fn vertex(
        &mut self,
        (path, turn): (u32, u32),
        hit: &Hit,
        direct: &DirectLighting,
    ) -> Option<Vertex<'a>> {
        let Self { pass, paths, segments, sampler, queues, .. } = self;
        let &PixelSamples { scene, view, index, .. } = pass.pixels;
        let row = path as usize;
        let mut state = segments.state(turn as usize);
        let mut lambda = paths.lambda(row);
        let mut surface = scene.interaction(hit, scene.world().surface(&state.ray.ray, hit));
        if surface.area_light.is_some_and(|light| !pass.area_lights.contains(light)) {
            let l = state.beta * direct.emitted(scene, &surface, state.origin.as_ref(), &lambda);
            paths.add_light(row, l);
        }
        paths.resume(sampler, row, index);
        let Some(bsdf) = scene.bsdf(view, &mut surface, &state.ray, &mut lambda, sampler) else {
            state.pass_through(&surface, hit.t);
            queues.next.push(path, &state);
            return None;
        };
        paths.set_lambda(row, &lambda);
        Some(Vertex { state, lambda, surface, bsdf })
    }

    /// Gives the paths that have no next ray their last waiting one.
    pub(super) fn go_on_with_waiting(&mut self) {
        let Queues { next, waiting, .. } = &mut self.queues;
        if waiting.is_empty() {
            return;
        }
        let mut goes_on = vec![false; self.paths.len()];
        next.rows.iter().for_each(|&row| goes_on[row as usize] = true);
        for &row in self.segments.rows.iter().filter(|&&row| !goes_on[row as usize]) {
            if let Some(state) = waiting.get_mut(row as usize).and_then(Vec::pop) {
                next.push(row, &state);
            }
        }
    }

    /// Goes on with the paths that have a next ray.
    pub(super) fn go_on(&mut self) {
        self.segments.rows.clear();
        std::mem::swap(&mut self.segments, &mut self.queues.next);
    }

    /// Traces the shadow rays.
    pub(super) fn connect(&mut self) {
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
    pub(super) fn finish(&mut self, tiles: &mut [FilmTile]) -> Result<(), Cancelled> {
        self.paths.weigh();
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
