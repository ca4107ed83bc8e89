//! Shading in lanes: the vertices of hits and their BSDFs, and what path tracing does there:
//! next-event estimation, a sample of the BSDF and Russian roulette.

use geometry::{PatchPoints, PointColumns};
use lanes::{Int, Kernel, Mask, Real};
use math::{Normal3, Point3Error, Vec2, Vec3, Vector3, offset_ray_origin};
use sampling::sampler::Address;
use scattering::{Bsdf, BsdfSample, BxdfFlags, Directions, Scatter, TransportMode};
use scene::Footprint;
use scene::light::LightSampleContext;
use scene::material::MaterialModel;
use scene::texture::TextureContext;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::columns::Rows;
use super::lights::{self, LightLanes, Samples};
use super::numbers::{VertexNumbers, draw_1d};
use super::pass::Pass;
use super::paths::{Paths, differentials_of};
use super::queues::{Queues, Shadow};
use crate::Path;
use crate::transport::direct::power_heuristic;
use crate::transport::roulette::CERTAIN;

/// What an algorithm does at vertices.
pub(super) trait AtVertices: Sized {
    /// Whether surfaces are roughened after a rough one.
    fn regularizes(&self) -> bool {
        false
    }

    /// Goes on from the vertices in the lanes. Most contexts of light sampling are offset to the
    /// side of the surface that scatters.
    fn go_on<R: Real, M: MaterialModel, B: Scatter<R>>(
        shade: &mut Shade<M, Self>,
        vertices: Vertices<R>,
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
    );
}

/// Shades hits of one material.
pub(super) struct Shade<'a, 'b, M, A> {
    pub pass: Pass<'a>,
    pub algorithm: &'b A,
    pub material: &'a M,
    pub with_footprint: bool,
    /// Their surface points.
    pub points: &'b PointColumns,
    /// Indices of hits, and their paths.
    pub turns: &'b [u32],
    pub rows: &'b [u32],
    pub paths: &'b mut Paths,
    pub queues: &'b mut Queues,
    pub light_samples: &'b mut Samples,
}

impl<M: MaterialModel, A: AtVertices> Kernel for Shade<'_, '_, M, A> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(mut self) {
        for (part, rows) in self.rows.chunks(R::LANES).enumerate() {
            self.shade::<R>(part * R::LANES, rows);
        }
    }
}

/// The vertices of the paths in the lanes.
pub(super) struct Vertices<R: Real> {
    pub rows: Rows<R>,
    /// The lanes that have a vertex.
    pub active: R::Mask,
    /// The place of the first one in the queue.
    pub first: usize,
    pub surface: PatchPoints<R>,
    pub wo: Vector3<R>,
    pub time: R,
    pub lambda: SampledWavelengths<R>,
    /// Path throughput before the vertex.
    pub beta: SampledSpectrum<R>,
    pub address: Address<R::Int>,
}

impl<M: MaterialModel, A: AtVertices> Shade<'_, '_, M, A> {
    #[inline(always)]
    fn shade<R: Real>(&mut self, first: usize, queue: &[u32]) {
        let mut vertices = self.vertices::<R>(first, queue);
        let PatchPoints { p, n, ns, uv, dpdu, .. } = vertices.surface;
        let footprint = if self.with_footprint { self.footprint(&vertices) } else { Footprint::point() };
        let context = TextureContext::new(p.p, n, uv, &footprint);
        let before = vertices.lambda;
        let textures = self.pass.pixels.scene.textures();
        let bxdf = self.material.bxdf(textures, &context, &mut vertices.lambda);
        self.keep_wavelengths(&vertices, &before);
        let mut bsdf = Bsdf::new(ns, dpdu, bxdf);
        if self.algorithm.regularizes() {
            let rough: u32 = queue.iter().enumerate().map(|(lane, &row)| self.rough(row) << lane).sum();
            bsdf.regularize(R::Mask::from_bits(rough));
        }
        let contexts = contexts(&vertices, bsdf.flags());
        A::go_on(self, vertices, &bsdf, &contexts);
    }

    fn rough(&self, row: u32) -> u32 {
        self.paths.rough_before[row as usize].into()
    }

    #[inline(always)]
    fn vertices<R: Real>(&mut self, first: usize, queue: &[u32]) -> Vertices<R> {
        let rows = Rows::<R>::first(queue);
        let (surface, found) = self.points.get::<R>(first);
        rows.each_of(rows.active & !found, |lane, row| {
            self.queues.scalar.push((row as u32, self.turns[first + lane]));
        });
        let paths = &*self.paths;
        let [a, b, c, d, pdf @ ..] = paths.wavelengths.get(rows);
        let [x, y] = &paths.pixel;
        Vertices {
            rows,
            active: rows.active & found,
            first,
            surface,
            wo: -paths.direction.vector(rows).normalize(),
            time: R::gather(&paths.time, rows.indices),
            lambda: SampledWavelengths::new([a, b, c, d], pdf),
            beta: paths.beta.spectrum(rows),
            address: Address {
                pixel: [R::Int::gather(x, rows.indices), R::Int::gather(y, rows.indices)],
                index: self.pass.pixels.index,
                dimension: R::Int::gather(&paths.dimension, rows.indices),
            },
        }
    }

    /// The footprints of pixels at the vertices.
    #[inline(always)]
    fn footprint<R: Real>(&self, vertices: &Vertices<R>) -> Footprint<R> {
        let PatchPoints { p, n, dpdu, dpdv, .. } = vertices.surface;
        let (view, rows) = (self.pass.pixels.view, vertices.rows);
        let is = R::Int::gather(&self.paths.are_differentials, rows.indices).eq(R::Int::splat(1));
        let across = if is.any() {
            let differentials = differentials_of(self.paths.differentials.get(rows));
            view.pixel_on_plane(Some((&differentials, is)), p.p, n, vertices.time)
        } else {
            view.pixel_on_plane(None, p.p, n, vertices.time)
        };
        Footprint::new(across, [dpdu, dpdv])
    }

    /// Stores wavelengths whose densities the material has changed.
    #[inline(always)]
    fn keep_wavelengths<R: Real>(&mut self, vertices: &Vertices<R>, before: &SampledWavelengths<R>) {
        let changed = vertices.lambda.pdf()[0].ne(before.pdf()[0]) & vertices.active;
        if changed.any() {
            vertices.rows.each_of(changed, |lane, row| {
                self.paths.set_lambda(row, &vertices.lambda.lane(lane));
            });
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
        mut vertices: Vertices<R>,
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
    ) {
        let samples_light = bsdf.flags().is_non_specular();
        let numbers = VertexNumbers::draw(&shade.pass, &mut vertices.address, samples_light);
        shade.connect(&vertices, bsdf, contexts, numbers.light, samples_light);
        shade.scatter(&vertices, bsdf, contexts, numbers.bsdf);
    }
}

impl<M: MaterialModel> Shade<'_, '_, M, Path> {
    /// Next-event estimation of the lanes that are not specular.
    #[inline(always)]
    fn connect<R: Real, B: Scatter<R>>(
        &mut self,
        vertices: &Vertices<R>,
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
        u: (R, Vec2<R>),
        is_non_specular: R::Mask,
    ) {
        let samples = vertices.active & is_non_specular;
        if !samples.any() {
            return;
        }
        let sampling = (&self.pass, &self.algorithm.direct, &mut *self.light_samples);
        let light = lights::sample(sampling, None, contexts, u, &vertices.lambda, samples);
        let LightLanes { valid, l, wi, pdf, .. } = light;
        let Vertices { surface: PatchPoints { p, n, ns, .. }, wo, time, .. } = *vertices;
        let f = bsdf.f(wo, wi, TransportMode::Radiance);
        let scattered = f * l * wi.dot(ns).abs();
        let p_b = bsdf.pdf(wo, wi, TransportMode::Radiance, Directions::All);
        let weight = R::select(light.is_delta, R::one(), power_heuristic(pdf, p_b));
        let l = vertices.beta * (scattered * (weight / pdf));
        let lit = valid & !scattered.is_black();
        let (ray, t_max) = light.shadow_rays(p, n, time);
        let shadow = Shadow { l, ray, t_max };
        let [stopped, passing] = &mut self.queues.shadows;
        stopped.append(vertices.rows, lit & !light.passes, &shadow);
        passing.append(vertices.rows, lit & light.passes, &shadow);
    }

    /// Continues the paths along a direction of the BSDF, unless Russian roulette ends them.
    #[inline(always)]
    fn scatter<R: Real, B: Scatter<R>>(
        &mut self,
        vertices: &Vertices<R>,
        bsdf: &Bsdf<B, R>,
        contexts: &LightSampleContext<R>,
        (uc, u): (R, Vec2<R>),
    ) {
        let Vertices { rows, surface: PatchPoints { p, n, ns, .. }, wo, .. } = *vertices;
        let sample = bsdf.sample_lanes(wo, uc, u, TransportMode::Radiance, Directions::All);
        let BsdfSample { f, wi, pdf, flags, eta, valid, .. } = sample;
        let beta = vertices.beta * (f * (wi.dot(ns).abs() / pdf));
        let eta_scale = R::gather(&self.paths.eta_scale, rows.indices);
        let eta_scale = R::select(flags.is_transmissive(), eta_scale * (eta * eta), eta_scale);
        let valid = valid & vertices.active;

        // The first scattering event is never the last by roulette.
        let depth = R::Int::gather(&self.paths.depth, rows.indices);
        let is_first = depth.eq(R::Int::splat(0));
        let probability = (beta * eta_scale).max_component();
        let plays = !is_first & probability.lt(R::splat(CERTAIN)) & valid;
        let draws = plays & probability.gt(R::zero());
        let mut survives = valid & !plays;
        if draws.any() {
            let u = draw_1d::<R>(&self.pass, &mut { vertices.address });
            survives = survives | (draws & u.lt(probability));
        }
        let beta = SampledSpectrum::select(plays, beta / probability, beta);

        let paths = &mut *self.paths;
        paths.beta.set(rows, survives, beta.0);
        paths.origin.set(rows, survives, offset_ray_origin(p, n, wi).to_array());
        paths.direction.set(rows, survives, wi.to_array());
        let vectors = [contexts.p.p, contexts.p.error, contexts.n, contexts.ns];
        for (columns, v) in paths.vertex.iter_mut().zip(vectors) {
            columns.set(rows, survives, v.to_array());
        }
        let is_specular = flags.is_specular();
        R::select(is_specular, R::zero(), pdf).scatter(survives, &mut paths.pdf, rows.indices);
        eta_scale.scatter(survives, &mut paths.eta_scale, rows.indices);
        let one = R::Int::splat(1);
        depth.wrapping_add(one).scatter(survives, &mut paths.depth, rows.indices);
        let dimension = vertices.address.dimension;
        let dimension = R::Int::select(draws, dimension.wrapping_add(one), dimension);
        dimension.scatter(survives, &mut paths.dimension, rows.indices);
        if self.algorithm.settings.regularize {
            rows.each_of(survives & !is_specular, |_, row| paths.rough_before[row] = true);
        }
        if !paths.are_differentials.is_empty() {
            R::Int::splat(0).scatter(survives, &mut paths.are_differentials, rows.indices);
        }
        rows.indices.append(survives, &mut self.queues.next);
    }
}

/// The contexts of light sampling: as in `transport/direct.rs`, a point that scatters to one side
/// only is offset to the side of `wo`.
#[inline(always)]
fn contexts<R: Real>(vertices: &Vertices<R>, flags: BxdfFlags<R>) -> LightSampleContext<R> {
    let PatchPoints { p, n, ns, .. } = vertices.surface;
    let (reflects, transmits) = (flags.is_reflective(), flags.is_transmissive());
    let one_sided = reflects ^ transmits;
    let side: Normal3<R> = Vec3::select(reflects, vertices.wo, -vertices.wo);
    let moved = Point3Error::exact(offset_ray_origin(p, n, side));
    let p = Point3Error::new(
        Vec3::select(one_sided, moved.p, p.p),
        Vec3::select(one_sided, moved.error, p.error),
    );
    LightSampleContext { p, n, ns, time: vertices.time }
}
