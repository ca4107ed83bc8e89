//! All instruction sets find the same hits, bit for bit.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

/// The same world for each instruction set of this processor.
fn worlds(geometries: Vec<Geometry>) -> Vec<(InstructionSet, World)> {
    let world = world(geometries);
    let sets = InstructionSet::ALL.into_iter().filter(|set| set.is_available());
    let given = |set| {
        let mut world = world.clone();
        world.set_instruction_set(set);
        (set, world)
    };
    sets.map(given).collect()
}

fn bits(hit: Option<Hit>) -> Option<(u32, [u32; 2], GeometryId, u32)> {
    hit.map(|h| (h.t.to_bits(), [h.uv.x.to_bits(), h.uv.y.to_bits()], h.geometry, h.primitive))
}

fn agree(geometries: Vec<Geometry>, rays: impl IntoIterator<Item = Ray>) {
    let worlds = worlds(geometries);
    let rays: Vec<(Ray, f32)> = rays.into_iter().map(|ray| (ray, f32::INFINITY)).collect();
    let expected: Vec<_> = rays.iter().map(|(ray, _)| bits(nearest(&worlds[0].1, ray))).collect();
    for (set, world) in &worlds {
        let [mut alone, mut together] = [RayStats::default(); 2];
        for ((ray, t_max), expected) in rays.iter().zip(&expected) {
            let hit = world.intersect(ray, *t_max, &KEEP_ALL, &mut alone);
            assert_eq!(bits(hit), *expected, "{set:?} {ray:?}");
            for t_max in [*t_max, 1e30] {
                let hits = world.occluded(ray, t_max, &KEEP_ALL, &mut RayStats::default());
                assert_eq!(hits, hit.is_some_and(|hit| hit.t < t_max), "{set:?} {ray:?} up to {t_max}");
            }
        }
        let mut hits = HitColumns::default();
        let mut occluded = vec![true; rays.len()];
        let batch: RayBuffer = rays.iter().copied().collect();
        world.intersect_batch(batch.columns(), &KEEP_ALL, &mut hits, &mut together);
        world.occluded_batch(batch.columns(), &KEEP_ALL, &mut occluded, &mut RayStats::default());
        for (i, expected) in expected.iter().enumerate() {
            assert_eq!(bits(hits.get(i)), *expected, "{set:?} {:?} in a batch", rays[i]);
            assert_eq!(occluded[i], expected.is_some(), "{set:?} {:?} in a batch", rays[i]);
        }
        for share in [0.5, 1.0, 1.0 + f32::EPSILON, 2.0] {
            let end = |i| hits.get(i).map_or(3.0, |hit| hit.t * share);
            let ends: Vec<f32> = (0..rays.len()).map(end).collect();
            let batch: RayBuffer = rays.iter().zip(&ends).map(|((ray, _), end)| (*ray, *end)).collect();
            world.occluded_batch(batch.columns(), &KEEP_ALL, &mut occluded, &mut RayStats::default());
            for (i, ((ray, _), end)) in rays.iter().zip(ends).enumerate() {
                let alone = world.occluded(ray, end, &KEEP_ALL, &mut RayStats::default());
                assert_eq!(occluded[i], alone, "{set:?} {ray:?} up to {end} in a batch");
            }
        }
        assert_eq!(together.rays, alone.rays);
        assert_eq!(
            (together.extents > 0, together.primitives > 0),
            (alone.extents > 0, alone.primitives > 0)
        );
    }
}

#[test]
fn closed_mesh() {
    let rng = &mut Rng::new(1, 0);
    let mesh = ball(60, 0.2, &Transform::IDENTITY);
    let rays = (0..30_000).map(|i| {
        let o = point_in(rng, [0.3, 2.0][i % 2]);
        // Towards vertices, midpoints of edges, and random points.
        let triangle = ((rng.uniform_f32() * mesh.len() as f32) as usize).min(mesh.len() - 1);
        let [a, b, _] = mesh.corners(triangle);
        let d = match i % 5 {
            0 => a - o,
            1 => (a + b) * 0.5 - o,
            _ => direction(rng),
        };
        Ray::new(o, d, 0.0)
    });
    let rays: Vec<Ray> = rays.collect();
    agree(vec![mesh.into()], rays);
}

#[test]
fn lattices_with_coincident_hits() {
    let rng = &mut Rng::new(2, 0);
    let step = |rng: &mut Rng| (rng.uniform_f32() * 5.0).floor();
    let lattice = |rng: &mut Rng| Vec3::new(step(rng), step(rng), step(rng));
    for _ in 0..40 {
        let geometries = (0..3).map(|_| {
            let positions: Vec<_> = (0..90).map(|_| lattice(rng)).collect();
            let indices = (0..60).map(|i| [i, i + 1, (i + 7) % 90]).collect();
            mesh(positions, indices, &Transform::IDENTITY).into()
        });
        let geometries = geometries.collect();
        let rays: Vec<_> =
            (0..300).map(|_| Ray::new(lattice(rng), lattice(rng) - lattice(rng), 0.0)).collect();
        agree(geometries, rays);
    }
}

#[test]
fn degenerate_geometry() {
    let bad = [f32::NAN, f32::INFINITY, -f32::INFINITY, 3e38, -3e38, 1e-42, 1e-30, 0.0, 1.0, -1.0, 0.5];
    let rng = &mut Rng::new(3, 0);
    let pick = |rng: &mut Rng| bad[((rng.uniform_f32() * bad.len() as f32) as usize).min(bad.len() - 1)];
    let any = |rng: &mut Rng| Vec3::new(pick(rng), pick(rng), pick(rng));
    for _ in 0..40 {
        let positions: Vec<_> = (0..150).map(|_| any(rng)).collect();
        let indices = (0..50).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let rays: Vec<_> = (0..300).map(|_| Ray::new(any(rng), any(rng), 0.0)).collect();
        agree(vec![mesh(positions, indices, &Transform::IDENTITY).into()], rays);
    }
}

/// Coherent rays, which a batch traces as packets, and some incoherent ones: from one point, and
/// from several ones.
#[test]
fn coherent_rays() {
    let rng = &mut Rng::new(4, 0);
    let soup = (0..600).flat_map(|_| {
        let center = point_in(rng, 1.0);
        [0; 3].map(|_| center + point_in(rng, 0.1))
    });
    let positions = soup.collect();
    let indices = (0..600).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let m = Transform::translate(Vec3::new(0.1, 0.2, 0.3));
    let centers = (0..500).map(|_| point_in(rng, 1.0)).collect();
    let radii = (0..500).map(|_| between(rng, 0.01, 0.1)).collect();
    let geometries = vec![
        mesh(positions, indices, &Transform::IDENTITY).into(),
        ball(30, 0.2, &m).into(),
        Shape::from(Sphere::whole(&m, false, 0.3)).into(),
        SphereSet::new(centers, radii, &Transform::IDENTITY, false).expect("a set").into(),
    ];
    let eye = Vec3::new(0.3, -0.2, 3.0);
    let mut ray = |i: u32| {
        let (x, y) = ((i % 150) as f32 / 75.0 - 1.0, (i / 150) as f32 / 75.0 - 1.0);
        match i % 100 {
            77 => Ray::new(point_in(rng, 1.0), direction(rng), 0.0),
            78 => Ray::new(eye, Vec3::NAN, 0.0),
            _ if i % 2400 < 1200 => Ray::new(eye, Vec3::new(x, y, -3.0), 0.0),
            _ => Ray::new(Vec3::new(x, y, 0.5 * x * y), Vec3::new(0.5 + 0.01 * x, 0.4, -0.9), 0.0),
        }
    };
    let rays: Vec<_> = (0..150 * 150).map(&mut ray).collect();
    agree(geometries, rays);
}

#[test]
fn batches_call_filters() {
    let plane = |z: f32| {
        mesh(
            vec![Vec3::new(-9.0, -9.0, z), Vec3::new(9.0, -9.0, z), Vec3::new(0.0, 9.0, z)],
            vec![[0, 1, 2]],
            &Transform::IDENTITY,
        )
        .into()
    };
    let below_four = Accepts::Some(&|hit| hit.geometry.0 < 4);
    let rays: RayBuffer = (0..64)
        .map(|i| (Ray::new(Vec3::Z * 20.0, Vec3::new(i as f32 * 1e-3, 0.01, -1.0), 0.0), 40.0))
        .collect();
    for (set, world) in worlds((0..10).map(|i| plane(i as f32)).collect()) {
        let mut hits = HitColumns::default();
        world.intersect_batch(rays.columns(), &below_four, &mut hits, &mut RayStats::default());
        assert_eq!(hits.geometry, [3; 64], "{set:?}");
        let mut occluded = vec![false; 64];
        world.occluded_batch(
            rays.columns(),
            &Accepts::Some(&|hit| hit.geometry.0 > 9),
            &mut occluded,
            &mut RayStats::default(),
        );
        assert!(!occluded.contains(&true), "{set:?}");
    }
}
