//! Direct light in lanes by one sample of every light, of ray casting and Whitted's ray tracing.

use geometry::PatchPoints;
use lanes::{Each, Int, Mask, Real};
use math::{Ray, RayDifferential, Vec2, Vec3, offset_ray_origin};
use scattering::{Bsdf, BsdfSample, Directions, Scatter, TransportMode};
use scene::Interfaces;
use scene::light::{Light, LightId, LightSampleContext};
use scene::material::MaterialModel;
use spectrum::SampledSpectrum;

use super::batch::AtHits;
use super::lights::{self, LightLanes};
use super::numbers::{draw_2d, draw_two};
use super::shade::{AtVertices, Shade, Vertices};
use super::shadows::Shadow;
use crate::transport::direct::{DirectLighting, sample_ambient};
use crate::transport::path_state::PathState;

/// Direct light by one sample of every light.
pub(super) struct AllLights {
    /// Whether surfaces cast shadows. Then specular surfaces reflect and refract rays, too.
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
        let (flags, active) = (bsdf.flags(), vertices.active);
        let mut next = vertices.address.dimension;
        let lit = active & flags.is_non_specular();
        if lit.any() {
            shade.connect_all(&mut vertices, bsdf, contexts, lit);
            next = R::Int::select(lit, vertices.address.dimension, next);
        }
        if !shade.algorithm.casts_shadows {
            return;
        }
        let specular = active & flags.is_specular();
        if specular.any() {
            vertices.address.dimension = next;
            shade.wait_for_specular(&mut vertices, bsdf, specular);
            next = R::Int::select(specular, vertices.address.dimension, next);
        }
        next.scatter(lit | specular, &mut shade.paths.dimension, vertices.rows.indices);
    }
}

impl AtHits for AllLights {}

impl<M: MaterialModel> Shade<'_, '_, M, AllLights> {
    /// Connects lanes to one point of every light.
    #[inline(always)]
    fn connect_all<R: Real, B: Scatter<R>>(
        &mut self,
        vertices: &mut Vertices<R>,
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
        lit: R::Mask,
    ) {
        let Vertices { rows, surface: PatchPoints { p, n, ns, .. }, wo, time, .. } = *vertices;
        let AllLights { casts_shadows, has_ambient, direct } = self.algorithm;
        let flags = bsdf.flags();
        let mut sum = self.paths.l.get::<R>(rows);
        for id in 0..self.pass.pixels.scene.lights().len() as u32 {
            let light = self.pass.pixels.scene.light(LightId(id)).row();
            // There is nothing to choose where light comes from one direction or point.
            let u = if matches!(light, Light::Distant(_) | Light::Point(_)) {
                vertices.address.skip(2);
                Vec2::splat(R::zero())
            } else {
                draw_2d::<R>(&self.pass, &mut vertices.address)
            };
            let sky = match light {
                Light::UniformInfinite(sky) if *has_ambient => Some(sky),
                _ => None,
            };
            let light = if let Some(sky) = sky {
                let (wi, pdf) = sample_ambient(wo, ns, flags, u);
                LightLanes::from_afar(sky.radiance.sample(&vertices.lambda), wi, pdf, lit)
            } else {
                let sampling = (&self.pass, direct, &mut *self.light_samples);
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
            let [stopped, passing] = &mut self.queues.shadows;
            stopped.append(rows, valid & !light.passes, &shadow);
            passing.append(rows, valid & light.passes, &shadow);
        }
        if !casts_shadows || *has_ambient {
            self.paths.l.set(rows, lit, sum);
        }
    }

    /// Lets the reflected and the refracted rays of lanes wait, those first that are traced last.
    #[inline(always)]
    fn wait_for_specular<R: Real, B: Scatter<R>>(
        &mut self,
        vertices: &mut Vertices<R>,
        bsdf: &Bsdf<B, R>,
        specular: R::Mask,
    ) {
        let numbers = draw_two::<R>(&self.pass, &mut vertices.address, B::CHOOSES);
        let Vertices { rows, turns, surface: PatchPoints { p, n, ns, .. }, wo, time, beta, .. } = *vertices;
        for i in [1, 0] {
            let directions = [Directions::Reflection, Directions::Transmission][i];
            let (uc, u) = numbers[i];
            let sample = bsdf.sample_lanes(wo, uc, u, TransportMode::Radiance, directions);
            let BsdfSample { f, wi, pdf, flags, valid, .. } = sample;
            let beta = (beta * (f * (wi.dot(ns).abs() / pdf))).0.each(R::to_array);
            let [o, d] = [offset_ray_origin(p, n, wi), wi].each(|v| v.to_array().each(R::to_array));
            let turn_of = turns.indices.to_array();
            rows.each_of(valid & specular & flags.is_specular(), |lane, row| {
                let turn = turn_of[lane] as usize;
                let [o, d] = [o, d].map(|v| Vec3::from_array(v.map(|lanes| lanes[lane])));
                let ray = RayDifferential {
                    ray: Ray::new(o, d, time.lane(lane)),
                    differentials: self.scattered_differentials(turn, &sample, lane),
                };
                let beta = SampledSpectrum::new(beta.map(|lanes| lanes[lane]));
                let depth = self.segments.depth[turn] + 1;
                self.queues.waiting.push(row as u32, PathState { beta, ..PathState::new(ray, depth) });
            });
        }
    }
}
