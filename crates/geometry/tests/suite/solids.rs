//! Solids: hits against point membership, and closed boundaries.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

/// A solid, and the membership test of its points.
struct Body {
    solid: Solid,
    contains: Box<dyn Fn(DVec3) -> bool>,
}

fn choice(rng: &mut Rng, n: usize) -> usize {
    ((rng.uniform_f32() * n as f32) as usize).min(n - 1)
}

fn random_transform(rng: &mut Rng) -> Transform {
    let stretch = Vec3::new(between(rng, 0.6, 1.2), between(rng, 0.6, 1.2), between(rng, -1.2, -0.6));
    Transform::translate(point_in(rng, 0.5))
        .after(&Transform::rotate(between(rng, 0.0, 6.0), direction(rng)))
        .after(&Transform::scale(if rng.uniform_f32() < 0.5 { stretch } else { stretch.abs() }))
}

fn formula(text: &str) -> Formula {
    Formula::parse(text).expect("a formula")
}

fn single(rng: &mut Rng) -> Body {
    let m = random_transform(rng);
    let inverse = m.matrix().as_dmat4().inverse();
    let place = move |p: DVec3| inverse.transform_point3(p);
    let bounds = Bounds3 { min: Vec3::new(-0.9, -1.0, -1.1), max: Vec3::new(1.0, 0.7, 1.0) };
    let in_box = move |q: DVec3| q.cmpge(bounds.min.as_dvec3()).all() && q.cmple(bounds.max.as_dvec3()).all();
    match choice(rng, 9) {
        0 => Body {
            solid: Solid::sphere(&m, 1.0, [-1.0, 1.0]),
            contains: Box::new(move |p| place(p).length_squared() < 1.0),
        },
        1 => Body {
            solid: Solid::sphere(&m, 1.0, [0.5, -0.25]),
            contains: Box::new(move |p| {
                let q = place(p);
                q.length_squared() < 1.0 && q.z > -0.25 && q.z < 0.5
            }),
        },
        2 => Body {
            solid: Solid::cylinder(&m, 0.75, [-1.0, 0.5]),
            contains: Box::new(move |p| {
                let q = place(p);
                q.x.hypot(q.y) < 0.75 && q.z > -1.0 && q.z < 0.5
            }),
        },
        6 => Body {
            solid: Solid::cone(&m, 0.75, 1.25),
            contains: Box::new(move |p| {
                let q = place(p);
                q.z > 0.0 && q.z < 1.25 && q.x.hypot(q.y) < 0.6 * (1.25 - q.z)
            }),
        },
        7 => Body {
            solid: Solid::paraboloid(&m, 1.0, [0.25, 1.0]),
            contains: Box::new(move |p| {
                let q = place(p);
                q.z > 0.25 && q.z < 1.0 && q.x * q.x + q.y * q.y < q.z
            }),
        },
        8 => Body {
            // The line x = 0.25, y = z.
            solid: Solid::hyperboloid(&m, [Vec3::new(0.25, -0.75, -0.75), Vec3::new(0.25, 1.0, 1.0)]),
            contains: Box::new(move |p| {
                let q = place(p);
                q.z > -0.75 && q.z < 1.0 && q.x * q.x + q.y * q.y < 0.0625 + q.z * q.z
            }),
        },
        3 => Body { solid: Solid::below_plane(&m), contains: Box::new(move |p| place(p).z < 0.0) },
        4 => Body {
            solid: Solid::implicit(&m, formula("x^4 + y^4 + z^4 - x^2 - y^2 - z^2 + 0.4"), &bounds),
            contains: Box::new(move |p| {
                let q = place(p);
                let [x, y, z] = (q * q).to_array();
                in_box(q) && x * x + y * y + z * z - x - y - z + 0.4 < 0.0
            }),
        },
        _ => Body {
            solid: Solid::implicit(
                &m,
                formula("sin(4*x)*cos(4*y) + sin(4*y)*cos(4*z) + sin(4*z)*cos(4*x)"),
                &bounds,
            ),
            contains: Box::new(move |p| {
                let q = place(p);
                let [x, y, z] = (q * 4.0).to_array();
                in_box(q) && x.sin() * y.cos() + y.sin() * z.cos() + z.sin() * x.cos() < 0.0
            }),
        },
    }
}

fn body(rng: &mut Rng, depth: usize) -> Body {
    if depth == 0 {
        return single(rng);
    }
    let count = 2 + choice(rng, 2);
    let (mut solids, mut tests) = (Vec::new(), Vec::new());
    for _ in 0..count {
        let inner = choice(rng, depth);
        let Body { solid, contains } = body(rng, inner);
        solids.push(solid);
        tests.push(contains);
    }
    let operation = [Operation::Union, Operation::Intersection, Operation::Difference][choice(rng, 3)];
    let contains: Box<dyn Fn(DVec3) -> bool> = match operation {
        Operation::Union => Box::new(move |p| tests.iter().any(|test| test(p))),
        Operation::Intersection => Box::new(move |p| tests.iter().all(|test| test(p))),
        Operation::Difference => Box::new(move |p| tests[0](p) && !tests[1..].iter().any(|test| test(p))),
    };
    Body { solid: Solid::combine(operation, solids).expect("operands"), contains }
}

#[test]
fn the_first_hit_is_the_first_boundary() {
    const STEPS: usize = 2000;
    let rng = &mut Rng::new(1, 0);
    let (mut hits, mut edges) = (0, 0);
    for i in 0..1000 {
        let Body { solid, contains } = body(rng, i % 4);
        let shape = Shape::from(solid);
        for _ in 0..40 {
            let o = direction(rng) * between(rng, 0.0, 4.0);
            let ray = Ray::new(o, point_in(rng, 1.0) - o, 0.0);
            let point = |t: f64| ray.o.as_dvec3() + ray.d.as_dvec3() * t;
            let at = |i: usize| 2.0 * i as f64 / STEPS as f64;
            let mut inside = (0..=STEPS).map(|i| contains(point(at(i))));
            let first = inside.next();
            let change = inside.position(|is_inside| Some(is_inside) != first);
            let hit = shape.intersect(&ray, f32::INFINITY);
            if let Some(step) = change {
                let t =
                    hit.unwrap_or_else(|| panic!("solid {i}: nothing, but at {} along {ray:?}", at(step))).t;
                assert!(
                    f64::from(t) <= at(step + 1) + 1e-6,
                    "solid {i}: {t} is behind {} along {ray:?}",
                    at(step + 1)
                );
            }
            let Some(hit) = hit else { continue };
            hits += 1;
            let surface = shape.surface(&ray, &hit);
            let (p, n) = (surface.p.p.as_dvec3(), surface.n.as_dvec3());
            assert!(surface.p.p.distance(ray.at(hit.t)) < 1e-5 * (1.0 + surface.p.p.length()), "solid {i}");
            assert!(
                (surface.n.length() - 1.0).abs() < 1e-5 && surface.uv.is_finite(),
                "solid {i}: {surface:?}"
            );
            // Inside below the surface and outside above it, except near edges and on thin walls.
            let h = 1e-5 * (1.0 + f64::from(hit.t));
            edges += i32::from(contains(p + n * h) || !contains(p - n * h));
        }
    }
    assert!(hits > 16_000 && edges * 200 < hits, "{hits} hits, {edges} at edges");
}

/// Closed solids that contain the origin.
fn closed(m: &Transform) -> Vec<(&'static str, Solid)> {
    let at = |t: Transform| m.after(&t);
    let turned = |axis: Vec3| at(Transform::rotate(std::f32::consts::FRAC_PI_2, axis));
    let half_spaces = [Vec3::X, Vec3::Y, Vec3::Z].into_iter().flat_map(|axis| {
        let turn =
            Transform::rotate(std::f32::consts::FRAC_PI_2, if axis == Vec3::X { Vec3::Y } else { Vec3::X });
        let turn = if axis == Vec3::Z { Transform::IDENTITY } else { turn };
        let flip = turn.after(&Transform::rotate(std::f32::consts::PI, Vec3::X));
        let away = Transform::translate(Vec3::Z * 0.8);
        [turn.after(&away), flip.after(&away)]
    });
    let cylinder = || Solid::cylinder(m, 0.6, [-1.5, 1.5]);
    let bounds = Bounds3 { min: Vec3::splat(-1.0), max: Vec3::splat(0.9) };
    let combine = |operation, solids: Vec<Solid>| Solid::combine(operation, solids).expect("operands");
    let shifted = |v: Vec3| at(Transform::translate(v));
    vec![
        ("a cylinder", cylinder()),
        ("a cone", Solid::cone(&shifted(Vec3::Z * -0.5), 1.0, 1.5)),
        ("a bowl", Solid::paraboloid(&shifted(Vec3::Z * -0.5), 1.0, [0.125, 1.0])),
        ("a waist", Solid::hyperboloid(m, [Vec3::new(0.5, -1.0, -1.0), Vec3::new(0.5, 0.5, 0.75)])),
        ("a cut ball", Solid::sphere(m, 1.0, [-0.5, 0.75])),
        ("a capped formula", Solid::implicit(m, formula("x^2 + y^2 - z^2 - 0.3"), &bounds)),
        (
            "a box of planes",
            combine(Operation::Intersection, half_spaces.map(|t| Solid::below_plane(&at(t))).collect()),
        ),
        (
            "a cross",
            combine(
                Operation::Union,
                vec![
                    cylinder(),
                    Solid::cylinder(&turned(Vec3::X), 0.6, [-1.5, 1.5]),
                    Solid::sphere(m, 1.0, [-1.0, 1.0]),
                ],
            ),
        ),
        (
            "a lens",
            combine(
                Operation::Intersection,
                vec![
                    Solid::sphere(&shifted(Vec3::X * 0.7), 1.0, [-1.0, 1.0]),
                    Solid::implicit(
                        &shifted(Vec3::X * -0.7),
                        formula("x^2 + y^2 + z^2 - 1"),
                        &Bounds3 { min: Vec3::splat(-1.5), max: Vec3::splat(1.5) },
                    ),
                ],
            ),
        ),
        (
            "a bitten ball",
            combine(
                Operation::Difference,
                vec![
                    Solid::sphere(m, 1.5, [-1.5, 1.5]),
                    Solid::sphere(&shifted(Vec3::X * 1.5), 0.9, [-0.9, 0.9]),
                    Solid::cylinder(&shifted(Vec3::Y * -1.2), 0.5, [-2.0, 2.0]),
                ],
            ),
        ),
    ]
}

fn placed(rng: &mut Rng, i: usize) -> Transform {
    let size = [1.0f32, 1e-3, 1e4][i % 3];
    Transform::translate(direction(rng) * size * [0.0, 3.0][i % 2])
        .after(&Transform::rotate(between(rng, 0.0, 6.0), direction(rng)))
        .after(&Transform::scale(Vec3::new(1.0, 0.8, if i.is_multiple_of(2) { 1.3 } else { -1.3 }) * size))
}

#[test]
fn rays_inside_do_not_leak() {
    let rng = &mut Rng::new(2, 0);
    let mut past_edges = 0;
    for i in 0..6 {
        let m = placed(rng, i);
        for (name, solid) in closed(&m) {
            let world = world([Shape::from(solid).into()]);
            let start = |rng: &mut Rng| Ray::new(m.point(Vec3::ZERO), direction(rng), 0.0);
            let mut ray = start(rng);
            for step in 0..20_000 {
                let Some(hit) = nearest(&world, &ray) else {
                    // Near an acute edge, a step inwards from one face may end outside the other.
                    let is_sharp =
                        !matches!(name, "a cylinder" | "a cut ball" | "a box of planes" | "a cross");
                    assert!(is_sharp, "{name} under transform {i} leaks at step {step}: {ray:?}");
                    past_edges += 1;
                    ray = start(rng);
                    continue;
                };
                let surface = world.surface(&ray, &hit);
                assert!(
                    surface.n.dot(surface.wo) < 0.0,
                    "{name} under transform {i}: the outside of {surface:?}"
                );
                ray = surface.spawn_ray(face_forward(direction(rng), -surface.n));
            }
        }
    }
    assert!(past_edges < 6, "{past_edges} of 1.2 million rays passed edges");
}

#[test]
fn spawned_rays_do_not_hit_a_convex_solid() {
    let rng = &mut Rng::new(3, 0);
    for i in 0..12 {
        let m = placed(rng, i);
        for (name, solid) in closed(&m) {
            if !matches!(
                name,
                "a cylinder" | "a cone" | "a bowl" | "a cut ball" | "a box of planes" | "a lens"
            ) {
                continue;
            }
            let shape = Shape::from(solid);
            for _ in 0..1000 {
                let o = m.point(direction(rng) * 4.0);
                let ray = Ray::new(o, m.point(point_in(rng, 0.2)) - o, 0.0);
                let hit = shape.intersect(&ray, f32::INFINITY).expect("towards the middle");
                let surface = shape.surface(&ray, &hit);
                let next = surface.spawn_ray(face_forward(direction(rng), surface.n));
                assert_eq!(
                    shape.intersect(&next, f32::INFINITY),
                    None,
                    "{name} under transform {i}: {surface:?} {next:?}"
                );
                let inward = surface.spawn_ray(ray.d);
                let far = shape.intersect(&inward, f32::INFINITY).expect("the far side");
                let out = shape.surface(&inward, &far).spawn_ray(ray.d);
                assert_eq!(shape.intersect(&out, f32::INFINITY), None, "{name} under transform {i}");
            }
        }
    }
}

#[test]
fn hits_in_closed_form() {
    let m = &Transform::IDENTITY;
    let ball =
        |x: f32, radius: f32| Solid::sphere(&Transform::translate(Vec3::X * x), radius, [-radius, radius]);
    let meet = |operation: Operation, solids: Vec<Solid>, o: Vec3, d: Vec3| {
        let shape = Shape::from(Solid::combine(operation, solids).expect("operands"));
        let ray = Ray::new(o, d, 0.0);
        let hit = shape.intersect(&ray, 1e9)?;
        Some((hit.t, shape.surface(&ray, &hit).n))
    };
    use Operation::*;
    let left = Vec3::X * -5.0;
    assert_eq!(meet(Union, vec![ball(0.0, 1.0), ball(1.0, 1.0)], left, Vec3::X), Some((4.0, -Vec3::X)));
    assert_eq!(meet(Union, vec![ball(0.0, 1.0), ball(1.0, 1.0)], Vec3::ZERO, Vec3::X), Some((2.0, Vec3::X)));
    assert_eq!(
        meet(Intersection, vec![ball(0.0, 1.0), ball(1.0, 1.0)], left, Vec3::X),
        Some((5.0, -Vec3::X))
    );
    assert_eq!(meet(Intersection, vec![ball(0.0, 1.0), ball(3.0, 1.0)], left, Vec3::X), None);
    // The surface of the subtracted solid faces the cavity.
    let hollow = || vec![ball(0.0, 2.0), ball(0.0, 1.0)];
    assert_eq!(meet(Difference, hollow(), Vec3::ZERO, Vec3::X), Some((1.0, -Vec3::X)));
    assert_eq!(meet(Difference, hollow(), Vec3::X * 1.5, -Vec3::X), Some((0.5, -Vec3::X)));
    assert_eq!(meet(Difference, hollow(), Vec3::X * 1.5, Vec3::X), Some((0.5, Vec3::X)));
    // Coincident faces leave nothing between them.
    let tube = |low: f32, high: f32| Solid::cylinder(m, 1.0, [low, high]);
    assert_eq!(
        meet(Difference, vec![tube(0.0, 1.0), tube(0.0, 1.0)], Vec3::new(0.1, 0.2, 5.0), -Vec3::Z),
        None
    );
    assert_eq!(
        meet(
            Difference,
            vec![tube(0.0, 1.0), tube(-1.0, 1.0)],
            Vec3::new(0.1, 0.2, 5.0),
            Vec3::new(0.01, 0.02, -1.0)
        ),
        None
    );
    let joined = meet(Union, vec![tube(0.0, 1.0), tube(-1.0, 0.0)], Vec3::new(0.1, 0.2, 0.5), -Vec3::Z);
    assert_eq!(joined, Some((1.5, -Vec3::Z)), "no surface inside of a union");
    // An implicit surface is closed by its bounds.
    let half = Solid::implicit(
        m,
        formula("x^2 + y^2 + z^2 - 1"),
        &Bounds3 { min: Vec3::new(-2.0, -2.0, 0.0), max: Vec3::splat(2.0) },
    );
    assert_eq!(meet(Union, vec![half], Vec3::new(0.1, 0.2, -3.0), Vec3::Z), Some((3.0, -Vec3::Z)));
    assert!(Solid::combine(Union, []).is_none());
    let endless = Solid::combine(Union, [ball(0.0, 1.0), Solid::below_plane(m)]).map(Shape::from);
    assert_eq!(endless.and_then(|shape| shape.bounds()), None);
}

#[test]
fn degenerate_rays_terminate() {
    for (name, solid) in closed(&Transform::IDENTITY) {
        let shape = Shape::from(solid);
        for (o, d) in [
            (Vec3::ZERO, Vec3::ZERO),
            (Vec3::ZERO, Vec3::splat(f32::MIN_POSITIVE)),
            (Vec3::ZERO, Vec3::splat(1e38)),
            (Vec3::splat(f32::MAX), Vec3::X),
            (Vec3::splat(f32::NAN), Vec3::X),
            (Vec3::ZERO, Vec3::splat(f32::INFINITY)),
            (Vec3::new(1.0, 0.0, 0.0), Vec3::new(0.0, -0.0, 1e-30)),
        ] {
            for t_max in [0.0, 1.0, f32::INFINITY, f32::NAN] {
                let hit = shape.intersect(&Ray::new(o, d, 0.0), t_max);
                assert!(
                    hit.is_none_or(|hit| hit.t > 0.0 && hit.t < t_max),
                    "{name}: {o} {d} {t_max}: {hit:?}"
                );
            }
        }
    }
}
