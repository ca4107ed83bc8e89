//! What stages hand to each other.

use geometry::RayBuffer;
use lanes::{Int, Mask, Real};
use math::Ray;
use spectrum::SampledSpectrum;

use super::columns::Rows;
use super::media::Passages;
use super::segments::Segments;
use super::spectra::Spectra;
use crate::transport::path_state::PathState;

/// The queues of a batch.
#[derive(Default)]
pub(super) struct Queues {
    /// The paths that go on.
    pub next: Segments,
    /// Hits to be shaded one by one: path, and index of its hit.
    pub scalar: Vec<(u32, u32)>,
    /// Shadow rays; those that interfaces occlude, and those that pass them.
    pub shadows: [ShadowRays; 2],
    /// Those of scenes with media.
    pub passages: Passages,
    /// Rays that wait until their path has no other, the last first; one stack for each path.
    pub waiting: Vec<Vec<PathState>>,
}

impl Queues {
    /// Lets a ray of a path wait.
    pub fn wait(&mut self, path: u32, state: PathState) {
        let path = path as usize;
        if self.waiting.len() <= path {
            self.waiting.resize_with(path + 1, Vec::new);
        }
        self.waiting[path].push(state);
    }
}

/// Shadow rays, and the light that their paths get unless they are occluded.
#[derive(Default)]
pub(super) struct ShadowRays {
    pub paths: Vec<u32>,
    pub l: Spectra,
    pub rays: RayBuffer,
}

/// Shadow rays in lanes.
pub(super) struct Shadow<R: Real> {
    pub l: SampledSpectrum<R>,
    pub ray: Ray<R>,
    pub t_max: R,
}

impl ShadowRays {
    /// Adds a ray.
    pub fn push(&mut self, path: u32, l: SampledSpectrum, ray: &Ray, t_max: f32) {
        self.paths.push(path);
        self.l.push(l);
        self.rays.push(ray, t_max);
    }

    /// Adds the rays of a mask's lanes.
    #[inline(always)]
    pub fn append<R: Real>(&mut self, rows: Rows<R>, mask: R::Mask, shadow: &Shadow<R>) {
        if mask.any() {
            rows.indices.append(mask, &mut self.paths);
            self.l.append(mask, shadow.l);
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
