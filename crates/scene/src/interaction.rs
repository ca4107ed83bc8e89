//! A surface interaction: the point of a hit with its material, its light and its footprint.
//!
//! Reflections and refractions off smooth surfaces carry ray differentials on ([Igehy 1999]; [Pharr
//! 2023 §10.1.3]).

use crate::footprint::Footprint;
use crate::id::{LightId, MaterialId};
use crate::light::LightSampleContext;
use crate::medium::{MediumId, MediumInterface};
use crate::texture::TextureContext;
use crate::view::View;
use geometry::SurfacePoint;
use math::{Differentials, Normal3, Point3, Ray, RayDifferential, Vec3, Vector3};
use scattering::BsdfSample;

/// A point on a surface of the scene.
#[derive(Clone, Debug)]
pub struct SurfaceInteraction {
    /// The point, as geometry returns it.
    pub surface: SurfacePoint,
    /// Its material.
    pub material: MaterialId,
    /// The media on its two sides, if they differ.
    pub media: Option<MediumInterface>,
    /// The normal of the front face of a single-sided surface; zero where the camera sees both
    /// sides.
    pub front: Normal3,
    /// The area light of the surface, if it emits.
    pub area_light: Option<LightId>,
    /// The footprint of the pixel; zero until [`SurfaceInteraction::compute_footprint`].
    pub footprint: Footprint,
}

impl SurfaceInteraction {
    /// The position.
    #[inline]
    pub fn p(&self) -> Point3 {
        self.surface.p.p
    }

    /// The context of light sampling.
    #[inline]
    pub fn light_context(&self) -> LightSampleContext {
        LightSampleContext {
            p: self.surface.p,
            n: self.surface.n,
            ns: self.surface.shading.n,
            time: self.surface.time,
        }
    }

    /// The context of texture evaluation.
    #[inline]
    pub fn texture_context(&self) -> TextureContext {
        let s = &self.surface;
        TextureContext { p: s.p.p, n: s.n, uv: s.uv, footprint: self.footprint }
    }

    /// Computes the footprint of the pixel of `ray`.
    pub fn compute_footprint(&mut self, ray: &RayDifferential, view: &View) {
        let s = &self.surface;
        let across = view.pixel_on_plane(ray.differentials.as_ref().map(|d| (d, true)), s.p.p, s.n, s.time);
        self.footprint = Footprint::new(across, [s.dpdu, s.dpdv]);
    }

    /// The medium of a ray that leaves along `w`, if the ray that arrived was in `medium`.
    #[inline]
    pub fn medium_towards(&self, w: Vector3, medium: Option<MediumId>) -> Option<MediumId> {
        self.media.map_or(medium, |media| media.towards(w, self.surface.n))
    }

    /// The ray that leaves along `d`.
    #[inline]
    pub fn spawn_ray(&self, d: Vector3) -> Ray {
        self.surface.spawn_ray(d)
    }

    /// The ray that leaves along a BSDF sample; off a smooth surface with differentials, if `from`
    /// has them.
    pub fn spawn_scattered(&self, from: &RayDifferential, sample: &BsdfSample) -> RayDifferential {
        let ray = self.spawn_ray(sample.wi);
        let differentials = from
            .differentials
            .filter(|_| sample.flags.is_specular())
            .and_then(|d| self.scattered_differentials(from, &d, sample))
            .filter(|d| {
                // Differentials too large for filtering are dropped.
                let far = 1e8 * self.p().abs().max_element().max(1.0);
                d.rx_direction.length_squared() < 1e16
                    && d.ry_direction.length_squared() < 1e16
                    && d.rx_origin.length_squared() < far * far
                    && d.ry_origin.length_squared() < far * far
            });
        RayDifferential { ray, differentials }
    }

    fn scattered_differentials(
        &self,
        from: &RayDifferential,
        d: &Differentials,
        sample: &BsdfSample,
    ) -> Option<Differentials> {
        let (s, f) = (&self.surface, &self.footprint);
        let (wo, wi) = (s.wo, sample.wi);
        let mut n = s.shading.n;
        let mut dndx = s.shading.dndu * f.dudx + s.shading.dndv * f.dvdx;
        let mut dndy = s.shading.dndu * f.dudy + s.shading.dndv * f.dvdy;
        let unit = 1.0 / from.ray.d.length();
        let dwodx = -d.rx_direction * unit - wo;
        let dwody = -d.ry_direction * unit - wo;
        let (rx_direction, ry_direction) = if sample.flags.is_reflective() {
            let reflected = |dwo: Vector3, dn: Vec3| {
                let dwo_dot_n = dwo.dot(n) + wo.dot(dn);
                wi - dwo + 2.0 * (dn * wo.dot(n) + n * dwo_dot_n)
            };
            (reflected(dwodx, dndx), reflected(dwody, dndy))
        } else {
            if wo.dot(n) < 0.0 {
                (n, dndx, dndy) = (-n, -dndx, -dndy);
            }
            let eta = sample.eta.recip();
            let mu = eta * wo.dot(n) - wi.dot(n).abs();
            let refracted = |dwo: Vector3, dn: Vec3| {
                let dwo_dot_n = dwo.dot(n) + wo.dot(dn);
                let dmu = dwo_dot_n * (eta + eta * eta * wo.dot(n) / wi.dot(n));
                wi - dwo * eta + n * dmu + dn * mu
            };
            (refracted(dwodx, dndx), refracted(dwody, dndy))
        };
        let (rx_origin, ry_origin) = (s.p.p + f.dpdx, s.p.p + f.dpdy);
        (rx_direction.is_finite() && ry_direction.is_finite()).then_some(Differentials {
            rx_origin,
            rx_direction,
            ry_origin,
            ry_direction,
        })
    }
}
