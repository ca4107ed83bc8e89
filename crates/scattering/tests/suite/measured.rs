//! Measured BRDFs, of made-up tables: values where the tables are linear, densities, sampling.

use alhazen_scattering::{
    Directions, Measured, MeasuredData, MeasuredGrid, MeasuredTable, Scatter, TransportMode,
};
use lanes::Real;
use math::{Vec2, Vec3, Vector3, spherical_direction};
use sampling::warp::{sample_uniform_hemisphere, sample_uniform_sphere};
use spectrum::{SampledSpectrum, SampledWavelengths};
use std::f32::consts::{FRAC_PI_2, PI, TAU};
use testkit::{Chi2, LaneFunction, Random, lanes_agree};

use TransportMode::{Importance, Radiance};

fn lambda() -> SampledWavelengths {
    SampledWavelengths::new([420.0, 500.0, 575.0, 900.0], [1.0; 4])
}

fn grid(size: [usize; 2], layers: usize, value: impl Fn(usize, f32, f32) -> f32) -> MeasuredGrid {
    let [width, height] = size;
    let at = |i: usize, n: usize| i as f32 / (n - 1) as f32;
    let points = (0..layers * height * width).map(|i| (i / (width * height), i / width % height, i % width));
    MeasuredGrid {
        size,
        values: points.map(|(layer, y, x)| value(layer, at(x, width), at(y, height))).collect(),
    }
}

/// Visible normals are uniform in their square, so that it is that of the reflectances, which are
/// linear in it, in the angle of the outgoing direction and in the wavelength.
fn linear() -> MeasuredData {
    let theta = vec![0.0, 0.5, 1.0, FRAC_PI_2];
    let wavelengths = vec![400.0, 600.0, 700.0];
    let angles = theta.clone();
    MeasuredData {
        phi: vec![0.0],
        ndf: grid([3, 2], 1, |_, x, _| 2.0 - x),
        sigma: grid([2, 2], 1, |_, x, _| 1.0 - 0.5 * x),
        vndf: grid([4, 4], 4, |_, _, _| 3.0),
        luminance: grid([4, 5], 4, |layer, x, y| 1.0 + x + y * layer as f32),
        values: grid([3, 5], 12, |layer, x, y| {
            let lambda = [400.0, 600.0, 700.0][layer % 3];
            (0.2 + 0.1 * x + 0.3 * y + 0.2 * angles[layer / 3]) * lambda / 400.0
        }),
        theta,
        wavelengths: Some(wavelengths),
    }
}

/// A table with all kinds of differences between neighbours. Visible normals are so few at the pole
/// and the horizon that their density per solid angle is bounded, as that of real surfaces is.
fn rough(phi: &[f32], wavelengths: Option<Vec<f32>>) -> MeasuredData {
    let theta = vec![0.0, 0.7, 1.2, FRAC_PI_2];
    let layers = phi.len() * theta.len();
    let channels = wavelengths.as_ref().map_or(3, Vec::len);
    let random = |seed: u64| {
        let mut random = Random::new(seed);
        let numbers: Vec<f32> = (0..layers * channels * 72).map(|_| random.get_1d()).collect();
        move |layer: usize, x: f32, y: f32| {
            numbers[layer * 72 + (y * 7.0 + 0.5) as usize * 9 + (x * 8.0 + 0.5) as usize]
        }
    };
    let (normals, samples, values) = (random(1), random(2), random(3));
    MeasuredData {
        phi: phi.to_vec(),
        theta,
        ndf: grid([9, 8], 1, |_, x, _| (1.0 - x) * (1.0 - x)),
        sigma: grid([9, 8], 1, |_, x, _| 1.0 - 0.8 * x),
        vndf: grid([65, 8], layers, |layer, x, y| {
            x * (x * x * FRAC_PI_2).sin() * (1.0 - x) * (0.2 + normals(layer, x, y))
        }),
        luminance: grid([9, 8], layers, |layer, x, y| 0.1 + samples(layer, x, y)),
        values: grid([9, 8], layers * channels, values),
        wavelengths,
    }
}

fn tables() -> [MeasuredTable; 4] {
    let all_around = [-PI, -1.0, 0.5, PI];
    let data = [
        linear(),
        rough(&[0.0], Some(vec![400.0, 550.0, 800.0])),
        rough(&all_around, Some(vec![400.0, 550.0])),
        rough(&all_around, None),
    ];
    data.map(|data| MeasuredTable::new(data).expect("tables that fit"))
}

fn views() -> [Vector3; 5] {
    [(0.02, 1.0), (0.4, -2.0), (0.9, 3.0), (1.4, 0.3), (2.5, 0.3)]
        .map(|(theta, phi): (f32, f32)| spherical_direction(theta.sin(), theta.cos(), phi))
}

#[test]
fn values_follow_the_formula_where_tables_are_linear() {
    let table = MeasuredTable::new(linear()).unwrap();
    let bxdf = Measured::new(&table, &lambda());
    let mut random = Random::new(1);
    for _ in 0..1000 {
        let [wo, wi] = [0, 1].map(|_| sample_uniform_hemisphere(Vec2::from(random.get_2d())));
        let wm = (wo + wi).normalize();
        let x = |w: Vector3| (w.z.min(1.0).acos() / FRAC_PI_2).sqrt();
        let y = (wm.y.atan2(wm.x) - wo.y.atan2(wo.x)) / TAU + 0.5;
        let y = y - y.floor();
        let reflectance = 0.2 + 0.1 * x(wm) + 0.3 * y + 0.2 * wo.z.acos();
        let facets = (2.0 - x(wm)) / (4.0 * (1.0 - 0.5 * x(wo)) * wi.z);
        let expected = [420.0, 500.0, 575.0, 700.0].map(|lambda| reflectance * lambda / 400.0 * facets);
        let found = bxdf.f(wo, wi, Radiance);
        for (expected, found) in expected.into_iter().zip(found.0) {
            assert!((expected - found).abs() < 2e-3 * expected, "{found}, not {expected}");
        }
        assert_eq!(found, bxdf.f(wi, wo, Importance));
        assert_eq!(bxdf.f(wo, -wi, Radiance), SampledSpectrum::ZERO);
    }
}

#[test]
fn samples_have_their_density() {
    let tables = tables();
    let test = Chi2 { bins: [16, 24], samples: 60_000, tests: 15, ..Chi2::default() };
    for (i, table) in tables.iter().enumerate().skip(1) {
        let bxdf = Measured::new(table, &lambda());
        for wo in views() {
            let sample = |u: [f32; 2]| {
                let sample = bxdf.sample_f(wo, 0.0, u.into(), Radiance, Directions::All).into_option()?;
                Some(sample.wi.to_array())
            };
            let pdf = |w: [f32; 3]| f64::from(bxdf.pdf(wo, w.into(), Radiance, Directions::All));
            test.sphere(sample, pdf).unwrap_or_else(|e| panic!("table {i} from {wo}: {e}"));
        }
    }
}

/// A sample is the point where `pdf` and `f` are those of the tables at the random numbers that
/// gave it.
#[test]
fn samples_agree_with_f_and_pdf() {
    let mut random = Random::new(3);
    for table in tables() {
        let bxdf = Measured::new(&table, &lambda());
        for wo in views() {
            for mode in [Radiance, Importance] {
                let mut valid = 0;
                for _ in 0..200 {
                    let u = Vec2::from(random.get_2d());
                    let sample = bxdf.sample_f(wo, 0.0, u, mode, Directions::All);
                    let Some(sample) = sample.into_option() else { continue };
                    assert_eq!(sample.f, bxdf.f(wo, sample.wi, mode));
                    assert_eq!(sample.pdf, bxdf.pdf(wo, sample.wi, mode, Directions::All));
                    assert!(sample.flags == bxdf.flags() && sample.wi.z * wo.z > 0.0);
                    assert!((sample.wi.length() - 1.0).abs() < 1e-5);
                    valid += 1;
                }
                assert!(valid > 20, "{valid} from {wo}");
                let none = bxdf.sample_f(wo, 0.0, Vec2::splat(0.5), mode, Directions::Transmission);
                assert!(!none.valid);
            }
        }
    }
}

#[test]
fn isotropic_tables_turn_with_the_surface() {
    let tables = tables();
    let mut random = Random::new(4);
    for (table, turns) in tables.iter().zip([true, true, false, false]) {
        let bxdf = Measured::new(table, &lambda());
        let mut same = 0;
        for _ in 0..100 {
            let [wo, wi] = [0, 1].map(|_| sample_uniform_hemisphere(Vec2::from(random.get_2d())));
            let turned = |w: Vector3| Vec3::new(-w.y, w.x, w.z);
            let (f, g) = (bxdf.f(wo, wi, Radiance)[0], bxdf.f(turned(wo), turned(wi), Radiance)[0]);
            same += usize::from((f - g).abs() < 1e-3 * f);
            // The other side is like this one.
            assert_eq!(bxdf.f(-wo, -wi, Radiance)[0], f);
        }
        assert!(if turns { same == 100 } else { same < 20 }, "{same}");
    }
}

#[test]
fn degenerate_directions_give_finite_values() {
    let up = Vec3::Z;
    let along = Vec3::new(1.0, 0.0, 0.0);
    let low = Vec3::new(1.0, 0.0, 1e-7);
    for table in tables() {
        let bxdf = Measured::new(&table, &lambda());
        for wo in [up, along, low, -up, -low] {
            for wi in [up, along, low, -up, -low, -along] {
                let (f, pdf) = (bxdf.f(wo, wi, Radiance), bxdf.pdf(wo, wi, Radiance, Directions::All));
                assert!(f.0.iter().all(|f| f.is_finite() && *f >= 0.0), "{wo} {wi} {f:?}");
                assert!(pdf.is_finite() && pdf >= 0.0, "{wo} {wi} {pdf}");
            }
            for u in [Vec2::splat(0.0), Vec2::splat(math::ONE_MINUS_EPSILON), Vec2::new(0.0, 0.5)] {
                let sample = bxdf.sample_f(wo, 0.0, u, Radiance, Directions::All);
                assert!(!sample.valid || sample.pdf.is_finite() && sample.wi.is_finite(), "{wo} {sample:?}");
            }
        }
    }
}

struct Lanes(MeasuredTable);

impl LaneFunction for Lanes {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let wo = sample_uniform_sphere(Vec2::new(u[0], u[1]));
        let wi = sample_uniform_sphere(Vec2::new(u[2], u[3]));
        let nanometre = |u: R| R::splat(380.0) + u * R::splat(450.0);
        let lambda = [u[4], u[5], u[6], u[7]].map(nanometre);
        let measured = Measured::new(&self.0, &SampledWavelengths::new(lambda, [R::one(); 4]));
        let sample = measured.sample_f(wo, R::zero(), Vec2::new(u[3], u[4]), Radiance, Directions::All);
        let mut results = measured.f(wo, wi, Radiance).0.to_vec();
        results.push(measured.pdf(wo, wi, Radiance, Directions::All));
        let valid = |x: R| R::select(sample.valid, x, R::zero());
        results.extend([sample.f[0], sample.wi.x, sample.wi.y, sample.wi.z, sample.pdf].map(valid));
        results
    }
}

#[test]
fn lanes_have_the_bits_of_single_floats() {
    for table in tables() {
        lanes_agree(&Lanes(table), 8, 100);
    }
}

#[test]
fn tables_that_do_not_fit_are_refused() {
    let refused = |change: fn(&mut MeasuredData), expected: &str| {
        let mut data = linear();
        change(&mut data);
        let message = MeasuredTable::new(data).expect_err(expected);
        assert!(message.contains(expected), "{message}, not {expected}");
    };
    refused(|data| data.theta[1] = 0.0, "elevations are not increasing");
    refused(|data| data.phi.clear(), "azimuths are not increasing");
    refused(|data| data.wavelengths = Some(vec![400.0, 600.0, f32::NAN]), "wavelengths are not increasing");
    refused(|data| data.wavelengths = Some(vec![400.0]), "reflectances do not have 4 layers");
    refused(|data| data.theta.push(2.0), "visible normals do not have 5 layers");
    refused(|data| data.ndf = grid([1, 2], 1, |_, _, _| 1.0), "grid of 1 × 2 points");
    refused(|data| data.luminance.values[3] = f32::INFINITY, "luminances are not all finite");
    refused(|data| data.sigma.values[1] = 0.0, "areas are not all above 0");
    refused(|data| data.vndf.size = [usize::MAX, 2], "visible normals do not have");
}
