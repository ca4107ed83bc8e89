//! The hits of path tracing on bodies that scatter light under their surface.
//!
//! The boundary is glass, and is shaded in lanes as glass is. Paths that enter by it wait until the
//! kernel has ended; then a probe finds for each where it leaves (`transport/subsurface/`), one
//! path after another. There they are shaded in lanes again, by the lobe of the exit.

use lanes::Real;
use scattering::{Body, NormalizedFresnel};
use scene::Footprint;
use scene::material::{DielectricMaterial, MaterialId, MaterialModel, SubsurfaceMaterial};
use scene::texture::{TextureContext, Textures};
use spectrum::{SampledSpectrum, SampledWavelengths, Spectrum};

use super::batch::{Batch, BatchColumns};
use super::exits::Exits;
use super::groups::Group;
use super::queues::{Entering, PathHit};
use super::shade::Shade;
use super::stage::{Algorithm, Stage};
use crate::Tracer;
use crate::transport::path_state::PathState;
use crate::transport::subsurface::Entry;

/// The lobe by which paths leave a body, as a material.
struct Leaving(NormalizedFresnel);

impl MaterialModel for Leaving {
    type Bxdf<'a, R: Real> = NormalizedFresnel<R>;

    #[inline(always)]
    fn bxdf<R: Real>(
        &self,
        _: &Textures,
        _: &TextureContext<R>,
        _: &mut SampledWavelengths<R>,
    ) -> NormalizedFresnel<R> {
        self.0.splat()
    }
}

impl Batch<'_> {
    /// Shades hits on a body.
    pub(super) fn shade_body(
        &mut self,
        algorithm: Algorithm,
        id: MaterialId,
        body: &SubsurfaceMaterial,
        group: &Group,
    ) {
        let Algorithm::Path(path) = algorithm else {
            unreachable!("invariant: LaneMaterials has bodies for path tracing alone")
        };
        let boundary =
            DielectricMaterial { eta: Spectrum::Constant(body.table.eta()), roughness: body.roughness };
        self.dispatch(Algorithm::Boundaries(path), id, &boundary, group);
        let mut entering = std::mem::take(&mut self.columns.queues.entering);
        let mut exits = std::mem::take(&mut self.columns.exits);
        exits.start(entering.rows.len());
        let mut points = group.hit_indices.iter();
        for (i, (&path, &hit)) in entering.rows.iter().zip(&entering.hit_indices).enumerate() {
            // Both are in the same order.
            while points.next().is_some_and(|&other| other != hit) {}
            let point = group.hit_indices.len() - points.len() - 1;
            self.follow(body, PathHit { path, hit }, point, entering.beta.row(i), &mut exits);
        }
        let Exits { segments, points, hit_indices } = &exits;
        let BatchColumns { hits, paths, queues, light_samples, .. } = &mut *self.columns;
        let stage = Stage {
            pass: self.pass,
            algorithm,
            with_footprint: false,
            points,
            hits,
            hit_indices,
            rows: &segments.rows,
            segments,
            paths,
            queues,
            light_samples,
        };
        let leaving = Leaving(NormalizedFresnel::new(&body.table));
        self.pass.instruction_set.dispatch_large(Shade { material: &leaving, stage });
        self.columns.exits = exits;
        let Entering { rows, hit_indices, beta } = &mut entering;
        [rows, hit_indices].into_iter().for_each(Vec::clear);
        beta.clear();
        self.columns.queues.entering = entering;
    }

    /// Leads a path that has entered a body out of it; the index of its surface point is given.
    fn follow(
        &mut self,
        body: &SubsurfaceMaterial,
        place: PathHit,
        point: usize,
        beta: SampledSpectrum,
        exits: &mut Exits,
    ) {
        let Self { pass, sampler, stats, columns } = self;
        let BatchColumns { paths, segments, hits, points, .. } = &mut **columns;
        let (scene, row) = (pass.pixels.scene, place.path as usize);
        let lambda = paths.lambda(row);
        let (point, hit_index) = (points.get::<f32>(point), place.hit as usize);
        let ray = segments.ray(hit_index);
        let material = scene.geometries()[hits.geometry[hit_index] as usize].material;
        let entry = Entry { p: point.p, n: point.n, ns: point.ns, time: ray.time, material };
        let context =
            TextureContext { p: point.p.p, n: point.n, uv: point.uv, footprint: Footprint::point() };
        let body = body.bxdf(scene.textures(), &context, &lambda);
        let depth = segments.depth[hit_index];
        let mut state = PathState::new(ray.into(), depth + 1);
        state.beta = beta;
        // As the boundary has scaled it, up to where it leaves.
        state.eta_scale = segments.eta_scale[hit_index] * (body.boundary.eta * body.boundary.eta);
        paths.resume(sampler, row, pass.pixels.index);
        let mut tracer = Tracer::new(scene, pass.pixels.view, pass.control, sampler, stats);
        let under = Body::Subsurface(&body);
        if let Some(exit) = state.leave_body(&mut tracer, &entry, under, -entry.ns, &lambda) {
            paths.dimension[row] = sampler.dimension();
            exits.push(place.path, &state, &exit.surface, depth);
        }
    }
}
