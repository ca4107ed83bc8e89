//! What paths have where there are media.
//!
//! Densities are divided by the mean of r_u ([`SpectralMis`]): β is then the estimate itself, and
//! the density of a path's ray is 1 over the mean of r_l, so that stages that meet lights need not
//! know of media.

use lanes::{Int, Real};
use math::{Normal3, Point3, Vector3};
use scattering::HenyeyGreenstein;
use scene::Scene;
use scene::material::{Material, MaterialEntry};
use scene::medium::{MediumId, MediumInterface};
use spectrum::SampledSpectrum;

use super::float_columns::FloatColumn;
use super::indices::HitIndices;
use super::spectrum_column::SpectrumColumn;
use crate::transport::media::{Heroes, SpectralMis};

/// The media of a scene, as lanes look them up.
#[derive(Clone, Debug, Default)]
pub(super) struct LaneMedia {
    /// For each geometry the media inside and outside of it, or [`SAME`](Self::SAME).
    sides: Vec<[u32; 2]>,
    /// Whether there are interfaces, which shadow rays pass.
    pub has_interfaces: bool,
}

impl LaneMedia {
    /// In place of media that do not change at a surface.
    const SAME: u32 = u32::MAX;

    pub fn new(scene: &Scene) -> Self {
        let sides = scene.geometries().iter().map(|entry| {
            let media = entry.media.filter(MediumInterface::is_transition);
            media.map_or([Self::SAME; 2], |media| [media.inside, media.outside].map(number))
        });
        let is_interface = |entry: &MaterialEntry| matches!(entry.material, Material::Interface);
        Self { sides: sides.collect(), has_interfaces: scene.materials().iter().any(is_interface) }
    }
}

/// A medium as a number: 0 is empty space.
fn number(medium: Option<MediumId>) -> u32 {
    medium.map_or(0, |MediumId(id)| id + 1)
}

/// The medium of a number.
pub(super) fn medium(number: u32) -> Option<MediumId> {
    number.checked_sub(1).map(MediumId)
}

/// Columns that [`SegmentColumns`] have besides where there are media.
#[derive(Default)]
pub(super) struct MediaColumns {
    /// The media of the rays, as numbers.
    medium: Vec<u32>,
    /// As of [`SpectralMis`].
    r_u: SpectrumColumn,
    r_l: SpectrumColumn,
}

impl MediaColumns {
    /// Makes room for as many paths, whatever they have.
    pub fn grow(&mut self, len: usize) {
        self.medium.resize(len, 0);
        self.r_u.grow(len);
        self.r_l.grow(len);
    }

    /// Lets all paths begin in a medium.
    pub fn begin_in(&mut self, medium: Option<MediumId>) {
        let len = self.medium.len();
        self.medium.fill(number(medium));
        self.r_u.fill(len, 1.0);
        self.r_l.fill(len, 1.0);
    }

    /// The medium of a path.
    pub fn medium(&self, hit_index: usize) -> Option<MediumId> {
        medium(self.medium[hit_index])
    }

    /// The weights of a path that has these heroes.
    pub fn spectral(&self, hit_index: usize, heroes: Heroes) -> SpectralMis {
        SpectralMis { heroes, r_u: self.r_u.row(hit_index), r_l: self.r_l.row(hit_index) }
    }

    /// Copies a path.
    pub fn copy(&mut self, hit_index: usize, from: &Self, from_index: usize) {
        self.medium[hit_index] = from.medium[from_index];
        self.r_u.set_row(hit_index, from.r_u.row(from_index));
        self.r_l.set_row(hit_index, from.r_l.row(from_index));
    }

    /// Changes a path.
    pub fn set(&mut self, hit_index: usize, medium: Option<MediumId>, spectral: &SpectralMis) {
        self.medium[hit_index] = number(medium);
        self.r_u.set_row(hit_index, spectral.r_u);
        self.r_l.set_row(hit_index, spectral.r_l);
    }

    /// The media of paths, and r_u.
    #[inline(always)]
    pub fn at<R: Real>(&self, hit_indices: HitIndices<R>) -> (R::Int, SampledSpectrum<R>) {
        (R::Int::gather(&self.medium, hit_indices.indices), self.r_u.get(hit_indices))
    }

    /// Changes successive paths to those of a mask's lanes.
    #[inline(always)]
    pub fn compress<R: Real>(&mut self, hit_index: usize, mask: R::Mask, segment: &SegmentInMedia<R>) {
        segment.medium.compress(mask, &mut self.medium[hit_index..]);
        self.r_u.compress(hit_index, mask, segment.r_u);
        self.r_l.compress(hit_index, mask, segment.r_l);
    }
}

/// What a segment in lanes has besides.
pub(super) struct SegmentInMedia<R: Real> {
    pub medium: R::Int,
    pub r_u: SampledSpectrum<R>,
    pub r_l: SampledSpectrum<R>,
}

/// Vertices in lanes, where there are media.
#[derive(Clone, Copy)]
pub(super) struct VerticesInMedia<R: Real> {
    /// The media on the two sides of the surface.
    inside: R::Int,
    outside: R::Int,
    /// Density of the path up to the vertex at each wavelength.
    pub r_u: SampledSpectrum<R>,
}

impl<R: Real> VerticesInMedia<R> {
    /// At hits of geometries. Where dispersion has `terminated` the other wavelengths, the first
    /// goes on alone.
    #[inline(always)]
    pub fn new(
        media: &LaneMedia,
        columns: &MediaColumns,
        hit_indices: HitIndices<R>,
        geometries: &[u32],
        terminated: R::Mask,
    ) -> Self {
        let (before, r_u) = columns.at(hit_indices);
        let geometry = R::Int::gather(geometries, hit_indices.indices);
        let [inside, outside] = R::Int::gather_rows(media.sides.as_flattened(), geometry.shl(1));
        let is_same = inside.eq(R::Int::splat(LaneMedia::SAME));
        Self {
            inside: R::Int::select(is_same, before, inside),
            outside: R::Int::select(is_same, before, outside),
            r_u: SampledSpectrum::select(terminated, SampledSpectrum::splat(R::one()), r_u),
        }
    }

    /// The media of rays that leave along `w` surfaces with normals `n`.
    #[inline(always)]
    pub fn towards(&self, w: Vector3<R>, n: Normal3<R>) -> R::Int {
        R::Int::select(w.dot(n).gt(R::zero()), self.outside, self.inside)
    }

    /// What segments that leave along `wi` have, in directions of the density `pdf`.
    #[inline(always)]
    pub fn leave(&self, wi: Vector3<R>, n: Normal3<R>, pdf: R) -> SegmentInMedia<R> {
        SegmentInMedia { medium: self.towards(wi, n), r_u: self.r_u, r_l: self.r_u / pdf }
    }
}

/// Where paths have been scattered by media.
#[derive(Default)]
pub(super) struct MediumVertices {
    /// The indices of the paths' hits.
    pub hit_indices: Vec<u32>,
    pub p: [FloatColumn; 3],
    /// The asymmetry of the phase function.
    pub g: FloatColumn,
}

impl MediumVertices {
    pub fn push(&mut self, hit_index: usize, p: Point3, phase: HenyeyGreenstein) {
        self.hit_indices.push(hit_index as u32);
        self.p.iter_mut().zip(p.to_array()).for_each(|(column, x)| column.push(x));
        self.g.push(phase.g);
    }

    pub fn is_empty(&self) -> bool {
        self.hit_indices.is_empty()
    }

    pub fn clear(&mut self) {
        self.hit_indices.clear();
        self.p.iter_mut().for_each(Vec::clear);
        self.g.clear();
    }
}
