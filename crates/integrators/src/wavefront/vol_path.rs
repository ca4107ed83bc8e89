//! The hits of path tracing through media.

use super::WaveIntegrator;
use super::batch::Batch;
use crate::VolPath;

impl WaveIntegrator for VolPath {
    const KNOWS_MEDIA: bool = true;

    fn shade(&self, batch: &mut Batch) {
        let surfaces = &self.in_vacuum;
        batch.fly(self);
        batch.classify(surfaces.settings.max_depth, &surfaces.direct);
        batch.shade_in_lanes(surfaces);
        batch.shade_others(|batch, place, hit| batch.shade_in_media(self, place, hit));
    }
}
