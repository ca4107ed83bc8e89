//! All sets of instructions find the same hits, bit for bit.

mod common;

use alhazen_geometry::*;
use common::*;
use math::*;
use sampling::Rng;

/// A world, once for each set that this processor has.
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
    for ray in rays {
        let expected = bits(nearest(&worlds[0].1, &ray));
        for (set, world) in &worlds {
            assert_eq!(bits(nearest(world, &ray)), expected, "{set:?} {ray:?}");
            let stats = &mut RayStats::default();
            let hits = world.occluded(&ray, f32::INFINITY, &keep_all, stats);
            assert_eq!(hits, expected.is_some(), "{set:?} {ray:?}");
        }
    }
}

#[test]
fn on_a_closed_mesh() {
    let rng = &mut Rng::new(1, 0);
    let mesh = ball(60, 0.2, &Transform::IDENTITY);
    let rays = (0..30_000).map(|i| {
        let o = point_in(rng, [0.3, 2.0][i % 2]);
        // Towards corners, middles of edges, and anywhere.
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
fn on_lattices_where_hits_coincide() {
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
fn on_what_is_hostile() {
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
