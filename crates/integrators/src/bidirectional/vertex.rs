//! Vertices of subpaths.

use math::{Normal3, Point3Error, Ray, Vector3};
use scattering::{Bsdf, Bxdf, TransportMode};
use scene::light::LightSampleContext;
use spectrum::SampledSpectrum;

use super::{Merges, Partial};
use crate::transport::direct::on_its_side;

/// A vertex of a subpath on a surface.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<'a> {
    /// Position.
    pub p: Point3Error,
    /// Geometric normal.
    pub n: Normal3,
    /// Unit direction to the previous vertex.
    pub wo: Vector3,
    /// Time, in the scene's units.
    pub time: f32,
    /// The BSDF.
    pub bsdf: Bsdf<Bxdf<'a>>,
    /// The probability with which a ray hits the surface there.
    pub alpha: f32,
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
    /// Whether the subpath carries radiance or importance.
    pub mode: TransportMode,
}

impl Vertex<'_> {
    /// The context for sampling lights from it.
    #[inline]
    pub fn light_context(&self) -> LightSampleContext {
        let context = LightSampleContext { p: self.p, n: self.n, ns: self.bsdf.frame.z, time: self.time };
        on_its_side(context, self.wo, self.bsdf.flags())
    }

    /// Whether other vertices can be connected to it.
    #[inline]
    pub fn is_connectible(&self) -> bool {
        self.bsdf.flags().is_non_specular()
    }

    /// Whether it can be merged with a vertex of the other kind of subpath: not the first vertex of
    /// a light subpath, nor those of a camera subpath beyond a diffuse surface.
    #[inline]
    pub fn can_merge(&self) -> bool {
        match self.mode {
            TransportMode::Radiance => !self.after_diffuse,
            TransportMode::Importance => self.depth > 1,
        }
    }

    /// Whether it has a diffuse lobe and no specular one: camera subpaths merge no further.
    #[inline]
    pub fn is_diffuse(&self) -> bool {
        let flags = self.bsdf.flags();
        flags.is_diffuse() && !flags.is_specular()
    }

    /// The merges at the vertex and before it on the subpath.
    #[inline]
    pub fn merges(&self) -> Merges {
        let before = self.mode == TransportMode::Radiance || !self.is_diffuse();
        Merges { here: if self.can_merge() { self.alpha } else { 0.0 }, before }
    }

    /// The power of the photon of a light subpath, divided by `alpha`: only the share `alpha` of
    /// light subpaths hits the surface, but the camera subpath with which the photon is merged has
    /// hit it already.
    #[inline]
    pub fn photon_beta(&self) -> SampledSpectrum {
        self.beta / self.alpha
    }

    /// `beta` times the BSDF and its cosine: the throughput that leaves along `wi`, per solid
    /// angle.
    #[inline]
    pub fn scattered(&self, wi: Vector3) -> SampledSpectrum {
        self.beta * self.bsdf.f(self.wo, wi, self.mode) * self.cosine(wi)
    }

    /// The cosine that scattering towards `wi` is multiplied by: with the shading normal, and for
    /// light with the correction that keeps its energy ([Veach 1997 §5.3.2]).
    #[inline]
    pub fn cosine(&self, wi: Vector3) -> f32 {
        let ns = self.bsdf.frame.z;
        match self.mode {
            TransportMode::Radiance => wi.dot(ns).abs(),
            TransportMode::Importance => {
                let cos_wo = self.wo.dot(self.n).abs();
                if cos_wo == 0.0 { 0.0 } else { (self.wo.dot(ns) * wi.dot(self.n)).abs() / cos_wo }
            }
        }
    }

    /// Density per solid angle with which this subpath continues along `wi`.
    #[inline]
    pub fn pdf(&self, wi: Vector3) -> f32 {
        self.bsdf.pdf(self.wo, wi, self.mode, scattering::Directions::All)
    }

    /// Density per solid angle with which a subpath of the other kind that comes from `wi`
    /// continues along `wo`.
    #[inline]
    pub fn pdf_back(&self, wi: Vector3) -> f32 {
        self.bsdf.pdf(wi, self.wo, !self.mode, scattering::Directions::All)
    }

    /// |cos| of a direction to the geometric normal.
    #[inline]
    pub fn cos_theta(&self, w: Vector3) -> f32 {
        self.n.dot(w).abs()
    }

    /// The ray to another point, with the normal of its surface if there is one; to be traced up to
    /// [`Ray::SHADOW_END`].
    #[inline]
    pub fn ray_to(&self, p: Point3Error, n: Normal3) -> Ray {
        Ray::between(self.p, self.n, p, n, self.time)
    }
}
