//! The hits of path tracing: emission, light samples, BSDF samples and Russian roulette.

use geometry::Hit;
use scattering::{Bsdf, each_bxdf};
use scene::Interfaces;
use scene::material::{Material, MaterialId, MaterialModel};

use super::WaveIntegrator;
use super::batch::Batch;
use super::materials::Shading;
use super::shade::Shade;
use crate::Path;
use crate::transport::direct::{Connection, light_context};
use crate::transport::path_state::Scattered;
use crate::transport::pixel_samples::PixelSamples;

impl WaveIntegrator for Path {
    fn shade(&self, batch: &mut Batch) {
        batch.classify(self.settings.max_depth, &self.direct);
        let lanes = std::mem::take(&mut batch.lanes);
        for (material, turns, rows) in lanes.iter() {
            self.shade_in_lanes(batch, material, turns, rows);
        }
        batch.lanes = lanes;
        let mut scalar = std::mem::take(&mut batch.queues.scalar);
        for (row, turn) in scalar.drain(..) {
            let hit = batch.hits.get(turn as usize).expect("invariant: paths without hit have ended");
            self.shade_path(batch, row, &hit);
        }
        batch.queues.scalar = scalar;
    }
}

impl Path {
    /// Shades hits of one material.
    fn shade_in_lanes(&self, batch: &mut Batch, id: MaterialId, turns: &[u32], rows: &[u32]) {
        let scene = batch.pass.pixels.scene;
        scene.world().points(&batch.hits, turns, &mut batch.points);
        match &scene.materials()[id.0 as usize].material {
            Material::Diffuse(material) => self.dispatch(batch, (id, material), turns, rows),
            Material::DiffuseTransmission(material) => self.dispatch(batch, (id, material), turns, rows),
            Material::Conductor(material) => self.dispatch(batch, (id, material), turns, rows),
            Material::Dielectric(material) => self.dispatch(batch, (id, material), turns, rows),
            Material::ThinDielectric(material) => self.dispatch(batch, (id, material), turns, rows),
            Material::Mix(_) | Material::Interface => {
                unreachable!("invariant: mixes and interfaces are not shaded in lanes")
            }
        }
    }

    fn dispatch<M: MaterialModel>(
        &self,
        batch: &mut Batch,
        (id, material): (MaterialId, &M),
        turns: &[u32],
        rows: &[u32],
    ) {
        let with_footprint = batch.pass.materials.shading(id, false) == Shading::LanesWithFootprint;
        batch.pass.instruction_set.dispatch(Shade {
            pass: batch.pass,
            settings: &self.settings,
            direct: &self.direct,
            material,
            with_footprint,
            points: &batch.points,
            turns,
            rows,
            paths: &mut batch.paths,
            queues: &mut batch.queues,
            light_samples: &mut batch.light_samples,
        });
    }

    /// Shades one path.
    fn shade_path(&self, batch: &mut Batch, path: u32, hit: &Hit) {
        let Batch { pass, paths, sampler, queues, .. } = batch;
        let &PixelSamples { scene, view, index, .. } = pass.pixels;
        let row = path as usize;
        let mut state = paths.state(row);
        let mut lambda = paths.lambda(row);
        let mut surface = scene.interaction(hit, scene.world().surface(&state.ray.ray, hit));
        if surface.area_light.is_some_and(|light| !pass.area_lights.contains(light)) {
            let l = state.beta * self.direct.emitted(scene, &surface, state.origin.as_ref(), &lambda);
            paths.add_light(row, l);
        }
        paths.resume(sampler, row, index);
        let Some(mut bsdf) = scene.bsdf(view, &mut surface, &state.ray, &mut lambda, sampler) else {
            state.pass_through(&surface, hit.t);
            paths.set_state(row, &state);
            queues.next.push(path);
            return;
        };
        if state.depth == self.settings.max_depth {
            paths.set_lambda(row, &lambda);
            return;
        }
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
        paths.set_lambda(row, &lambda);
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
