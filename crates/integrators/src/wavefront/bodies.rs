//! The hits of path tracing on bodies that scatter light under their surface.
//!
//! The boundary is glass, and is shaded in lanes as glass is. Paths that enter by it wait until the
//! kernel has ended; then a probe finds for each where it leaves (`transport/subsurface/`), one
//! path after another.

use lanes::{Int, Mask, Real};
use scattering::{Body, Bsdf, BsdfSample, Scatter};
use scene::Footprint;
use scene::light::LightSampleContext;
use scene::material::{DielectricMaterial, MaterialId, MaterialModel, SubsurfaceMaterial};
use scene::texture::TextureContext;
use spectrum::{SampledSpectrum, Spectrum};

use super::batch::{Batch, BatchColumns};
use super::path::PathVertices;
use super::queues::Entering;
use super::shade::{AtVertices, Shade, Vertices};
use crate::transport::path_state::PathState;
use crate::transport::subsurface::Entry;
use crate::{Path, Tracer};

/// Path tracing at the boundaries of bodies.
struct AtBoundary<'a>(&'a Path);

impl AtVertices for AtBoundary<'_> {
    #[inline(always)]
    fn regularizes(&self) -> bool {
        self.0.regularizes()
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

impl PathVertices for AtBoundary<'_> {
    #[inline(always)]
    fn path(&self) -> &Path {
        self.0
    }

    /// Light that comes out has been scattered under the surface.
    #[inline(always)]
    fn lets_pass<R: Real>(cos_o: R, cos_i: R) -> R::Mask {
        !(cos_o.gt(R::zero()) & cos_i.lt(R::zero()))
    }

    #[inline(always)]
    fn take_entering<R: Real, M>(
        shade: &mut Shade<M, Self>,
        vertices: &Vertices<R>,
        sample: &BsdfSample<R>,
        beta: SampledSpectrum<R>,
        mask: R::Mask,
    ) -> R::Mask {
        let is_outside = vertices.wo.dot(vertices.surface.ns).gt(R::zero());
        let enters = mask & is_outside & sample.flags.is_transmissive();
        if enters.any() {
            let rows = vertices.rows.indices;
            vertices.address.dimension.scatter(enters, &mut shade.paths.dimension, rows);
            let Entering { rows: to, turns, beta: betas } = &mut shade.queues.entering;
            rows.append(enters, to);
            vertices.turns.indices.append(enters, turns);
            betas.append(enters, beta);
        }
        enters
    }
}

impl Batch<'_> {
    /// Shades hits on a body, of which indices and paths are given.
    pub(super) fn shade_body(
        &mut self,
        algorithm: &Path,
        (id, body): (MaterialId, &SubsurfaceMaterial),
        (turns, rows): (&[u32], &[u32]),
    ) {
        let boundary =
            DielectricMaterial { eta: Spectrum::Constant(body.table.eta()), roughness: body.roughness };
        self.dispatch(&AtBoundary(algorithm), (id, &boundary), turns, rows);
        let mut entering = std::mem::take(&mut self.columns.queues.entering);
        let mut places = turns.iter();
        for (i, (&row, &turn)) in entering.rows.iter().zip(&entering.turns).enumerate() {
            // Both are in the same order.
            while places.next().is_some_and(|&other| other != turn) {}
            let place = turns.len() - places.len() - 1;
            self.follow(algorithm, body, (row, turn as usize, place), entering.beta.row(i));
        }
        let Entering { rows, turns, beta } = &mut entering;
        [rows, turns].into_iter().for_each(Vec::clear);
        beta.clear();
        self.columns.queues.entering = entering;
    }

    /// Leads a path that has entered a body out of it; row, turn and place of its point are given.
    fn follow(
        &mut self,
        algorithm: &Path,
        body: &SubsurfaceMaterial,
        (path, turn, place): (u32, usize, usize),
        beta: SampledSpectrum,
    ) {
        let Self { pass, sampler, stats, columns } = self;
        let BatchColumns { paths, segments, hits, points, queues, .. } = &mut **columns;
        let (scene, row) = (pass.pixels.scene, path as usize);
        let lambda = paths.lambda(row);
        let point = points.get::<f32>(place);
        let ray = segments.ray(turn);
        let material = scene.geometries()[hits.geometry[turn] as usize].material;
        let entry = Entry { p: point.p, n: point.n, ns: point.ns, time: ray.time, material };
        let context =
            TextureContext { p: point.p.p, n: point.n, uv: point.uv, footprint: Footprint::point() };
        let body = body.bxdf(scene.textures(), &context, &lambda);
        let mut state = PathState::new(ray.into(), segments.depth[turn] + 1);
        state.beta = beta;
        // As the boundary has scaled it, up to where it leaves.
        state.eta_scale = segments.eta_scale[turn] * (body.boundary.eta * body.boundary.eta);
        paths.resume(sampler, row, pass.pixels.index);
        let mut tracer = Tracer::new(scene, pass.pixels.view, pass.control, sampler, stats);
        let under = (Body::Subsurface(&body), -entry.ns);
        let Some(exit) = state.pass_under(&mut tracer, &entry, under, &lambda) else { return };
        let (l, goes_on) = algorithm.leave_body(&mut tracer, &mut state, &exit, &lambda);
        paths.add_light(row, l);
        if goes_on && state.survives(sampler) {
            paths.rough_before[row] = true;
            paths.dimension[row] = sampler.dimension();
            queues.next.push(path, &state);
        }
    }
}
