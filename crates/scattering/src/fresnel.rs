//! Reflected and refracted directions, and the Fresnel reflectance of smooth interfaces.
//!
//! With c = cos θ_i and s = sin θ_i, Snell's law η_i sin θ_i = η_t sin θ_t and the relative index η
//! = η_t/η_i, unpolarised light is reflected by
//!
//! ```text
//! F   = (r_∥² + r_⊥²)/2
//! r_∥ = (η c − cos θ_t)/(η c + cos θ_t)     r_⊥ = (c − η cos θ_t)/(c + η cos θ_t)
//! ```
//!
//! For a conductor η becomes η + i k, and each square a squared modulus. Where a + i b is the root
//! of (η + i k)² − s²,
//!
//! ```text
//! |r_⊥|² = ((a − c)² + b²)/((a + c)² + b²)
//! |r_∥|² = |r_⊥|² ((a − s²/c)² + b²)/((a + s²/c)² + b²)
//! ```
//!
//! Sources: [Pharr 2023 §9.3.5, §9.3.6], [Born 1999 §1.5.2, §14.2].

use lanes::{Each, Real};
use math::{Normal3, Vector3, safe_sqrt, sqr};
use spectrum::{N, SampledSpectrum};

/// The mirror image of `wo` about `n`; both point away from the surface.
#[inline(always)]
pub fn reflect<R: Real>(wo: Vector3<R>, n: Normal3<R>) -> Vector3<R> {
    n * (wo.dot(n) * R::splat(2.0)) - wo
}

/// The refraction of `wi` through a surface with unit normal `n`, and the relative index η_t/η_i
/// along it: `eta` if `wi` is on the side of `n`, else its inverse; and where there is one: not
/// where all light is reflected inside.
#[inline(always)]
pub fn refract<R: Real>(wi: Vector3<R>, n: Normal3<R>, eta: R) -> (Vector3<R>, R, R::Mask) {
    let cos = n.dot(wi);
    let below = cos.lt(R::zero());
    let n = Vector3::select(below, -n, n);
    let cos_i = R::select(below, -cos, cos);
    let eta = R::select(below, R::one() / eta, eta);
    let sin2_t = (R::one() - sqr(cos_i)).max(R::zero()) / sqr(eta);
    let cos_t = safe_sqrt(R::one() - sin2_t);
    (n * (cos_i / eta - cos_t) - wi / eta, eta, !sin2_t.ge(R::one()))
}

/// The reflectance of an interface between dielectrics; `eta` is the relative index met by light
/// with `cos_theta_i` > 0.
#[inline(always)]
#[doc(alias = "FrDielectric")]
pub fn fr_dielectric<R: Real>(cos_theta_i: R, eta: R) -> R {
    let below = cos_theta_i.lt(R::zero());
    let cos_i = R::select(below, -cos_theta_i, cos_theta_i).min(R::one());
    let eta = R::select(below, R::one() / eta, eta);
    let sin2_t = (R::one() - sqr(cos_i)) / sqr(eta);
    let cos_t = safe_sqrt(R::one() - sin2_t);
    let parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    let perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    let reflectance = (sqr(parallel) + sqr(perpendicular)) * R::splat(0.5);
    R::select(sin2_t.ge(R::one()), R::one(), reflectance)
}

/// The share of uniform light that an interface between dielectrics of relative index `eta`
/// reflects: the mean of [`fr_dielectric`] over the directions of a hemisphere by their cosine. A
/// fit, to 0.01, of [Kulla 2017].
#[inline(always)]
pub(crate) fn mean_fresnel<R: Real>(eta: R) -> R {
    let [one, a, b] = [1.0, 4.085_67, 1.000_71].each(R::splat);
    let denser = (eta - one) / (a + b * eta);
    let [c, d, e, f] = [0.997_118, 0.1014, -0.965_241, -0.130_607].each(R::splat);
    R::select(eta.ge(one), denser, c + eta * (d + eta * (e + eta * f)))
}

/// The reflectance of an interface to a medium of complex index `eta` + i `k`, relative to the
/// medium of the light; `cos_theta_i` in [0, 1].
#[inline(always)]
#[doc(alias = "FrComplex")]
pub fn fr_complex<R: Real>(cos_theta_i: R, eta: R, k: R) -> R {
    let [half, one, two] = [0.5, 1.0, 2.0].each(R::splat);
    // A cosine whose square underflows would give 0/0 for an index of 1.
    let cos = cos_theta_i.clamp(R::splat(1e-12), one);
    let cos2 = sqr(cos);
    let sin2 = one - cos2;
    let real = (eta - one) * (eta + one) - sqr(k) + cos2;
    let imaginary = two * eta * k;
    let modulus = (sqr(real) + sqr(imaginary)).sqrt();
    // The larger part of the root by the half-angle formula, the smaller from the larger, to avoid
    // cancellation.
    let larger = (half * (modulus + real.abs())).sqrt();
    let is_real_part = real.ge(R::zero()) | larger.eq(R::zero());
    let a = R::select(is_real_part, larger, half * imaginary / larger);
    let (sum, cross) = (modulus + cos2, two * cos * a);
    let perpendicular = (sum - cross) / (sum + cross);
    let (sum, cross) = (cos2 * modulus + sqr(sin2), cross * sin2);
    let parallel = perpendicular * (sum - cross) / (sum + cross);
    half * (parallel + perpendicular)
}

/// [`fr_complex`] at each wavelength.
#[inline(always)]
pub fn fr_conductor<R: Real>(
    cos_theta_i: R,
    eta: SampledSpectrum<R>,
    k: SampledSpectrum<R>,
) -> SampledSpectrum<R> {
    let mut reflected = eta;
    for i in 0..N {
        reflected[i] = fr_complex(cos_theta_i, eta[i], k[i]);
    }
    reflected
}

#[cfg(test)]
mod tests {
    use super::*;
    use math::Vec3;
    use proptest::prelude::*;

    const INDICES: [f32; 6] = [0.4, 1.0 / 1.5, 1.1, 1.33, 1.5, 2.4];

    #[test]
    fn normal_incidence() {
        for eta in INDICES {
            let expected = sqr((eta - 1.0) / (eta + 1.0));
            assert!((fr_dielectric(1.0, eta) - expected).abs() < 1e-6);
            assert!((fr_dielectric(-1.0, eta) - expected).abs() < 1e-6, "{eta} from below");
            for k in [0.0, 0.5, 3.0, 10.0] {
                let expected = (sqr(eta - 1.0) + k * k) / (sqr(eta + 1.0) + k * k);
                assert!((fr_complex(1.0, eta, k) - expected).abs() < 1e-6, "{eta} + {k} i");
            }
        }
    }

    #[test]
    fn parallel_polarised_light_is_transmitted_at_brewsters_angle() {
        for eta in INDICES {
            let cos = (1.0 / (1.0 + eta * eta)).sqrt();
            let perpendicular = sqr((1.0 - eta * eta) / (1.0 + eta * eta));
            assert!((fr_dielectric(cos, eta) - 0.5 * perpendicular).abs() < 2e-6, "{eta}");
        }
    }

    #[test]
    fn total_reflection_beyond_the_critical_angle() {
        let critical = (1.0 - sqr(1.0 / 1.5f32)).sqrt();
        assert_eq!(fr_dielectric(-(critical - 1e-3), 1.5), 1.0);
        assert!(fr_dielectric(-(critical + 1e-3), 1.5) < 0.9);
        assert!(!refract(Vec3::new(0.8, 0.0, -0.6), Vec3::Z, 1.5).2);
        assert_eq!(fr_dielectric(0.0, 1.5), 1.0, "grazing");
    }

    #[test]
    fn the_mean_reflectance_is_the_integral() {
        for eta in INDICES {
            const STEPS: usize = 10_000;
            let cosine = |i: usize| (i as f32 + 0.5) / STEPS as f32;
            let sum: f32 = (0..STEPS).map(|i| 2.0 * cosine(i) * fr_dielectric(cosine(i), eta)).sum();
            let mean = sum / STEPS as f32;
            assert!((mean_fresnel(eta) - mean).abs() < 0.01, "{eta}: {mean}, {}", mean_fresnel(eta));
        }
    }

    /// The same reflectance by complex arithmetic in double precision.
    fn complex_oracle(cos: f64, eta: f64, k: f64) -> f64 {
        type C = (f64, f64);
        let mul = |a: C, b: C| (a.0 * b.0 - a.1 * b.1, a.0 * b.1 + a.1 * b.0);
        let norm = |a: C| a.0 * a.0 + a.1 * a.1;
        let index = (eta, k);
        let square = mul(index, index);
        let s = 1.0 - cos * cos;
        // cos θ_t · index = root of index² − sin², so that both ratios need no division of complex
        // numbers but one.
        let (re, im) = (square.0 - s, square.1);
        let modulus = re.hypot(im);
        let root = (((modulus + re) / 2.0).max(0.0).sqrt(), ((modulus - re) / 2.0).max(0.0).sqrt());
        let scaled = (square.0 * cos, square.1 * cos);
        let ratio = |a: C, b: C| norm((a.0 - b.0, a.1 - b.1)) / norm((a.0 + b.0, a.1 + b.1));
        0.5 * (ratio(scaled, root) + ratio((cos, 0.0), root))
    }

    proptest! {
        #[test]
        fn complex_reflectance_is_that_of_complex_arithmetic(cos in 1e-4f32..1.0, eta in 0.05f32..5.0, k in 0f32..12.0) {
            let expected = complex_oracle(cos as f64, eta as f64, k as f64) as f32;
            prop_assert!((fr_complex(cos, eta, k) - expected).abs() < 1e-5);
        }

        #[test]
        fn without_absorption_a_conductor_is_a_dielectric(cos in 0.01f32..1.0, eta in 0.3f32..3.0) {
            prop_assert!((fr_complex(cos, eta, 0.0) - fr_dielectric(cos, eta)).abs() < 2e-4);
        }

        #[test]
        fn reflectances_stay_within_one(cos in -1f32..=1.0, eta in 0.2f32..4.0, k in 0f32..12.0) {
            prop_assert!((0.0..=1.0).contains(&fr_dielectric(cos, eta)));
            prop_assert!((0.0..=1.00001).contains(&fr_complex(cos, eta, k)));
        }

        #[test]
        fn refraction_obeys_snell_and_reverses(x in -1f32..1.0, y in -1f32..1.0, z in -1f32..1.0, eta in 0.4f32..2.5) {
            let Some(wi) = Vec3::new(x, y, z).try_normalize() else { return Ok(()) };
            let (wt, met, true) = refract(wi, Vec3::Z, eta) else { return Ok(()) };
            prop_assert_eq!(met, if wi.z < 0.0 { 1.0 / eta } else { eta });
            prop_assert!((wt.length() - 1.0).abs() < 1e-4);
            prop_assert!(wt.z * wi.z <= 0.0);
            prop_assert!((wt.x * met + wi.x).abs() < 1e-5 && (wt.y * met + wi.y).abs() < 1e-5);
            if wt.z.abs() > 0.05 && wi.z.abs() > 0.05 {
                let (back, _, reversible) = refract(wt, Vec3::Z, eta);
                prop_assert!(reversible);
                prop_assert!((back - wi).length() < 1e-4);
                prop_assert!((fr_dielectric(wi.z, eta) - fr_dielectric(wt.z, eta)).abs() < 1e-4);
            }
        }
    }

    #[test]
    fn no_angle_gives_nan() {
        for cos in [0.0, 1e-45, 1e-30, 1e-12, 1e-6, 0.5, 1.0, 1.0000002] {
            for eta in INDICES.into_iter().chain([1.0]) {
                assert!(fr_dielectric(cos, eta).is_finite() && fr_dielectric(-cos, eta).is_finite());
                for k in [0.0, 1e-3, 3.0] {
                    assert!(fr_complex(cos, eta, k).is_finite(), "{cos} {eta} {k}");
                }
            }
        }
    }
}
