//! No ray passes through a closed surface, and no spawned ray hits the surface that it leaves.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

const TRANSFORMS: usize = 12;
/// Distances from the origin, in units of the object's size.
const AWAY: [f32; 3] = [0.0, 3.0, 1e3];

/// Transforms of all sizes, near the origin and far from it.
fn transform(rng: &mut Rng, i: usize) -> Transform {
    let scale = [1f32, 1e-4, 1e5, 30.0][i % 4];
    let away = AWAY[i % 3] * scale;
    let turn = Transform::rotate(between(rng, 0.0, 6.0), direction(rng));
    let stretch = if i.is_multiple_of(2) { Vec3::ONE } else { Vec3::new(1.0, 0.4, -1.7) };
    let place = Transform::translate(direction(rng) * away);
    place.after(&turn).after(&Transform::scale(stretch * scale))
}

fn closed_worlds(rng: &mut Rng, m: &Transform) -> Vec<World> {
    let mut groups = World::builder();
    let inner = groups.add_group();
    groups.add_geometry(inner, cube(&Transform::rotate(between(rng, 0.0, 6.0), direction(rng))));
    groups.add_instance(GroupId::TOP, Instance { group: inner, render_from_instance: (*m).into() });
    let rounded = Formula::parse("x^4 + y^4 + z^4 - 1").expect("a formula");
    let bounds = Bounds3 { min: Vec3::splat(-1.5), max: Vec3::splat(1.5) };
    vec![
        world([cube(m).into()]),
        world([ball(40, 0.2, m).into()]),
        world([Shape::from(Sphere::whole(m, false, 1.0)).into()]),
        world([Shape::from(Implicit::new(m, false, rounded, &bounds)).into()]),
        groups.build(),
    ]
}

#[test]
fn random_rays_do_not_leak() {
    let rng = &mut Rng::new(1, 0);
    for i in 0..TRANSFORMS {
        let m = transform(rng, i);
        for (k, world) in closed_worlds(rng, &m).iter().enumerate() {
            for _ in 0..20_000 {
                let ray = Ray::new(m.point(point_in(rng, 0.2)), direction(rng), 0.0);
                assert!(nearest(world, &ray).is_some(), "world {k} under transform {i}: {ray:?}");
            }
        }
    }
}

#[test]
fn rays_through_vertices_and_edges_do_not_leak() {
    let rng = &mut Rng::new(2, 0);
    for i in 0..TRANSFORMS {
        let m = transform(rng, i);
        for mesh in [cube(&m), ball(40, 0.2, &m), ball(200, 0.0, &m)] {
            let world = world([mesh.clone().into()]);
            for _ in 0..20_000 {
                let triangle = ((rng.uniform_f32() * mesh.len() as f32) as usize).min(mesh.len() - 1);
                let [a, b, _] = mesh.corners(triangle);
                let along = [0.0, 0.5, rng.uniform_f32()][(rng.uniform_f32() * 3.0) as usize];
                let o = m.point(point_in(rng, 0.2));
                let ray = Ray::new(o, a + (b - a) * along - o, 0.0);
                assert!(nearest(&world, &ray).is_some(), "under transform {i}: {ray:?}");
            }
        }
    }
}

#[test]
fn axis_parallel_rays_along_shared_edges_do_not_leak() {
    // A wall of squares of two triangles each, hit exactly at shared vertices and along shared
    // edges.
    let n = 9u32;
    let positions = (0..n * n).map(|i| Vec3::new((i % n) as f32, (i / n) as f32, 1.0)).collect();
    let quads = (0..n - 1).flat_map(|y| (0..n - 1).map(move |x| x + n * y));
    let indices = quads.flat_map(|a| [[a, a + 1, a + n + 1], [a, a + n + 1, a + n]]).collect();
    let world = world([mesh(positions, indices, &Transform::IDENTITY).into()]);
    for i in 1..(n - 1) * 4 {
        for j in 1..(n - 1) * 4 {
            let o = Vec3::new(i as f32 / 4.0, j as f32 / 4.0, 0.0);
            let hit = nearest(&world, &Ray::new(o, Vec3::Z, 0.0)).expect("no gap");
            assert_eq!(hit.t, 1.0);
        }
    }
}

/// Random walks inside a closed surface: every ray spawned inwards hits, and none leaves.
#[test]
fn random_walks_inside_do_not_leak() {
    let rng = &mut Rng::new(3, 0);
    // Away from the origin, the rounding of a point near an edge may put it beyond the next wall.
    for i in (0..TRANSFORMS).filter(|i| AWAY[i % 3] == 0.0) {
        let m = transform(rng, i);
        for (k, world) in closed_worlds(rng, &m).iter().enumerate() {
            let center = m.point(Vec3::ZERO);
            let mut ray = Ray::new(center, direction(rng), 0.0);
            for step in 0..10_000 {
                let Some(hit) = nearest(world, &ray) else {
                    panic!("world {k} under transform {i} leaks at step {step}: {ray:?}")
                };
                let surface = world.surface(&ray, &hit);
                let inward = face_forward(surface.n, surface.wo);
                let d = direction(rng);
                ray = surface.spawn_ray(face_forward(d, inward));
            }
        }
    }
}

/// Rays spawned outwards from a convex surface hit nothing.
#[test]
fn spawned_rays_do_not_hit_their_own_convex_surface() {
    let rng = &mut Rng::new(4, 0);
    for i in 0..60 {
        let m = transform(rng, i);
        for (name, shape) in shapes(&m) {
            if matches!(name, "bent patch" | "hyperboloid" | "two cones") {
                continue;
            }
            let is_flat = matches!(shape, Shape::Disk(_) | Shape::BilinearPatch(_) | Shape::Triangle(_));
            let world = world([shape.clone().into()]);
            for _ in 0..500 {
                let Some(sample) = shape.sample(uniform_2d(rng)) else { continue };
                let size = shape.area().sqrt();
                let ray = Ray::new(sample.p.p + direction(rng) * size * 3.0, Vec3::ZERO, 0.0);
                let ray = Ray::new(ray.o, (sample.p.p - ray.o) * between(rng, 0.01, 3.0), 0.0);
                let Some(hit) = nearest(&world, &ray) else { continue };
                let surface = world.surface(&ray, &hit);
                // Of curved shapes only the outside is convex; `n` may point inwards if the
                // orientation is reversed.
                let out = if is_flat {
                    surface.n
                } else {
                    face_forward(surface.n, m.normal(outward(&shape, m.inverse().point(surface.p.p))))
                };
                for side in [1.0, -1.0] {
                    if side < 0.0 && !is_flat {
                        continue;
                    }
                    let d = face_forward(direction(rng), side * out);
                    let next = surface.spawn_ray(d);
                    assert_eq!(
                        nearest(&world, &next),
                        None,
                        "{name} under transform {i}: from {surface:?} along {next:?}"
                    );
                }
            }
        }
    }
}

fn outward(shape: &Shape, p: Vec3) -> Vec3 {
    match shape {
        Shape::Cylinder(_) | Shape::Cone(_) => Vec3::new(p.x, p.y, 0.0),
        Shape::Paraboloid(_) => Vec3::new(p.x, p.y, -0.4),
        _ => p,
    }
}

/// A transmitted ray hits the far side, not the near one again.
#[test]
fn transmitted_rays_reach_the_far_side() {
    let rng = &mut Rng::new(5, 0);
    for i in 0..TRANSFORMS {
        let m = transform(rng, i);
        let world = world([Shape::from(Sphere::whole(&m, false, 1.0)).into()]);
        for _ in 0..10_000 {
            let o = m.point(direction(rng) * 3.0);
            let target = m.point(direction(rng) * 0.9);
            let ray = Ray::new(o, target - o, 0.0);
            let hit = nearest(&world, &ray).expect("towards the inside");
            let inner = world.surface(&ray, &hit).spawn_ray(ray.d);
            let far = nearest(&world, &inner).expect("the far side");
            let out = world.surface(&inner, &far).spawn_ray(ray.d);
            assert_eq!(nearest(&world, &out), None, "transform {i}");
            assert!(
                (hit.t + far.t) * ray.d.length()
                    > m.vector(Vec3::X * 0.1).length().min(m.vector(Vec3::Y * 0.1).length())
            );
        }
    }
}

/// For coordinates that are exactly zero, a relative error bound is zero.
#[test]
fn spawned_rays_do_not_hit_a_surface_in_a_coordinate_plane() {
    let rng = &mut Rng::new(9, 0);
    let corners = [(-7.0, -6.0), (7.0, -7.0), (-6.5, 7.0), (7.0, 5.0)];
    for axis in 0..3 {
        let turn = match axis {
            0 => Transform::from_parts(swapped(0, 2), swapped(0, 2)),
            1 => Transform::from_parts(swapped(1, 2), swapped(1, 2)),
            _ => Transform::IDENTITY,
        };
        for away in [Vec3::ZERO, Vec3::new(30.0, -20.0, 0.0), Vec3::new(0.3, 4e4, 0.0)] {
            let m = turn.after(&Transform::translate(away));
            let flat = |p: [(f32, f32); 4]| p.map(|(x, y)| Vec3::new(x, y, 0.0));
            let square = flat([(-7.0, -7.0), (7.0, -7.0), (-7.0, 7.0), (7.0, 7.0)]);
            let indices = vec![[0, 1, 2], [2, 1, 3]];
            let shapes: Vec<Geometry> = vec![
                Shape::from(BilinearPatch::new(square, None, None, &m, false)).into(),
                Shape::from(BilinearPatch::new(flat(corners), None, None, &m, false)).into(),
                Shape::from(Disk::new(&m, false, 0.0, 7.0, 0.0, 360.0)).into(),
                Shape::from(Plane::new(&m, false)).into(),
                mesh(flat(corners).to_vec(), indices, &m).into(),
            ];
            for (k, shape) in shapes.into_iter().enumerate() {
                let world = world([shape]);
                for _ in 0..5_000 {
                    let target = m.point(Vec3::new(between(rng, -4.0, 4.0), between(rng, -4.0, 4.0), 0.0));
                    let ray = Ray::new(target - direction(rng) * 13.0, Vec3::ZERO, 0.0);
                    let ray = Ray { d: target - ray.o, ..ray };
                    let Some(hit) = nearest(&world, &ray) else { continue };
                    let spawned = world.surface(&ray, &hit).spawn_ray(direction(rng));
                    assert!(nearest(&world, &spawned).is_none(), "shape {k} across axis {axis}: {spawned:?}");
                }
            }
        }
    }
}

/// The exchange of two axes.
fn swapped(a: usize, b: usize) -> Mat4 {
    let mut axes = [Vec3::X, Vec3::Y, Vec3::Z].map(|v| v.extend(0.0));
    axes.swap(a, b);
    Mat4::from_cols(axes[0], axes[1], axes[2], Vec3::ZERO.extend(1.0))
}
