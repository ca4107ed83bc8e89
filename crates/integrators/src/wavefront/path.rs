//! The hits of path tracing: emission, light samples, BSDF samples and Russian roulette.

use geometry::Hit;
use scattering::{Bsdf, each_bxdf};
use scene::Interfaces;

use super::WaveIntegrator;
use super::batch::{Batch, Vertex};
use crate::Path;
use crate::transport::direct::{Connection, light_context};
use crate::transport::path_state::Scattered;

impl WaveIntegrator for Path {
    fn shade(&self, batch: &mut Batch) {
        batch.classify(self.settings.max_depth, &self.direct);
        batch.shade_in_lanes(self);
        batch.shade_others(|batch, path, hit| self.shade_path(batch, path, hit));
    }
}

impl Path {
    /// Shades one path.
    fn shade_path(&self, batch: &mut Batch, path: u32, hit: &Hit) {
        let Some(vertex) = batch.vertex(path, hit, &self.direct) else { return };
        let Vertex { mut state, lambda, surface, mut bsdf } = vertex;
        if state.depth == self.settings.max_depth {
            return;
        }
        let Batch { pass, paths, sampler, queues, .. } = batch;
        let (scene, row) = (pass.pixels.scene, path as usize);
        state.depth += 1;
        bsdf.regularize(self.settings.regularize && paths.rough_before[row]);
        let context = light_context(&surface, bsdf.flags());
        let scattered = each_bxdf!(bsdf.bxdf, bxdf => {
            let bsdf = Bsdf { bxdf, frame: bsdf.frame };
            if bsdf.flags().is_non_specular() {
                let connection = self.direct.connect(scene, sampler, (&surface, &context), &bsdf, &lambda);
                if let Some(Connection { ray, t_max, interfaces, l }) = connection {
                    let queue = &mut queues.shadows[(interfaces == Interfaces::Pass) as usize];
                    queue.push(path, state.beta * l, &ray, t_max);
                }
            }
            Scattered::sample(&surface, &bsdf, sampler)
        });
        let Some(scattered) = scattered else { return };
        paths.rough_before[row] |= !scattered.sample.flags.is_specular();
        state.scatter(&surface, context, &scattered);
        if state.survives(sampler) {
            paths.dimension[row] = sampler.dimension();
            paths.set_state(row, &state);
            queues.next.push(path);
        }
    }
}
