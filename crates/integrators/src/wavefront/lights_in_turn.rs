//! The steps of ray casting and Whitted's ray tracing at vertices in lanes: one sample of every
//! light, then the rays of specular surfaces.

use lanes::{Each, Int, Mask, Real};
use math::{Ray, RayDifferential, Vec2, Vec3, offset_ray_origin};
use scattering::{BsdfSample, BxdfFlags, Directions};
use scene::light::{Light, LightId};
use spectrum::SampledSpectrum;

use super::all_lights::AllLights;
use super::lights::{LightLanes, LightSampling};
use super::numbers::{SampleNumbers, draw_2d, draw_two};
use super::stage::{Request, SpecularSamples, Stage, Vertices};
use crate::transport::direct::sample_ambient;
use crate::transport::path_state::{PathState, throughput};
use crate::transport::vertex::scattered;

/// The lights at vertices, one after another; then the rays of specular surfaces.
pub(super) struct LightsInTurn<'b, R: Real> {
    lights: &'b AllLights,
    /// The lanes that scatter light of lights.
    lit: R::Mask,
    /// The lanes that reflect or refract rays.
    specular: R::Mask,
    flags: BxdfFlags<R>,
    /// Whether BSDFs choose among lobes.
    chooses: bool,
    /// The next light.
    id: u32,
    /// The one before; whether it is a sky that casts no shadows.
    light: Option<(LightLanes<R>, bool)>,
    /// Radiance that needs no shadow rays.
    sum: SampledSpectrum<R>,
    /// The next dimension of the lanes that are not lit.
    unlit: R::Int,
    /// Numbers of samples that reflect and that transmit.
    numbers: [SampleNumbers<R>; 2],
    /// Whether rays that are transmitted come next.
    transmits: bool,
}

impl<'b, R: Real> LightsInTurn<'b, R> {
    /// Begins with the first light.
    #[inline(always)]
    pub fn begin(
        lights: &'b AllLights,
        stage: &mut Stage,
        vertices: &mut Vertices<R>,
        flags: &BxdfFlags<R>,
        chooses: bool,
    ) -> (Self, Request<R>) {
        let active = vertices.active;
        let mut state = Self {
            lights,
            lit: active & flags.is_non_specular(),
            specular: active & flags.is_specular(),
            flags: *flags,
            chooses,
            id: 0,
            light: None,
            sum: stage.paths.l.get::<R>(vertices.rows),
            unlit: vertices.address.dimension,
            numbers: [SampleNumbers { uc: R::zero(), u: Vec2::splat(R::zero()) }; 2],
            transmits: true,
        };
        let request = state.advance(stage, vertices);
        (state, request)
    }

    /// Goes on to the next light that has a sample.
    #[inline(always)]
    fn advance(&mut self, stage: &mut Stage, vertices: &mut Vertices<R>) -> Request<R> {
        if !self.lit.any() {
            return self.reflect(stage, vertices);
        }
        while self.id < stage.pass.pixels.scene.lights().len() as u32 {
            let (light, is_ambient) = self.sample(stage, vertices);
            self.id += 1;
            if light.valid.any() {
                let request = Request::Value(light.wi);
                self.light = Some((light, is_ambient));
                return request;
            }
        }
        if !self.lights.casts_shadows || self.lights.has_ambient {
            stage.paths.l.set(vertices.rows, self.lit, self.sum);
        }
        self.reflect(stage, vertices)
    }

    /// A point of the next light; whether that is a sky that casts no shadows.
    #[inline(always)]
    fn sample(&self, stage: &mut Stage, vertices: &mut Vertices<R>) -> (LightLanes<R>, bool) {
        let Self { lit, .. } = self;
        let AllLights { has_ambient, direct, .. } = self.lights;
        let id = LightId(self.id);
        let light = stage.pass.pixels.scene.light(id).row();
        // There is nothing to choose where light comes from one direction or point.
        let u = if matches!(light, Light::Distant(_) | Light::Point(_)) {
            vertices.address.skip(2);
            Vec2::splat(R::zero())
        } else {
            draw_2d::<R>(&stage.pass, &mut vertices.address)
        };
        match light {
            Light::UniformInfinite(sky) if *has_ambient => {
                let (wi, pdf) = sample_ambient(vertices.wo, vertices.ns, self.flags, u);
                let l = sky.radiance.sample(&vertices.lambda);
                (LightLanes::from_afar(l, wi, pdf, *lit), true)
            }
            _ => {
                let sampling = LightSampling { pass: &stage.pass, direct, light: Some(id) };
                let numbers = SampleNumbers { uc: R::zero(), u };
                let (context, lambda) = (vertices.contexts(), &vertices.lambda);
                sampling.draw(stage.light_samples, &context, numbers, lambda, *lit);
                (stage.light_samples.lanes(), false)
            }
        }
    }

    /// Adds the light of the last sample, by the values of the BSDFs.
    #[inline(always)]
    pub fn connect(
        &mut self,
        stage: &mut Stage,
        vertices: &mut Vertices<R>,
        f: SampledSpectrum<R>,
    ) -> Request<R> {
        let Vertices { rows, p, n, ns, time, beta, .. } = *vertices;
        if let Some((light, is_ambient)) = self.light.take() {
            let LightLanes { valid, l, wi, pdf, .. } = light;
            let scattered = scattered(f, l, wi, ns);
            let valid = valid & !scattered.is_black();
            let l = beta * (scattered / pdf);
            if !self.lights.casts_shadows || is_ambient {
                self.sum = SampledSpectrum::select(valid, self.sum + l, self.sum);
            } else {
                let shadow = light.shadow_rays(p, n, time);
                let [stopped, passing] = &mut stage.queues.shadows;
                stopped.append(rows, valid & !light.passes, l, &shadow);
                passing.append(rows, valid & light.passes, l, &shadow);
            }
        }
        self.advance(stage, vertices)
    }

    /// Goes on to the rays of specular surfaces.
    #[inline(always)]
    fn reflect(&mut self, stage: &mut Stage, vertices: &mut Vertices<R>) -> Request<R> {
        if !self.lights.casts_shadows {
            return Request::Nothing;
        }
        let Self { lit, specular, .. } = self;
        let address = &mut vertices.address;
        address.dimension = R::Int::select(*lit, address.dimension, self.unlit);
        let mut next = address.dimension;
        if specular.any() {
            self.numbers = draw_two::<R>(&stage.pass, address, self.chooses);
            next = R::Int::select(*specular, address.dimension, next);
        }
        next.scatter(*lit | *specular, &mut stage.paths.dimension, vertices.rows.indices);
        // Refracted rays wait first, as the last one that waits is traced next.
        match specular.any() {
            true => Request::Sample(self.numbers[1], Directions::Transmission),
            false => Request::Nothing,
        }
    }

    /// Lets the rays of samples wait.
    #[inline(always)]
    pub fn wait_for(
        &mut self,
        stage: &mut Stage,
        vertices: &Vertices<R>,
        sample: &BsdfSample<R>,
    ) -> Request<R> {
        let Vertices { rows, hit_indices, p, n, ns, time, beta, .. } = *vertices;
        let BsdfSample { wi, flags, valid, .. } = *sample;
        let samples = SpecularSamples::of(sample);
        let beta = (beta * throughput(ns, sample)).0.each(R::to_array);
        let o = offset_ray_origin(p, n, wi).to_array().each(R::to_array);
        let (hit_of, time) = (hit_indices.indices.to_array(), time.to_array());
        rows.each_of(valid & self.specular & flags.is_specular(), |lane, row| {
            let hit_index = hit_of[lane] as usize;
            let sample = samples.at(lane);
            let o = Vec3::from_array(o.each(|lanes| lanes[lane]));
            let ray = RayDifferential {
                ray: Ray::new(o, sample.wi, time[lane]),
                differentials: stage.scattered_differentials(hit_index, &sample),
            };
            let beta = SampledSpectrum::new(beta.each(|lanes| lanes[lane]));
            let depth = stage.segments.depth[hit_index] + 1;
            stage.queues.waiting.push(row as u32, PathState { beta, ..PathState::new(ray, depth) });
        });
        if std::mem::take(&mut self.transmits) {
            return Request::Sample(self.numbers[0], Directions::Reflection);
        }
        Request::Nothing
    }
}
