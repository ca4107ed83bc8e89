//! Worlds of few triangles and patches, which are traced without a tree.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

fn patch(p: [Vec3; 4], m: &Transform) -> Geometry {
    Shape::from(BilinearPatch::new(p, None, None, m, false)).into()
}

fn turned(rng: &mut Rng) -> Transform {
    let turn = Transform::rotate(between(rng, 0.0, 3.0), direction(rng));
    Transform::translate(point_in(rng, 2.0)).after(&turn)
}

/// Rectangles, parallelograms, trapezoids, slightly curved patches and triangles.
fn few(rng: &mut Rng) -> Vec<Geometry> {
    let mut geometries = Vec::new();
    for kind in 0..20 {
        let (x, y) = (between(rng, 0.1, 2.0), between(rng, 0.1, 2.0));
        let slant = if kind % 4 == 0 { 0.0 } else { between(rng, -0.5, 0.5) };
        let mut p = [Vec3::ZERO, Vec3::X * x, Vec3::new(slant, y, 0.0), Vec3::new(x + slant, y, 0.0)];
        p[3].x += if kind % 4 >= 2 { 0.1 * x } else { 0.0 };
        p[3].z += if kind % 4 == 3 { 0.05 * y } else { 0.0 };
        let m = if kind % 3 == 0 { Transform::translate(point_in(rng, 2.0)) } else { turned(rng) };
        geometries.push(patch(p, &m));
    }
    let corners = (0..60).map(|_| point_in(rng, 2.0)).collect();
    let indices = (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    geometries.push(mesh(corners, indices, &Transform::IDENTITY).into());
    geometries
}

/// Rays to points on, near and at the edges of primitives, some of them from such points, too.
fn rays(rng: &mut Rng, geometries: &[Geometry], n: usize) -> Vec<Ray> {
    let point = |rng: &mut Rng| {
        let geometry = &geometries[(rng.uniform_f32() * geometries.len() as f32) as usize % geometries.len()];
        let primitive = (rng.uniform_f32() * geometry.len() as f32) as u32 % geometry.len() as u32;
        let shape = geometry.shape(primitive).expect("a shape");
        let edge = |x: f32| if x < 0.2 { 0.0 } else { ((x - 0.2) / 0.6).min(1.0) };
        let uv = Vec2::new(edge(rng.uniform_f32()), edge(rng.uniform_f32()));
        shape.surface_at(uv, 0.0).expect("a surface").p.p
    };
    let ray = |i: usize| {
        let o = if i.is_multiple_of(3) { point(rng) } else { point_in(rng, 4.0) };
        let d = if i.is_multiple_of(5) { direction(rng) } else { point(rng) - o };
        let axis = i.is_multiple_of(17).then_some(Vec3::new(0.0, 0.0, 1.0));
        Ray::new(o, axis.unwrap_or(d), 0.0)
    };
    (0..n).map(ray).filter(|ray| ray.d != Vec3::ZERO).collect()
}

#[test]
fn hits_are_those_of_the_shapes() {
    let rng = &mut Rng::new(1, 0);
    let (mut hits, mut others) = (0, 0);
    for _ in 0..20 {
        let geometries = few(rng);
        let world = world(geometries.clone());
        for ray in rays(rng, &geometries, 4000) {
            for t_max in [f32::INFINITY, 0.9, Ray::SHADOW_END] {
                let mut expected: Option<(f32, u32, u32)> = None;
                for (g, geometry) in geometries.iter().enumerate() {
                    for i in 0..geometry.len() as u32 {
                        let end = expected.map_or(t_max, |hit| hit.0);
                        if let Some(hit) = geometry.shape(i).expect("a shape").intersect(&ray, end) {
                            expected = Some((hit.t, g as u32, i));
                        }
                    }
                }
                let hit = world.intersect(&ray, t_max, &Accepts::All, &mut RayStats::default());
                let occluded = world.occluded(&ray, t_max, &Accepts::All, &mut RayStats::default());
                assert_eq!(hit.is_some(), expected.is_some(), "{ray:?} {hit:?} {expected:?}");
                assert_eq!(occluded, expected.is_some(), "{ray:?}");
                let (Some(hit), Some((t, geometry, primitive))) = (hit, expected) else { continue };
                let size = ray.o.length() + t * ray.d.length() + 4.0;
                let distance = (hit.t - t).abs() * ray.d.length();
                assert!(distance < 1e-2 * size, "{ray:?} {hit:?} at {t}");
                hits += 1;
                others += (distance > 1e-5 * size) as u32;
                others += ((hit.geometry.0, hit.primitive) != (geometry, primitive)) as u32;
            }
        }
    }
    // Hits on common edges or along a surface.
    assert!(hits > 50_000 && others * 1000 < hits, "{others} of {hits} differ");
}

#[test]
fn parameters_are_those_of_the_hit_point() {
    let rng = &mut Rng::new(2, 0);
    for _ in 0..10 {
        let geometries = few(rng);
        let world = world(geometries.clone());
        for ray in rays(rng, &geometries, 1000) {
            let Some(hit) = world.intersect(&ray, f32::INFINITY, &Accepts::All, &mut RayStats::default())
            else {
                continue;
            };
            let surface = world.surface(&ray, &hit);
            // Along the surface, distances have large errors.
            let cos = surface.n.dot(ray.d).abs() / ray.d.length();
            let error = (surface.p.p - ray.at(hit.t)).length() * cos;
            assert!(error < 1e-5 * (ray.o.length() + 4.0), "{ray:?} {hit:?}: {error}");
        }
    }
}

#[test]
fn rays_do_not_hit_the_surface_that_they_leave() {
    let rng = &mut Rng::new(3, 0);
    for _ in 0..20 {
        let geometries = few(rng);
        let world = world(geometries.clone());
        let mut spawned = RayBuffer::default();
        let mut left = Vec::new();
        for ray in rays(rng, &geometries, 1000) {
            let Some(hit) = nearest(&world, &ray) else { continue };
            let surface = world.surface(&ray, &hit);
            spawned.push(&surface.spawn_ray(direction(rng)), f32::INFINITY);
            left.push((hit.geometry.0, hit.primitive));
        }
        let mut hits = HitColumns::default();
        world.intersect_batch(spawned.columns(), &Accepts::All, &mut hits, &mut RayStats::default());
        for (place, left) in left.into_iter().enumerate() {
            let Some(hit) = hits.get(place) else { continue };
            // A curved patch can be hit again from its hollow side.
            let again = (hit.geometry.0, hit.primitive) == left && hit.t < 1e-3;
            assert!(!again, "{:?} {hit:?}", spawned.columns().ray(place));
        }
    }
}

#[test]
fn turned_boxes_are_closed() {
    const SIDES: [[usize; 4]; 6] =
        [[0, 1, 2, 3], [4, 5, 6, 7], [0, 1, 4, 5], [2, 3, 6, 7], [0, 2, 4, 6], [1, 3, 5, 7]];
    let rng = &mut Rng::new(4, 0);
    for _ in 0..20 {
        let m = turned(rng);
        let corner = |i: usize| Vec3::new((i & 1) as f32, (i >> 1 & 1) as f32, (i >> 2) as f32);
        let world = world(SIDES.map(|side| patch(side.map(corner), &m)));
        let mut rays = RayBuffer::default();
        for [a, b, ..] in SIDES {
            for _ in 0..2000 {
                let o = m.point(point_in(rng, 0.499) + Vec3::splat(0.5));
                let target = m.point(corner(a).lerp(corner(b), rng.uniform_f32()));
                rays.push(&Ray::new(o, target - o, 0.0), f32::INFINITY);
            }
        }
        let mut occluded = vec![false; rays.columns().len()];
        world.occluded_batch(rays.columns(), &Accepts::All, &mut occluded, &mut RayStats::default());
        assert!(!occluded.contains(&false));
    }
}

/// One ray against facets in lanes and facets against rays in lanes, with any instruction set.
#[test]
fn batches_and_instruction_sets_agree() {
    let rng = &mut Rng::new(5, 0);
    let most = Accepts::Some(&|hit| !(hit.geometry.0 + hit.primitive).is_multiple_of(5));
    for _ in 0..5 {
        let geometries = few(rng);
        let rays: Vec<(Ray, f32)> = rays(rng, &geometries, 2003)
            .into_iter()
            .map(|ray| (ray, if rng.uniform_f32() < 0.3 { 0.9 } else { f32::INFINITY }))
            .collect();
        let batch: RayBuffer = rays.iter().copied().collect();
        let mut world = world(geometries);
        let expected: Vec<_> = rays.iter().map(|(ray, t)| alone(&world, ray, *t, &Accepts::All)).collect();
        let filtered: Vec<_> = rays.iter().map(|(ray, t)| alone(&world, ray, *t, &most)).collect();
        assert_ne!(expected, filtered);
        for set in InstructionSet::ALL.into_iter().filter(|set| set.is_available()) {
            world.set_instruction_set(set);
            check(&world, &rays, &batch, &Accepts::All, &expected);
            check(&world, &rays, &batch, &most, &filtered);
        }
    }
}

fn alone(world: &World, ray: &Ray, t_max: f32, filter: &Accepts) -> Option<Hit> {
    world.intersect(ray, t_max, filter, &mut RayStats::default())
}

fn check(world: &World, rays: &[(Ray, f32)], batch: &RayBuffer, filter: &Accepts, expected: &[Option<Hit>]) {
    let stats = &mut RayStats::default();
    let mut hits = HitColumns::default();
    world.intersect_batch(batch.columns(), filter, &mut hits, stats);
    let mut occluded = vec![false; rays.len()];
    world.occluded_batch(batch.columns(), filter, &mut occluded, stats);
    for (place, ((ray, t_max), expected)) in rays.iter().zip(expected).enumerate() {
        assert_eq!(alone(world, ray, *t_max, filter), *expected, "{ray:?} up to {t_max}");
        assert_eq!(hits.get(place), *expected, "{ray:?} up to {t_max} in a batch");
        assert_eq!(world.occluded(ray, *t_max, filter, stats), expected.is_some(), "{ray:?} up to {t_max}");
        assert_eq!(occluded[place], expected.is_some(), "{ray:?} up to {t_max} in a batch");
    }
}
