//! Vertices of subpaths.

use film::FirstEvent;
use math::{Normal3, Point3Error, Ray, Vector3};
use scattering::{Body, Bsdf, BsdfSample, BxdfFlags, TransportMode};
use scene::light::{LightId, LightSampleContext};
use scene::medium::{MediumId, MediumInterface};
use spectrum::SampledSpectrum;

use super::{Law, Merges, Partial};
use crate::transport::parts::{DIFFUSE, event_at, event_of};
use crate::transport::vertex::on_its_side;
use crate::transport::{ShadowRay, Tracer};

/// A vertex of a subpath.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<'a> {
    /// Position.
    pub p: Point3Error,
    /// Geometric normal; zero in a medium.
    pub n: Normal3,
    /// Unit direction to the previous vertex.
    pub wo: Vector3,
    /// Time, in the scene's units.
    pub time: f32,
    /// How it scatters.
    pub law: Law<'a>,
    /// The medium in which the subpath arrived.
    pub medium: Option<MediumId>,
    /// The media on the two sides of the surface, if they differ.
    pub media: Option<MediumInterface>,
    /// The normal of the front face, if the camera sees the surface from there alone; else zero.
    pub front: Normal3,
    /// The probability with which a ray hits the surface there; in a medium, that of a collision
    /// over the length of the merging ball, 4r/3.
    pub alpha: f32,
    /// The factor that the throughput has from there being a surface or a collision at all: `alpha`
    /// of a surface, or the coefficient of scattering.
    pub presence: SampledSpectrum,
    /// Throughput: importance (from the camera) or power (from a light) that arrives along `wo`,
    /// over the density of the subpath.
    pub beta: SampledSpectrum,
    /// Whether all wavelengths but the first are terminated.
    pub hero_only: bool,
    /// Partial MIS weights.
    pub partial: Partial,
    /// Scattering events on the subpath, this one included.
    pub depth: u32,
    /// Whether an earlier vertex of the subpath is diffuse.
    pub after_diffuse: bool,
    /// The light at which the subpath began, if it did.
    pub light: Option<LightId>,
    /// The event by which a camera subpath left its first vertex, where somebody takes parts of the
    /// light.
    pub first: FirstEvent,
    /// Whether the subpath began in a medium that emits.
    pub begins_in_medium: bool,
    /// Whether the subpath leaves a body there, under the surface of which it went.
    pub is_exit: bool,
    /// Whether the subpath carries radiance or importance.
    pub mode: TransportMode,
}

impl<'a> Vertex<'a> {
    /// The lobes of its law.
    #[inline]
    pub fn flags(&self) -> BxdfFlags {
        self.law.flags()
    }

    /// The shading normal; zero in a medium.
    #[inline]
    pub fn ns(&self) -> Normal3 {
        match &self.law {
            Law::Surface(bsdf) => bsdf.frame.z,
            Law::Medium(_) => Normal3::ZERO,
        }
    }

    /// Whether it lies in a medium.
    #[inline]
    pub fn is_in_medium(&self) -> bool {
        matches!(self.law, Law::Medium(_))
    }

    /// The medium of a ray that leaves along `w`.
    #[inline]
    pub fn medium_towards(&self, w: Vector3) -> Option<MediumId> {
        self.media.map_or(self.medium, |media| media.towards(w, self.n))
    }

    /// The context for sampling lights from it.
    #[inline]
    pub fn light_context(&self) -> LightSampleContext {
        let context = LightSampleContext { p: self.p, n: self.n, ns: self.ns(), time: self.time };
        on_its_side(context, self.wo, &self.flags())
    }

    /// Whether other vertices can be connected to it.
    #[inline]
    pub fn is_connectible(&self) -> bool {
        self.flags().is_non_specular()
    }

    /// Whether it can be merged with a vertex of the other kind of subpath: not the first vertex of
    /// a light subpath from a light, nor those of a camera subpath beyond a diffuse surface.
    #[inline]
    pub fn can_merge(&self) -> bool {
        match self.mode {
            TransportMode::Radiance => !self.after_diffuse,
            TransportMode::Importance => self.depth > 1 || self.begins_in_medium,
        }
    }

    /// The body under its surface, if the subpath comes from outside.
    #[inline]
    pub fn body(&self) -> Option<Body<'_, 'a>> {
        match &self.law {
            Law::Surface(Bsdf { bxdf, frame }) if !self.is_exit && self.wo.dot(frame.z) > 0.0 => bxdf.body(),
            _ => None,
        }
    }

    /// Whether photons are stored there: where the lobes, or that by which a camera subpath leaves
    /// the body, are not all specular. A light subpath that emerges has not arrived by a ray.
    #[inline]
    pub fn takes_photons(&self) -> bool {
        !self.is_exit && (self.is_connectible() || self.body().is_some())
    }

    /// Whether it has a diffuse lobe, no specular one and no body under it, or lies in a medium:
    /// camera subpaths merge no further.
    #[inline]
    pub fn is_diffuse(&self) -> bool {
        let flags = self.flags();
        flags.is_diffuse() && !flags.is_specular() && self.body().is_none()
    }

    /// The merges at the vertex and before it on the subpath.
    #[inline]
    pub fn merges(&self) -> Merges {
        let before = self.mode == TransportMode::Radiance || !self.is_diffuse();
        Merges { here: if self.can_merge() { self.alpha } else { 0.0 }, before }
    }

    /// The power of the photon of a light subpath, divided by `presence`: only the share `alpha` of
    /// light subpaths hits the surface, or σ_s per length is scattered, but the camera subpath with
    /// which the photon is merged has been there already.
    #[inline]
    pub fn photon_beta(&self) -> SampledSpectrum {
        self.beta.safe_div(self.presence)
    }

    /// `beta` times the law and its cosine: the throughput that leaves along `wi`, per solid
    /// angle.
    #[inline]
    pub fn scattered(&self, wi: Vector3) -> SampledSpectrum {
        self.beta * self.law.f(self.wo, wi, self.mode) * self.cosine(wi)
    }

    /// The cosine that scattering towards `wi` is multiplied by: with the shading normal, and for
    /// light with the correction that keeps its energy ([Veach 1997 §5.3.2]); 1 in a medium.
    #[inline]
    pub fn cosine(&self, wi: Vector3) -> f32 {
        let Law::Surface(bsdf) = &self.law else { return 1.0 };
        let ns = bsdf.frame.z;
        match self.mode {
            TransportMode::Radiance => wi.dot(ns).abs(),
            TransportMode::Importance => {
                let cos_wo = self.wo.dot(self.n).abs();
                if cos_wo == 0.0 { 0.0 } else { (self.wo.dot(ns) * wi.dot(self.n)).abs() / cos_wo }
            }
        }
    }

    /// The event next to the camera of a path that leaves this subpath along `wi`, where the tracer
    /// takes parts of the light: at this vertex, unless it is a later one of a camera subpath.
    pub fn first_event(&self, wi: Vector3, tracer: &Tracer) -> FirstEvent {
        let is_first = self.mode == TransportMode::Importance || self.depth == 1;
        match &self.law {
            _ if !tracer.takes_parts() => FirstEvent::None,
            _ if !is_first => self.first,
            _ if self.is_exit => DIFFUSE,
            Law::Surface(bsdf) if self.mode == TransportMode::Importance => event_at(bsdf, wi, self.wo),
            Law::Surface(bsdf) => event_at(bsdf, self.wo, wi),
            Law::Medium(_) => FirstEvent::Volume,
        }
    }

    /// The same for a camera subpath that goes on by a sample of its law.
    pub fn first_event_of(&self, sample: &BsdfSample, tracer: &Tracer) -> FirstEvent {
        match &self.law {
            Law::Surface(bsdf) if tracer.takes_parts() && self.depth == 1 && !self.is_exit => {
                event_of(bsdf, self.wo, sample)
            }
            _ => self.first_event(sample.wi, tracer),
        }
    }

    /// Density per solid angle with which this subpath continues along `wi`.
    #[inline]
    pub fn pdf(&self, wi: Vector3) -> f32 {
        self.law.pdf(self.wo, wi, self.mode)
    }

    /// Density per solid angle with which a subpath of the other kind that comes from `wi`
    /// continues along `wo`.
    #[inline]
    pub fn pdf_back(&self, wi: Vector3) -> f32 {
        self.law.pdf(wi, self.wo, !self.mode)
    }

    /// |cos| of a direction to the geometric normal; 1 in a medium.
    #[inline]
    pub fn cos_theta(&self, w: Vector3) -> f32 {
        if self.is_in_medium() { 1.0 } else { self.n.dot(w).abs() }
    }

    /// The shadow ray to another point, with the normal of its surface if there is one.
    #[inline]
    pub fn shadow_ray_to(&self, p: Point3Error, n: Normal3) -> ShadowRay {
        ShadowRay { ray: Ray::between(self.p, self.n, p, n, self.time), t_max: Ray::SHADOW_END }
    }
}
