//! Shading in lanes: the vertices of hits and their BSDFs, where algorithms go on.

use geometry::{HitColumns, PatchPoints, PointColumns};
use lanes::{Kernel, Mask, Real};
use math::{Differentials, Normal3, Point3Error, Vec3, Vector3, offset_ray_origin};
use sampling::sampler::Address;
use scattering::{Bsdf, BsdfSample, BxdfFlags, Scatter};
use scene::Footprint;
use scene::light::LightSampleContext;
use scene::material::MaterialModel;
use scene::texture::TextureContext;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::columns::Rows;
use super::lights::Samples;
use super::pass::Pass;
use super::paths::Paths;
use super::queues::Queues;
use super::segments::Segments;
use crate::transport::pixel_samples::PixelSamples;

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
}

impl<M: MaterialModel, A: AtVertices> Shade<'_, '_, M, A> {
    #[inline(always)]
    fn shade<R: Real>(&mut self, first: usize, queue: &[u32]) {
        let mut vertices = self.vertices::<R>(first, queue);
        let PatchPoints { p, n, ns, uv, ss, .. } = vertices.surface;
        let footprint = if self.with_footprint {
            self.segments.footprint(self.pass.pixels.view, vertices.turns, &vertices.surface)
        } else {
            Footprint::point()
        };
        let context = TextureContext { p: p.p, n, uv, footprint };
        let before = vertices.lambda;
        let textures = self.pass.pixels.scene.textures();
        let bxdf = self.material.bxdf(textures, &context, &mut vertices.lambda);
        self.keep_wavelengths(&vertices, &before);
        let mut bsdf = Bsdf::new(ns, ss, bxdf);
        bsdf.seed(&vertices.lambda, vertices.address.dimension);
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
        let turns = Rows::<R>::first(&self.turns[first..first + queue.len()]);
        let (paths, segments) = (&*self.paths, self.segments);
        Vertices {
            rows,
            turns,
            active: rows.active,
            surface: self.points.get(first),
            wo: -segments.direction.vector(turns).normalize(),
            time: R::gather(&segments.time, turns.indices),
            lambda: paths.lambda_lanes(rows),
            beta: segments.beta.get(turns),
            address: paths.address(rows, self.pass.pixels.index),
        }
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

impl<M, A> Shade<'_, '_, M, A> {
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
        let wi = sample.wi.to_array().map(|coordinate| coordinate.lane(lane));
        let scattered = BsdfSample {
            eta: sample.eta.lane(lane),
            ..BsdfSample::new(SampledSpectrum::zero(), Vec3::from_array(wi), 0.0, lobe)
        };
        let hit = self.hits.get(turn).expect("invariant: vertices have hits");
        scene.scattered_differentials(view, (&self.segments.state(turn).ray, &hit), &scattered)
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
