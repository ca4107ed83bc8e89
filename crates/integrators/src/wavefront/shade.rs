//! Shading in lanes: the vertices of hits and their BSDFs.
//!
//! A kernel of each material evaluates and samples BSDFs. The steps of algorithms at vertices do
//! not depend on materials: they are functions of the lanes, compiled once for each instruction
//! set, which [request](Request) of a kernel one value or sample after another.

use geometry::{HitColumns, PatchPoints, PointColumns};
use lanes::{Callee, Each, Kernel, Mask, Real};
use math::{Differentials, Normal3, Point3Error, Vec2, Vec3, Vector3, offset_ray_origin};
use sampling::sampler::Address;
use scattering::{Bsdf, BsdfSample, BxdfFlags, Directions, Scatter, TransportMode};
use scene::Footprint;
use scene::light::LightSampleContext;
use scene::material::MaterialModel;
use scene::texture::TextureContext;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::all_lights::{AllLights, LightsInTurn};
use super::columns::Rows;
use super::lights::Samples;
use super::pass::Pass;
use super::path::PathVertices;
use super::paths::Paths;
use super::queues::Queues;
use super::segments::Segments;
use crate::Path;
use crate::transport::pixel_samples::PixelSamples;

/// The algorithm at vertices.
#[derive(Clone, Copy)]
pub(super) enum Surfaces<'b> {
    Path(&'b Path),
    /// Path tracing at the boundaries of bodies.
    Boundaries(&'b Path),
    AllLights(&'b AllLights),
}

impl Surfaces<'_> {
    /// Whether surfaces are roughened after a rough one.
    #[inline(always)]
    pub fn regularizes(self) -> bool {
        match self {
            Self::Path(path) | Self::Boundaries(path) => path.settings.regularize,
            Self::AllLights(_) => false,
        }
    }

    /// Whether it asks for the densities of directions, too.
    #[inline(always)]
    fn weighs(self) -> bool {
        !matches!(self, Self::AllLights(_))
    }
}

/// A question of an algorithm about the BSDFs at vertices, in each lane.
pub(super) enum Request<R> {
    /// The value in a direction.
    Value(Vector3<R>),
    /// A sample by these numbers.
    Sample((R, Vec2<R>), Directions),
    /// None: it is done.
    Nothing,
}

/// Shades hits of one material.
pub(super) struct Shade<'a, 'b, M> {
    pub material: &'a M,
    pub stage: Stage<'a, 'b>,
}

/// Hits of one material, and all that shading them changes.
pub(super) struct Stage<'a, 'b> {
    pub pass: Pass<'a>,
    pub surfaces: Surfaces<'b>,
    pub with_footprint: bool,
    /// Their surface points.
    pub points: &'b PointColumns,
    /// The hits of all paths.
    pub hits: &'b HitColumns,
    /// Indices of hits, and their paths.
    pub turns: &'b [u32],
    pub rows: &'b [u32],
    pub segments: &'b Segments,
    pub paths: &'b mut Paths,
    pub queues: &'b mut Queues,
    pub light_samples: &'b mut Samples,
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
        // Large values stay where functions have written them.
        let mut vertices: Vertices<R> = R::call(Reach { stage, first });
        let PatchPoints { p, n, ns, uv, ss, .. } = vertices.surface;
        let context = TextureContext { p: p.p, n, uv, footprint: vertices.footprint };
        let mut lambda = vertices.lambda;
        let bxdf = material.bxdf(stage.pass.pixels.scene.textures(), &context, &mut lambda);
        let mut bsdf = Bsdf::new(ns, ss, bxdf);
        bsdf.seed(&lambda, vertices.address.dimension);
        if stage.surfaces.regularizes() {
            bsdf.regularize(vertices.is_rough);
        }
        let (wo, mode, weighs) = (vertices.wo, TransportMode::Radiance, stage.surfaces.weighs());
        let (flags, chooses) = (bsdf.flags(), M::Bxdf::<'_, R>::CHOOSES);
        let begin = Begin { stage, vertices: &mut vertices, lambda: &lambda, flags: &flags, chooses };
        let mut state = R::call(begin);
        loop {
            match state.request {
                Request::Value(wi) => {
                    let f = bsdf.f(wo, wi, mode);
                    let pdf = if weighs { bsdf.pdf(wo, wi, mode, Directions::All) } else { R::one() };
                    R::call(Connect { stage, vertices: &mut vertices, state: &mut state, f: &f, pdf });
                }
                Request::Sample((uc, u), directions) => {
                    let sample = bsdf.sample_lanes(wo, uc, u, mode, directions);
                    let pdf = if weighs && sample.pdf_is_proportional {
                        bsdf.pdf(wo, sample.wi, mode, directions)
                    } else {
                        sample.pdf
                    };
                    R::call(Continue { stage, vertices: &vertices, state: &mut state, sample: &sample, pdf });
                }
                Request::Nothing => return,
            }
        }
    }
}

/// The state of an algorithm at vertices.
struct AtVertices<'b, R: Real> {
    request: Request<R>,
    algorithm: AlgorithmState<'b, R>,
}

enum AlgorithmState<'b, R: Real> {
    Path(PathVertices<R>),
    AllLights(LightsInTurn<'b, R>),
}

/// The way to vertices up to their materials.
struct Reach<'a, 'b, 'c> {
    stage: &'c mut Stage<'a, 'b>,
    first: usize,
}

impl<R: Real> Callee<R> for Reach<'_, '_, '_> {
    type Output = Vertices<R>;

    #[inline(always)]
    fn run(self) -> Vertices<R> {
        let Self { stage, first } = self;
        let queue = &stage.rows[first..stage.rows.len().min(first + R::LANES)];
        stage.vertices::<R>(first, queue)
    }
}

/// The first step of the algorithm.
struct Begin<'a, 'b, 'c, R: Real> {
    stage: &'c mut Stage<'a, 'b>,
    vertices: &'c mut Vertices<R>,
    /// The wavelengths as the materials have left them.
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
        let Self { stage, vertices, lambda, flags, chooses } = self;
        stage.keep_wavelengths(vertices, lambda);
        vertices.lambda = *lambda;
        vertices.offset_contexts(flags);
        match stage.surfaces {
            Surfaces::Path(path) | Surfaces::Boundaries(path) => {
                let (state, request) = PathVertices::begin(path, stage, vertices, flags, chooses);
                AtVertices { request, algorithm: AlgorithmState::Path(state) }
            }
            Surfaces::AllLights(lights) => {
                let (state, request) = LightsInTurn::begin(lights, stage, vertices, flags, chooses);
                AtVertices { request, algorithm: AlgorithmState::AllLights(state) }
            }
        }
    }
}

/// The step that follows a value and its density.
struct Connect<'a, 'b, 'c, R: Real> {
    stage: &'c mut Stage<'a, 'b>,
    vertices: &'c mut Vertices<R>,
    state: &'c mut AtVertices<'b, R>,
    f: &'c SampledSpectrum<R>,
    pdf: R,
}

impl<R: Real> Callee<R> for Connect<'_, '_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { stage, vertices, state, f, pdf } = self;
        state.request = match &mut state.algorithm {
            AlgorithmState::Path(path) => path.connect(stage, vertices, *f, pdf),
            AlgorithmState::AllLights(lights) => lights.connect(stage, vertices, *f),
        };
    }
}

/// The step that follows a sample, of which the density is given.
struct Continue<'a, 'b, 'c, R: Real> {
    stage: &'c mut Stage<'a, 'b>,
    vertices: &'c Vertices<R>,
    state: &'c mut AtVertices<'b, R>,
    sample: &'c BsdfSample<R>,
    pdf: R,
}

impl<R: Real> Callee<R> for Continue<'_, '_, '_, R> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let Self { stage, vertices, state, sample, pdf } = self;
        state.request = match &mut state.algorithm {
            AlgorithmState::Path(path) => path.scatter(stage, vertices, sample, pdf),
            AlgorithmState::AllLights(lights) => lights.wait_for(stage, vertices, sample),
        };
    }
}

/// The vertices of the paths in the lanes.
pub(super) struct Vertices<R: Real> {
    pub rows: Rows<R>,
    /// Their turns.
    pub turns: Rows<R>,
    /// The lanes that have a vertex.
    pub active: R::Mask,
    pub surface: PatchPoints<R>,
    pub wo: Vector3<R>,
    pub time: R,
    pub lambda: SampledWavelengths<R>,
    /// Path throughput before the vertex.
    pub beta: SampledSpectrum<R>,
    pub address: Address<R::Int>,
    footprint: Footprint<R>,
    /// The lanes whose surfaces are roughened.
    is_rough: R::Mask,
    /// The contexts of light sampling.
    pub contexts: LightSampleContext<R>,
}

impl Stage<'_, '_> {
    #[inline(always)]
    fn vertices<R: Real>(&mut self, first: usize, queue: &[u32]) -> Vertices<R> {
        let rows = Rows::<R>::first(queue);
        let turns = Rows::<R>::first(&self.turns[first..first + queue.len()]);
        let (paths, segments) = (&*self.paths, self.segments);
        let surface = self.points.get(first);
        let footprint = if self.with_footprint {
            segments.footprint(self.pass.pixels.view, turns, &surface)
        } else {
            Footprint::point()
        };
        let mut rough = 0;
        if self.surfaces.regularizes() {
            for (lane, &row) in queue.iter().enumerate() {
                rough |= u32::from(paths.rough_before[row as usize]) << lane;
            }
        }
        let PatchPoints { p, n, ns, .. } = surface;
        let time = R::gather(&segments.time, turns.indices);
        Vertices {
            rows,
            turns,
            active: rows.active,
            surface,
            wo: -segments.direction.vector(turns).normalize(),
            time,
            lambda: paths.lambda_lanes(rows),
            beta: segments.beta.get(turns),
            address: paths.address(rows, self.pass.pixels.index),
            footprint,
            is_rough: R::Mask::from_bits(rough),
            contexts: LightSampleContext { p, n, ns, time },
        }
    }

    /// Stores wavelengths whose densities the material has changed.
    #[inline(always)]
    fn keep_wavelengths<R: Real>(&mut self, vertices: &Vertices<R>, lambda: &SampledWavelengths<R>) {
        let changed = lambda.pdf()[0].ne(vertices.lambda.pdf()[0]) & vertices.active;
        if changed.any() {
            vertices.rows.each_of(changed, |lane, row| self.paths.set_lambda(row, &lambda.lane(lane)));
        }
    }

    /// The differentials of the ray that the specular sample of a lane makes of that of a turn, if
    /// this has any.
    pub fn scattered_differentials<R: Real>(
        &self,
        turn: usize,
        sample: &BsdfSample<R>,
        lane: usize,
    ) -> Option<Differentials> {
        if !self.segments.has_differentials(turn as u32) {
            return None;
        }
        let PixelSamples { scene, view, .. } = *self.pass.pixels;
        let lobe = if sample.flags.is_reflective().bits() >> lane & 1 == 1 {
            BxdfFlags::SPECULAR_REFLECTION
        } else {
            BxdfFlags::SPECULAR_TRANSMISSION
        };
        let wi = sample.wi.to_array().each(|coordinate| coordinate.lane(lane));
        let scattered = BsdfSample {
            eta: sample.eta.lane(lane),
            ..BsdfSample::new(SampledSpectrum::zero(), Vec3::from_array(wi), 0.0, lobe)
        };
        let hit = self.hits.get(turn).expect("invariant: vertices have hits");
        scene.scattered_differentials(view, (&self.segments.state(turn).ray, &hit), &scattered)
    }
}

impl<R: Real> Vertices<R> {
    /// As in `transport/direct.rs`, points that scatter to one side only are offset to the side of
    /// `wo` for light sampling.
    #[inline(always)]
    fn offset_contexts(&mut self, flags: &BxdfFlags<R>) {
        let PatchPoints { p, n, .. } = self.surface;
        let (reflects, transmits) = (flags.is_reflective(), flags.is_transmissive());
        let one_sided = reflects ^ transmits;
        let side: Normal3<R> = Vec3::select(reflects, self.wo, -self.wo);
        let moved = Point3Error::exact(offset_ray_origin(p, n, side));
        self.contexts.p = Point3Error::new(
            Vec3::select(one_sided, moved.p, p.p),
            Vec3::select(one_sided, moved.error, p.error),
        );
    }
}
