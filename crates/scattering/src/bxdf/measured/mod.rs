//! A measured BRDF in the adaptive parametrisation of [Dupuy 2018].
//!
//! Directions are points of the unit square, (√(2θ/π), φ/2π + ½). For each direction `wo` of a
//! coarse grid the table holds the density p_wo of visible microfacet normals over the square, by
//! whose inversion T the normal wm of a pair of directions becomes a point u of another square. In
//! it the measured values M_wo are smooth, however narrow the lobe is:
//!
//! ```text
//! f = M_wo(u, λ) D(wm) / (4 σ(wo) cos θi)        wm = (wo + wi)/|wo + wi|,  u = T_wo(wm)
//! ```
//!
//! with the density D of normals and their projected area σ. Directions between those of the grid
//! have the weighted means of their tables. Samples are drawn from the luminance of M_wo in the
//! square of u, then by T⁻¹. An isotropic material has one azimuth of `wo`, and wm counts from it.
//!
//! Both sides of the surface scatter alike. Tables are not quite reciprocal: importance is
//! scattered by the adjoint. Sources: [Dupuy 2018], [Pharr 2023 §9.8].

mod table;

pub use table::{MeasuredData, MeasuredGrid, MeasuredTable};

use super::{BsdfSample, Scatter};
use crate::{BxdfFlags, Directions, TransportMode, reflect};
use math::{Point2, Vec2, Vector3, same_hemisphere, spherical_direction, spherical_theta, sqr};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::{FRAC_PI_2, PI, TAU};
use table::Between;

/// Scattering by a measured surface.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a> {
    table: &'a MeasuredTable,
    lambda: SampledWavelengths,
}

impl<'a> Measured<'a> {
    /// The material of a table at four wavelengths.
    #[inline]
    pub fn new(table: &'a MeasuredTable, lambda: &SampledWavelengths) -> Self {
        Self { table, lambda: *lambda }
    }

    /// The side of `wo` as the upper one; `None` on the horizon.
    fn outgoing(&self, wo: Vector3) -> Option<Outgoing> {
        let w = if wo.z < 0.0 { -wo } else { wo };
        let theta = spherical_theta(w);
        let phi = lanes::atan2(w.y, w.x);
        (w.z > 0.0).then(|| Outgoing {
            w,
            at: square(theta, phi),
            turn: if self.table.is_isotropic() { phi } else { 0.0 },
            between: self.table.between(phi, theta),
        })
    }

    /// The normal of microfacets that turn `wo` into `wi`, on the side of `wo`; `None` if there is
    /// none.
    fn facet(&self, wo: Vector3, wi: Vector3) -> Option<Facet> {
        if !same_hemisphere(wo, wi) {
            return None;
        }
        let outgoing = self.outgoing(wo)?;
        let wm = (wo + wi).try_normalize()?;
        let wm = if wm.z < 0.0 { -wm } else { wm };
        let theta = spherical_theta(wm);
        let at = square(theta, lanes::atan2(wm.y, wm.x) - outgoing.turn);
        let at = Vec2::new(at.x, at.y - at.y.floor());
        Some(Facet { cosine: outgoing.w.dot(wm), sin_theta: wm.x.hypot(wm.y), outgoing, at })
    }
}

/// The direction of light that leaves.
struct Outgoing {
    w: Vector3,
    /// Its point of the square.
    at: Point2,
    /// The azimuth that normals are measured from.
    turn: f32,
    between: Between,
}

/// A microfacet normal.
struct Facet {
    outgoing: Outgoing,
    /// Its point of the square.
    at: Point2,
    /// To the outgoing direction.
    cosine: f32,
    sin_theta: f32,
}

/// The point of the square of a direction.
fn square(theta: f32, phi: f32) -> Point2 {
    Vec2::new((theta / FRAC_PI_2).sqrt().min(1.0), phi / TAU + 0.5)
}

impl Scatter for Measured<'_> {
    fn flags(&self) -> BxdfFlags {
        BxdfFlags::GLOSSY_REFLECTION
    }

    fn f(&self, wo: Vector3, wi: Vector3, mode: TransportMode) -> SampledSpectrum {
        let (wo, wi) = match mode {
            TransportMode::Radiance => (wo, wi),
            TransportMode::Importance => (wi, wo),
        };
        let Some(Facet { outgoing, at, .. }) = self.facet(wo, wi) else { return SampledSpectrum::ZERO };
        let (u, _) = self.table.normals.invert(at, outgoing.between.layers());
        let facets = self.table.ndf(at) / (4.0 * self.table.sigma(outgoing.at) * wi.z.abs());
        self.table.values(u, &outgoing.between, &self.lambda) * facets
    }

    fn sample_f(
        &self,
        wo: Vector3,
        _: f32,
        u: Vec2,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample {
        let Some(outgoing) = self.outgoing(wo).filter(|_| directions.reflection()) else {
            return BsdfSample::invalid();
        };
        let layers = outgoing.between.layers();
        let (u, _) = self.table.luminance.sample(u, layers);
        let (at, _) = self.table.normals.sample(u, layers);
        let (theta, phi) = (sqr(at.x) * FRAC_PI_2, (at.y - 0.5) * TAU + outgoing.turn);
        let (sin_theta, cos_theta) = lanes::sin_cos(theta);
        let wi = reflect(outgoing.w, spherical_direction(sin_theta, cos_theta, phi));
        let wi = if wo.z < 0.0 { -wi } else { wi };
        let pdf = self.pdf(wo, wi, mode, directions);
        let sample = BsdfSample::new(self.f(wo, wi, mode), wi, pdf, BxdfFlags::GLOSSY_REFLECTION);
        BsdfSample { valid: pdf > 0.0, ..sample }
    }

    fn pdf(&self, wo: Vector3, wi: Vector3, _: TransportMode, directions: Directions) -> f32 {
        let Some(facet) = self.facet(wo, wi).filter(|_| directions.reflection()) else { return 0.0 };
        let layers = facet.outgoing.between.layers();
        let (u, density) = self.table.normals.invert(facet.at, layers);
        // From area of the square to solid angle of the normal, which has a limit at the pole, then
        // to that of its reflection.
        let solid_angle = (2.0 * sqr(PI) * facet.at.x * facet.sin_theta).max(1e-6);
        density * self.table.luminance.pdf(u, layers) / (4.0 * facet.cosine * solid_angle)
    }
}
