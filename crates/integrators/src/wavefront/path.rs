//! The hits of path tracing: emission, light samples, BSDF samples and Russian roulette.

use geometry::Hit;
use scene::Scene;

use super::WaveIntegrator;
use super::batch::{Batch, BatchColumns};
use super::queues::PathHit;
use super::stage::Algorithm;
use crate::{Path, Tracer};

impl WaveIntegrator for Path {
    const FOLLOWS_BODIES: bool = true;

    fn knows_media(&self, scene: &Scene) -> bool {
        self.flies_in(scene)
    }

    fn shade(&self, batch: &mut Batch) {
        if batch.columns.segments.media.is_some() {
            batch.fly(self);
        }
        batch.classify(self.settings.max_depth, &self.direct);
        batch.shade_in_lanes(Algorithm::Path(self));
        batch.shade_others(|batch, place, hit| self.shade_path(batch, place, hit));
    }
}

impl Path {
    /// Shades one path.
    fn shade_path(&self, batch: &mut Batch, place: PathHit, hit: &Hit) {
        let Batch { pass, sampler, stats, columns } = batch;
        let BatchColumns { paths, segments, queues, .. } = &mut **columns;
        let (pixels, at) = (pass.pixels, place.path as usize);
        let mut path = segments.path(paths, place.hit as usize);
        let mut lambda = paths.lambda(at);
        let surface = pixels.scene.interaction(hit, pixels.scene.world().surface(&path.ray.ray, hit));
        paths.resume(sampler, at, pixels.index);
        let mut tracer = Tracer::new(pixels.scene, pixels.view, pass.control, sampler, stats);
        if surface.area_light.is_some_and(|light| !pass.area_lights.contains(light)) {
            paths.add_light(at, self.emitted(&mut tracer, &path, &surface, &lambda));
        }
        let (l, goes_on) = self.scatter(&mut tracer, &mut path, surface, hit.t, &mut lambda);
        paths.add_light(at, l);
        paths.set_lambda(at, &lambda);
        paths.dimension[at] = sampler.dimension();
        paths.rough_before[at] = path.rough_before;
        if goes_on {
            queues.next.push(place.path, &path);
        }
    }
}
