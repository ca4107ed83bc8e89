//! A batch of paths, and the stages that it goes through whatever the algorithm.

use film::FilmTile;
use geometry::{Hit, HitColumns, PointColumns, RayStats};
use math::CameraEnd;
use sampling::Sampler;
use scattering::{Bsdf, Bxdf};
use scene::light::LightId;
use scene::material::{Material, MaterialId, MaterialModel};
use scene::{GeometryEntry, Interfaces, SurfaceInteraction};
use spectrum::SampledWavelengths;

use super::begin::Begin;
use super::emission::{Emit, Escape, LightHit};
use super::exits::Exits;
use super::finish::{Finish, finish_some, finish_with_first_hits};
use super::groups::{Group, Grouping, Groups};
use super::lights::Samples;
use super::materials::Shading;
use super::media::MediumVertices;
use super::normals::Perturb;
use super::pass::Pass;
use super::path_columns::PathColumns;
use super::queues::{PathHit, Queues};
use super::segment_columns::{OptionalColumns, SegmentColumns};
use super::shade::Shade;
use super::stage::{Algorithm, Stage};
use crate::Cancelled;
use crate::transport::direct::DirectLighting;
use crate::transport::path_state::PathState;
use crate::transport::pixel_samples::PixelSamples;

/// The paths of some tiles, one for each pixel that takes a sample. Between the stages here an
/// algorithm [shades](super::WaveIntegrator::shade) the hits.
pub struct Batch<'a> {
    pub(super) pass: Pass<'a>,
    pub(super) sampler: Sampler,
    /// Counts the rays.
    pub(super) stats: RayStats,
    pub(super) columns: &'a mut BatchColumns,
}

/// The columns of a batch. Those of the next batch take their memory.
#[derive(Default)]
pub(super) struct BatchColumns {
    pub paths: PathColumns,
    pub queues: Queues,
    /// The paths whose rays are traced, in the order of their hits.
    pub segments: SegmentColumns,
    pub hits: HitColumns,
    /// Surface points of some of the hits.
    pub points: PointColumns,
    /// Hits to be shaded in lanes.
    lanes: Groups,
    /// The hits of paths that have left the scene.
    escaped: Vec<u32>,
    /// Hits whose group depends on more than their geometry.
    left: Vec<u32>,
    /// Hits of lights that shine in lanes.
    lit: Vec<LightHit>,
    pub occluded: Vec<bool>,
    pub light_samples: Samples,
    /// Where media scatter paths.
    pub medium_vertices: MediumVertices,
    /// Where paths leave bodies.
    pub exits: Exits,
}

/// The way of a hit.
enum Way {
    /// Its path ends there.
    Ends,
    /// It is shaded by itself.
    Scalar,
    /// It is shaded in lanes, with the others of a material.
    Lanes(MaterialId),
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
    pub(super) fn new(pass: Pass<'a>, columns: &'a mut BatchColumns) -> Self {
        Self { pass, sampler: pass.pixels.sampler.clone(), stats: RayStats::default(), columns }
    }

    /// Starts a path for each pixel that takes a sample, whose camera ray may have differentials.
    pub(super) fn begin(&mut self, tiles: &[FilmTile], optional: OptionalColumns) {
        let instruction_set = self.pass.instruction_set;
        let with_weights = !self.pass.pixels.view.camera.is_unweighted();
        let Self { pass, columns: BatchColumns { paths, segments, queues, .. }, .. } = self;
        let bounds = tiles.iter().map(FilmTile::bounds);
        paths.start(bounds, |pixel| pass.pixels.takes(pixel), with_weights, optional.media);
        segments.start_from_camera(paths.len(), optional, pass.pixels.view.medium);
        queues.next.start(paths.len(), optional);
        instruction_set.dispatch_large(Begin { pass: *pass, paths, segments, optional });
        queues.waiting.clear();
        if with_weights {
            queues.next.camera = segments.camera;
            // Rays that the camera's lens blocks are not traced.
            for row in 0..paths.len() {
                if paths.camera_weight[row] > 0.0 {
                    queues.next.push_from(segments, row);
                }
            }
            self.go_on();
        }
    }

    /// Finds the nearest hit of each path's ray.
    pub(super) fn extend(&mut self) {
        let rays = self.columns.segments.rays();
        self.pass.pixels.scene.hit_batch(rays, &mut self.columns.hits, &mut self.stats);
    }

    /// Sorts the hits into those to be shaded in lanes, grouped by material, and those to be shaded
    /// one by one (`queues.scalar`). Adds the light from infinity, and that of the lights that
    /// shine in lanes. Paths of `max_depth` scattering events end where no more than this happens.
    pub(super) fn classify(&mut self, max_depth: u32, direct: &DirectLighting) {
        self.columns.lanes.clear(self.pass.pixels.scene.materials().len());
        self.columns.lit.clear();
        self.columns.escaped.clear();
        let mut left = std::mem::take(&mut self.columns.left);
        self.pass.instruction_set.dispatch_large(Grouping {
            materials: self.pass.materials,
            segments: &self.columns.segments,
            geometries: &self.columns.hits.geometry,
            max_depth,
            groups: &mut self.columns.lanes,
            escaped: &mut self.columns.escaped,
            left: &mut left,
        });
        for hit in left.drain(..) {
            let place = PathHit { path: self.columns.segments.rows[hit as usize], hit };
            match self.way(place, max_depth) {
                Way::Ends => (),
                Way::Scalar => self.columns.queues.scalar.push(place),
                Way::Lanes(material) => self.columns.lanes.push(material, place),
            }
        }
        self.columns.left = left;
        self.emit(direct);
        self.escape(direct);
    }

    /// The way of a hit whose group depends on more than its geometry. Lists it if it is of a light
    /// that shines in lanes.
    fn way(&mut self, place: PathHit, max_depth: u32) -> Way {
        let (scene, hit) = (self.pass.pixels.scene, place.hit as usize);
        let entry = &scene.geometries()[self.columns.hits.geometry[hit] as usize];
        if let Some(first) = entry.first_light {
            match self.pass.area_lights.light_of(first, &self.columns.hits, place.hit) {
                Some(LightId(light)) => self.columns.lit.push(LightHit { place, light }),
                None => return Way::Scalar,
            }
        }
        if self.columns.segments.depth[hit] == max_depth {
            let material = &scene.materials()[entry.material.0 as usize].material;
            return if material.stops(scene.textures()) { Way::Ends } else { Way::Scalar };
        }
        let material = self.material_at(place.hit, entry);
        match self.pass.materials.shading(material) {
            Shading::Scalar => Way::Scalar,
            Shading::Lanes | Shading::LanesWithFootprint => Way::Lanes(material),
        }
    }

    /// The material at a hit on a geometry, after the choices of mixes.
    fn material_at(&self, hit_index: u32, entry: &GeometryEntry) -> MaterialId {
        let &PixelSamples { scene, view, .. } = self.pass.pixels;
        if !matches!(scene.materials()[entry.material.0 as usize].material, Material::Mix(_)) {
            return entry.material;
        }
        let hit = self.columns.hits.get(hit_index as usize).expect("invariant: paths without hit have ended");
        let ray = self.columns.segments.state(hit_index as usize).ray;
        let mut interaction = scene.interaction(&hit, scene.world().surface(&ray.ray, &hit));
        scene.material_at(view, &mut interaction, &ray)
    }

    /// Adds the emission at hits of lights that shine in lanes.
    fn emit(&mut self, direct: &DirectLighting) {
        self.pass.instruction_set.dispatch_large(Emit {
            pass: self.pass,
            direct,
            hits: &self.columns.hits,
            found: &self.columns.lit,
            segments: &self.columns.segments,
            paths: &mut self.columns.paths,
        });
    }

    /// Adds the light from infinity to the paths that have left the scene.
    fn escape(&mut self, direct: &DirectLighting) {
        let &PixelSamples { scene, .. } = self.pass.pixels;
        let BatchColumns { escaped: queue, segments, paths, .. } = &mut *self.columns;
        if Escape::is_enough(scene) {
            self.pass.instruction_set.dispatch_large(Escape { scene, direct, queue, segments, paths });
            return;
        }
        for hit_index in queue.iter().map(|&hit_index| hit_index as usize) {
            let row = segments.rows[hit_index] as usize;
            let (state, lambda) = (segments.state(hit_index), paths.lambda(row));
            let l = state.beta * direct.escaped(scene, &state.ray, state.origin.as_ref(), &lambda);
            paths.add_light(row, l);
        }
    }

    /// Shades the hits that are shaded in lanes.
    pub(super) fn shade_in_lanes(&mut self, algorithm: Algorithm) {
        let scene = self.pass.pixels.scene;
        let lanes = std::mem::take(&mut self.columns.lanes);
        for (id, group) in lanes.iter() {
            let hit_indices = &group.hit_indices;
            let BatchColumns { segments, hits, points, .. } = &mut *self.columns;
            let entry = &scene.materials()[id.0 as usize];
            if entry.bump_map.is_some() {
                scene.world().points_with_shading(segments.rays(), hits, hit_indices, points);
            } else {
                scene.world().points(segments.rays(), hits, hit_indices, points);
            }
            if entry.normal_map.is_some() || entry.bump_map.is_some() {
                self.pass.instruction_set.dispatch_large(Perturb {
                    pass: self.pass,
                    entry,
                    hit_indices,
                    segments,
                    points,
                });
            }
            macro_rules! shade {
                ($($kind:ident)*) => {
                    match &entry.material {
                        $(Material::$kind(material) => self.dispatch(algorithm, id, material, group),)*
                        Material::OpenPbr(material) => self.dispatch(algorithm, id, &**material, group),
                        Material::Subsurface(body) => self.shade_body(algorithm, id, body, group),
                        Material::Mix(_) | Material::Interface => {
                            unreachable!("invariant: LaneMaterials has all others in no lanes")
                        }
                    }
                };
            }
            shade! {
                Diffuse DiffuseTransmission Conductor Dielectric ThinDielectric CoatedDiffuse
                CoatedConductor Hair Measured
            }
        }
        self.columns.lanes = lanes;
    }

    /// Shades hits of a material.
    pub(super) fn dispatch<M: MaterialModel>(
        &mut self,
        algorithm: Algorithm,
        id: MaterialId,
        material: &M,
        group: &Group,
    ) {
        let BatchColumns { segments, points, hits, paths, queues, light_samples, .. } = &mut *self.columns;
        let with_footprint = self.pass.materials.shading(id) == Shading::LanesWithFootprint;
        let stage = Stage {
            pass: self.pass,
            algorithm,
            with_footprint,
            points,
            hits,
            hit_indices: &group.hit_indices,
            rows: &group.rows,
            segments,
            paths,
            queues,
            light_samples,
        };
        self.pass.instruction_set.dispatch_large(Shade { material, stage });
    }

    /// Calls `shade` with each hit that is not shaded in lanes.
    pub(super) fn shade_others(&mut self, shade: impl Fn(&mut Self, PathHit, &Hit)) {
        let mut scalar = std::mem::take(&mut self.columns.queues.scalar);
        for place in scalar.drain(..) {
            let hit = self.columns.hits.get(place.hit as usize);
            shade(self, place, &hit.expect("invariant: paths without hit have ended"));
        }
        self.columns.queues.scalar = scalar;
    }

    /// The vertex of a path at a hit, to which the batch's sampler has gone on. Adds emission.
    /// `None` where the ray passes through the surface.
    pub(super) fn vertex(
        &mut self,
        place: PathHit,
        hit: &Hit,
        direct: &DirectLighting,
    ) -> Option<Vertex<'a>> {
        let Self { pass, sampler, columns: BatchColumns { paths, segments, queues, .. }, .. } = self;
        let &PixelSamples { scene, view, index, .. } = pass.pixels;
        let row = place.path as usize;
        let mut state = segments.state(place.hit as usize);
        let mut lambda = paths.lambda(row);
        let mut surface = scene.interaction(hit, scene.world().surface(&state.ray.ray, hit));
        if surface.area_light.is_some_and(|light| !pass.area_lights.contains(light)) {
            let l = state.beta * direct.emitted(scene, &surface, state.origin.as_ref(), &lambda);
            paths.add_light(row, l);
        }
        paths.resume(sampler, row, index);
        let Some(bsdf) = scene.bsdf(view, &mut surface, &state.ray, &mut lambda, sampler) else {
            state.pass_through(&surface, hit.t);
            queues.next.push(place.path, &state);
            return None;
        };
        paths.set_lambda(row, &lambda);
        Some(Vertex { state, lambda, surface, bsdf })
    }

    /// Gives the paths that have no next ray their last waiting one.
    pub(super) fn go_on_with_waiting(&mut self) {
        let Queues { next, waiting, .. } = &mut self.columns.queues;
        if waiting.is_empty() {
            return;
        }
        let mut goes_on = vec![false; self.columns.paths.len()];
        next.rows.iter().for_each(|&row| goes_on[row as usize] = true);
        for &row in self.columns.segments.rows.iter().filter(|&&row| !goes_on[row as usize]) {
            if let Some(state) = waiting.pop(row) {
                next.push(row, &state);
            }
        }
    }

    /// Goes on with the paths that have a next ray.
    pub(super) fn go_on(&mut self) {
        let BatchColumns { segments, queues, .. } = &mut *self.columns;
        segments.rows.clear();
        segments.camera = CameraEnd::Neither;
        std::mem::swap(segments, &mut queues.next);
    }

    /// Traces the shadow rays.
    pub(super) fn connect(&mut self) {
        let BatchColumns { queues, paths, occluded, .. } = &mut *self.columns;
        for (queue, interfaces) in queues.shadows.iter_mut().zip([Interfaces::Stop, Interfaces::Pass]) {
            occluded.clear();
            occluded.resize(queue.paths.len(), false);
            let scene = self.pass.pixels.scene;
            scene.occluded_batch(queue.rays.columns(), interfaces, occluded, &mut self.stats);
            for (shadow, (&path, occluded)) in queue.paths.iter().zip(&*occluded).enumerate() {
                if !occluded {
                    paths.add_light(path as usize, queue.l.row(shadow));
                }
            }
            queue.clear();
        }
    }

    /// Adds the radiance of all paths to the film.
    pub(super) fn finish(&mut self, tiles: &mut [FilmTile]) -> Result<(), Cancelled> {
        self.columns.paths.weigh();
        let mut first = 0;
        for tile in tiles {
            let paths = &self.columns.paths;
            let rows = first..paths.end_of(tile.bounds(), first);
            first = rows.end;
            let (with_first_hits, is_full) = (tile.wants_first_hit(), rows.len() == tile.bounds().area());
            let finish = Finish { paths, rows, tile };
            if with_first_hits {
                finish_with_first_hits(&self.pass, &mut self.sampler, &mut self.stats, finish)?;
            } else if is_full {
                self.pass.instruction_set.dispatch_large(finish);
            } else {
                finish_some(finish);
            }
        }
        Ok(())
    }
}
