//! The hits of path tracing: emission, light samples, BSDF samples and Russian roulette.

use geometry::{Hit, PatchPoints};
use lanes::{Int, Mask, Real};
use math::{Ray, Vec2, offset_ray_origin};
use sampling::sampler::Address;
use scattering::{Bsdf, BsdfSample, Directions, Scatter, TransportMode, each_bxdf};
use scene::Interfaces;
use scene::light::LightSampleContext;
use scene::material::{MaterialId, MaterialModel, SubsurfaceMaterial};
use spectrum::SampledSpectrum;

use super::WaveIntegrator;
use super::batch::{AtHits, Batch, BatchColumns, Vertex};
use super::columns::Rows;
use super::lights::{self, LightLanes};
use super::media::VerticesInMedia;
use super::numbers::{VertexNumbers, draw_1d};
use super::pass::Pass;
use super::segments::Segment;
use super::shade::{AtVertices, Shade, Vertices};
use super::shadows::{PassageLanes, Shadow};
use crate::transport::direct::{Connection, light_context, power_heuristic};
use crate::transport::path_state::Scattered;
use crate::transport::roulette::{self, CERTAIN};
use crate::transport::subsurface::entered;
use crate::{Path, Tracer};

impl WaveIntegrator for Path {
    const FOLLOWS_BODIES: bool = true;

    fn shade(&self, batch: &mut Batch) {
        batch.classify(self.settings.max_depth, &self.direct);
        batch.shade_in_lanes(self);
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
        let scattered = each_bxdf!(bsdf.bxdf, bxdf => {
            let bsdf = Bsdf { bxdf, frame: bsdf.frame };
            if bsdf.flags().is_non_specular() {
                let connection = self.direct.connect(scene, sampler, (&surface, &context), &bsdf, &lambda);
                if let Some(Connection { ray, t_max, interfaces, l, .. }) = connection {
                    let queue = &mut queues.shadows[(interfaces == Interfaces::Pass) as usize];
                    queue.push(path, state.beta * l, &ray, t_max);
                }
            }
            Scattered::sample(&surface, &bsdf, sampler)
        });
        let Some(scattered) = scattered else { return };
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

impl AtVertices for Path {
    #[inline(always)]
    fn regularizes(&self) -> bool {
        self.settings.regularize
    }

    #[inline(always)]
    fn go_on<R: Real, M: MaterialModel, B: Scatter<R>>(
        shade: &mut Shade<M, Self>,
        vertices: Vertices<R>,
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
    ) {
        shade.go_on(vertices, bsdf, contexts);
    }
}

impl AtHits for Path {
    fn shade_body(&self, batch: &mut Batch, body: (MaterialId, &SubsurfaceMaterial), hits: (&[u32], &[u32])) {
        batch.shade_body(self, body, hits);
    }
}

/// Path tracing at vertices.
pub(super) trait PathVertices: AtVertices {
    /// The algorithm.
    fn path(&self) -> &Path;

    /// Where light from the side of `cos_i` passes to that of `cos_o`.
    #[inline(always)]
    fn lets_pass<R: Real>(_cos_o: R, _cos_i: R) -> R::Mask {
        R::Mask::splat(true)
    }

    /// Takes the lanes of a mask whose paths go on under the surface, of the throughput `beta`;
    /// gives which they are.
    #[inline(always)]
    fn take_entering<R: Real, M>(
        _shade: &mut Shade<M, Self>,
        _vertices: &Vertices<R>,
        _sample: &BsdfSample<R>,
        _beta: SampledSpectrum<R>,
        _mask: R::Mask,
    ) -> R::Mask {
        R::Mask::splat(false)
    }
}

impl PathVertices for Path {
    #[inline(always)]
    fn path(&self) -> &Path {
        self
    }
}

impl<M: MaterialModel, A: PathVertices> Shade<'_, '_, M, A> {
    /// Samples light and BSDF at the vertices.
    #[inline(always)]
    pub fn go_on<R: Real, B: Scatter<R>>(
        &mut self,
        mut vertices: Vertices<R>,
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
    ) {
        let samples_light = bsdf.flags().is_non_specular();
        let media = self.segments.media.as_ref().map(|columns| {
            let place = (vertices.turns, &self.hits.geometry[..]);
            VerticesInMedia::new(self.pass.media, columns, place, vertices.lambda.secondary_terminated())
        });
        let (address, has_media) = (&mut vertices.address, media.is_some());
        let numbers = VertexNumbers::draw(&self.pass, address, samples_light, B::CHOOSES, has_media);
        self.connect((&vertices, media.as_ref()), bsdf, contexts, &numbers, samples_light);
        self.scatter((&vertices, media.as_ref()), bsdf, contexts, numbers.bsdf);
    }

    /// Next-event estimation of the lanes that are not specular.
    #[inline(always)]
    fn connect<R: Real, B: Scatter<R>>(
        &mut self,
        (vertices, media): (&Vertices<R>, Option<&VerticesInMedia<R>>),
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
        numbers: &VertexNumbers<R>,
        is_non_specular: R::Mask,
    ) {
        let samples = vertices.active & is_non_specular;
        if !samples.any() {
            return;
        }
        let sampling = (&self.pass, &self.algorithm.path().direct, &mut *self.light_samples);
        let light = lights::sample(sampling, None, contexts, numbers.light, &vertices.lambda, samples);
        let LightLanes { valid, l, wi, pdf, .. } = light;
        let Vertices { surface: PatchPoints { p, n, ns, .. }, wo, time, .. } = *vertices;
        let f = bsdf.f(wo, wi, TransportMode::Radiance);
        let scattered = f * l * wi.dot(ns).abs();
        let p_b = bsdf.pdf(wo, wi, TransportMode::Radiance, Directions::All);
        let lit = valid & !scattered.is_black() & A::lets_pass(wo.dot(ns), wi.dot(ns));
        let (ray, t_max) = light.shadow_rays(p, n, time);
        if let Some(media) = media {
            // The weight depends on what the rays pass.
            let shadow = Shadow { l: vertices.beta * scattered / pdf, ray, t_max };
            let passage = PassageLanes {
                r_u: media.r_u,
                ratio: R::select(light.is_delta, R::zero(), p_b / pdf),
                medium: media.towards(wi, n),
                dimension: numbers.passage,
            };
            self.queues.passages.append(vertices.rows, lit, &shadow, &passage);
            return;
        }
        let weight = R::select(light.is_delta, R::one(), power_heuristic(pdf, p_b));
        let l = vertices.beta * (scattered * (weight / pdf));
        let shadow = Shadow { l, ray, t_max };
        let [stopped, passing] = &mut self.queues.shadows;
        stopped.append(vertices.rows, lit & !light.passes, &shadow);
        passing.append(vertices.rows, lit & light.passes, &shadow);
    }

    /// Continues the paths along a direction of the BSDF, unless Russian roulette ends them.
    #[inline(always)]
    fn scatter<R: Real, B: Scatter<R>>(
        &mut self,
        (vertices, media): (&Vertices<R>, Option<&VerticesInMedia<R>>),
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
        (uc, u): (R, Vec2<R>),
    ) {
        let Vertices { rows, turns, surface: PatchPoints { p, n, ns, .. }, wo, time, .. } = *vertices;
        let sample = bsdf.sample_lanes(wo, uc, u, TransportMode::Radiance, Directions::All);
        let BsdfSample { f, wi, pdf, flags, eta, valid, .. } = sample;
        let beta = vertices.beta * (f * (wi.dot(ns).abs() / pdf));
        let pdf = if sample.pdf_is_proportional {
            bsdf.pdf(wo, wi, TransportMode::Radiance, Directions::All)
        } else {
            pdf
        };
        let eta_scale = R::gather(&self.segments.eta_scale, turns.indices);
        let eta_scale = R::select(flags.is_transmissive(), eta_scale * (eta * eta), eta_scale);
        let valid = valid & vertices.active;
        let valid = valid & !A::take_entering(self, vertices, &sample, beta, valid);

        let depth = R::Int::gather(&self.segments.depth, turns.indices);
        let Roulette { survives, weight, dimension } =
            play(&self.pass, vertices.address, depth, beta * eta_scale, valid);
        dimension.scatter(survives, &mut self.paths.dimension, rows.indices);
        let is_specular = flags.is_specular();
        if self.algorithm.regularizes() {
            rows.each_of(survives & !is_specular, |_, row| self.paths.rough_before[row] = true);
        }
        let segment = Segment {
            ray: Ray::new(offset_ray_origin(p, n, wi), wi, time),
            beta: beta * weight,
            eta_scale,
            depth: depth.wrapping_add(R::Int::splat(1)),
            vertex: *contexts,
            pdf: R::select(is_specular, R::zero(), pdf),
            media: media.map(|media| media.leave((wi, n), pdf)),
        };
        let first = self.queues.next.rows.len();
        self.queues.next.append(rows.indices, survives, &segment);
        if !self.segments.are_differentials.is_empty() && (survives & is_specular).any() {
            self.carry_differentials(turns, survives, &sample, first);
        }
    }

    /// Gives the rays that specular scattering has appended, from a place in the queue on, the
    /// differentials of the rays before. Few rays have any, so that they are computed one by one.
    fn carry_differentials<R: Real>(
        &mut self,
        turns: Rows<R>,
        appended: R::Mask,
        sample: &BsdfSample<R>,
        first: usize,
    ) {
        turns.each_of(appended & sample.flags.is_specular(), |lane, turn| {
            let place = first + (appended.bits() & ((1 << lane) - 1)).count_ones() as usize;
            if let Some(differentials) = self.scattered_differentials(turn, sample, lane) {
                self.queues.next.set_differentials(place, Some(&differentials));
            }
        });
    }
}

/// Russian roulette in lanes.
pub(super) struct Roulette<R: Real> {
    pub survives: R::Mask,
    /// The factor of the throughput of those that survive.
    pub weight: R,
    /// The next dimension of their samplers.
    pub dimension: R::Int,
}

/// Plays Russian roulette for the `valid` paths, which `carry` so much after `depth` scattering
/// events and one more.
#[inline(always)]
pub(super) fn play<R: Real>(
    pass: &Pass,
    address: Address<R::Int>,
    depth: R::Int,
    carry: SampledSpectrum<R>,
    valid: R::Mask,
) -> Roulette<R> {
    // The first scattering event is never the last by roulette.
    let is_first = depth.eq(R::Int::splat(0));
    let probability = roulette::of_camera_path(carry);
    let plays = !is_first & probability.lt(R::splat(CERTAIN)) & valid;
    let draws = plays & probability.gt(R::zero());
    let mut survives = valid & !plays;
    if draws.any() {
        let u = draw_1d::<R>(pass, &mut { address });
        survives = survives | (draws & u.lt(probability));
    }
    let weight = R::select(plays, R::one() / probability, R::one());
    let next = address.dimension.wrapping_add(R::Int::splat(1));
    Roulette { survives, weight, dimension: R::Int::select(draws, next, address.dimension) }
}
