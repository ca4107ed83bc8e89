//! The diffuse base: energy-preserving Oren–Nayar reflection.
//!
//! ```text
//! f   = ρ/π A (1 + r s/t) + ρ_m/π (1 − E(θo)) (1 − E(θi))/(1 − Ē)
//! E   = A (1 + r G(θ)/π)            A = 1/(1 + (1/2 − 2/3π) r)         s = ωo·ωi − cos θo cos θi
//! ρ_m = ρ² Ē/(1 − ρ (1 − Ē))        t = max(cos θo, cos θi) where s > 0, else 1
//! ```
//!
//! The second term is light scattered between facets, without which rough surfaces would be too
//! dark; a white one reflects all light. Source: [Portsmouth 2025].

use lanes::{Mask, Real, atan2};
use math::{Vector3, sqr};
use spectrum::SampledSpectrum;
use std::f32::consts::{FRAC_1_PI, PI};

/// A in dependence of the roughness.
#[inline(always)]
fn amplitude<R: Real>(roughness: R) -> R {
    R::one() / (R::one() + R::splat(0.5 - 2.0 / (3.0 * PI)) * roughness)
}

/// E: the albedo of white facets by single scattering.
#[inline(always)]
fn single_albedo<R: Real>(roughness: R, cosine: R) -> R {
    let one = R::one();
    let cosine = cosine.clamp(R::zero(), one);
    let sine = (one - sqr(cosine)).sqrt();
    let theta = atan2(sine, cosine);
    // tan θ (1 − sin³ θ), which is finite at the horizon.
    let steep = sine * cosine * (one + sine + sqr(sine)) / (one + sine);
    let g = sine * (theta - sine * cosine) + R::splat(2.0 / 3.0) * (steep - sine);
    amplitude(roughness) * (one + roughness * R::splat(FRAC_1_PI) * g)
}

/// The value for two directions above, of an `albedo` and a `roughness` in [0, 1].
#[inline(always)]
pub(super) fn oren_nayar<R: Real>(
    albedo: SampledSpectrum<R>,
    roughness: R,
    wo: Vector3<R>,
    wi: Vector3<R>,
) -> SampledSpectrum<R> {
    let smooth = albedo * R::splat(FRAC_1_PI);
    let is_rough = roughness.gt(R::zero());
    if !is_rough.any() {
        return smooth;
    }
    let one = R::one();
    let s = wo.dot(wi) - wo.z * wi.z;
    let t = R::select(s.gt(R::zero()), wo.z.max(wi.z), one);
    let single = albedo * (amplitude(roughness) * (one + roughness * s / t));
    let mean = amplitude(roughness) * (one + R::splat(2.0 / 3.0 - 28.0 / (15.0 * PI)) * roughness);
    let lost = (one - single_albedo(roughness, wo.z)) * (one - single_albedo(roughness, wi.z));
    let mut again = albedo;
    for value in &mut again.0 {
        *value = sqr(*value) * mean / (one - *value * (one - mean));
    }
    let rough = (single + again * (lost / (one - mean))) * R::splat(FRAC_1_PI);
    SampledSpectrum::select(is_rough, rough, smooth)
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::spherical_direction;
    use testkit::integrate;

    fn albedo(reflectance: f32, roughness: f32, cosine: f32) -> f64 {
        let wo = spherical_direction((1.0 - sqr(cosine)).sqrt(), cosine, 0.0);
        let light = |cosine: f64, phi: f64| {
            let sine = (1.0 - cosine * cosine).sqrt();
            let wi = spherical_direction(sine as f32, cosine as f32, phi as f32);
            f64::from(oren_nayar(SampledSpectrum::splat(reflectance), roughness, wo, wi)[0]) * cosine
        };
        integrate(&light, [[0.0, 1.0], [0.0, std::f64::consts::TAU]], 1e-4)
    }

    #[test]
    fn a_white_surface_reflects_all_light() {
        for roughness in [0.0, 0.3, 1.0] {
            for cosine in [1.0, 0.7, 0.2, 0.02] {
                let found = albedo(1.0, roughness, cosine);
                assert!((found - 1.0).abs() < 2e-3, "{roughness} {cosine}: {found}");
            }
        }
    }

    #[test]
    fn the_albedo_of_single_scattering_is_its_integral() {
        for roughness in [0.2f32, 1.0] {
            for cosine in [1.0f32, 0.6, 0.1] {
                // Scattering between facets vanishes with the square of the reflectance.
                let found = albedo(1e-3, roughness, cosine) / 1e-3;
                let expected = f64::from(single_albedo(roughness, cosine));
                assert!((found - expected).abs() < 3e-3, "{roughness} {cosine}: {found} {expected}");
            }
        }
    }
}
