//! Direct light in lanes by one sample of every light, of ray casting and Whitted's ray tracing.

use geometry::PatchPoints;
use lanes::{Int, Mask, Real};
use scattering::{Bsdf, Scatter, TransportMode};
use scene::Interfaces;
use scene::light::{Light, LightId, LightSampleContext};
use scene::material::MaterialModel;
use spectrum::SampledSpectrum;

use super::lights::{self, LightLanes};
use super::numbers::draw_2d;
use super::shade::{AtVertices, Shade, Vertices};
use super::shadows::Shadow;
use crate::transport::direct::{DirectLighting, sample_ambient};

/// Direct light by one sample of every light.
pub(super) struct AllLights {
    /// Whether surfaces cast shadows. Specular surfaces are left to be shaded one by one then.
    casts_shadows: bool,
    /// Whether skies of one colour cast none.
    has_ambient: bool,
    direct: DirectLighting,
}

impl AllLights {
    /// Without shadows.
    pub fn without_shadows() -> Self {
        Self { casts_shadows: false, has_ambient: false, direct: DirectLighting::none(Interfaces::Pass) }
    }

    /// With shadows; `has_ambient` says that skies of one colour cast none.
    pub fn with_shadows(has_ambient: bool) -> Self {
        Self { casts_shadows: true, has_ambient, ..Self::without_shadows() }
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
        let Self { casts_shadows, has_ambient, direct } = shade.algorithm;
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
            let sky = match shade.pass.pixels.scene.light(LightId(id)).row() {
                Light::UniformInfinite(sky) if *has_ambient => Some(sky),
                _ => None,
            };
            let light = if let Some(sky) = sky {
                let (wi, pdf) = sample_ambient(wo, ns, flags, u);
                LightLanes::from_afar(sky.radiance.sample(&vertices.lambda), wi, pdf, lit)
            } else {
                let sampling = (&shade.pass, direct, &mut *shade.light_samples);
                let (id, numbers) = (Some(LightId(id)), (R::zero(), u));
                lights::sample(sampling, id, contexts, numbers, &vertices.lambda, lit)
            };
            let LightLanes { valid, l, wi, pdf, .. } = light;
            if !valid.any() {
                continue;
            }
            let scattered = bsdf.f(wo, wi, TransportMode::Radiance) * l * wi.dot(ns).abs();
            let valid = valid & !scattered.is_black();
            let l = vertices.beta * (scattered / pdf);
            if !casts_shadows || sky.is_some() {
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
        }
        if !casts_shadows || *has_ambient {
            shade.paths.l.set(rows, lit, sum);
        }
    }
}
