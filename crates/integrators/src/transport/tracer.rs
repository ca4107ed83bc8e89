//! Tracing the rays of a sample.

use film::{FirstEvent, Parts};
use geometry::{Hit, RayStats};
use math::{Ray, RayDifferential};
use sampling::Sampler;
use scattering::{Bsdf, Bxdf};
use scene::light::LightId;
use scene::{Scene, SurfaceInteraction, View};
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::Step;
use super::parts::group_of;
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
    /// Takes the parts of the sample's radiance, where the film has layers of them.
    parts: Option<&'a mut Parts>,
    /// Takes the steps of the sample, where somebody wants to see them.
    steps: Option<&'a mut Vec<Step>>,
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
        Self { scene, view, sampler, stats, control, is_cancelled: false, parts: None, steps: None }
    }

    /// The same, which also takes the parts of the sample's radiance.
    pub(crate) fn with_parts(self, parts: Option<&'a mut Parts>) -> Self {
        Self { parts, ..self }
    }

    /// The same, which also takes the steps of the sample.
    pub(crate) fn with_steps(self, steps: &'a mut Vec<Step>) -> Self {
        Self { steps: Some(steps), ..self }
    }

    /// Takes a step of the sample.
    #[inline]
    pub(crate) fn take_step(&mut self, step: impl FnOnce(&Scene) -> Step) {
        if let Some(steps) = &mut self.steps {
            steps.push(step(self.scene));
        }
    }

    /// Whether the parts of the sample's radiance are taken.
    #[inline]
    pub(crate) fn takes_parts(&self) -> bool {
        self.parts.is_some() || self.steps.is_some()
    }

    /// Takes a part of the sample's radiance: that of a path with this first event and number of
    /// scattering events from a light, or from a medium.
    #[inline]
    pub(crate) fn take_part(
        &mut self,
        light: Option<LightId>,
        first: &FirstEvent,
        events: u32,
        l: SampledSpectrum,
    ) {
        if let Some(parts) = &mut self.parts {
            parts.add(l, group_of(self.scene, light), first, events);
        }
        if !l.is_black() {
            self.take_step(|_| Step::Light { light, events, l });
        }
    }

    /// Multiplies the parts of the sample's radiance.
    pub(crate) fn scale_parts(&mut self, factor: f32) {
        self.parts.iter_mut().for_each(|parts| parts.scale(factor));
    }

    /// Traces a part of the sample with another sampler.
    pub fn with_sampler<T>(&mut self, sampler: &mut Sampler, trace: impl FnOnce(&mut Tracer) -> T) -> T {
        let Self { scene, view, control, is_cancelled, .. } = *self;
        let parts = self.parts.as_deref_mut();
        let steps = self.steps.as_deref_mut();
        let stats = &mut *self.stats;
        let mut part = Tracer { scene, view, sampler, stats, control, is_cancelled, parts, steps };
        let found = trace(&mut part);
        self.is_cancelled = part.is_cancelled;
        found
    }

    /// Traces rays that are not the sample's, with another sampler.
    pub(crate) fn apart<T>(&mut self, sampler: &mut Sampler, trace: impl FnOnce(&mut Tracer) -> T) -> T {
        let mut apart = Tracer::new(self.scene, self.view, self.control, sampler, &mut *self.stats);
        let found = trace(&mut apart);
        self.is_cancelled |= apart.is_cancelled;
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
        let (hit, surface) = self.surface(ray)?;
        Some((surface, hit.t))
    }

    /// The nearest surface that a ray hits, and the hit.
    #[inline]
    pub(crate) fn surface(&mut self, ray: &Ray) -> Option<(Hit, SurfaceInteraction)> {
        if !self.may_trace() {
            return None;
        }
        let scene = self.scene;
        let hit = scene.hit(ray, f32::INFINITY, self.stats);
        self.take_step(|scene| {
            let hit = hit.as_ref().map(|hit| {
                let [object, _] = scene.names().object(hit);
                (hit.t, object)
            });
            Step::Ray { ray: *ray, hit }
        });
        let hit = hit?;
        let surface = scene.interaction(&hit, scene.world().surface(ray, &hit));
        Some((hit, surface))
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
        let bsdf = self.scene.bsdf(self.view, surface, ray, lambda, self.sampler)?;
        self.take_step(|_| {
            let (point, material) = (&surface.surface, surface.material);
            let (p, n, wo) = (point.p.p, point.shading.n, point.wo);
            Step::Surface { p, n, wo, material, lobes: bsdf.flags() }
        });
        Some(bsdf)
    }
}
