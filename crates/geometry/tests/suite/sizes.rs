//! Worlds scaled by powers of two: the same hits, points and densities, but for the scale.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

/// Meshes, patches and quadrics in units of `unit`: few facets, or all in trees.
fn world_of(unit: f32, are_few: bool) -> World {
    let m = |x: f32, size: f32| {
        let (x, size) = (f64::from(x * unit), f64::from(size * unit));
        let m = DMat4::from_translation(DVec3::new(x, 0.0, 0.0)) * DMat4::from_scale(DVec3::splat(size));
        Transform::from_f64(m).expect("an inverse")
    };
    let patch = |lift: f32| {
        let p = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, lift)];
        Shape::from(BilinearPatch::new(p, None, None, &m(1.0, 1.0), false))
    };
    let patches = Geometry::Shapes(vec![patch(0.0), patch(0.25)].into());
    let mut geometries: Vec<Geometry> = vec![cube(&m(-1.0, 0.5)).into(), patches];
    if !are_few {
        geometries.push(ball(12, 0.1, &m(0.0, 0.5)).into());
        geometries.push(Shape::from(Sphere::whole(&m(-2.0, 1.0), false, 0.25)).into());
    }
    world(geometries)
}

/// The points of hits of some rays in units of `unit`, computed in batches.
fn points(unit: f32, are_few: bool) -> Vec<Option<(Hit, SurfacePoint, [Vec3; 5])>> {
    let (rng, world) = (&mut Rng::new(7, 0), world_of(unit, are_few));
    let rays: RayBuffer = (0..3000)
        .map(|_| {
            let o = point_in(rng, 3.0);
            (Ray::new(o * unit, point_in(rng, 1.0) - o * 0.5, 0.0), f32::INFINITY)
        })
        .collect();
    let rays = rays.columns();
    let mut hits = HitColumns::default();
    world.intersect_batch(rays, &Accepts::All, &mut hits, &mut RayStats::default());
    let places: Vec<u32> = (0..rays.len() as u32).filter(|&i| hits.get(i as usize).is_some()).collect();
    let mut points = PointColumns::default();
    world.points(rays, &hits, &places, &mut points);
    let mut all = vec![None; rays.len()];
    for (i, &place) in places.iter().enumerate() {
        let hit = hits.get(place as usize).expect("a hit");
        let surface = world.surface(&rays.ray(place as usize), &hit);
        let p = points.get::<f32>(i);
        all[place as usize] = Some((hit, surface, [p.p.p, p.n, p.ns, p.dpdu, p.dpdv]));
    }
    all
}

#[test]
fn scaled_worlds_have_the_same_points() {
    let mut wrong = Vec::new();
    for are_few in [true, false] {
        let plain = points(1.0, are_few);
        assert!(plain.iter().flatten().count() > 100);
        for exponent in [-60, -50, -40, -30, -15, 15, 30, 40, 50, 60] {
            let unit = 2f32.powi(exponent);
            let scaled = points(unit, are_few);
            // Where rays graze an edge, rounding decides.
            let differing = plain.iter().zip(&scaled).filter(|(a, b)| match (a, b) {
                (None, None) => false,
                (Some((hit, surface, lanes)), Some((other, found, in_lanes))) => {
                    let near = |a: Vec3, b: Vec3| (a - b).length() < 1e-4 * (1.0 + b.length());
                    let [p, n, ns, dpdu, dpdv] = *in_lanes;
                    let back = 1.0 / unit;
                    let is_same = near(p * back, lanes[0])
                        && near(n, lanes[1])
                        && near(ns, lanes[2])
                        && near(dpdu * back, lanes[3])
                        && near(dpdv * back, lanes[4])
                        && near(found.n, surface.n)
                        && near(found.p.p * back, surface.p.p)
                        && near(found.dpdu * back, surface.dpdu);
                    !(is_same && (other.t / unit / hit.t - 1.0).abs() < 1e-4)
                }
                _ => true,
            });
            let count = differing.count();
            if count > 10 {
                wrong.push(format!("2^{exponent}: {count} points differ"));
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}

#[test]
fn densities_of_lights_do_not_depend_on_the_unit() {
    let rng = &mut Rng::new(9, 0);
    // Squares of lengths are floats.
    for (size, least) in [(1.0, -55), (1e-3, -45)] {
        for _ in 0..50 {
            let corners = [(); 3].map(|_| point_in(rng, size));
            let side = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y].map(|p| p * size);
            let (p, ns) = (direction(rng) * 3.0, direction(rng));
            let u = uniform_2d(rng);
            let sample = |exponent: i32| {
                let unit = 2f32.powi(exponent);
                let m = Transform::IDENTITY;
                let shapes: [Shape; 2] = [
                    Triangle::new(corners.map(|p| p * unit)).into(),
                    BilinearPatch::new(side.map(|p| p * unit), None, None, &m, false).into(),
                ];
                let p = Point3Error::exact(p * unit);
                let reference = ShapeSampleContext { p, n: ns, ns, time: 0.0 };
                shapes.map(|shape| {
                    let flat = shape.flat_shape().expect("a flat shape");
                    let (sample, valid) = flat.sample_from(&reference, u);
                    assert!(valid, "2^{exponent}");
                    let single = shape.sample_from(&reference, u).expect("a sample");
                    [sample.pdf, single.pdf, flat.pdf_from(&reference, sample.uv)]
                })
            };
            let plain = sample(0);
            for exponent in [least, -30, 30, 55] {
                for (found, expected) in sample(exponent).as_flattened().iter().zip(plain.as_flattened()) {
                    assert!((found / expected - 1.0).abs() < 1e-4, "2^{exponent}: {found}, not {expected}");
                }
            }
        }
    }
}

#[test]
fn a_sphere_far_larger_than_its_distance_is_met_there() {
    for radius in [1e5, 6.371e6, 2e9] {
        let m = DMat4::from_translation(DVec3::new(0.0, -3.0 - radius, 4.0));
        let sphere = Sphere::whole(&Transform::from_f64(m).expect("an inverse"), false, radius as f32);
        let world = world([Shape::from(sphere).into()]);
        let hit = nearest(&world, &Ray::new(Vec3::ZERO, Vec3::new(0.0, -0.6, 0.8), 0.0)).expect("a hit");
        assert!((hit.t - 5.0).abs() < 1e-3, "{radius}: {}", hit.t);
    }
}
