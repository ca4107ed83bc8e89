//! Scattering under the surface: the parts that paths take apart which are followed there.
//!
//! The share w of the diffuse base that scatters under its surface is, where light leaves where it
//! entered, w ρ L(ωo) L(ωi)/(π L̄). Of this L(ωo) w is what goes under on the way from the camera,
//! a walk in the medium takes the place of the colour ρ, and L(ωi)/(π L̄) is the lobe by which
//! light has entered. So the layers over it attenuate light at both ends. As their tables have all
//! that the boundary reflects, the medium itself has no boundary: light starts there in all
//! directions by their cosine, and leaves where it comes to the surface.
//!
//! The medium is given by its albedo ρ under uniform light and by its mean free path. Its albedo of
//! single scattering is (1 − s²)/(1 − g s²), with s fitted to half spaces without a boundary.
//! Source: [Kulla 2017].

use super::{OpenPbr, OpenPbrParameters, Shares};
use crate::{HenyeyGreenstein, Interior};
use lanes::{Mask, Real};
use math::Vector3;
use spectrum::SampledSpectrum;
use std::f32::consts::FRAC_1_PI;

/// What of a surface scatters light at a point.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) enum Part {
    /// All of it, as if light left where it entered.
    #[default]
    Whole,
    /// All but what is scattered under it. A sample for radiance that passes to the other side
    /// diffusely is the beginning of a path there.
    Boundary,
    /// The lobe by which light enters, over all that does.
    Entering,
    /// The lobe by which light leaves.
    Leaving,
}

/// The albedo of single scattering of a half space that reflects `albedo` of uniform light.
#[inline(always)]
fn single_scattering<R: Real>(albedo: R, g: R) -> R {
    let c = R::splat;
    let a = albedo.clamp(R::zero(), R::one());
    let s = c(4.09712) + c(4.20863) * a - (c(9.59217) + c(41.6808) * a + c(17.7126) * a * a).sqrt();
    ((R::one() - s * s) / (R::one() - g * s * s)).clamp(R::zero(), R::one())
}

/// The medium under a surface, which does nothing if nothing is scattered there, or at once.
#[inline(always)]
pub(super) fn interior<R: Real>(p: &OpenPbrParameters<R>) -> Interior<R> {
    let zero = SampledSpectrum::zero();
    let phase = HenyeyGreenstein { g: R::zero() };
    let nothing = Interior { sigma_s: zero, sigma_t: zero, phase, eta: R::one() };
    if p.geometry_thin_walled {
        return nothing;
    }
    let opaque = (R::one() - p.base_metalness) * (R::one() - p.transmission_weight);
    let is_body = (opaque * p.subsurface_weight).gt(R::zero()) & !p.subsurface_radius.is_black();
    if !is_body.any() {
        return nothing;
    }
    let g = p.subsurface_scatter_anisotropy.clamp(R::splat(-0.99), R::splat(0.99));
    let (mut albedo, mut sigma_t) = (p.subsurface_color, p.subsurface_radius);
    for value in &mut albedo.0 {
        *value = single_scattering(*value, g);
    }
    for value in &mut sigma_t.0 {
        *value = R::one() / value.max(R::splat(1e-6));
    }
    Interior {
        sigma_s: SampledSpectrum::select(is_body, albedo * sigma_t, zero),
        sigma_t: SampledSpectrum::select(is_body, sigma_t, zero),
        phase: HenyeyGreenstein { g },
        eta: R::one(),
    }
}

impl<'a> OpenPbr<'a> {
    /// The medium under the surface, if light is followed there.
    pub fn interior(&self) -> Option<&Interior> {
        (!self.interior.sigma_t.is_black()).then_some(&self.interior)
    }

    /// The surface without what is scattered under it. From above, samples for radiance may lead
    /// there; these are [diffuse and transmitted](crate::BxdfFlags::DIFFUSE_TRANSMISSION).
    pub(in super::super) fn boundary_part(&self) -> Self {
        let part = if self.interior().is_some() { Part::Boundary } else { Part::Whole };
        Self { part, ..*self }
    }

    /// The lobe by which light has entered that is scattered under the surface, from above.
    pub(in super::super) fn entering(&self) -> Self {
        Self { part: Part::Entering, ..*self }
    }

    /// The lobe by which it leaves to above, of all directions within alike.
    pub(in super::super) fn leaving(&self) -> Self {
        Self { part: Part::Leaving, ..*self }
    }

    /// The probability with which a path to `wo`, above, goes on under the surface.
    pub fn chance_under(&self, wo: Vector3) -> f32 {
        let under = self.goes_under(&self.shares(wo), wo) * self.subsurface_color;
        under.average().clamp(0.05, 0.95)
    }
}

impl<R: Real> OpenPbr<'_, R> {
    /// The share of the diffuse base that paths go under, from the side of `z`.
    #[inline(always)]
    pub(super) fn share_under(&self, z: R) -> R {
        match self.part {
            Part::Boundary => R::select(z.gt(R::zero()), self.subsurface_weight, R::zero()),
            _ => R::zero(),
        }
    }

    /// What of the light to `wo`, above, comes from under the surface, over what does of all.
    #[inline(always)]
    pub(super) fn goes_under(&self, shares: &Shares<R>, wo: Vector3<R>) -> SampledSpectrum<R> {
        let weight = self.weights(R::one()).diffuse * self.subsurface_weight * shares.seen;
        shares.diffuse_rest * self.darkening * self.absorbed(self.coat_length(wo.z)) * weight
    }

    /// The value of one of the two lobes for light on the way between the surface and `w`, above.
    #[inline(always)]
    pub(super) fn lobe(&self, w: Vector3<R>) -> SampledSpectrum<R> {
        let shares = self.shares(w);
        let value = match self.part {
            Part::Entering => {
                let left = shares.diffuse_rest.safe_div(self.rests().diffuse);
                left * self.absorbed(self.coat_length(w.z))
            }
            _ => self.goes_under(&shares, w),
        };
        value * R::splat(FRAC_1_PI)
    }

    /// Whether it is one of the two lobes.
    #[inline(always)]
    pub(super) fn is_lobe(&self) -> bool {
        self.part == Part::Entering || self.part == Part::Leaving
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn albedos_of_single_scattering_have_the_right_ends() {
        for g in [-0.5, 0.0, 0.8] {
            assert!(single_scattering(0.0, g) < 1e-4 && single_scattering(1.0, g) > 0.9999);
            let values: Vec<f32> = (0..=20).map(|i| single_scattering(i as f32 / 20.0, g)).collect();
            assert!(values.is_sorted_by(|a, b| a < b), "{values:?}");
        }
        // A medium of mean cosine g scatters as one of isotropic phase with (1 − g) σs.
        let (even, forward) = (single_scattering(0.6, 0.0), single_scattering(0.6, 0.7));
        let reduced = forward * (1.0 - 0.7) / (1.0 - 0.7 * forward);
        assert!((even - reduced).abs() < 1e-5, "{even} {reduced}");
    }
}
