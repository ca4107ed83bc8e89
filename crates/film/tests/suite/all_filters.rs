//! The contract of all filters.

use alhazen_film::Filter;
use alhazen_film::filter::MAX_RADIUS;
use description::FilterDesc;
use description::schema::Settings;
use lanes::Real;
use math::Vec2;
use testkit::{Chi2, LaneFunction, Moments, Random, assert_complete, integrate, lanes_agree, t_test};

/// Filters of every kind, with names for failures.
fn all() -> Vec<(&'static str, Filter)> {
    let describe = [
        ("box", FilterDesc::Box { radius: [0.5, 0.5] }),
        ("wide box", FilterDesc::Box { radius: [2.0, 0.25] }),
        ("triangle", FilterDesc::Triangle { radius: [2.0, 1.0] }),
        ("gaussian", FilterDesc::Gaussian { radius: [1.5, 1.5], sigma: 0.5 }),
        ("uneven gaussian", FilterDesc::Gaussian { radius: [2.0, 1.0], sigma: 0.8 }),
        ("mitchell", FilterDesc::Mitchell { radius: [2.0, 2.0], b: 1.0 / 3.0, c: 1.0 / 3.0 }),
        ("sharp mitchell", FilterDesc::Mitchell { radius: [2.0, 1.5], b: 0.0, c: 0.5 }),
        ("sinc", FilterDesc::LanczosSinc { radius: [4.0, 4.0], tau: 3.0 }),
    ];
    describe.into_iter().map(|(name, desc)| (name, Filter::new(&desc).expect("a filter"))).collect()
}

#[test]
fn every_filter_is_tested() {
    let set: Vec<_> = FilterDesc::members().iter().map(FilterDesc::name).collect();
    assert_complete(&set, all().into_iter().map(|(name, _)| name));
}

fn support(filter: &Filter) -> [[f32; 2]; 2] {
    filter.radius().to_array().map(|r| [-r, r])
}

#[test]
fn the_integral_is_that_of_the_values() {
    for (name, filter) in all() {
        let bounds = support(&filter).map(|axis| axis.map(f64::from));
        let f = |x: f64, y: f64| f64::from(filter.evaluate(Vec2::new(x as f32, y as f32)));
        // Cell by cell, so that no cell straddles a kink or many lobes.
        let cells = 16;
        let edge = |axis: usize, i: i32| {
            bounds[axis][0] + (bounds[axis][1] - bounds[axis][0]) * f64::from(i) / f64::from(cells)
        };
        let mut sum = 0.0;
        for i in 0..cells {
            for j in 0..cells {
                sum += integrate(&f, [[edge(0, i), edge(0, i + 1)], [edge(1, j), edge(1, j + 1)]], 1e-9);
            }
        }
        let integral = f64::from(filter.integral());
        assert!((integral - sum).abs() < 1e-4 * sum.abs(), "{name}: {integral} is not {sum}");
    }
}

#[test]
fn filters_end_at_their_radius_and_are_even() {
    for (name, filter) in all() {
        let mut random = Random::new(3);
        for _ in 0..1000 {
            let p = (Vec2::from_array(random.get_2d()) * 4.0 - 2.0) * filter.radius();
            let value = filter.evaluate(p);
            if p.abs().cmpgt(filter.radius()).any() {
                assert_eq!(value, 0.0, "{name} at {p}");
            }
            for mirrored in [-p, Vec2::new(-p.x, p.y)] {
                assert_eq!(filter.evaluate(mirrored), value, "{name} at {p}");
            }
        }
    }
}

#[test]
fn samples_lie_within_the_radius() {
    for (name, filter) in all() {
        let almost_one = 1.0 - f32::EPSILON / 2.0;
        let mut random = Random::new(5);
        let corners = [[0.0, 0.0], [almost_one, almost_one], [0.0, almost_one], [0.5, 0.5]];
        for u in corners.into_iter().chain((0..10_000).map(|_| random.get_2d())) {
            let sample = filter.sample(Vec2::from_array(u));
            assert!(sample.offset.abs().cmple(filter.radius()).all(), "{name}: {sample:?} from {u:?}");
            assert!(sample.weight.is_finite() && sample.weight != 0.0, "{name}: {sample:?} from {u:?}");
        }
    }
}

/// Samples have the density |f| / ∫|f|. Tabulated filters follow their tables, which the cells of
/// this test do not resolve beyond the table's own.
#[test]
fn samples_follow_the_magnitude_of_the_filter() {
    let filters = all();
    for (name, filter) in &filters {
        let [rx, ry] = filter.radius().to_array();
        let tabulated = !matches!(filter, Filter::Box(_) | Filter::Triangle(_));
        let cells = [rx, ry].map(|r| 32.0 * r);
        let magnitude = |p: [f32; 2]| {
            let p = if tabulated {
                let centre = |x: f32, r: f32, n: f32| {
                    (((x + r) / (2.0 * r) * n).floor().min(n - 1.0) + 0.5) / n * 2.0 * r - r
                };
                [centre(p[0], rx, cells[0]), centre(p[1], ry, cells[1])]
            } else {
                p
            };
            f64::from(filter.evaluate(Vec2::from_array(p)).abs())
        };
        let mut total = 0.0;
        let n = 512;
        for i in 0..n {
            for j in 0..n {
                let at = |k: i32, r: f32| r * ((2 * k + 1) as f32 / n as f32 - 1.0);
                total += magnitude([at(i, rx), at(j, ry)]);
            }
        }
        total *= f64::from(4.0 * rx * ry) / f64::from(n * n);
        // Cells of the test are whole cells of the table, so that the density is constant in each.
        let bins = if tabulated { cells.map(|c| (c / 2.0) as usize) } else { [16, 16] };
        let test = Chi2 { bins, tests: filters.len(), samples: 400_000, ..Chi2::default() };
        test.rectangle(
            support(filter),
            |u| Some(filter.sample(Vec2::from_array(u)).offset.to_array()),
            |p| magnitude(p) / total,
        )
        .unwrap_or_else(|table| panic!("{name}: {table}"));
    }
}

/// Σ w g(x) / Σ w estimates ∫ f g / ∫ f; here with g = x², y², and through the mean weight.
#[test]
fn weighted_samples_estimate_integrals() {
    let filters = all();
    for (name, filter) in &filters {
        let bounds = support(filter).map(|axis| axis.map(f64::from));
        let integral = |g: &dyn Fn(f64, f64) -> f64| {
            let n = 2048;
            let at = |axis: usize, i: i32| bounds[axis][1] * (f64::from(2 * i + 1) / f64::from(n) - 1.0);
            let mut sum = 0.0;
            for i in 0..n {
                for j in 0..n {
                    let (x, y) = (at(0, i), at(1, j));
                    sum += f64::from(filter.evaluate(Vec2::new(x as f32, y as f32))) * g(x, y);
                }
            }
            sum * bounds[0][1] * bounds[1][1] * 4.0 / f64::from(n * n)
        };
        let whole = integral(&|_, _| 1.0);
        let expected = [integral(&|x, _| x * x) / whole, integral(&|_, y| y * y) / whole];
        let mut random = Random::new(11);
        let samples: Vec<_> =
            (0..200_000).map(|_| filter.sample(Vec2::from_array(random.get_2d()))).collect();
        let mean_weight = samples.iter().map(|s| f64::from(s.weight)).sum::<f64>() / samples.len() as f64;
        for (axis, expected) in expected.into_iter().enumerate() {
            // A ratio of means, linearised: the mean of w (g − expected) is zero, up to the
            // coarseness of the table.
            let table = 2e-3 * f64::from(filter.radius()[axis]).powi(2);
            let moments: Moments = samples
                .iter()
                .map(|s| f64::from(s.weight) / mean_weight * (f64::from(s.offset[axis]).powi(2) - expected))
                .collect();
            if moments.mean.abs() > table {
                t_test(&moments, 0.0, 2 * filters.len())
                    .unwrap_or_else(|e| panic!("{name}, axis {axis}: {e}"));
            }
        }
    }
}

#[test]
fn the_defaults_of_the_format_have_known_values() {
    let gaussian = Filter::new(&FilterDesc::default()).unwrap();
    let g = |x: f64| {
        (-x * x / 0.5).exp() / (std::f64::consts::TAU * 0.25).sqrt()
            - (-4.5_f64).exp() / (std::f64::consts::TAU * 0.25).sqrt()
    };
    let expected = g(0.3) * g(-0.9);
    assert!((f64::from(gaussian.evaluate(Vec2::new(0.3, -0.9))) - expected).abs() < 1e-6);
    let mitchell =
        Filter::new(&FilterDesc::Mitchell { radius: [2.0, 2.0], b: 1.0 / 3.0, c: 1.0 / 3.0 }).unwrap();
    assert!((mitchell.evaluate(Vec2::ZERO) - (8.0_f32 / 9.0).powi(2)).abs() < 1e-6);
    assert!((mitchell.evaluate(Vec2::new(1.0, 0.0)) - 8.0 / 9.0 / 18.0).abs() < 1e-6);
    assert!((mitchell.integral() - 1.0).abs() < 1e-6);
    let sinc = Filter::new(&FilterDesc::LanczosSinc { radius: [4.0, 4.0], tau: 3.0 }).unwrap();
    assert_eq!(sinc.evaluate(Vec2::ZERO), 1.0);
    assert!(sinc.evaluate(Vec2::new(1.5, 0.0)) < 0.0, "the first lobe is negative");
}

#[test]
fn invalid_parameters_are_refused_by_name() {
    for (desc, parameter) in [
        (FilterDesc::Box { radius: [0.0, 1.0] }, "xradius"),
        (FilterDesc::Box { radius: [1.0, f32::NAN] }, "yradius"),
        (FilterDesc::Triangle { radius: [-1.0, 1.0] }, "xradius"),
        (FilterDesc::Gaussian { radius: [1.0, 2.0 * MAX_RADIUS], sigma: 0.5 }, "yradius"),
        (FilterDesc::Gaussian { radius: [1.0, 1.0], sigma: 0.0 }, "sigma"),
        (FilterDesc::Mitchell { radius: [1.0, 1.0], b: f32::INFINITY, c: 0.0 }, "B"),
        (FilterDesc::LanczosSinc { radius: [1.0, 1.0], tau: -3.0 }, "tau"),
    ] {
        let (named, message) = Filter::new(&desc).unwrap_err();
        assert_eq!(named, parameter, "{message}");
    }
}

impl LaneFunction for Sampled<'_> {
    #[inline(always)]
    fn results<R: Real>(&self, u: &[R]) -> Vec<R> {
        let sample = self.0.sample(Vec2::new(u[0], u[1]));
        vec![sample.offset.x, sample.offset.y, sample.weight]
    }
}

/// A sample of a filter.
struct Sampled<'a>(&'a Filter);

#[test]
fn samples_do_not_depend_on_the_number_of_lanes() {
    for (_, filter) in all() {
        lanes_agree(&Sampled(&filter), 2, 200);
    }
}
