//! Implicit surfaces: against closed forms, against dense sampling, and where roots are
//! ill-conditioned.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

const BARTH: &str = "4*((3+sqrt(5))/2*x^2 - y^2)*((3+sqrt(5))/2*y^2 - z^2)*((3+sqrt(5))/2*z^2 - x^2)
    - (2+sqrt(5))*(x^2 + y^2 + z^2 - 1)^2";
const STEINER: &str = "x^2*y^2 + y^2*z^2 + z^2*x^2 + x*y*z";
const CAYLEY: &str = "4*(x^2 + y^2 + z^2) + 16*x*y*z - 1";
const TORUS: &str = "(x^2 + y^2 + z^2 + 0.91)^2 - 4*(x^2 + y^2)";

/// Formulas of every kind: quadrics to high degrees, singular points, functions, kinks, domain
/// boundaries.
const FORMULAS: [&str; 16] = [
    "x^2 + 0.5*y^2 + 2*z^2 - 1",
    "x^2 + y^2 - z^2",
    "x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 0.4",
    TORUS,
    "(sqrt(x^2 + y^2) - 1)^2 + z^2 - 0.09",
    CAYLEY,
    STEINER,
    BARTH,
    "x^10 + y^10 + z^10 - 1",
    "x^40 + y^40 + z^40 - 1",
    "sin(5*x)*cos(5*y) + sin(5*y)*cos(5*z) + sin(5*z)*cos(5*x)",
    "max(abs(x) + abs(y) + abs(z) - 1.3, 0.6 - sqrt(x*x + y*y))",
    "exp(-3*((x-0.6)^2 + y^2 + z^2)) + exp(-3*((x+0.6)^2 + y^2 + z^2)) - 0.5",
    "z - 0.3*tan(2*x) + log(y + 1)",
    "1/(x^2 + y^2 + 0.1) + 1/z - 2",
    "pow(x*x, 0.3) + pow(y*y, 0.3) + pow(z*z, z + 3) - 1.1",
];

fn formula(text: &str) -> Formula {
    Formula::parse(text).unwrap_or_else(|error| panic!("{text}: {error}"))
}

fn cube_of(half: f32) -> Bounds3 {
    Bounds3 { min: Vec3::splat(-half), max: Vec3::splat(half) }
}

fn surface(text: &str, m: &Transform) -> Shape {
    Implicit::new(m, false, formula(text), &cube_of(1.6)).into()
}

fn first(shape: &Shape, o: Vec3, d: Vec3) -> Option<f32> {
    shape.intersect(&Ray::new(o, d, 0.0), f32::INFINITY).map(|hit| hit.t)
}

fn value(formula: &Formula, p: DVec3) -> f64 {
    formula.value(p.to_array())
}

/// The formula is zero at the first hit, and has the same sign at all samples before it.
#[test]
fn hits_are_the_first_roots_of_dense_sampling() {
    const STEPS: usize = 4000;
    let rng = &mut Rng::new(1, 0);
    let mut hits = 0;
    for text in FORMULAS {
        let (f, shape) = (formula(text), surface(text, &Transform::IDENTITY));
        for _ in 0..300 {
            let o = direction(rng) * 4.0;
            let d = point_in(rng, 1.0) - o;
            let (o64, d64) = (o.as_dvec3(), d.as_dvec3());
            let inside = |p: DVec3| p.abs().max_element() <= 1.6;
            let at = |i: usize| 2.0 * i as f64 / STEPS as f64;
            let point = |t: f64| o64 + d64 * t;
            // Signs change at roots and at poles; near a pole the formula is large.
            let change = (0..STEPS).find(|&i| {
                let (p, q) = (point(at(i)), point(at(i + 1)));
                let (a, b) = (value(&f, p), value(&f, q));
                inside(p) && inside(q) && a * b < 0.0 && a.abs().max(b.abs()) < 30.0
            });
            let hit = first(&shape, o, d);
            if let Some(i) = change {
                let t =
                    hit.unwrap_or_else(|| panic!("{text}: nothing found along {o} {d}, but at {}", at(i)));
                assert!(t as f64 <= at(i + 1), "{text}: {t} is behind {} along {o} {d}", at(i + 1));
            }
            let Some(t) = hit else { continue };
            hits += 1;
            // Between the floats around a root the formula changes its sign, or is small compared
            // with its change.
            let t = t as f64;
            let around = [-2e-6, -1e-6, 0.0, 1e-6, 2e-6].map(|h| value(&f, point(t + h)));
            let known: Vec<f64> = around.into_iter().filter(|value| value.is_finite()).collect();
            let (low, high) = known.iter().fold((f64::MAX, f64::MIN), |(a, b), &v| (a.min(v), b.max(v)));
            assert!(
                low <= high - low && -high <= high - low || low.abs() < 1e-9,
                "{text}: {around:?} at {t} along {o} {d}"
            );
        }
    }
    assert!(hits > 2000, "{hits}");
}

#[test]
fn an_implicit_sphere_equals_the_sphere() {
    let rng = &mut Rng::new(2, 0);
    let turn = Transform::translate(Vec3::new(3.0, -2.0, 1.0))
        .after(&Transform::rotate(0.7, Vec3::new(0.3, 1.0, -0.2)));
    for m in [turn, turn.after(&Transform::scale(Vec3::new(0.6, 1.3, -0.9)))] {
        for reverse in [false, true] {
            let formula = formula("x^2 + y^2 + z^2 - 1");
            let implicit = Shape::from(Implicit::new(&m, reverse, formula, &cube_of(1.5)));
            let sphere = Shape::from(Sphere::whole(&m, reverse, 1.0));
            for _ in 0..2000 {
                let o = m.point(direction(rng) * between(rng, 0.0, 9.0));
                let ray = Ray::new(o, m.point(point_in(rng, 0.8)) - o, 0.3);
                let (Some(a), Some(b)) = (sphere.intersect(&ray, 9.0), implicit.intersect(&ray, 9.0)) else {
                    assert_eq!(
                        sphere.intersect(&ray, 9.0).map(|hit| hit.t),
                        implicit.intersect(&ray, 9.0).map(|hit| hit.t)
                    );
                    continue;
                };
                assert!((a.t - b.t).abs() <= 1e-6 * (1.0 + a.t), "{a:?} {b:?}");
                let (a, b) = (sphere.surface(&ray, &a), implicit.surface(&ray, &b));
                assert!(a.p.p.distance(b.p.p) < 2e-6 && a.n.distance(b.n) < 1e-5, "{a:?} {b:?}");
                assert!((a.uv - b.uv).length() < 1e-5 || a.uv.x.min(b.uv.x) < 1e-5);
                assert!(b.p.error.max_element() < 2e-6, "{:?}", b.p.error);
                if a.dpdu.length() > 0.3 {
                    for (a, b) in [(a.dpdu, b.dpdu), (a.dpdv, b.dpdv), (a.dndu, b.dndu), (a.dndv, b.dndv)] {
                        assert!(a.distance(b) < 1e-3 * (1.0 + a.length()), "{a} {b}");
                    }
                }
            }
        }
    }
}

/// The axis of the tube has radius 1, the tube 0.3.
#[test]
fn torus_hits_in_closed_form() {
    for text in [TORUS, "(sqrt(x^2 + y^2) - 1)^2 + z^2 - 0.09"] {
        let torus = surface(text, &Transform::IDENTITY);
        for i in 0..200 {
            let h = i as f32 / 200.0 * 0.299;
            // In the plane at height h, through the centre and off-centre.
            let expected = 5.0 - 1.0 - (0.09 - h * h).sqrt();
            let t = first(&torus, Vec3::new(-5.0, 0.0, h), Vec3::X).expect("a hit");
            assert!((t - expected).abs() < 2e-6, "{t} {expected}");
            let outer = 1.0 + (0.09 - h * h).sqrt();
            let y = i as f32 / 200.0;
            let expected = 5.0 - (outer * outer - y * y).sqrt();
            let t = first(&torus, Vec3::new(-5.0, y, h), Vec3::X).expect("a hit");
            assert!((t - expected).abs() < 2e-6, "{t} {expected}");
            // Along the axis through the hole, and onto the top.
            assert_eq!(first(&torus, Vec3::new(0.5 * y, 0.0, 4.0), -Vec3::Z), None);
        }
        let t = first(&torus, Vec3::new(0.0, 1.0, 4.0), -Vec3::Z).expect("the crest");
        assert!((t - 3.7).abs() < 1e-6);
    }
}

#[test]
fn tangent_rays() {
    let at = |text: &str, o: Vec3, d: Vec3| first(&surface(text, &Transform::IDENTITY), o, d);
    let sphere = "x^2 + y^2 + z^2 - 1";
    let high = |x: f32| Vec3::new(x, 0.0, 5.0);
    let touched = at(sphere, high(1.0), -Vec3::Z).expect("touched");
    assert!((touched - 5.0).abs() < 1e-5);
    assert_eq!(at(sphere, high(1.000001), -Vec3::Z), None);
    let near = at(sphere, high(0.999999), -Vec3::Z).expect("cut");
    assert!(
        (near - (5.0 - (1.0 - 0.999999f32 as f64 * 0.999999f32 as f64).sqrt() as f32)).abs() < 1e-6,
        "{near}"
    );
    // A ray in the plane that is tangent to a torus along a circle.
    let crest = at(TORUS, Vec3::new(-3.0, 0.0, 0.3), Vec3::X);
    assert!(
        crest.is_none_or(|t| (t - 2.0).abs() < 1e-3),
        "{crest:?}: 0.3 is a little more than 0.3 in floats"
    );
    assert_eq!(at(TORUS, Vec3::new(-3.0, 0.0, 0.30001), Vec3::X), None);
    // Planes of multiplicity two and four, where the sign does not change.
    for text in ["z^2", "z^4", "z^2*(x^2 + 1)", "abs(z)", "(sin(z))^2"] {
        let t = at(text, Vec3::new(0.1, 0.2, 1.0), Vec3::new(0.1, 0.2, -1.0)).expect(text);
        assert!((t - 1.0).abs() < 3e-3, "{text}: {t}");
    }
    // Zero everywhere: the whole box is hit.
    assert!((at("x - x", Vec3::new(0.1, 0.2, 3.6), -Vec3::Z).expect("full") - 2.0).abs() < 1e-5);
}

#[test]
fn thin_shells_are_hit() {
    let rng = &mut Rng::new(3, 0);
    for exponent in [4, 6, 8, 10, 12] {
        // Two spheres that are 10^(-exponent/2) apart.
        let shell = surface(&format!("(x^2 + y^2 + z^2 - 1)^2 - 1e-{exponent}"), &Transform::IDENTITY);
        let sheet = surface(&format!("(z - 0.1*x)*(z - 0.1*x - 1e-{exponent})"), &Transform::IDENTITY);
        for _ in 0..300 {
            let o = direction(rng) * 3.0;
            let d = point_in(rng, 0.5) - o;
            let t = first(&shell, o, d).expect("the near side");
            let radius = (o.as_dvec3() + d.as_dvec3() * t as f64).length();
            assert!((radius - (1.0 + 10f64.powf(-0.5 * exponent as f64)).sqrt()).abs() < 1e-6, "{radius}");
            let target = Vec3::new(between(rng, -1.0, 1.0), between(rng, -1.0, 1.0), 0.0);
            let target = target + Vec3::Z * (0.1 * target.x);
            let o = Vec3::new(0.3, 0.2, -3.0);
            let t = first(&sheet, o, target - o).expect("the sheet");
            assert!((t - 1.0).abs() < 1e-5);
        }
    }
}

/// Rays through apexes, nodes and double lines, from all sides.
#[test]
fn singular_points() {
    let rng = &mut Rng::new(4, 0);
    for (text, points) in [
        ("x^2 + y^2 - z^2", vec![Vec3::ZERO]),
        ("sqrt(x^2 + y^2) - z", vec![Vec3::ZERO]),
        ("x^2 + y^2 - z^3", vec![Vec3::ZERO]),
        (CAYLEY, vec![Vec3::new(0.5, 0.5, -0.5), Vec3::new(0.5, -0.5, 0.5), Vec3::new(-0.5, -0.5, -0.5)]),
        (STEINER, vec![Vec3::ZERO, Vec3::X * 0.375, Vec3::Y * 0.25, Vec3::Z * 0.4375]),
    ] {
        let shape = surface(text, &Transform::IDENTITY);
        for target in points {
            for _ in 0..300 {
                // On a grid, so that the ray passes through the point without rounding.
                let o = target + (direction(rng) * 320.0).map(f32::round) / 64.0;
                let ray = Ray::new(o, target - o, 0.0);
                let hit = shape
                    .intersect(&ray, f32::INFINITY)
                    .unwrap_or_else(|| panic!("{text} at {target} from {o}"));
                assert!(hit.t < 1.0 + 1e-3, "{text}: {} from {o}", hit.t);
                let point = shape.surface(&ray, &hit);
                assert!((point.n.length() - 1.0).abs() < 1e-5 && point.p.p.is_finite(), "{text}: {point:?}");
                assert!(
                    point.uv.is_finite() && point.dpdu.is_finite() && point.dndv.is_finite(),
                    "{text}: {point:?}"
                );
            }
        }
    }
}

#[test]
fn distant_origins_add_only_their_own_rounding_error() {
    let rng = &mut Rng::new(5, 0);
    for distance in [1e2f32, 1e4, 1e6] {
        for text in ["x^2 + y^2 + z^2 - 1", "x^4 + y^4 + z^4 - 1", "sqrt(x^2 + y^2 + z^2) - 1"] {
            let (f, shape) = (formula(text), surface(text, &Transform::IDENTITY));
            for _ in 0..300 {
                let o = direction(rng) * distance;
                let ray = Ray::new(o, point_in(rng, 0.4) - o, 0.0);
                let hit = shape.intersect(&ray, f32::INFINITY).expect("a hit");
                let p = shape.surface(&ray, &hit).p;
                assert!(value(&f, p.p.as_dvec3()).abs() < 2e-6, "{text} from {distance}: {p:?}");
                assert!(p.error.max_element() < 1e-6, "{p:?}");
            }
        }
    }
}

/// Huge bounds do not matter: rays that start near the surface hit it as in tight bounds, with
/// directions of any length.
#[test]
fn small_surfaces_in_huge_bounds() {
    let bounded = ["x^2 + y^2 + z^2 - 1", FORMULAS[2], TORUS, FORMULAS[4], FORMULAS[9], FORMULAS[12]];
    let rng = &mut Rng::new(12, 0);
    for text in bounded {
        let near = surface(text, &Transform::IDENTITY);
        let rays: Vec<_> =
            (0..200).map(|i| (direction(rng) * [2.5, 60.0][i % 2], point_in(rng, 1.4))).collect();
        for half in [1e3, 1e6, 1e9, 1e12, 1e20, 1e30, 1e38] {
            let huge: Shape =
                Implicit::new(&Transform::IDENTITY, false, formula(text), &cube_of(half)).into();
            for &(o, p) in &rays {
                for length in [1.0, 1e9] {
                    let d = (p - o) * length;
                    let (expected, found) = (first(&near, o, p - o), first(&huge, o, d));
                    let is_same = match (expected, found) {
                        (Some(a), Some(b)) => (a - b * length).abs() < 1e-5,
                        (None, None) => true,
                        _ => false,
                    };
                    assert!(is_same, "{text} within {half}, {o} to {p}: {expected:?}, {found:?} of {length}");
                }
            }
        }
    }
}

#[test]
fn poles_are_not_hit() {
    let at =
        |text: &str, d: Vec3| first(&surface(text, &Transform::IDENTITY), Vec3::new(-1.5, 0.01, 0.02), d);
    assert_eq!(at("1/x", Vec3::X), None);
    assert_eq!(at("1/(x - 0.1)^3", Vec3::X), None);
    let t = at("tan(3*x)", Vec3::X).expect("where the sine is zero");
    assert!((t - 1.5 + std::f32::consts::FRAC_PI_3).abs() < 1e-6, "{t}");
    assert_eq!(at("log(x) - 5", Vec3::X), None);
    let t = at("sqrt(x - 0.5) - 0.5", Vec3::X).expect("a hit");
    assert!((t - 2.25).abs() < 1e-6);
    let edge = at("sqrt(x - 0.5)", Vec3::X).expect("the edge of the domain");
    assert!((edge - 2.0).abs() < 1e-6);
}

/// Formulas that vary faster than can be resolved take bounded time, and degenerate rays hit
/// nothing.
#[test]
fn hostile_formulas_and_rays_terminate() {
    let rng = &mut Rng::new(6, 0);
    for text in [
        "sin(1e9*x)",
        "sin(1/x) + 0.5",
        "tan(1e7*x*y)",
        "exp(exp(exp(x*9)))-2",
        "x^256 - y^256",
        "1/sin(1e8*z)",
        "x/x",
        "pow(x, y) - 1e300*z",
    ] {
        let shape = surface(text, &Transform::IDENTITY);
        for _ in 0..20 {
            let ray = Ray::new(point_in(rng, 3.0), direction(rng), 0.0);
            if let Some(hit) = shape.intersect(&ray, f32::INFINITY) {
                assert!(hit.t > 0.0 && shape.surface(&ray, &hit).p.p.is_finite(), "{text}");
            }
        }
    }
    let shape = surface("x^2 + y^2 + z^2 - 1", &Transform::IDENTITY);
    for (o, d) in [
        (Vec3::ZERO, Vec3::ZERO),
        (Vec3::ZERO, Vec3::splat(f32::MIN_POSITIVE)),
        (Vec3::ZERO, Vec3::splat(1e38)),
        (Vec3::splat(f32::MAX), Vec3::X),
        (Vec3::splat(-1e30), Vec3::splat(1e30)),
        (Vec3::splat(f32::NAN), Vec3::X),
        (Vec3::ZERO, Vec3::splat(f32::INFINITY)),
        (Vec3::X, Vec3::new(0.0, -0.0, 1e-30)),
    ] {
        for t_max in [0.0, 1.0, f32::INFINITY, f32::NAN] {
            let hit = shape.intersect(&Ray::new(o, d, 0.0), t_max);
            assert!(hit.is_none_or(|hit| hit.t > 0.0 && hit.t < t_max), "{o} {d} {t_max}: {hit:?}");
        }
    }
}

/// Rays that leave the convex side of a surface never hit it again.
#[test]
fn spawned_rays_do_not_hit_their_own_surface() {
    let rng = &mut Rng::new(7, 0);
    for i in 0..24 {
        let size = [1.0f32, 1e-3, 1e4][i % 3];
        let place = Transform::translate(direction(rng) * size * [0.0, 3.0, 1e3, 1e4][i % 4]);
        let m = place
            .after(&Transform::rotate(between(rng, 0.0, 6.0), direction(rng)))
            .after(&Transform::scale(Vec3::new(1.0, 0.4, -1.3) * size));
        for text in [
            "x^2 + y^2 + z^2 - 1",
            "x^4 + y^4 + z^4 - 1",
            "sqrt(x^2 + 2*y^2) + abs(z) - 1",
            "z",
            "z^2",
            "exp(z) - 1",
        ] {
            let shape = surface(text, &m);
            let is_flat = text.contains('z') && !text.contains('x');
            for _ in 0..200 {
                let o = m.point(direction(rng) * 3.0);
                let ray = Ray::new(o, m.point(point_in(rng, 0.5)) - o, 0.0);
                let Some(hit) = shape.intersect(&ray, f32::INFINITY) else { continue };
                let point = shape.surface(&ray, &hit);
                let out = if is_flat {
                    point.n
                } else {
                    face_forward(point.n, m.normal(m.inverse().point(point.p.p)))
                };
                let next = point.spawn_ray(face_forward(direction(rng), out));
                assert_eq!(
                    shape.intersect(&next, f32::INFINITY),
                    None,
                    "{text} under transform {i}: {point:?} {next:?}"
                );
                if is_flat {
                    let through = point.spawn_ray(face_forward(direction(rng), -out));
                    assert_eq!(shape.intersect(&through, f32::INFINITY), None, "{text} under transform {i}");
                }
            }
        }
    }
}

#[test]
fn the_bounds_clip_the_surface() {
    let bounds = Bounds3 { min: Vec3::new(-1.0, -1.0, 0.0), max: Vec3::ONE };
    let dome =
        Shape::from(Implicit::new(&Transform::IDENTITY, false, formula("x^2 + y^2 + z^2 - 1"), &bounds));
    assert_eq!(first(&dome, Vec3::new(0.0, 0.0, -5.0), Vec3::Z), Some(6.0), "through the open bottom");
    assert_eq!(first(&dome, Vec3::new(0.0, -5.0, -0.1), Vec3::Y), None);
    assert_eq!(first(&dome, Vec3::new(0.0, -5.0, 0.1), Vec3::Y).map(|t| (t * 10.0).round()), Some(40.0));
    assert!(dome.bounds().is_some_and(|b| b.min.z > -1e-5 && b.max.z < 1.0 + 1e-5));
    assert!(dome.sample(Vec2::splat(0.5)).is_none() && dome.area() == 0.0);
    assert!(formula("x^2 + 4").has_no_zero(&bounds) && !formula("x^2 - 0.5").has_no_zero(&bounds));
}
