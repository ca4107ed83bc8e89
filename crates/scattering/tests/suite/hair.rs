//! The hair BxDF: its values by another program, its energy, its sampling.

use alhazen_scattering::{Directions, Hair, Scatter, TransportMode};
use lanes::Real;
use math::{Vec2, Vec3, Vector3, spherical_direction};
use sampling::warp::sample_uniform_sphere;
use spectrum::SampledSpectrum;
use std::f32::consts::PI;
use testkit::{Chi2, LaneFunction, Moments, Random, lanes_agree};

use TransportMode::{Importance, Radiance};

/// Roughness from narrow to wide.
const ROUGHNESS: [[f32; 2]; 5] = [[0.1, 0.2], [0.25, 0.3], [0.3, 0.9], [0.7, 0.3], [1.0, 1.0]];

fn hair(h: f32, sigma_a: f32, roughness: [f32; 2]) -> Hair {
    Hair::new(h, 1.55, SampledSpectrum::splat(sigma_a), roughness, 2.0)
}

/// Rows of β_m, β_n, α in degrees, η, σ_a, h, two directions with x along the fibre, and f·|cos|.
#[test]
fn values_are_those_of_pbrt() {
    let Some(path) = testkit::data("measured/hair/pbrt_hair_bsdf_a.f32") else { return };
    let bytes = std::fs::read(path).expect("the file is read");
    let numbers: Vec<f32> =
        bytes.chunks_exact(4).map(|b| f32::from_le_bytes([b[0], b[1], b[2], b[3]])).collect();
    let (mut count, mut different) = (0, 0);
    for row in numbers.chunks_exact(17) {
        let &[beta_m, beta_n, alpha, eta, r, g, b, h, ..] = row else { unreachable!() };
        let (wo, wi) = (Vec3::new(row[8], row[9], row[10]), Vec3::new(row[11], row[12], row[13]));
        let sigma_a = SampledSpectrum::new([r, g, b, 0.0]);
        let hair = Hair::new(h, eta, sigma_a, [beta_m, beta_n], alpha);
        let f = hair.f(wo, wi, Radiance) * wi.z.abs();
        for (&expected, found) in row[14..].iter().zip(f.0) {
            count += 1;
            different += ((found - expected).abs() > 0.01 * expected + 1e-6) as usize;
        }
    }
    eprintln!("{different} of {count}");
    assert!(count == 18_000 && different * 1000 <= count, "{different} of {count} values differ");
}

fn direction(random: &mut Random) -> Vector3 {
    sample_uniform_sphere(Vec2::from(random.get_2d()))
}

/// Without absorption all light leaves again.
#[test]
fn white_hair_keeps_all_light() {
    let mut random = Random::new(1);
    for roughness in ROUGHNESS {
        for h in [-0.9, 0.0, 0.4] {
            let (hair, wo) = (hair(h, 0.0, roughness), direction(&mut random));
            let albedo: Moments = (0..60_000)
                .map(|_| direction(&mut random))
                .map(|wi| (hair.f(wo, wi, Radiance)[0] * wi.z.abs() * 4.0 * PI) as f64)
                .collect();
            let tolerance = 5.0 * albedo.variance_of_mean().sqrt() + 2e-3;
            assert!((albedo.mean - 1.0).abs() < tolerance, "{roughness:?} {h}: {albedo:?}");
        }
    }
}

#[test]
fn samples_have_their_density() {
    let mut random = Random::new(2);
    let cases: Vec<_> =
        ROUGHNESS.iter().flat_map(|&roughness| [-0.7, 0.2, 0.95].map(|h| (roughness, h))).collect();
    let test = Chi2 { bins: [24, 36], samples: 60_000, tests: cases.len(), ..Chi2::default() };
    for (roughness, h) in cases {
        let (hair, wo) = (hair(h, 0.3, roughness), direction(&mut random));
        let sample = |u: [f32; 2]| {
            let sample = hair.sample_f(wo, random.get_1d(), u.into(), Radiance, Directions::All);
            let wi = sample.into_option()?.wi;
            Some([wi.x.clamp(-1.0, 1.0).asin(), wi.z.atan2(wi.y)])
        };
        let pdf = |[theta, phi]: [f32; 2]| {
            let (sin, cos) = theta.sin_cos();
            let wi = Vec3::new(sin, cos * phi.cos(), cos * phi.sin());
            (hair.pdf(wo, wi, Radiance, Directions::All) * cos) as f64
        };
        let domain = [[-0.5 * PI, 0.5 * PI], [-PI, PI]];
        test.rectangle(domain, sample, pdf).unwrap_or_else(|e| panic!("{roughness:?} {h}: {e}"));
    }
}

/// Samples have their value, and grey hair weights of at most 1.
#[test]
fn samples_agree_with_f_and_pdf() {
    let mut random = Random::new(3);
    for roughness in ROUGHNESS {
        for mode in [Radiance, Importance] {
            for directions in [Directions::All, Directions::Reflection, Directions::Transmission] {
                let (hair, wo) = (hair(2.0 * random.get_1d() - 1.0, 0.5, roughness), direction(&mut random));
                for _ in 0..200 {
                    let u = Vec2::from(random.get_2d());
                    let sample = hair.sample_f(wo, random.get_1d(), u, mode, directions);
                    let Some(sample) = sample.into_option() else { continue };
                    assert_eq!(sample.f, hair.f(wo, sample.wi, mode));
                    assert_eq!(sample.pdf, hair.pdf(wo, sample.wi, mode, directions));
                    assert!(directions.meet(sample.flags) && hair.flags().contains(sample.flags));
                    let weight = sample.f[0] * sample.wi.z.abs() / sample.pdf;
                    assert!(mode == Importance || weight <= 1.001, "{weight}");
                }
            }
        }
    }
}

#[test]
fn importance_is_scattered_by_the_adjoint() {
    let mut random = Random::new(4);
    for roughness in ROUGHNESS {
        let (hair, wo, wi) = (hair(0.3, 0.2, roughness), direction(&mut random), direction(&mut random));
        assert_eq!(hair.f(wo, wi, Importance), hair.f(wi, wo, Radiance));
    }
}

/// The colour of a volume of hair determines the absorption, more of it for darker hair.
#[test]
fn darker_hair_absorbs_more() {
    let sigma_a = |color| Hair::sigma_a_from_reflectance(SampledSpectrum::splat(color), 0.3)[0];
    assert_eq!(sigma_a(1.0), 0.0);
    assert!(sigma_a(0.1) > sigma_a(0.5) && sigma_a(0.0).is_finite());
}

#[test]
fn degenerate_directions_give_finite_values() {
    let along = [Vec3::X, -Vec3::X, Vec3::new(1.0, 1e-20, 0.0), Vec3::Y, Vec3::Z];
    for roughness in [[1e-3, 1e-3], [1.0, 1.0]] {
        for h in [-1.0, 0.0, 1.0] {
            let hair = hair(h, 0.0, roughness);
            for wo in along {
                for u in [0.0, 0.5, math::ONE_MINUS_EPSILON] {
                    let sample = hair.sample_f(wo, u, Vec2::new(u, u), Radiance, Directions::All);
                    if let Some(sample) = sample.into_option() {
                        assert!(sample.wi.is_finite() && sample.pdf.is_finite() && !sample.f[0].is_nan());
                    }
                }
                let wi = spherical_direction(0.6, 0.8, 1.0);
                assert!(hair.f(wo, wi, Radiance)[0] >= 0.0, "{wo} {roughness:?} {h}");
                assert!(hair.f(wo, Vec3::Y, Radiance)[0].is_finite(), "along the surface: {wo} {h}");
                assert!(hair.pdf(wo, wi, Radiance, Directions::All) >= 0.0);
            }
        }
    }
}

struct Lanes;

impl LaneFunction for Lanes {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let wo = sample_uniform_sphere(Vec2::new(u[0], u[1]));
        let wi = sample_uniform_sphere(Vec2::new(u[2], u[3]));
        let roughness = [u[4].max(R::splat(0.05)), u[5].max(R::splat(0.05))];
        let h = u[6] * R::splat(2.0) - R::one();
        let hair = Hair::new(h, R::splat(1.55), SampledSpectrum::splat(u[7]), roughness, u[7]);
        let sample = hair.sample_f(wo, u[5], Vec2::new(u[3], u[4]), Radiance, Directions::All);
        let mut results = vec![hair.f(wo, wi, Radiance)[0], hair.pdf(wo, wi, Radiance, Directions::All)];
        let valid = |x: R| R::select(sample.valid, x, R::zero());
        results.extend([sample.f[0], sample.wi.x, sample.wi.y, sample.wi.z, sample.pdf].map(valid));
        results
    }
}

#[test]
fn lanes_have_the_bits_of_single_floats() {
    lanes_agree(&Lanes, 8, 100);
}
