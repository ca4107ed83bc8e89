//! The hits of ray casting: emission, and light samples without visibility.

use super::WaveIntegrator;
use super::all_lights::AllLights;
use super::batch::{Batch, BatchColumns, Vertex};
use super::stage::Algorithm;
use crate::RayCasting;
use crate::transport::direct::connect_all;
use crate::transport::vertex::SurfaceVertex;

impl WaveIntegrator for RayCasting {
    fn shade(&self, batch: &mut Batch) {
        let lights = AllLights::without_shadows();
        batch.classify(u32::MAX, &lights.direct);
        batch.shade_in_lanes(Algorithm::AllLights(&lights));
        batch.shade_others(|batch, place, hit| {
            let Some(vertex) = batch.vertex(place, hit, &lights.direct) else { return };
            let Vertex { state, lambda, surface, bsdf } = vertex;
            let Batch { pass, sampler, columns: BatchColumns { paths, .. }, .. } = batch;
            let at = SurfaceVertex::new(&surface, &bsdf);
            connect_all(pass.pixels.scene, sampler, &at, false, &lambda, |light| {
                paths.add_light(place.path as usize, state.beta * light.l);
            });
        });
    }
}
