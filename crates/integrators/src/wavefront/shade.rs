//! Shading in lanes: the vertices of hits and their BSDFs.
//!
//! A kernel of each material evaluates and samples BSDFs. The steps of algorithms at vertices do
//! not depend on materials: they are functions of the lanes, compiled once for each instruction
//! set, which [request](Request) of a kernel one value or sample after another.

use geometry::{HitColumns, PatchPoints, PointColumns};
use lanes::{Callee, Each, Int, Kernel, Mask, Real};
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
pub(super) enum Algorithm<'b> {
    Path(&'b Path),
    /// Path tracing at the boundaries of bodies.
    Boundaries(&'b Path),
    AllLights(&'b AllLights),
}

impl Algorithm<'_> {
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
    pub algorithm: Algorithm<'b>,
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
        let Place { rows, turns } = stage.place::<R>(first);
        let surface: PatchPoints<R> = stage.points.get(first);
        let (wo, before) = (stage.outgoing(turns), stage.paths.lambda_lanes(rows));
        let footprint = if stage.with_footprint {
            R::call(FootprintAt { stage, turns, surface: &surface })
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
                Request::Sample((uc, u), directions) => {
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

/// Paths, and the turns of their hits.
struct Place<R: Real> {
    rows: Rows<R>,
    turns: Rows<R>,
}

/// The footprints of pixels at surface points.
struct FootprintAt<'a, 'b, 'c, R: Real> {
    stage: &'c Stage<'a, 'b>,
    turns: Rows<R>,
    surface: &'c PatchPoints<R>,
}

impl<R: Real> Callee<R> for FootprintAt<'_, '_, '_, R> {
    type Output = Footprint<R>;

    #[inline(always)]
    fn run(self) -> Footprint<R> {
        let Self { stage, turns, surface } = self;
        stage.segments.footprint(stage.pass.pixels.view, turns, surface)
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
        let mut vertices = stage.vertices::<R>(first, (*wo, *lambda), flags);
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

/// The vertices of the paths in the lanes.
pub(super) struct Vertices<R: Real> {
    pub rows: Rows<R>,
    /// Their turns.
    pub turns: Rows<R>,
    /// The lanes that have a vertex.
    pub active: R::Mask,
    pub p: Point3Error<R>,
    /// Geometric and shading normal.
    pub n: Normal3<R>,
    pub ns: Normal3<R>,
    pub wo: Vector3<R>,
    pub time: R,
    pub lambda: SampledWavelengths<R>,
    /// Path throughput before the vertex.
    pub beta: SampledSpectrum<R>,
    pub address: Address<R::Int>,
    /// Where lights are sampled from.
    origin: Point3Error<R>,
}

impl<R: Real> Vertices<R> {
    /// The contexts of light sampling.
    #[inline(always)]
    pub fn contexts(&self) -> LightSampleContext<R> {
        LightSampleContext { p: self.origin, n: self.n, ns: self.ns, time: self.time }
    }
}

impl Stage<'_, '_> {
    #[inline(always)]
    fn place<R: Real>(&self, first: usize) -> Place<R> {
        Place { rows: Rows::first(&self.rows[first..]), turns: Rows::first(&self.turns[first..]) }
    }

    /// The directions back along the rays.
    #[inline(always)]
    fn outgoing<R: Real>(&self, turns: Rows<R>) -> Vector3<R> {
        -self.segments.direction.vector(turns).normalize()
    }

    /// The lanes whose paths have been scattered by a rough surface.
    #[inline(always)]
    fn rough_before<R: Real>(&self, first: usize) -> R::Mask {
        let (mut bits, end) = (0, self.rows.len().min(first + R::LANES));
        for (lane, &row) in self.rows[first..end].iter().enumerate() {
            bits |= u32::from(self.paths.rough_before[row as usize]) << lane;
        }
        R::Mask::from_bits(bits)
    }

    /// The vertices of BSDFs with these flags. As in `transport/direct.rs`, lights are sampled from
    /// points that are offset to the side of `wo` where they scatter to one side only.
    #[inline(always)]
    fn vertices<R: Real>(
        &self,
        first: usize,
        (wo, lambda): (Vector3<R>, SampledWavelengths<R>),
        flags: &BxdfFlags<R>,
    ) -> Vertices<R> {
        let Place { rows, turns } = self.place::<R>(first);
        let PatchPoints { p, n, ns, .. } = self.points.get(first);
        let (reflects, transmits) = (flags.is_reflective(), flags.is_transmissive());
        let one_sided = reflects ^ transmits;
        let side: Normal3<R> = Vec3::select(reflects, wo, -wo);
        let moved = Point3Error::exact(offset_ray_origin(p, n, side));
        Vertices {
            rows,
            turns,
            active: rows.active,
            p,
            n,
            ns,
            wo,
            time: R::gather(&self.segments.time, turns.indices),
            lambda,
            beta: self.segments.beta.get(turns),
            address: self.paths.address(rows, self.pass.pixels.index),
            origin: Point3Error::new(
                Vec3::select(one_sided, moved.p, p.p),
                Vec3::select(one_sided, moved.error, p.error),
            ),
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
