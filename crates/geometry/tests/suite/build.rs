//! Worlds of every build quality find the same hits, and so do refitted worlds.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;
use std::sync::Arc;

const QUALITIES: [BuildQuality; 3] = [BuildQuality::Fast, BuildQuality::Balanced, BuildQuality::High];

fn build(quality: BuildQuality, geometries: &[Geometry]) -> World {
    let mut builder = World::builder().quality(quality);
    for geometry in geometries {
        builder.add_geometry(GroupId::TOP, geometry.clone());
    }
    builder.build()
}

fn rays(rng: &mut Rng, n: usize, reach: f32) -> Vec<Ray> {
    (0..n).map(|_| Ray::new(point_in(rng, reach), direction(rng), 0.0)).collect()
}

fn triangles(corners: Vec<[Vec3; 3]>) -> TriangleMesh {
    let indices = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    mesh(corners.concat(), indices, &Transform::IDENTITY)
}

/// Long thin triangles, oblique to all axes: a few sheets of strips.
fn strips(rng: &mut Rng, n: usize) -> TriangleMesh {
    let frames: Vec<Frame> = (0..5).map(|_| Frame::from_z(direction(rng))).collect();
    let strip = |i: usize| {
        let frame = &frames[i % 5];
        let x = i as f32 / n as f32 * 2.0 - 1.0;
        let corner = |x: f32, y: f32| frame.from_local(Vec3::new(x, y, 0.3));
        [corner(x, -1.0), corner(x + 5.0 / n as f32, -1.0), corner(x, 1.0)]
    };
    triangles((0..n).map(strip).collect())
}

fn brute_force(geometries: &[Geometry], ray: &Ray) -> Option<f32> {
    let mut t_max = f32::INFINITY;
    for geometry in geometries {
        for i in 0..geometry.len() as u32 {
            if let Some(hit) = geometry.shape(i).expect("a shape").intersect(ray, t_max) {
                t_max = hit.t;
            }
        }
    }
    t_max.is_finite().then_some(t_max)
}

fn assert_same_hits(world: &World, geometries: &[Geometry], rays: &[Ray], what: &str) {
    for ray in rays {
        let expected = brute_force(geometries, ray);
        assert_eq!(nearest(world, ray).map(|hit| hit.t), expected, "{what} {ray:?}");
        let hit = world.occluded(ray, f32::INFINITY, &KEEP_ALL, &mut RayStats::default());
        assert_eq!(hit, expected.is_some(), "{what} {ray:?}");
    }
}

#[test]
fn every_quality_finds_the_hits_of_brute_force() {
    let rng = &mut Rng::new(21, 0);
    let mut soup = |n: usize, spread: f32, size: &dyn Fn(&mut Rng) -> f32| {
        let triangle = |_| {
            let (center, size) = (point_in(rng, spread), size(rng));
            [0; 3].map(|_| center + point_in(rng, size))
        };
        Geometry::from(triangles((0..n).map(triangle).collect()))
    };
    let inputs = [
        ("random", vec![soup(2000, 1.0, &|_| 0.1)]),
        ("clusters", vec![soup(1000, 0.01, &|_| 0.001), soup(1000, 1.0, &|_| 0.3)]),
        ("all sizes", vec![soup(2000, 1.0, &|rng| 10f32.powf(between(rng, -30.0, 0.5)))]),
        ("flat", vec![soup(500, 1.0, &|_| 0.0), soup(20, 1.0, &|_| 1.0)]),
        ("duplicates", vec![triangles(vec![[Vec3::ZERO, Vec3::X, Vec3::Y]; 500]).into()]),
        ("strips", vec![strips(&mut Rng::new(22, 0), 1500).into()]),
        ("shapes", shapes(&Transform::scale(Vec3::splat(0.5))).into_iter().map(|(_, s)| s.into()).collect()),
    ];
    let rays = rays(&mut Rng::new(23, 0), 400, 1.5);
    for (name, geometries) in inputs {
        for quality in QUALITIES {
            assert_same_hits(
                &build(quality, &geometries),
                &geometries,
                &rays,
                &format!("{name} {quality:?}"),
            );
        }
    }
}

/// Rays towards points of triangles that spatial splits have divided.
#[test]
fn spatial_splits_lose_no_hit() {
    let rng = &mut Rng::new(31, 0);
    let corners: Vec<[Vec3; 3]> = (0..400).map(|_| [0; 3].map(|_| point_in(rng, 1.0))).collect();
    let geometries = [Geometry::from(triangles(corners.clone()))];
    let world = build(BuildQuality::High, &geometries);
    let rays: Vec<Ray> = (0..4000)
        .map(|i| {
            let [a, b, c] = corners[i % 400];
            let u = uniform_2d(rng);
            let p = a + (b - a) * u.x + (c - b) * (u.x * u.y);
            let d = direction(rng);
            Ray::new(p - d, d, 0.0)
        })
        .collect();
    assert_same_hits(&world, &geometries, &rays, "cut");
}

#[test]
fn spatial_splits_save_tests_of_thin_triangles() {
    let geometry = Geometry::from(strips(&mut Rng::new(41, 0), 20_000));
    let cost = |quality| {
        let world = build(quality, std::slice::from_ref(&geometry));
        let mut stats = RayStats::default();
        for ray in rays(&mut Rng::new(42, 0), 3000, 1.5) {
            world.intersect(&ray, f32::INFINITY, &KEEP_ALL, &mut stats);
        }
        (stats.extents / 8 + stats.primitives / 4) as f64
    };
    let [balanced, high] = [BuildQuality::Balanced, BuildQuality::High].map(cost);
    assert!(high < 0.8 * balanced, "{high} against {balanced}");
}

#[test]
fn a_refitted_world_equals_a_rebuilt_one() {
    let rng = &mut Rng::new(51, 0);
    let bump = |bump: f32| ball(90, bump, &Transform::IDENTITY);
    let place = |x: f32| Shape::from(Sphere::whole(&Transform::translate(Vec3::X * x), false, 0.4));
    let rays = rays(rng, 500, 3.0);
    for quality in QUALITIES {
        let mut builder = World::builder().quality(quality);
        let group = builder.add_group();
        let placed = builder.add_geometry(group, bump(0.1));
        let still = builder.add_geometry(GroupId::TOP, strips(rng, 100));
        let moving = builder.add_geometry(GroupId::TOP, bump(0.2));
        let sphere = builder.add_geometry(GroupId::TOP, place(2.0));
        let at = Transform::translate(Vec3::new(0.0, 2.0, 0.0));
        let outer = builder.add_group();
        builder.add_instance(outer, Instance { group, render_from_instance: at.into() });
        builder.add_instance(GroupId::TOP, Instance { group: outer, render_from_instance: at.into() });
        let mut world = builder.clone().build();
        let moved: [(GeometryId, Geometry); 3] =
            [(placed, bump(0.3).into()), (moving, bump(-0.3).into()), (sphere, place(-1.5).into())];
        world.refit(moved.clone()).expect("the same primitives");

        let mut again = World::builder().quality(quality);
        let group = again.add_group();
        again.add_geometry(group, moved[0].1.clone());
        again.add_geometry(GroupId::TOP, world.geometry(still).clone());
        again.add_geometry(GroupId::TOP, moved[1].1.clone());
        again.add_geometry(GroupId::TOP, moved[2].1.clone());
        let outer = again.add_group();
        again.add_instance(outer, Instance { group, render_from_instance: at.into() });
        again.add_instance(GroupId::TOP, Instance { group: outer, render_from_instance: at.into() });
        let again = again.build();
        assert_eq!(world.bounds(), again.bounds());
        let mut hits = 0;
        for ray in &rays {
            assert_eq!(nearest(&world, ray), nearest(&again, ray));
            hits += nearest(&world, ray).is_some() as u32;
        }
        assert!(hits > 50, "{hits} hits");
    }
}

#[test]
fn refit_skips_non_finite_vertices() {
    let mesh = cube(&Transform::IDENTITY);
    let positions: Vec<Vec3> = Bounds3::new(-Vec3::ONE, Vec3::ONE).corners().collect();
    let mut world = world([mesh.clone().into()]);
    let ray = Ray::new(Vec3::new(0.1, 0.2, 5.0), -Vec3::Z, 0.0);
    let mut refit = |positions: Vec<Vec3>| {
        let moved = mesh.moved(positions.into(), None).expect("the same number of vertices");
        world.refit([(GeometryId(0), moved.into())]).expect("the same triangles");
        nearest(&world, &ray).map(|hit| hit.t)
    };
    assert_eq!(refit(positions.clone()), Some(4.0));
    assert_eq!(refit(vec![Vec3::NAN; 8]), None);
    assert_eq!(refit(positions.iter().map(|&p| p * 2.0).collect()), Some(3.0));
}

#[test]
fn instances_are_placed_elsewhere() {
    let transforms = |seed| {
        let rng = &mut Rng::new(seed, 0);
        let turned = |_| {
            let turn = Transform::rotate(point_in(rng, 3.0).x, direction(rng));
            Transform::translate(point_in(rng, 3.0)).after(&turn)
        };
        [0; 20].map(turned)
    };
    let with = |transforms: [Transform; 20]| {
        let mut builder = World::builder();
        let [inner, outer] = [builder.add_group(), builder.add_group()];
        builder.add_geometry(inner, cube(&Transform::scale(Vec3::splat(0.3))));
        let mut place = |at, group, transform: Transform| {
            builder.add_instance(at, Instance { group, render_from_instance: transform.into() })
        };
        let nested = place(outer, inner, Transform::translate(Vec3::X));
        let placed = transforms.map(|transform| place(GroupId::TOP, outer, transform));
        (builder.build(), nested, placed)
    };
    let (mut world, nested, ids) = with(transforms(1));
    let flat = Transform::from_parts(Mat4::ZERO, Mat4::from_scale(Vec3::splat(f32::INFINITY).into()));
    let refused = [
        ((nested, Transform::IDENTITY), RefitError::Instance(nested)),
        ((InstanceId(99), Transform::IDENTITY), RefitError::Instance(InstanceId(99))),
        ((ids[3], flat), RefitError::Transform(ids[3])),
    ];
    for (place, error) in refused {
        assert_eq!(world.place_instances([(ids[0], Transform::IDENTITY), place]), Err(error));
    }
    let rays = rays(&mut Rng::new(2, 0), 2000, 4.0);
    let same = |world: &World, other: &World| {
        let hits = rays.iter().map(|ray| (nearest(world, ray), nearest(other, ray)));
        hits.inspect(|(a, b)| assert_eq!(a, b)).filter(|(a, _)| a.is_some()).count()
    };
    assert!(same(&world, &with(transforms(1)).0) > 100);
    assert_eq!(world.place_instances(ids.into_iter().zip(transforms(3))), Ok(()));
    assert!(same(&world, &with(transforms(3)).0) > 100);
}

#[test]
fn refit_refuses_other_primitives() {
    let sphere = Geometry::from(Shape::from(Sphere::whole(&Transform::IDENTITY, false, 1.0)));
    let plane = Geometry::from(Shape::from(Plane::new(&Transform::IDENTITY, false)));
    let cube = Geometry::from(cube(&Transform::IDENTITY));
    let mut world = world([sphere.clone(), cube.clone()]);
    let [first, second, third] = [0, 1, 2].map(GeometryId);
    assert_eq!(world.refit([(first, plane)]), Err(RefitError::Different(first)));
    assert_eq!(world.refit([(first, cube.clone())]), Err(RefitError::Different(first)));
    assert_eq!(
        world.refit([(second, ball(9, 0.0, &Transform::IDENTITY).into())]),
        Err(RefitError::Different(second))
    );
    let Geometry::Mesh(turned) = &cube else { panic!("a mesh") };
    let corners = (0..turned.len()).map(|i| turned.corners(i)).map(|[a, b, c]| [b, c, a]).collect();
    assert_eq!(world.refit([(second, triangles(corners).into())]), Err(RefitError::Different(second)));
    assert_eq!(world.refit([(third, cube.clone())]), Err(RefitError::Unknown(third)));
    assert_eq!(world.refit([(first, sphere), (second, cube)]), Ok(()));
    let Geometry::Mesh(mesh) = world.geometry(second) else { panic!("a mesh") };
    assert!(Arc::clone(mesh).moved(vec![Vec3::ZERO; 7].into(), None).is_err());
}
