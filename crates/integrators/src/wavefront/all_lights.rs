//! Direct light in lanes by one sample of every light, of ray casting and Whitted's ray tracing.

use geometry::PatchPoints;
use lanes::{Int, Mask, Real};
use scattering::{Bsdf, Scatter, TransportMode};
use scene::Interfaces;
use scene::light::{LightId, LightSampleContext};
use scene::material::MaterialModel;
use spectrum::SampledSpectrum;

use super::lights::{self, LightLanes};
use super::numbers::draw_2d;
use super::shade::{AtVertices, Shade, Vertices};
use super::shadows::Shadow;
use crate::transport::direct::DirectLighting;

/// Direct light by one sample of every light.
pub(super) struct AllLights {
    /// Whether surfaces cast shadows. Specular surfaces are left to be shaded one by one then.
    casts_shadows: bool,
    direct: DirectLighting,
}

impl AllLights {
    /// With shadows or without.
    pub fn new(casts_shadows: bool) -> Self {
        Self { casts_shadows, direct: DirectLighting::none(Interfaces::Pass) }
    }

    /// Light that rays find, which counts fully.
    pub fn direct(&self) -> &DirectLighting {
        &self.direct
    }
}

impl AtVertices for AllLights {
    #[inline(always)]
    fn go_on<R: Real, M: MaterialModel, B: Scatter<R>>(
        shade: &mut Shade<M, Self>,
        mut vertices: Vertices<R>,
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
    ) {
        let Vertices { rows, active, surface: PatchPoints { p, n, ns, .. }, wo, time, .. } = vertices;
        let Self { casts_shadows, direct } = shade.algorithm;
        let (flags, mut lit) = (bsdf.flags(), active);
        if *casts_shadows {
            let is_specular = flags.is_specular();
            rows.each_of(active & is_specular, |lane, row| {
                shade.queues.scalar.push((row as u32, shade.turns[vertices.first + lane]));
            });
            lit = lit & !is_specular;
        }
        lit = lit & flags.is_non_specular();
        if !lit.any() {
            return;
        }
        let mut sum = shade.paths.l.get::<R>(rows);
        for id in 0..shade.pass.pixels.scene.lights().len() as u32 {
            let u = draw_2d::<R>(&shade.pass, &mut vertices.address);
            let sampling = (&shade.pass, direct, &mut *shade.light_samples);
            let numbers = (R::zero(), u);
            let light = lights::sample(sampling, Some(LightId(id)), contexts, numbers, &vertices.lambda, lit);
            let LightLanes { valid, l, wi, pdf, .. } = light;
            if !valid.any() {
                continue;
            }
            let scattered = bsdf.f(wo, wi, TransportMode::Radiance) * l * wi.dot(ns).abs();
            let valid = valid & !scattered.is_black();
            let l = vertices.beta * (scattered / pdf);
            if !casts_shadows {
                sum = SampledSpectrum::select(valid, sum + l, sum);
                continue;
            }
            let (ray, t_max) = light.shadow_rays(p, n, time);
            let shadow = Shadow { l, ray, t_max };
            let [stopped, passing] = &mut shade.queues.shadows;
            stopped.append(rows, valid & !light.passes, &shadow);
            passing.append(rows, valid & light.passes, &shadow);
        }
        if *casts_shadows {
            vertices.address.dimension.scatter(lit, &mut shade.paths.dimension, rows.indices);
        } else {
            shade.paths.l.set(rows, lit, sum);
        }
    }
}
