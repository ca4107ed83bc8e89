//! Shading in lanes: the vertices of hits and their BSDFs.
//!
//! A kernel of each material evaluates and samples BSDFs. The steps of algorithms at vertices do
//! not depend on materials: they are functions of the lanes, compiled once for each instruction
//! set, which [request](Request) of a kernel one value or sample after another.

use geometry::PatchPoints;
use lanes::{Callee, Int, Kernel, Mask, Real};
use math::Vector3;
use scattering::{Bsdf, BsdfSample, BxdfFlags, Directions, Scatter, TransportMode};
use scene::Footprint;
use scene::material::MaterialModel;
use scene::texture::TextureContext;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::indices::HitIndices;
use super::lights_in_turn::LightsInTurn;
use super::numbers::SampleNumbers;
use super::path_vertices::PathVertices;
use super::stage::{Algorithm, Place, Request, Stage, Vertices};

/// Shades hits of one material.
pub(super) struct Shade<'a, 'b, M> {
    pub material: &'a M,
    pub stage: Stage<'a, 'b>,
}

impl<M: MaterialModel> Kernel for Shade<'_, '_, M> {
    type Output = ();

    #[inline(always)]
    fn run<R: Real>(mut self) {
        for first in (0..self.stage.rows.len()).step_by(R::LANES) {
            self.shade::<R>(first);
        }
    }
}

impl<M: MaterialModel> Shade<'_, '_, M> {
    #[inline(always)]
    fn shade<R: Real>(&mut self, first: usize) {
        let Self { material, stage } = self;
        let Place { rows, hit_indices } = stage.place::<R>(first);
        let surface: PatchPoints<R> = stage.points.get(first);
        let (wo, before) = (stage.outgoing(hit_indices), stage.paths.lambda_lanes(rows));
        let footprint = if stage.with_footprint {
            R::call(FootprintAt { stage, hit_indices, surface: &surface })
        } else {
            Footprint::point()
        };
        let PatchPoints { p, n, ns, uv, ss, .. } = surface;
        let context = TextureContext { p: p.p, n, uv, footprint };
        let mut lambda = before;
        let bxdf = material.bxdf(stage.pass.pixels.scene.textures(), &context, &mut lambda);
        let changed = lambda.pdf()[0].ne(before.pdf()[0]) & rows.active;
        if changed.any() {
            rows.each_of(changed, |lane, row| stage.paths.set_lambda(row, &lambda.lane(lane)));
        }
        let mut bsdf = Bsdf::new(ns, ss, bxdf);
        bsdf.seed(&lambda, R::Int::gather(&stage.paths.dimension, rows.indices));
        if stage.algorithm.regularizes() {
            bsdf.regularize(stage.rough_before::<R>(first));
        }
        let (mode, weighs) = (TransportMode::Radiance, stage.algorithm.weighs());
        let (flags, chooses) = (bsdf.flags(), M::Bxdf::<'_, R>::CHOOSES);
        // Large values stay where functions have written them.
        let begin = Begin { stage, first, wo: &wo, lambda: &lambda, flags: &flags, chooses };
        let mut state = step::<R, M, _>(begin);
        loop {
            match state.request {
                Request::Value(wi) => {
                    let f = bsdf.f(wo, wi, mode);
                    let pdf = if weighs { bsdf.pdf(wo, wi, mode, Directions::All) } else { R::one() };
                    step::<R, M, _>(Connect { stage, state: &mut state, f: &f, pdf });
                }
                Request::Sample(SampleNumbers { uc, u }, directions) => {
                    let sample = bsdf.sample_lanes(wo, uc, u, mode, directions);
                    let pdf = if weighs && sample.pdf_is_proportional {
                        bsdf.pdf(wo, sample.wi, mode, directions)
                    } else {
                        sample.pdf
                    };
                    step::<R, M, _>(Continue { stage, state: &mut state, sample: &sample, pdf });
                }
                Request::Nothing => return,
            }
        }
    }
}

/// A step of an algorithm: a function of the lanes, but for materials so common and cheap that the
/// call would be seen.
#[inline(always)]
fn step<R: Real, M: MaterialModel, C: Callee<R>>(callee: C) -> C::Output {
    if M::IS_CHEAP { callee.run() } else { R::call(callee) }
}

/// The footprints of pixels at surface points.
struct FootprintAt<'a, 'b, 'c, R: Real> {
    stage: &'c Stage<'a, 'b>,
    hit_indices: HitIndices<R>,
    surface: &'c PatchPoints<R>,
}

impl<R: Real> Callee<R> for FootprintAt<'_, '_, '_, R> {
    type Output = Footprint<R>;

    #[inline(always)]
    fn run(self) -> Footprint<R> {
        let Self { stage, hit_indices, surface } = self;
        stage.segments.footprint(stage.pass.pixels.view, hit_indices, surface)
    }
}

/// Vertices with the state of their algorithm.
struct AtVertices<'b, R: Real> {
    vertices: Vertices<R>,
    request: Request<R>,
    state: AlgorithmState<'b, R>,
}

enum AlgorithmState<'b, R: Real> {
    Path(PathVertices<R>),
    AllLights(LightsInTurn<'b, R>),
}

/// The first step of the algorithm.
struct Begin<'a, 'b, 'c, R: Real> {
    stage: &'c mut Stage<'a, 'b>,
    first: usize,
    wo: &'c Vector3<R>,
    lambda: &'c SampledWavelengths<R>,
    /// The flags of the BSDFs.
    flags: &'c BxdfFlags<R>,
    /// Whether they choose among lobes.
    chooses: bool,
}

impl<'b, R: Real> Callee<R> for Begin<'_, 'b, '_, R> {
    type Output = AtVertices<'b, R>;

    #[inline(always)]
    fn run(self) -> AtVertices<'b, R> {
        let Self { stage, first, wo, lambda, flags, chooses } = self;
        let mut vertices = stage.vertices::<R>(first, *wo, *lambda, flags);
        let (request, state) = match stage.algorithm {
            Algorithm::Path(path) | Algorithm::Boundaries(path) => {
                let (state, request) = PathVertices::begin(path, stage, &mut vertices, flags, chooses);
                (request, AlgorithmState::Path(state))
            }
            Algorithm::AllLights(lights) => {
                let (state, request) = LightsInTurn::begin(lights, stage, &mut vertices, flags, chooses);
                (request, AlgorithmState::AllLights(state))
            }
        };
        AtVertices { vertices, request, state }
    }
}

/// The step that follows a value and its density.
struct Connect<'a, 'b, 'c, R: Real> {
    stage: &'c mut Stage<'a, 'b>,
    state: &'c mut AtVertices<'b, R>,
    f: &'c SampledSpectrum<R>,
    pdf: R,
}

impl<R: Real> Callee<R> for Connect<'_, '_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { stage, state: AtVertices { vertices, request, state }, f, pdf } = self;
        *request = match state {
            AlgorithmState::Path(path) => path.connect(stage, vertices, *f, pdf),
            AlgorithmState::AllLights(lights) => lights.connect(stage, vertices, *f),
        };
    }
}

/// The step that follows a sample, of which the density is given.
struct Continue<'a, 'b, 'c, R: Real> {
    stage: &'c mut Stage<'a, 'b>,
    state: &'c mut AtVertices<'b, R>,
    sample: &'c BsdfSample<R>,
    pdf: R,
}

impl<R: Real> Callee<R> for Continue<'_, '_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { stage, state: AtVertices { vertices, request, state }, sample, pdf } = self;
        *request = match state {
            AlgorithmState::Path(path) => path.scatter(stage, vertices, sample, pdf),
            AlgorithmState::AllLights(lights) => lights.wait_for(stage, vertices, sample),
        };
    }
}
