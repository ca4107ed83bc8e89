//! The hits of Whitted's ray tracing: emission, shadow rays to all lights, and the rays of specular
//! surfaces.
//!
//! Of the tree of a pixel one ray is traced in each wave, depth first, so that random numbers are
//! those of the scalar engine.

use geometry::Hit;
use scene::Interfaces;

use super::WaveIntegrator;
use super::all_lights::AllLights;
use super::batch::{Batch, BatchColumns, Vertex};
use super::queues::PathHit;
use super::stage::Algorithm;
use crate::Whitted;
use crate::camera_paths::Node;
use crate::transport::direct::{Connection, connect_all};
use crate::transport::path_state::PathState;
use crate::transport::vertex::SurfaceVertex;

impl WaveIntegrator for Whitted {
    fn shade(&self, batch: &mut Batch) {
        let lights = AllLights::with_shadows(self.is_ambient());
        batch.classify(self.max_depth(), &lights.direct);
        batch.shade_in_lanes(Algorithm::AllLights(&lights));
        batch.shade_others(|batch, place, hit| self.shade_path(batch, &lights, place, hit));
        batch.go_on_with_waiting();
    }
}

impl Whitted {
    /// Shades one path.
    fn shade_path(&self, batch: &mut Batch, lights: &AllLights, place: PathHit, hit: &Hit) {
        let Some(vertex) = batch.vertex(place, hit, &lights.direct) else { return };
        let Vertex { state, lambda, surface, bsdf } = vertex;
        let Batch { pass, sampler, columns: BatchColumns { paths, queues, .. }, .. } = batch;
        let path = place.path;
        let PathState { ray, beta, depth, .. } = state;
        if depth < self.max_depth() {
            let (scene, at) = (pass.pixels.scene, SurfaceVertex::new(&surface, &bsdf));
            let around = connect_all(scene, sampler, &at, self.is_ambient(), &lambda, |light| {
                let Connection { shadow, interfaces, l, .. } = light;
                let queue = &mut queues.shadows[(interfaces == Interfaces::Pass) as usize];
                queue.push(path, beta * l, &shadow);
            });
            paths.add_light(path as usize, beta * around);
            let children = Node { ray, medium: None, beta, depth, reflected_at: None }
                .children(&surface, &bsdf, sampler);
            for Node { ray, beta, depth, .. } in children.into_iter().rev().flatten() {
                queues.waiting.push(path, PathState { beta, ..PathState::new(ray, depth) });
            }
        }
        paths.dimension[path as usize] = sampler.dimension();
    }
}
