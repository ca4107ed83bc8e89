//! Shadow rays that wait to be traced.

use geometry::RayBuffer;
use lanes::{Int, Mask, Real};
use spectrum::SampledSpectrum;

use super::float_columns::FloatColumn;
use super::indices::PathIndices;
use super::spectrum_column::SpectrumColumn;
use crate::transport::ShadowRay;

/// Shadow rays, and the light that their paths get unless they are occluded.
#[derive(Default)]
pub(super) struct ShadowRays {
    pub paths: Vec<u32>,
    pub l: SpectrumColumn,
    pub rays: RayBuffer,
}

impl ShadowRays {
    /// Adds a ray.
    pub fn push(&mut self, path: u32, l: SampledSpectrum, shadow: &ShadowRay) {
        self.paths.push(path);
        self.l.push(l);
        self.rays.push(&shadow.ray, shadow.t_max);
    }

    /// Adds the rays of a mask's lanes.
    #[inline(always)]
    pub fn append<R: Real>(
        &mut self,
        rows: PathIndices<R>,
        mask: R::Mask,
        l: SampledSpectrum<R>,
        shadow: &ShadowRay<R>,
    ) {
        if mask.any() {
            rows.indices.append(mask, &mut self.paths);
            self.l.append(mask, l);
            self.rays.append(&shadow.ray, shadow.t_max, mask);
        }
    }

    /// Removes all rays.
    pub fn clear(&mut self) {
        self.paths.clear();
        self.l.clear();
        self.rays.clear();
    }
}

/// Shadow rays in scenes with media.
#[derive(Default)]
pub(super) struct Passages {
    /// The rays, and the light of [`Arrival`].
    pub shadows: ShadowRays,
    /// As of [`Arrival`].
    pub r_u: SpectrumColumn,
    pub ratio: FloatColumn,
    /// The media where they leave their vertices, as numbers.
    pub medium: Vec<u32>,
    /// The dimension of their random numbers.
    pub dimension: Vec<u32>,
}

/// The passages of shadow rays in lanes.
pub(super) struct PassageLanes<R: Real> {
    pub r_u: SampledSpectrum<R>,
    pub ratio: R,
    pub medium: R::Int,
    pub dimension: R::Int,
}

impl Passages {
    /// Adds the rays of a mask's lanes.
    #[inline(always)]
    pub fn append<R: Real>(
        &mut self,
        rows: PathIndices<R>,
        mask: R::Mask,
        l: SampledSpectrum<R>,
        shadow: &ShadowRay<R>,
        lanes: &PassageLanes<R>,
    ) {
        if !mask.any() {
            return;
        }
        self.shadows.append(rows, mask, l, shadow);
        self.r_u.append(mask, lanes.r_u);
        lanes.ratio.append(mask, &mut self.ratio);
        lanes.medium.append(mask, &mut self.medium);
        lanes.dimension.append(mask, &mut self.dimension);
    }

    /// Removes all rays.
    pub fn clear(&mut self) {
        self.shadows.clear();
        self.r_u.clear();
        self.ratio.clear();
        [&mut self.medium, &mut self.dimension].into_iter().for_each(Vec::clear);
    }
}
