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
use lanes::{Callee, Real, atan2, sin_cos};
use math::{Point2, Vec2, Vector3, same_hemisphere, spherical_direction, spherical_theta, sqr};
use sampling::LayerWeights;
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::{FRAC_PI_2, PI, TAU};

/// Scattering by a measured surface.
#[derive(Clone, Copy, Debug)]
pub struct Measured<'a, R = f32> {
    table: &'a MeasuredTable,
    lambda: SampledWavelengths<R>,
}

impl<'a, R: Real> Measured<'a, R> {
    /// The material of a table at four wavelengths.
    #[inline(always)]
    pub fn new(table: &'a MeasuredTable, lambda: &SampledWavelengths<R>) -> Self {
        Self { table, lambda: *lambda }
    }

    /// The side of `wo` as the upper one.
    #[inline(always)]
    fn outgoing(&self, wo: Vector3<R>) -> OutgoingDirection<R> {
        let w = Vector3::select(wo.z.lt(R::zero()), -wo, wo);
        let (theta, phi) = (spherical_theta(w), atan2(w.y, w.x));
        let turn = if self.table.is_isotropic() { phi } else { R::zero() };
        OutgoingDirection { w, at: in_square(theta, phi), turn, between: self.table.between(phi, theta) }
    }

    /// The normal of microfacets that turn a direction into `wi`, on its side.
    #[inline(always)]
    fn microfacet(&self, outgoing: &OutgoingDirection<R>, wo: Vector3<R>, wi: Vector3<R>) -> Microfacet<R> {
        let (wm, is_some) = (wo + wi).normalize_masked();
        let wm = Vector3::select(wm.z.lt(R::zero()), -wm, wm);
        let at = in_square(spherical_theta(wm), atan2(wm.y, wm.x) - outgoing.turn);
        let at = Vec2::new(at.x, at.y - at.y.floor());
        let exists = is_some & same_hemisphere(wo, wi);
        Microfacet { at, cosine: outgoing.w.dot(wm), sin_theta: (sqr(wm.x) + sqr(wm.y)).sqrt(), exists }
    }
}

/// The direction of light that leaves.
struct OutgoingDirection<R: Real> {
    w: Vector3<R>,
    /// Its point of the square.
    at: Point2<R>,
    /// The azimuth that normals are measured from.
    turn: R,
    /// The layers of the tables around it.
    between: LayerWeights<R>,
}

/// A microfacet normal.
struct Microfacet<R: Real> {
    /// Its point of the square.
    at: Point2<R>,
    /// To the outgoing direction.
    cosine: R,
    sin_theta: R,
    exists: R::Mask,
}

/// The point of the square of a direction.
#[inline(always)]
fn in_square<R: Real>(theta: R, phi: R) -> Point2<R> {
    let x = (theta * R::splat(1.0 / FRAC_PI_2)).sqrt().min(R::one());
    Vec2::new(x, phi * R::splat(1.0 / TAU) + R::splat(0.5))
}

impl<R: Real> Scatter<R> for Measured<'_, R> {
    const CHOOSES: bool = false;

    #[inline(always)]
    fn flags(&self) -> BxdfFlags<R> {
        BxdfFlags::splat(BxdfFlags::GLOSSY_REFLECTION)
    }

    #[inline(always)]
    fn f(&self, wo: Vector3<R>, wi: Vector3<R>, mode: TransportMode) -> SampledSpectrum<R> {
        let (wo, wi) = match mode {
            TransportMode::Radiance => (wo, wi),
            TransportMode::Importance => (wi, wo),
        };
        R::call(MeasuredValue { surface: self, wo, wi })
    }

    #[inline(always)]
    fn sample_f(
        &self,
        wo: Vector3<R>,
        _: R,
        u: Vec2<R>,
        mode: TransportMode,
        directions: Directions,
    ) -> BsdfSample<R> {
        if !directions.reflection() {
            return BsdfSample::invalid();
        }
        let outgoing = self.outgoing(wo);
        let u = self.table.sample_luminance(u, &outgoing.between);
        let at = self.table.sample_normal(u, &outgoing.between);
        let theta = sqr(at.x) * R::splat(FRAC_PI_2);
        let phi = (at.y - R::splat(0.5)) * R::splat(TAU) + outgoing.turn;
        let (sin_theta, cos_theta) = sin_cos(theta);
        let wi = reflect(outgoing.w, spherical_direction(sin_theta, cos_theta, phi));
        let wi = Vector3::select(wo.z.lt(R::zero()), -wi, wi);
        let pdf = self.pdf(wo, wi, mode, directions);
        let lobe = BxdfFlags::splat(BxdfFlags::GLOSSY_REFLECTION);
        let sample = BsdfSample::new(self.f(wo, wi, mode), wi, pdf, lobe);
        BsdfSample { valid: pdf.gt(R::zero()), ..sample }
    }

    #[inline(always)]
    fn pdf(&self, wo: Vector3<R>, wi: Vector3<R>, _: TransportMode, directions: Directions) -> R {
        if !directions.reflection() {
            return R::zero();
        }
        R::call(MeasuredDensity { surface: self, wo, wi })
    }
}

/// A value of the BRDF, which its samples have, too.
struct MeasuredValue<'b, 'a, R: Real> {
    surface: &'b Measured<'a, R>,
    wo: Vector3<R>,
    wi: Vector3<R>,
}

impl<R: Real> Callee<R> for MeasuredValue<'_, '_, R> {
    type Output = SampledSpectrum<R>;

    #[inline(always)]
    fn run(self) -> SampledSpectrum<R> {
        let Self { surface, wo, wi } = self;
        let Measured { table, lambda } = surface;
        let outgoing = surface.outgoing(wo);
        let facet = surface.microfacet(&outgoing, wo, wi);
        let (u, _) = table.invert_normal(facet.at, &outgoing.between);
        let area = R::splat(4.0) * table.sigma(outgoing.at) * wi.z.abs();
        let f = table.values(u, &outgoing.between, lambda) * (table.ndf(facet.at) / area);
        SampledSpectrum::select(facet.exists, f, SampledSpectrum::zero())
    }
}

/// The density of a sample.
struct MeasuredDensity<'b, 'a, R: Real> {
    surface: &'b Measured<'a, R>,
    wo: Vector3<R>,
    wi: Vector3<R>,
}

impl<R: Real> Callee<R> for MeasuredDensity<'_, '_, R> {
    type Output = R;

    #[inline(always)]
    fn run(self) -> R {
        let Self { surface, wo, wi } = self;
        let outgoing = surface.outgoing(wo);
        let facet = surface.microfacet(&outgoing, wo, wi);
        let (u, density) = surface.table.invert_normal(facet.at, &outgoing.between);
        // From area of the square to solid angle of the normal, which has a limit at the pole, then
        // to that of its reflection.
        let solid_angle = R::splat(2.0 * PI * PI) * facet.at.x * facet.sin_theta;
        let solid_angle = R::splat(4.0) * facet.cosine * solid_angle.max(R::splat(1e-6));
        let pdf = density * surface.table.luminance_pdf(u, &outgoing.between) / solid_angle;
        R::select(facet.exists, pdf, R::zero())
    }
}
