//! The Henyey–Greenstein phase function: scattering at particles, by the angle θ between `wo` and
//! `wi`, which both point away from the particle.
//!
//! ```text
//! p(cos θ) = (1 − g²) / (4π (1 + g² + 2 g cos θ)^{3/2})
//! ```
//!
//! The asymmetry g, in (−1, 1), is the mean of −cos θ: light goes on in its direction for g > 0,
//! and turns back for g < 0. It is sampled exactly by the inverse of its distribution. Sources:
//! [Henyey 1941], [Pharr 2023 §11.3.1].

use lanes::{Each, Real};
use math::{Frame, Vec2, Vector3, safe_sqrt, spherical_direction, sqr};
use std::f32::consts::{FRAC_1_PI, TAU};

/// The phase function of Henyey and Greenstein.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct HenyeyGreenstein<R = f32> {
    /// The asymmetry, in (−1, 1).
    pub g: R,
}

impl<R: Real> HenyeyGreenstein<R> {
    /// The value, which is the density of [`Self::sample_p`], too.
    #[inline(always)]
    pub fn p(&self, wo: Vector3<R>, wi: Vector3<R>) -> R {
        self.p_of_cos(wo.dot(wi))
    }

    #[inline(always)]
    pub(crate) fn p_of_cos(&self, cos_theta: R) -> R {
        let [one, two] = [1.0, 2.0].each(R::splat);
        let square = (one + sqr(self.g) + two * self.g * cos_theta).max(R::splat(1e-12));
        R::splat(0.25 * FRAC_1_PI) * (one - sqr(self.g)) / (square * square.sqrt())
    }

    /// A direction `wi` and its density.
    #[inline(always)]
    #[doc(alias = "Sample_p")]
    pub fn sample_p(&self, wo: Vector3<R>, u: Vec2<R>) -> (Vector3<R>, R) {
        let [one, two] = [1.0, 2.0].each(R::splat);
        let g = self.g;
        let ratio = (one - sqr(g)) / (one + g - two * g * u.x);
        let peaked = (sqr(ratio) - one - sqr(g)) / (two * g);
        // Near g = 0 the quotient cancels.
        let cos_theta = R::select(g.abs().lt(R::splat(1e-3)), one - two * u.x, peaked);
        let cos_theta = cos_theta.clamp(-one, one);
        let sin_theta = safe_sqrt(one - sqr(cos_theta));
        let wi = spherical_direction(sin_theta, cos_theta, u.y * R::splat(TAU));
        (Frame::from_z(wo).from_local(wi), self.p_of_cos(cos_theta))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec3;
    use testkit::{Chi2, Moments, Random};

    const ASYMMETRIES: [f32; 6] = [-0.9, -0.3, 0.0, 0.0005, 0.6, 0.95];

    #[test]
    fn samples_have_their_density() {
        let wo = Vec3::new(0.6, -0.48, 0.64);
        let frame = Frame::from_z(wo);
        let test = Chi2 { bins: [40, 20], tests: ASYMMETRIES.len(), ..Chi2::default() };
        for g in ASYMMETRIES {
            let phase = HenyeyGreenstein { g };
            let sample = |u: [f32; 2]| {
                let wi = frame.to_local(phase.sample_p(wo, u.into()).0);
                Some([wi.z, wi.y.atan2(wi.x)])
            };
            let pdf = |[z, phi]: [f32; 2]| {
                let wi = spherical_direction((1.0 - z * z).max(0.0).sqrt(), z, phi);
                phase.p(wo, frame.from_local(wi)) as f64
            };
            test.rectangle([[-1.0, 1.0], [-0.5 * TAU, 0.5 * TAU]], sample, pdf).unwrap();
        }
    }

    #[test]
    fn the_asymmetry_is_the_mean_cosine() {
        let mut random = Random::new(1);
        for g in ASYMMETRIES {
            let phase = HenyeyGreenstein { g };
            let cosines: Moments = (0..20_000)
                .map(|_| {
                    let (wi, p) = phase.sample_p(Vec3::Z, random.get_2d().into());
                    assert!((p - phase.p(Vec3::Z, wi)).abs() <= 1e-2 * p, "{g}: {p}");
                    -wi.z as f64
                })
                .collect();
            assert!((cosines.mean - g as f64).abs() < 5.0 * cosines.variance_of_mean().sqrt(), "{g}");
        }
    }
}
