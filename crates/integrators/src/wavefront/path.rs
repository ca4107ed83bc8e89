//! The hits of path tracing: emission, light samples, BSDF samples and Russian roulette.

use geometry::Hit;
use scene::Interfaces;

use super::WaveIntegrator;
use super::batch::{Batch, BatchColumns, Vertex};
use super::stage::Algorithm;
use crate::transport::direct::{Connection, light_context};
use crate::transport::path_state::Scattered;
use crate::transport::subsurface::entered;
use crate::{Path, Tracer};

impl WaveIntegrator for Path {
    const FOLLOWS_BODIES: bool = true;

    fn shade(&self, batch: &mut Batch) {
        batch.classify(self.settings.max_depth, &self.direct);
        batch.shade_in_lanes(Algorithm::Path(self));
        batch.shade_others(|batch, place, hit| self.shade_path(batch, place, hit));
    }
}

impl Path {
    /// Shades one path.
    fn shade_path(&self, batch: &mut Batch, place: (u32, u32), hit: &Hit) {
        let Some(vertex) = batch.vertex(place, hit, &self.direct) else { return };
        let Vertex { mut state, lambda, surface, mut bsdf } = vertex;
        if state.depth == self.settings.max_depth {
            return;
        }
        let Batch { pass, sampler, stats, columns: BatchColumns { paths, queues, .. } } = batch;
        let (scene, path, row) = (pass.pixels.scene, place.0, place.0 as usize);
        state.depth += 1;
        bsdf.bxdf.keep_boundary();
        bsdf.regularize(self.settings.regularize && paths.rough_before[row]);
        let context = light_context(&surface, bsdf.flags());
        if bsdf.flags().is_non_specular() {
            let connection = self.direct.connect(scene, sampler, (&surface, &context), &bsdf, &lambda);
            if let Some(Connection { ray, t_max, interfaces, l, .. }) = connection {
                let queue = &mut queues.shadows[(interfaces == Interfaces::Pass) as usize];
                queue.push(path, state.beta * l, &ray, t_max);
            }
        }
        let Some(scattered) = Scattered::sample(&surface, &bsdf, sampler) else { return };
        paths.rough_before[row] |= !scattered.sample.flags.is_specular();
        if let Some(body) = entered(&bsdf, &surface, &scattered.sample) {
            let mut tracer = Tracer::new(scene, pass.pixels.view, pass.control, sampler, stats);
            let entry = (&surface, context);
            let Some(exit) = state.go_under(&mut tracer, entry, (body, &scattered), &lambda) else { return };
            let (l, goes_on) = self.leave_body(&mut tracer, &mut state, &exit, &lambda);
            paths.add_light(row, l);
            if !goes_on {
                return;
            }
            paths.rough_before[row] = true;
        } else {
            state.scatter(&surface, context, &scattered);
        }
        if state.survives(sampler) {
            paths.dimension[row] = sampler.dimension();
            queues.next.push(path, &state);
        }
    }
}
