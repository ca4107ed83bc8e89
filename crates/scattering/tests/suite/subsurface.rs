//! Scattering under surfaces: tables against integration, samples against their densities.

use alhazen_scattering::{
    Bssrdf, BssrdfTable, Bxdf, Dielectric, Directions, NormalizedFresnel, Scatter, Subsurface,
    SubsurfaceMethod, SubsurfacePart, TransportMode, TrowbridgeReitz,
};
use math::{Vec2, Vec3, Vector3, spherical_direction};
use spectrum::SampledSpectrum;
use std::f32::consts::TAU;
use std::sync::LazyLock;
use testkit::{Chi2, Moments, Random, integrate};

static WATER: LazyLock<BssrdfTable> = LazyLock::new(|| BssrdfTable::new(0.0, 1.33));
static DENSE: LazyLock<BssrdfTable> = LazyLock::new(|| BssrdfTable::new(0.6, 2.1));

/// Of four wavelengths, from absorbing almost all to scattering all.
fn bssrdf(table: &'static BssrdfTable) -> Bssrdf<'static> {
    let sigma_s = SampledSpectrum::new([0.4, 2.0, 5.0, 8.0]);
    Bssrdf::new(table, SampledSpectrum::new([3.0, 0.5, 0.1, 0.0]), sigma_s)
}

fn body(table: &'static BssrdfTable, alpha: f32) -> Bxdf<'static> {
    let boundary = Dielectric { eta: table.eta(), distribution: TrowbridgeReitz::new(alpha, alpha) };
    let (method, part) = (SubsurfaceMethod::Diffusion, SubsurfacePart::Whole);
    Subsurface { boundary, bssrdf: bssrdf(table), method, part, seed: 0 }.into()
}

/// Facets of a smooth boundary.
fn smooth() -> TrowbridgeReitz {
    TrowbridgeReitz::new(0.0, 0.0)
}

/// Bodies with smooth and rough boundaries.
pub fn members() -> Vec<Bxdf<'static>> {
    vec![body(&WATER, 0.0), body(&WATER, 0.4), body(&DENSE, 0.1)]
}

#[test]
fn effective_albedos_are_inverted() {
    for table in [&*WATER, &*DENSE] {
        let mut last = -1.0;
        for i in 0..=200 {
            let albedo = i as f32 / 200.0;
            let effective = table.effective_albedo(albedo);
            assert!(effective >= last && effective <= 1.001, "{albedo}: {effective}");
            last = effective;
            let found = table.albedo(SubsurfaceMethod::Diffusion, &smooth(), effective);
            assert!((table.effective_albedo(found) - effective).abs() < 1e-4, "{albedo}: {found}");
        }
        let of = |x| table.albedo(SubsurfaceMethod::Diffusion, &smooth(), x);
        assert_eq!([-0.5, 2.0].map(of), [0.0, 1.0]);
    }
    assert!((WATER.effective_albedo(1.0) - 1.0).abs() < 1e-4);
}

/// ∫ Sp 2πr dr, in steps of equal ratio.
#[test]
fn effective_albedos_are_the_integrals_of_profiles() {
    for table in [&*WATER, &*DENSE] {
        let bssrdf = bssrdf(table);
        let mut sum = SampledSpectrum::ZERO;
        let (mut r, ratio) = (1e-6f32, 1.002f32);
        while r < 100.0 {
            let (middle, width) = (r * ratio.sqrt(), r * (ratio - 1.0));
            sum += bssrdf.profiles().at(middle) * (TAU * middle * width);
            r *= ratio;
        }
        let found = bssrdf.effective_albedo();
        for i in 0..4 {
            assert!((sum[i] - found[i]).abs() < 0.003 * found[i], "{sum:?} {found:?}");
        }
    }
}

#[test]
fn a_mean_free_path_scales_the_profile() {
    let given = SampledSpectrum::new([0.1, 0.3, 0.6, 0.7]);
    let method = SubsurfaceMethod::Diffusion;
    let of =
        |mfp: f32| Bssrdf::from_reflectance(&WATER, method, &smooth(), given, SampledSpectrum::splat(mfp));
    let (short, long) = (of(0.5), of(2.0));
    for r in [0.01, 0.2, 1.0, 3.0] {
        let (a, b) = (short.profiles().at(r), long.profiles().at(4.0 * r) * 16.0);
        for i in 0..4 {
            assert!((a[i] - b[i]).abs() <= 1e-4 * a[i], "{a:?} {b:?}");
            assert!((short.effective_albedo()[i] - given[i]).abs() < 1e-3);
        }
    }
}

/// A half space without a boundary that scatters evenly returns 1 − 2√(1 − α) ∫ H(μ) μ dμ of the
/// light of a uniform sky, with 1/H(μ) = √(1 − α) + α/2 ∫ μ' H(μ')/(μ + μ') dμ' [Chandrasekhar
/// 1960].
#[test]
fn walks_without_a_boundary_return_what_the_h_function_says() {
    const STEPS: usize = 200;
    let table = BssrdfTable::new(0.0, 1.0);
    let cosine = |i: usize| (i as f64 + 0.5) / STEPS as f64;
    for albedo in [0.2f64, 0.5, 0.8, 0.95, 0.99] {
        let mut h = vec![1.0; STEPS];
        for _ in 0..400 {
            let next = |i: usize| {
                let share = |j: usize| cosine(j) * h[j] / (cosine(i) + cosine(j)) / STEPS as f64;
                1.0 / ((1.0 - albedo).sqrt() + 0.5 * albedo * (0..STEPS).map(share).sum::<f64>())
            };
            h = (0..STEPS).map(|i| 0.5 * (h[i] + next(i))).collect();
        }
        let moment = (0..STEPS).map(|i| h[i] * cosine(i) / STEPS as f64).sum::<f64>();
        let returned = 1.0 - 2.0 * (1.0 - albedo).sqrt() * moment;
        let of = |share| table.albedo(SubsurfaceMethod::RandomWalk, &smooth(), share);
        let found = of(returned as f32);
        // Three standard errors of the share, by the change of the albedo with it.
        let more = of(returned as f32 + 0.006);
        assert!(
            (f64::from(found) - albedo).abs() < f64::from(more - found) + 1e-4,
            "{albedo}: {found} {more}"
        );
    }
}

#[test]
fn radii_have_the_density_of_the_profile() {
    let cases: Vec<_> = [&*WATER, &*DENSE].into_iter().flat_map(|t| [0, 1, 2, 3].map(|i| (t, i))).collect();
    let test = Chi2 { bins: [8, 16], samples: 100_000, tests: cases.len(), ..Chi2::default() };
    for (table, hero) in cases {
        let bssrdf = bssrdf(table);
        let albedo = bssrdf.effective_albedo()[hero];
        let density = |r: f32| f64::from(TAU * r * bssrdf.profiles().at(r)[hero] / albedo);
        let end = [0.3, 1.0, 1.0, 0.6][hero];
        let sample = |u| bssrdf.profiles().sample_radius(hero, u).filter(|r| *r < end);
        if let Err(difference) = test.interval([0.0, end], sample, density) {
            panic!("{table:?} {hero}: {difference}");
        }
    }
}

/// On a plane at an angle to all three axes, in polar coordinates.
#[test]
fn probes_have_their_density() {
    let n = Vec3::new(0.36, 0.48, 0.8);
    let frame = math::Frame::from_z(n);
    let met = frame.from_local(Vec3::new(0.48, 0.6, 0.64));
    let plane = math::Frame::from_z(met);
    let point = |r: f32, phi: f32| plane.from_local(Vec3::new(r * phi.cos(), r * phi.sin(), 0.0));
    let test = Chi2 { bins: [12, 12], samples: 100_000, tests: 2, ..Chi2::default() };
    for hero in [1, 2] {
        let bssrdf = bssrdf(&WATER);
        let mut random = Random::new(3);
        let sample = |u: [f32; 2]| {
            let probe = bssrdf.profiles().sample_probe(n, hero, random.get_1d(), u.into())?;
            let t = -probe.start.dot(met) / probe.direction.dot(met);
            let d = plane.to_local(probe.start + probe.direction * t);
            let (r, phi) = (d.x.hypot(d.y), d.y.atan2(d.x).rem_euclid(TAU));
            ((0.0..=probe.length).contains(&t) && r < 1.0).then_some([r, phi])
        };
        let density =
            |[r, phi]: [f32; 2]| f64::from(r * bssrdf.profiles().probe_pdf(n, point(r, phi), met)[hero]);
        if let Err(difference) = test.rectangle([[0.0, 1.0], [0.0, TAU]], sample, density) {
            panic!("{hero}: {difference}");
        }
    }
}

#[test]
fn nothing_leaves_a_body_that_does_not_scatter() {
    let black = Bssrdf::new(&WATER, SampledSpectrum::ONE, SampledSpectrum::ZERO);
    assert!(black.effective_albedo().is_black() && black.profiles().at(0.3).is_black());
    assert!(black.profiles().sample_probe(Vec3::Z, 0, 0.7, Vec2::splat(0.5)).is_none());
    let empty = Bssrdf::new(&WATER, SampledSpectrum::ZERO, SampledSpectrum::ZERO);
    assert!(
        empty.profiles().at(0.0).is_black()
            && empty.profiles().sample_probe(Vec3::Z, 0, 0.7, Vec2::ZERO).is_none()
    );
}

#[test]
fn the_exit_lobe_is_normalized() {
    for table in [&*WATER, &*DENSE, &BssrdfTable::new(0.0, 0.8)] {
        let lobe = NormalizedFresnel::new(table);
        let density = |cos: f64, _: f64| {
            let wi = spherical_direction((1.0 - cos * cos).sqrt() as f32, cos as f32, 0.0);
            f64::from(lobe.f(Vec3::Z, wi, TransportMode::Radiance)[0]) * cos
        };
        let total = integrate(&density, [[0.0, 1.0], [0.0, std::f64::consts::TAU]], 1e-6);
        assert!((total - 1.0).abs() < 1e-3, "{total}");
        let mut random = Random::new(5);
        let weights: Moments = (0..20_000)
            .map(|_| {
                let (u, mode) = (random.get_2d().into(), TransportMode::Radiance);
                let sample = lobe.sample_f(Vec3::Z, 0.0, u, mode, Directions::All);
                f64::from(sample.f[0] * sample.wi.z / sample.pdf)
            })
            .collect();
        assert!((weights.mean - 1.0).abs() < 5.0 * weights.variance_of_mean().sqrt() + 1e-3);
    }
}

/// The albedo of body and boundary stays below 1 from everywhere.
#[test]
fn bodies_conserve_energy() {
    let mut random = Random::new(6);
    for bxdf in members() {
        for theta in [0.0f32, 0.5, 1.0, 1.3, 1.5] {
            let wo: Vector3 = spherical_direction(theta.sin(), theta.cos(), 0.3);
            let samples = (0..20_000).map(|_| (random.get_1d(), random.get_2d().into()));
            let albedo = bxdf.rho_hd(wo, samples);
            assert!(albedo.max_component() < 1.01, "{bxdf:?} from {wo}: {albedo:?}");
        }
    }
}

/// Light passes the boundary inwards by refraction; what leaves is sampled from a direction inside.
#[test]
fn parts_of_a_boundary_add_up() {
    let mut random = Random::new(9);
    let boundary = Dielectric { eta: WATER.eta(), distribution: TrowbridgeReitz::new(0.4, 0.4) };
    let (bssrdf, method) = (bssrdf(&WATER), SubsurfaceMethod::Diffusion);
    let of = |part| Subsurface { boundary, bssrdf, method, part, seed: 0 };
    let [entered, left] = [SubsurfacePart::Boundary, SubsurfacePart::Leaving].map(of);
    let mut seen = [0; 2];
    for _ in 0..2000 {
        let [light, eye] = [0, 1].map(|_| {
            let [u, v] = random.get_2d();
            let z = 1.0 - 2.0 * u;
            spherical_direction((1.0 - z * z).sqrt(), z, TAU * v)
        });
        let leaves = light.z < 0.0 && eye.z > 0.0;
        for (wo, wi, mode) in [(eye, light, TransportMode::Radiance), (light, eye, TransportMode::Importance)]
        {
            let f = if leaves { SampledSpectrum::ZERO } else { boundary.f(wo, wi, mode) };
            assert_eq!(entered.f(wo, wi, mode), f);
        }
        let (mode, uc, u) = (TransportMode::Importance, random.get_1d(), random.get_2d().into());
        let sample = entered.sample_f(light, uc, u, mode, Directions::All);
        if sample.valid {
            let pdf = entered.pdf(light, sample.wi, mode, Directions::All);
            assert!((sample.pdf - pdf).abs() <= 1e-3 * pdf, "{sample:?} {pdf}");
            seen[0] += 1;
        }
        let sample = left.sample_f(light, uc, u, mode, Directions::All);
        assert!(!sample.valid || light.z < 0.0 && sample.wi.z > 0.0);
        seen[1] += usize::from(sample.valid);
    }
    assert!(seen[0] > 1000 && seen[1] > 300, "{seen:?}");
}

/// Diffused light leaves as the boundary transmits it from all directions inside.
#[test]
fn diffused_light_leaves_by_the_transmission_of_the_boundary() {
    let of = |alpha: f32| {
        let boundary = Dielectric { eta: WATER.eta(), distribution: TrowbridgeReitz::new(alpha, alpha) };
        let (method, part) = (SubsurfaceMethod::Diffusion, SubsurfacePart::Diffused);
        Subsurface { boundary, bssrdf: bssrdf(&WATER), method, part, seed: 0 }
    };
    let mut random = Random::new(10);
    for (theta, alpha) in [(0.0f32, 0.4), (0.6, 0.4), (1.2, 0.4), (0.0, 0.0), (1.3, 0.0)] {
        let mut body = of(alpha);
        let wi = spherical_direction(theta.sin(), theta.cos(), 0.3);
        let values: Moments = (0..40_000)
            .map(|seed| {
                body.seed(seed);
                f64::from(body.f(Vec3::Z, wi, TransportMode::Importance)[0])
            })
            .collect();
        let passes: Moments = (0..40_000)
            .map(|_| {
                let (uc, u, mode) = (random.get_1d(), random.get_2d().into(), TransportMode::Importance);
                let sample = body.boundary.sample_f(wi, uc, u, mode, Directions::All);
                let passes = sample.valid && sample.flags.is_transmissive();
                if passes { f64::from(sample.f[0] * sample.wi.z.abs() / sample.pdf) } else { 0.0 }
            })
            .collect();
        let error = (values.variance_of_mean() + passes.variance_of_mean()).sqrt();
        let difference = values.mean * std::f64::consts::PI - passes.mean;
        assert!(difference.abs() < 5.0 * error + 1e-4, "{theta} {alpha}: {values:?} {passes:?}");
    }
}

/// What a rough boundary does not reflect enters, if light walks under it: from facets alike both
/// ways by a table, from others by a quadrature of fewer normals.
#[test]
fn light_that_a_rough_boundary_does_not_reflect_enters() {
    const SIDE: usize = 128;
    let middle = |i: usize| (i as f32 + 0.5) / SIDE as f32;
    let (method, part) = (SubsurfaceMethod::RandomWalk, SubsurfacePart::Boundary);
    for table in [&*WATER, &*DENSE] {
        for (x, y, bound) in [(0.1, 0.1, 0.003), (0.4, 0.4, 0.003), (1.0, 1.0, 0.003), (0.1, 0.5, 0.01)] {
            let boundary = Dielectric { eta: table.eta(), distribution: TrowbridgeReitz::new(x, y) };
            let body = Subsurface { boundary, bssrdf: bssrdf(table), method, part, seed: 0 };
            for cosine in [1.0f32, 0.6, 0.3, 0.1] {
                let wo = spherical_direction((1.0 - cosine * cosine).sqrt(), cosine, 0.5);
                let mut total = 0.0;
                for i in 0..SIDE * SIDE {
                    let u = Vec2::new(middle(i % SIDE), middle(i / SIDE));
                    for directions in [Directions::Reflection, Directions::Transmission] {
                        let sample = body.sample_f(wo, 0.5, u, TransportMode::Importance, directions);
                        if sample.valid {
                            total += f64::from(sample.f[0] * sample.wi.z.abs() / sample.pdf);
                        }
                    }
                }
                let total = total / (SIDE * SIDE) as f64;
                assert!((total - 1.0).abs() < bound, "{table:?} {x} {y} from {cosine}: {total}");
            }
        }
    }
}
