//! Layered BxDFs: their values and samples are estimates, so that the contract holds in the mean.

use alhazen_scattering::{
    BsdfSample, Conductor, Dielectric, Diffuse, Directions, HenyeyGreenstein, Layered, Scatter,
    TransportMode, TrowbridgeReitz, inner_reflectance,
};
use lanes::Real;
use math::{Vec2, Vec3, Vector3, spherical_direction};
use sampling::warp::sample_cosine_hemisphere;
use spectrum::SampledSpectrum;
use std::f32::consts::{PI, TAU};
use testkit::{LaneFunction, Moments, Random, lanes_agree, welch_test};

use TransportMode::{Importance, Radiance};

type Bxdf = alhazen_scattering::Bxdf<'static>;

/// A coat over `base`.
fn coated<B>(base: B, alpha: f32, thickness: f32, albedo: f32) -> Layered<B> {
    Layered {
        base,
        interface: Dielectric { eta: 1.5, distribution: TrowbridgeReitz::new(alpha, alpha) },
        thickness,
        albedo: SampledSpectrum::splat(albedo),
        phase: HenyeyGreenstein { g: 0.4 },
        inner: -1.0,
        max_depth: 60,
        samples: 1,
        seed: 0,
    }
}

fn diffuse(reflectance: f32) -> Diffuse {
    Diffuse { reflectance: SampledSpectrum::splat(reflectance) }
}

fn metal(alpha: f32) -> Conductor {
    Conductor {
        distribution: TrowbridgeReitz::new(alpha, alpha),
        eta: SampledSpectrum::splat(0.3),
        k: SampledSpectrum::splat(2.0),
    }
}

/// Coats that are smooth and rough, clear, absorbing and scattering; all scatter to more than one
/// direction.
pub fn members() -> Vec<Bxdf> {
    vec![
        coated(diffuse(0.8), 0.0, 0.0, 0.0).into(),
        coated(diffuse(0.8), 0.0, 0.5, 0.0).into(),
        coated(diffuse(0.8), 0.3, 0.1, 0.0).into(),
        coated(diffuse(0.5), 0.1, 0.5, 0.8).into(),
        coated(diffuse(0.5), 0.0, 2.0, 0.9).into(),
        coated(metal(0.3), 0.0, 0.0, 0.0).into(),
        coated(metal(0.0), 0.3, 0.1, 0.0).into(),
        coated(metal(0.4), 0.2, 0.0, 0.0).into(),
        coated(metal(0.2), 0.4, 0.7, 0.9).into(),
    ]
}

/// Members of known values and densities.
pub fn exact_members() -> [Bxdf; 2] {
    [closed(coated(diffuse(0.8), 0.0, 0.0, 0.0)), closed(coated(diffuse(0.6), 0.0, 0.3, 0.0))]
}

fn with_seed(mut bxdf: Bxdf, seed: u32) -> Bxdf {
    match &mut bxdf {
        Bxdf::CoatedDiffuse(layered) => layered.seed = seed,
        Bxdf::CoatedConductor(layered) => layered.seed = seed,
        other => unreachable!("{other:?} is not layered"),
    }
    bxdf
}

fn views() -> [Vector3; 4] {
    [(0.0, 0.0), (40.0, 20.0), (70.0, -110.0), (140.0, 45.0)].map(|(theta, phi): (f32, f32)| {
        let theta = theta.to_radians();
        spherical_direction(theta.sin(), theta.cos(), phi.to_radians())
    })
}

fn sample(bxdf: &Bxdf, wo: Vector3, random: &mut Random, mode: TransportMode) -> Option<BsdfSample> {
    let (uc, u) = (random.get_1d(), Vec2::from(random.get_2d()));
    bxdf.sample_f(wo, uc, u, mode, Directions::All).into_option()
}

fn weight(sample: &BsdfSample) -> f64 {
    (sample.f[0] * sample.wi.z.abs() / sample.pdf) as f64
}

/// A direction on the side of `wo` by its cosine.
fn cosine(wo: Vector3, random: &mut Random) -> Vector3 {
    let wi = sample_cosine_hemisphere(Vec2::from(random.get_2d()));
    if wo.z < 0.0 { -wi } else { wi }
}

/// The albedo of the lobes that are not specular, by samples and by `f`.
#[test]
fn samples_and_values_have_the_same_integral() {
    let mut random = Random::new(1);
    for (i, bxdf) in members().into_iter().enumerate() {
        for wo in views() {
            for mode in [Radiance, Importance] {
                let samples: Moments = (0..20_000)
                    .map(|_| match sample(&bxdf, wo, &mut random, mode) {
                        Some(sample) if !sample.flags.is_specular() => weight(&sample),
                        _ => 0.0,
                    })
                    .collect();
                let values: Moments = (0..20_000)
                    .map(|seed| {
                        let wi = cosine(wo, &mut random);
                        (with_seed(bxdf, seed).f(wo, wi, mode)[0] * PI) as f64
                    })
                    .collect();
                welch_test(&samples, &values, 72).unwrap_or_else(|error| panic!("{i} from {wo}: {error}"));
            }
        }
    }
}

/// How far the density is from that of the samples that there are: half the sum of the differences
/// over cells of equal projected solid angle. This share of them would have to move.
#[test]
fn the_density_is_close_to_that_of_the_samples() {
    const SAMPLES: usize = 100_000;
    const CELLS: usize = 12;
    let mut random = Random::new(2);
    for (i, bxdf) in members().into_iter().enumerate() {
        for wo in &views()[..3] {
            let (mut found, mut expected) = (vec![0.0; CELLS * CELLS], vec![0.0; CELLS * CELLS]);
            let cell = |wi: Vector3| {
                let (x, y) = (wi.x * wi.x + wi.y * wi.y, wi.y.atan2(wi.x) / TAU + 0.5);
                let index = |x: f32| ((x * CELLS as f32) as usize).min(CELLS - 1);
                index(x) * CELLS + index(y)
            };
            for _ in 0..SAMPLES {
                if let Some(sample) = sample(&bxdf, *wo, &mut random, Radiance)
                    && !sample.flags.is_specular()
                {
                    found[cell(sample.wi)] += 1.0 / SAMPLES as f32;
                }
                let wi = cosine(*wo, &mut random);
                let pdf = bxdf.pdf(*wo, wi, Radiance, Directions::All);
                expected[cell(wi)] += pdf * PI / (wi.z * SAMPLES as f32);
            }
            let (of_found, of_expected) = (found.iter().sum::<f32>(), expected.iter().sum::<f32>());
            let differences =
                found.iter().zip(&expected).map(|(f, e)| (f / of_found - e / of_expected).abs());
            let distance = differences.sum::<f32>() / 2.0;
            assert!(distance < 0.2, "{i} from {wo}: {distance}");
            assert!(of_expected < 1.03, "{i} from {wo}: {of_expected}");
        }
    }
}

#[test]
fn values_are_reciprocal_in_the_mean() {
    let mut random = Random::new(3);
    for (i, bxdf) in members().into_iter().enumerate() {
        for _ in 0..6 {
            let wo = cosine(Vec3::Z, &mut random);
            let wi = cosine(Vec3::Z, &mut random);
            let values = |wo, wi, mode, first: u32| -> Moments {
                (0..8000).map(|seed| with_seed(bxdf, first + seed).f(wo, wi, mode)[0] as f64).collect()
            };
            let (there, back) = (values(wo, wi, Radiance, 0), values(wi, wo, Importance, 10_000));
            welch_test(&there, &back, 54).unwrap_or_else(|error| panic!("{i} from {wo} to {wi}: {error}"));
        }
    }
}

/// A smooth clear coat over a diffuse base with the closed form of its reflections.
fn closed(layers: Layered<Diffuse>) -> Bxdf {
    Layered { inner: inner_reflectance(layers.interface.eta, layers.thickness), ..layers }.into()
}

/// Random walks estimate the closed form, for all indices, thicknesses and numbers of events.
#[test]
fn walks_have_the_mean_of_the_closed_form() {
    let mut random = Random::new(4);
    for (reflectance, eta, thickness, max_depth) in
        [(0.2, 1.5, 0.0, 60), (0.9, 1.5, 0.1, 5), (0.8, 2.0, 0.5, 4), (0.95, 1.0 / 1.3, 0.05, 60)]
    {
        let smooth = Dielectric { eta, distribution: TrowbridgeReitz::new(0.0, 0.0) };
        let layers = coated(diffuse(reflectance), 0.0, thickness, 0.0);
        let layers = Layered { interface: smooth, max_depth, ..layers };
        for _ in 0..6 {
            let (wo, wi) = (cosine(Vec3::Z, &mut random), cosine(Vec3::Z, &mut random));
            let expected = closed(layers).f(wo, wi, Radiance)[0] as f64;
            let walks: Moments = (0..20_000)
                .map(|seed| with_seed(layers.into(), seed).f(wo, wi, Radiance)[0] as f64)
                .collect();
            let tolerance = 5.0 * walks.variance_of_mean().sqrt() + 2e-4 * expected;
            assert!((walks.mean - expected).abs() <= tolerance, "{eta}: {walks:?} for {expected}");
        }
    }
}

/// Without losses all light leaves again.
#[test]
fn lossless_layers_keep_all_light() {
    let mut random = Random::new(5);
    let white = Layered { max_depth: 2000, ..coated(diffuse(1.0), 0.0, 0.0, 0.0) };
    let varnished = closed(white);
    let cloudy = Layered { thickness: 1.0, albedo: SampledSpectrum::ONE, ..white };
    let mirror = Conductor { eta: SampledSpectrum::ZERO, ..metal(0.0) };
    for bxdf in [white.into(), varnished, cloudy.into(), coated(mirror, 0.0, 0.0, 0.0).into()] {
        for wo in views() {
            let kept: Moments = (0..20_000)
                .map(|_| sample(&bxdf, wo, &mut random, Importance).map_or(0.0, |sample| weight(&sample)))
                .collect();
            let tolerance = 5.0 * kept.variance_of_mean().sqrt() + 1e-3;
            assert!((kept.mean - 1.0).abs() < tolerance, "{bxdf:?} from {wo}: {kept:?}");
        }
    }
}

#[test]
fn a_coat_of_index_one_is_no_coat() {
    let base = diffuse(0.6);
    let air = Dielectric { eta: 1.0, distribution: TrowbridgeReitz::new(0.2, 0.2) };
    let bxdf = Layered { interface: air, ..coated(base, 0.0, 0.0, 0.0) };
    let (wo, wi) = (views()[1], views()[2]);
    assert!((bxdf.f(wo, wi, Radiance)[0] - base.f(wo, wi, Radiance)[0]).abs() < 1e-6);
}

struct Lanes;

impl LaneFunction for Lanes {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let up = sample_cosine_hemisphere(Vec2::new(u[0], u[1]));
        let wi = sample_cosine_hemisphere(Vec2::new(u[2], u[3]));
        let interface = Dielectric { eta: R::splat(1.5), distribution: TrowbridgeReitz::new(u[4], u[4]) };
        let albedo = SampledSpectrum::splat(R::select(u[5].lt(R::splat(0.5)), R::zero(), u[5]));
        let bxdf = Layered {
            base: Diffuse { reflectance: SampledSpectrum::splat(u[6]) },
            interface,
            thickness: u[7],
            albedo,
            phase: HenyeyGreenstein { g: u[6] * R::splat(0.9) },
            inner: u[3] - R::splat(0.5),
            max_depth: 8,
            samples: 2,
            seed: u[0].to_bits(),
        };
        let metal = Layered {
            base: Conductor {
                distribution: TrowbridgeReitz::new(u[5], u[6]),
                eta: SampledSpectrum::splat(u[6]),
                k: SampledSpectrum::splat(u[7]),
            },
            interface,
            thickness: bxdf.thickness,
            albedo,
            phase: bxdf.phase,
            inner: bxdf.inner,
            max_depth: 8,
            samples: 1,
            seed: bxdf.seed,
        };
        let mut results = Vec::new();
        values(&bxdf, up, wi, u, &mut results);
        values(&metal, up, wi, u, &mut results);
        results
    }
}

#[inline(always)]
fn values<R: Real>(bxdf: &impl Scatter<R>, wo: Vector3<R>, wi: Vector3<R>, u: &[R], results: &mut Vec<R>) {
    results.extend(bxdf.f(wo, -wi, Radiance).0);
    results.extend(bxdf.f(wo, wi, Radiance).0);
    results.push(bxdf.pdf(wo, wi, Radiance, Directions::All));
    let sample = bxdf.sample_f(-wo, u[4], Vec2::new(u[2], u[3]), Radiance, Directions::All);
    let valid = |x: R| R::select(sample.valid, x, R::zero());
    results.extend(sample.f.0.map(valid));
    results.extend([sample.wi.x, sample.wi.y, sample.wi.z, sample.pdf].map(valid));
}

#[test]
fn lanes_have_the_bits_of_single_floats() {
    lanes_agree(&Lanes, 8, 100);
}
