//! Tracing the rays of a sample.

use geometry::{Hit, RayStats};
use math::{Ray, RayDifferential};
use sampling::Sampler;
use scattering::{Bsdf, Bxdf};
use scene::{Scene, SurfaceInteraction, View};
use spectrum::SampledWavelengths;

use crate::{Cancelled, Control};

/// Traces the rays of a sample, on one thread.
///
/// After the render is cancelled rays hit nothing, so that every path ends at its next vertex. The
/// estimate is then incomplete, which [`finish`](Self::finish) reports.
pub struct Tracer<'a> {
    /// The scene.
    pub scene: &'a Scene,
    /// The view that is rendered.
    pub view: &'a View,
    /// The random numbers of the sample.
    pub sampler: &'a mut Sampler,
    /// Counts rays, and what they hit.
    pub stats: &'a mut RayStats,
    control: &'a Control,
    is_cancelled: bool,
}

impl<'a> Tracer<'a> {
    /// For the current sample of `sampler`.
    pub fn new(
        scene: &'a Scene,
        view: &'a View,
        control: &'a Control,
        sampler: &'a mut Sampler,
        stats: &'a mut RayStats,
    ) -> Self {
        Self { scene, view, sampler, stats, control, is_cancelled: false }
    }

    /// Traces a part of the sample with another sampler.
    pub fn with_sampler<T>(&mut self, sampler: &mut Sampler, trace: impl FnOnce(&mut Tracer) -> T) -> T {
        let Self { scene, view, control, is_cancelled, .. } = *self;
        let mut part = Tracer { scene, view, sampler, stats: self.stats, control, is_cancelled };
        let found = trace(&mut part);
        self.is_cancelled = part.is_cancelled;
        found
    }

    /// `Err` if rays of the sample were not traced because the render was cancelled: the estimate
    /// has to be discarded.
    pub fn finish(&self) -> Result<(), Cancelled> {
        if self.is_cancelled { Err(Cancelled) } else { Ok(()) }
    }

    /// Whether to trace another ray: `false` after a cancellation.
    #[inline]
    pub(crate) fn may_trace(&mut self) -> bool {
        self.is_cancelled |= self.control.check().is_err();
        !self.is_cancelled
    }

    /// The nearest surface that a ray hits, and its distance.
    #[inline]
    pub fn intersect(&mut self, ray: &Ray) -> Option<(SurfaceInteraction, f32)> {
        if self.may_trace() { self.scene.intersect(ray, f32::INFINITY, self.stats) } else { None }
    }

    /// The nearest hit of a ray.
    #[inline]
    pub fn hit(&mut self, ray: &Ray) -> Option<Hit> {
        if self.may_trace() { self.scene.hit(ray, f32::INFINITY, self.stats) } else { None }
    }

    /// [`Scene::bsdf`] in this view.
    #[inline]
    pub fn bsdf(
        &mut self,
        surface: &mut SurfaceInteraction,
        ray: &RayDifferential,
        lambda: &mut SampledWavelengths,
    ) -> Option<Bsdf<Bxdf<'a>>> {
        self.scene.bsdf(self.view, surface, ray, lambda, self.sampler)
    }
}
