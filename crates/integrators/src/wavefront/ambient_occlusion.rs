//! The hits of ambient occlusion: one shadow ray over the hemisphere of each.

use geometry::{Hit, PatchPoints, PointColumns};
use lanes::{Kernel, Real};
use scene::light::LightSampleContext;
use scene::material::Material;

use super::WaveIntegrator;
use super::batch::{Batch, BatchColumns};
use super::indices::Indices;
use super::numbers::draw_2d;
use super::pass::Pass;
use super::path_columns::PathColumns;
use super::queues::{PathHit, Queues};
use super::segment_columns::SegmentColumns;
use crate::AmbientOcclusion;

impl WaveIntegrator for AmbientOcclusion {
    const READS_TEXTURES: bool = false;

    fn shade(&self, batch: &mut Batch) {
        let scene = batch.pass.pixels.scene;
        let (mut hit_indices, mut rows) = (Vec::new(), Vec::new());
        for (hit_index, (&row, &geometry)) in
            batch.columns.segments.rows.iter().zip(&batch.columns.hits.geometry).enumerate()
        {
            let Some(entry) = scene.geometries().get(geometry as usize) else { continue };
            if let Material::Interface | Material::Mix(_) =
                scene.materials()[entry.material.0 as usize].material
            {
                batch.columns.queues.scalar.push(PathHit { path: row, hit: hit_index as u32 });
            } else {
                hit_indices.push(hit_index as u32);
                rows.push(row);
            }
        }
        let BatchColumns { segments, hits, points, .. } = &mut *batch.columns;
        scene.world().points(segments.rays(), hits, &hit_indices, points);
        batch.pass.instruction_set.dispatch_large(Occlude {
            pass: batch.pass,
            algorithm: self,
            points: &batch.columns.points,
            hit_indices: &hit_indices,
            rows: &rows,
            segments: &batch.columns.segments,
            paths: &batch.columns.paths,
            queues: &mut batch.columns.queues,
        });
        batch.shade_others(|batch, place, hit| self.shade_path(batch, place, hit));
    }
}

/// Asks for the shadow rays of hits.
struct Occlude<'a, 'b> {
    pass: Pass<'a>,
    algorithm: &'b AmbientOcclusion,
    /// Their surface points.
    points: &'b PointColumns,
    /// Indices of hits, and their paths.
    hit_indices: &'b [u32],
    rows: &'b [u32],
    segments: &'b SegmentColumns,
    paths: &'b PathColumns,
    queues: &'b mut Queues,
}

impl Kernel for Occlude<'_, '_> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(self) {
        let Self { pass, algorithm, points, hit_indices, rows, segments, paths, queues } = self;
        for (part, queue) in rows.chunks(R::LANES).enumerate() {
            let first = part * R::LANES;
            let rows = Indices::<R>::first(queue);
            let PatchPoints { p, n, ns, .. } = points.get::<R>(first);
            let u = draw_2d::<R>(&pass, &mut paths.address(rows, pass.pixels.index));
            let places = Indices::<R>::first(&hit_indices[first..first + queue.len()]);
            let time = R::gather(&segments.time, places.indices);
            let point = LightSampleContext { p, n, ns, time };
            let wo = -segments.direction.vector(places);
            let (shadow, l) = algorithm.sample(&point, wo, u, &paths.lambda_lanes(rows));
            let [shadows, _] = &mut queues.shadows;
            shadows.append(rows, rows.active & !l.is_black(), l, &shadow);
        }
    }
}

impl AmbientOcclusion {
    /// Continues one path from its hit.
    fn shade_path(&self, batch: &mut Batch, place: PathHit, hit: &Hit) {
        let Batch { pass, sampler, columns: BatchColumns { paths, segments, queues, .. }, .. } = batch;
        let (scene, row) = (pass.pixels.scene, place.path as usize);
        let mut state = segments.state(place.hit as usize);
        let ray = state.ray.ray;
        let surface = scene.interaction(hit, scene.world().surface(&ray, hit));
        if scene.is_interface(hit, &ray) {
            state.ray.ray = surface.spawn_ray(ray.d);
            queues.next.push(place.path, &state);
            return;
        }
        paths.resume(sampler, row, pass.pixels.index);
        let (u, point) = (sampler.get_2d(), surface.light_context());
        let (shadow, l) = self.sample(&point, surface.surface.wo, u, &paths.lambda(row));
        if !l.is_black() {
            queues.shadows[0].push(place.path, l, &shadow);
        }
    }
}
