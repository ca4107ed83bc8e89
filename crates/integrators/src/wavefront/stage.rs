//! The state that the steps of algorithms at vertices in lanes share with kernels of materials.

use geometry::{HitColumns, PatchPoints, PointColumns};
use lanes::{Each, MAX_LANES, Mask, Real};
use math::{Differentials, Normal3, Point3Error, Vec3, Vector3};
use sampling::sampler::Address;
use scattering::{BsdfSample, BxdfFlags, Directions};
use scene::light::LightSampleContext;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::all_lights::AllLights;
use super::indices::{HitIndices, Indices, PathIndices};
use super::lights::Samples;
use super::numbers::SampleNumbers;
use super::pass::Pass;
use super::path_columns::PathColumns;
use super::queues::Queues;
use super::segment_columns::SegmentColumns;
use crate::Path;
use crate::transport::pixel_samples::PixelSamples;
use crate::transport::vertex::on_its_side;

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
    pub fn weighs(self) -> bool {
        !matches!(self, Self::AllLights(_))
    }
}

/// A question of an algorithm about the BSDFs at vertices, in each lane.
pub(super) enum Request<R> {
    /// The value in a direction.
    Value(Vector3<R>),
    /// A sample by these numbers.
    Sample(SampleNumbers<R>, Directions),
    /// None: it is done.
    Nothing,
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
    pub hit_indices: &'b [u32],
    pub rows: &'b [u32],
    pub segments: &'b SegmentColumns,
    pub paths: &'b mut PathColumns,
    pub queues: &'b mut Queues,
    pub light_samples: &'b mut Samples,
}

/// Paths, and their hits.
pub(super) struct Place<R: Real> {
    pub rows: PathIndices<R>,
    pub hit_indices: HitIndices<R>,
}

/// The vertices of the paths in the lanes.
pub(super) struct Vertices<R: Real> {
    pub rows: PathIndices<R>,
    /// Their hits.
    pub hit_indices: HitIndices<R>,
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
    pub fn place<R: Real>(&self, first: usize) -> Place<R> {
        Place {
            rows: Indices::first(&self.rows[first..]),
            hit_indices: Indices::first(&self.hit_indices[first..]),
        }
    }

    /// The directions back along the rays.
    #[inline(always)]
    pub fn outgoing<R: Real>(&self, hit_indices: HitIndices<R>) -> Vector3<R> {
        -self.segments.direction.vector(hit_indices).normalize()
    }

    /// The lanes whose paths have been scattered by a rough surface.
    #[inline(always)]
    pub fn rough_before<R: Real>(&self, first: usize) -> R::Mask {
        let (mut bits, end) = (0, self.rows.len().min(first + R::LANES));
        for (lane, &row) in self.rows[first..end].iter().enumerate() {
            bits |= u32::from(self.paths.rough_before[row as usize]) << lane;
        }
        R::Mask::from_bits(bits)
    }

    /// The vertices of BSDFs with these flags.
    #[inline(always)]
    pub fn vertices<R: Real>(
        &self,
        first: usize,
        wo: Vector3<R>,
        lambda: SampledWavelengths<R>,
        flags: &BxdfFlags<R>,
    ) -> Vertices<R> {
        let Place { rows, hit_indices } = self.place::<R>(first);
        let PatchPoints { p, n, ns, .. } = self.points.get(first);
        let time = R::gather(&self.segments.time, hit_indices.indices);
        Vertices {
            rows,
            hit_indices,
            active: rows.active,
            p,
            n,
            ns,
            wo,
            time,
            lambda,
            beta: self.segments.beta.get(hit_indices),
            address: self.paths.address(rows, self.pass.pixels.index),
            origin: on_its_side(LightSampleContext { p, n, ns, time }, wo, flags).p,
        }
    }

    /// The differentials of the ray that a specular sample makes of that of a hit, if this has
    /// any.
    pub fn scattered_differentials(&self, hit_index: usize, sample: &BsdfSample) -> Option<Differentials> {
        if !self.segments.has_differentials(hit_index as u32) {
            return None;
        }
        let PixelSamples { scene, view, .. } = *self.pass.pixels;
        let hit = self.hits.get(hit_index).expect("invariant: vertices have hits");
        scene.scattered_differentials(view, &self.segments.state(hit_index).ray, &hit, sample)
    }
}

/// Specular samples in lanes, out of their registers, to be read one by one.
pub(super) struct SpecularSamples {
    wi: [[f32; MAX_LANES]; 3],
    eta: [f32; MAX_LANES],
    reflective: u32,
}

impl SpecularSamples {
    #[inline(always)]
    pub fn of<R: Real>(sample: &BsdfSample<R>) -> Self {
        Self {
            wi: sample.wi.to_array().each(R::to_array),
            eta: sample.eta.to_array(),
            reflective: sample.flags.is_reflective().bits(),
        }
    }

    /// The direction, relative index of refraction and lobe of a lane's sample.
    pub fn at(&self, lane: usize) -> BsdfSample {
        let lobe = if self.reflective >> lane & 1 == 1 {
            BxdfFlags::SPECULAR_REFLECTION
        } else {
            BxdfFlags::SPECULAR_TRANSMISSION
        };
        let wi = Vec3::from_array(self.wi.each(|lanes| lanes[lane]));
        BsdfSample { eta: self.eta[lane], ..BsdfSample::new(SampledSpectrum::zero(), wi, 0.0, lobe) }
    }
}
