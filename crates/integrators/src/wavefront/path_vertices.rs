//! The steps of path tracing at vertices in lanes: light samples, BSDF samples and Russian
//! roulette.

use lanes::{Int, MAX_LANES, Mask, Real};
use math::{Ray, offset_ray_origin};
use sampling::sampler::Address;
use scattering::{BsdfSample, BxdfFlags, Directions};
use spectrum::SampledSpectrum;

use super::indices::HitIndices;
use super::lights::{LightLanes, LightSampling};
use super::media::VerticesInMedia;
use super::numbers::{SampleNumbers, VertexNumbers, draw_1d};
use super::pass::Pass;
use super::queues::Entering;
use super::segment_columns::Segment;
use super::shadows::PassageLanes;
use super::stage::{Algorithm, Request, SpecularSamples, Stage, Vertices};
use crate::Path;
use crate::transport::direct::power_heuristic;
use crate::transport::path_state::{self, throughput};
use crate::transport::roulette;
use crate::transport::vertex::scattered;

/// Path tracing at vertices. The samples of lights stay in the stage.
pub(super) struct PathVertices<R: Real> {
    media: Option<VerticesInMedia<R>>,
    /// The dimension of the numbers of shadow rays in media.
    passage: R::Int,
    /// The numbers of samples of BSDFs.
    numbers: SampleNumbers<R>,
}

impl<R: Real> PathVertices<R> {
    /// Samples lights for the lanes that are not specular.
    #[inline(always)]
    pub fn begin(
        path: &Path,
        stage: &mut Stage,
        vertices: &mut Vertices<R>,
        flags: &BxdfFlags<R>,
        chooses: bool,
    ) -> (Self, Request<R>) {
        let samples_light = flags.is_non_specular();
        let media = match &stage.segments.media {
            Some(columns) => {
                let Vertices { hit_indices, lambda, .. } = vertices;
                let (media, geometries) = (stage.pass.media, &stage.hits.geometry);
                let terminated = lambda.secondary_terminated();
                Some(VerticesInMedia::new(media, columns, *hit_indices, geometries, terminated))
            }
            None => None,
        };
        let (address, has_media) = (&mut vertices.address, media.is_some());
        let numbers = VertexNumbers::draw(&stage.pass, address, samples_light, chooses, has_media);
        let samples = vertices.active & samples_light;
        let request = if samples.any() {
            let sampling = LightSampling { pass: &stage.pass, direct: &path.direct, light: None };
            let (context, lambda) = (vertices.contexts(), &vertices.lambda);
            sampling.draw(stage.light_samples, &context, numbers.light, lambda, samples);
            Request::Value(stage.light_samples.directions())
        } else {
            Request::Sample(numbers.bsdf, Directions::All)
        };
        (Self { media, passage: numbers.passage, numbers: numbers.bsdf }, request)
    }

    /// Next-event estimation, by the values of the BSDFs towards the lights and their densities
    /// there.
    #[inline(always)]
    pub fn connect(
        &self,
        stage: &mut Stage,
        vertices: &Vertices<R>,
        f: SampledSpectrum<R>,
        p_b: R,
    ) -> Request<R> {
        let Self { media, passage, numbers } = self;
        let light = stage.light_samples.lanes::<R>();
        let LightLanes { valid, l, wi, pdf, .. } = light;
        let Vertices { p, n, ns, wo, time, .. } = *vertices;
        let scattered = scattered(f, l, wi, ns);
        let mut lit = valid & !scattered.is_black();
        if let Algorithm::Boundaries(_) = stage.algorithm {
            // Light that comes out has been scattered under the surface.
            lit = lit & !(wo.dot(ns).gt(R::zero()) & wi.dot(ns).lt(R::zero()));
        }
        let shadow = light.shadow_rays(p, n, time);
        if let Some(media) = media {
            // The weight depends on what the rays pass.
            let l = vertices.beta * scattered / pdf;
            let passage = PassageLanes {
                r_u: media.r_u,
                ratio: R::select(light.is_delta, R::zero(), p_b / pdf),
                medium: media.towards(wi, n),
                dimension: *passage,
            };
            stage.queues.passages.append(vertices.rows, lit, l, &shadow, &passage);
        } else {
            let weight = R::select(light.is_delta, R::one(), power_heuristic(pdf, p_b));
            let l = vertices.beta * (scattered * (weight / pdf));
            let [stopped, passing] = &mut stage.queues.shadows;
            stopped.append(vertices.rows, lit & !light.passes, l, &shadow);
            passing.append(vertices.rows, lit & light.passes, l, &shadow);
        }
        Request::Sample(*numbers, Directions::All)
    }

    /// Continues the paths along samples of the BSDFs, unless Russian roulette ends them.
    #[inline(always)]
    pub fn scatter(
        &self,
        stage: &mut Stage,
        vertices: &Vertices<R>,
        sample: &BsdfSample<R>,
        density: R,
    ) -> Request<R> {
        let Vertices { rows, hit_indices, p, n, ns, time, .. } = *vertices;
        let BsdfSample { wi, flags, valid, .. } = *sample;
        let beta = vertices.beta * throughput(ns, sample);
        let eta_scale = R::gather(&stage.segments.eta_scale, hit_indices.indices);
        let eta_scale = path_state::eta_scale(eta_scale, sample);
        let mut valid = valid & vertices.active;
        if let Algorithm::Boundaries(_) = stage.algorithm {
            valid = valid & !vertices.enter(stage, sample, beta, valid);
        }

        let depth = R::Int::gather(&stage.segments.depth, hit_indices.indices).wrapping_add(R::Int::splat(1));
        let Roulette { survives, weight, dimension } =
            play(&stage.pass, vertices.address, depth, beta * eta_scale, valid);
        dimension.scatter(survives, &mut stage.paths.dimension, rows.indices);
        let is_specular = flags.is_specular();
        if stage.algorithm.regularizes() {
            rows.each_of(survives & !is_specular, |_, row| stage.paths.rough_before[row] = true);
        }
        let mut in_media = None;
        if let Some(media) = &self.media {
            in_media = Some(media.leave(wi, n, density));
        }
        let segment = Segment {
            ray: Ray::new(offset_ray_origin(p, n, wi), wi, time),
            beta: beta * weight,
            eta_scale,
            depth,
            vertex: vertices.contexts(),
            pdf: R::select(is_specular, R::zero(), density),
            media: in_media,
        };
        let first = stage.queues.next.rows.len();
        stage.queues.next.append(rows.indices, survives, &segment);
        if !stage.segments.are_differentials.is_empty() && (survives & is_specular).any() {
            stage.carry_differentials(hit_indices, survives, sample, first);
        }
        Request::Nothing
    }
}

impl<R: Real> Vertices<R> {
    /// Takes the paths of a mask's lanes that go on under the surface, of the throughput `beta`;
    /// gives which they are.
    #[inline(always)]
    fn enter(
        &self,
        stage: &mut Stage,
        sample: &BsdfSample<R>,
        beta: SampledSpectrum<R>,
        mask: R::Mask,
    ) -> R::Mask {
        let is_outside = self.wo.dot(self.ns).gt(R::zero());
        let enters = mask & is_outside & sample.flags.is_transmissive();
        if enters.any() {
            let rows = self.rows.indices;
            self.address.dimension.scatter(enters, &mut stage.paths.dimension, rows);
            let Entering { rows: to, hit_indices, beta: betas } = &mut stage.queues.entering;
            rows.append(enters, to);
            self.hit_indices.indices.append(enters, hit_indices);
            betas.append(enters, beta);
        }
        enters
    }
}

impl Stage<'_, '_> {
    /// Gives the rays that specular scattering has appended, from a place in the queue on, the
    /// differentials of the rays before.
    #[inline(always)]
    fn carry_differentials<R: Real>(
        &mut self,
        hit_indices: HitIndices<R>,
        appended: R::Mask,
        sample: &BsdfSample<R>,
        first: usize,
    ) {
        let specular = (appended & sample.flags.is_specular()).bits();
        let hit_indices = hit_indices.indices.to_array();
        self.carry_each(&hit_indices, appended.bits(), specular, &SpecularSamples::of(sample), first);
    }

    /// Few rays have differentials, so that they are computed one by one.
    #[inline(never)]
    fn carry_each(
        &mut self,
        hit_indices: &[u32; MAX_LANES],
        appended: u32,
        mut specular: u32,
        samples: &SpecularSamples,
        first: usize,
    ) {
        while specular != 0 {
            let lane = specular.trailing_zeros() as usize;
            specular &= specular - 1;
            let place = first + (appended & ((1 << lane) - 1)).count_ones() as usize;
            let sample = samples.at(lane);
            if let Some(differentials) = self.scattered_differentials(hit_indices[lane] as usize, &sample) {
                self.queues.next.set_differentials(place, Some(&differentials));
            }
        }
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
/// events.
#[inline(always)]
pub(super) fn play<R: Real>(
    pass: &Pass,
    address: Address<R::Int>,
    depth: R::Int,
    carry: SampledSpectrum<R>,
    valid: R::Mask,
) -> Roulette<R> {
    let probability = roulette::camera_path_survival(carry);
    let plays = roulette::plays_roulette(depth, probability) & valid;
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
