//! BVHs find the hits of brute force for any input, and do not depend on the number of threads that
//! build them.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use proptest::prelude::*;
use sampling::Rng;

/// The nearest hit by testing all primitives of the top group.
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

fn compare(geometries: &[Geometry], rays: impl IntoIterator<Item = Ray>) -> Result<(), TestCaseError> {
    let world = world(geometries.iter().cloned());
    for ray in rays {
        let expected = brute_force(geometries, &ray);
        let mut stats = RayStats::default();
        prop_assert_eq!(nearest(&world, &ray).map(|hit| hit.t), expected, "{:?}", ray);
        prop_assert_eq!(world.occluded(&ray, f32::INFINITY, &KEEP_ALL, &mut stats), expected.is_some());
        if let Some(t) = expected {
            prop_assert!(!world.occluded(&ray, t, &KEEP_ALL, &mut stats), "t_max is exclusive");
        }
    }
    Ok(())
}

fn soup(rng: &mut Rng, triangles: usize, size: impl Fn(&mut Rng) -> f32) -> Geometry {
    let positions = (0..triangles)
        .flat_map(|_| {
            let (center, size) = (point_in(rng, 1.0), size(rng));
            [0; 3].map(|_| center + point_in(rng, size))
        })
        .collect();
    let indices = (0..triangles as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    mesh(positions, indices, &Transform::IDENTITY).into()
}

fn rays(rng: &mut Rng, n: usize) -> Vec<Ray> {
    (0..n).map(|_| Ray::new(point_in(rng, 2.0), direction(rng) * between(rng, 0.1, 9.0), 0.0)).collect()
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 60, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn tree_equals_brute_force(seed in 0u64..1 << 40, triangles in 0usize..300, shapes_count in 0usize..20) {
        let rng = &mut Rng::new(seed, 0);
        let mut geometries = vec![soup(rng, triangles, |rng| 10f32.powf(between(rng, -4.0, 0.0)))];
        for i in 0..shapes_count {
            let m = Transform::translate(point_in(rng, 1.0)).after(&Transform::scale(Vec3::splat(between(rng, 0.01, 0.5))));
            let mut all = shapes(&m);
            geometries.push(all.swap_remove(i % all.len()).1.into());
        }
        if shapes_count % 4 == 1 {
            geometries.push(Shape::from(Plane::new(&Transform::rotate(1.0, Vec3::new(1.0, 0.3, 0.2)), false)).into());
        }
        compare(&geometries, rays(rng, 200))?;
    }

    #[test]
    fn rays_along_the_axes_through_a_grid(seed in 0u64..1 << 40) {
        let rng = &mut Rng::new(seed, 0);
        let step = |rng: &mut Rng| (rng.uniform_f32() * 5.0).floor();
        let lattice = |rng: &mut Rng| Vec3::new(step(rng), step(rng), step(rng));
        let positions: Vec<_> = (0..360).map(|_| lattice(rng)).collect();
        let indices = (0..120).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let geometry = mesh(positions, indices, &Transform::IDENTITY).into();
        let axes = [Vec3::X, Vec3::Y, Vec3::Z, -Vec3::X, -Vec3::Y, -Vec3::Z, Vec3::ONE, Vec3::new(1.0, -1.0, 0.0)];
        let rays: Vec<_> = (0..200).map(|i| Ray::new(lattice(rng) - 2.0 * axes[i % 8], axes[i % 8], 0.0)).collect();
        compare(&[geometry], rays)?;
    }
}

#[test]
fn an_empty_world_has_no_hits() {
    let world = World::builder().build();
    assert!(nearest(&world, &Ray::new(Vec3::ZERO, Vec3::X, 0.0)).is_none());
    assert!(world.bounds().is_empty());
}

#[test]
fn non_finite_primitives_are_skipped() {
    let bad = [f32::NAN, f32::INFINITY, f32::NEG_INFINITY, 3e38, -3e38, 1e-42, 0.0];
    let rng = &mut Rng::new(3, 0);
    let mut pick = || bad[(rng.uniform_f32() * 7.0) as usize];
    let mut positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    positions.extend((0..300).map(|_| Vec3::new(pick(), pick(), pick())));
    let indices = (0..101).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mut geometries = vec![Geometry::from(mesh(positions, indices, &Transform::IDENTITY))];
    for value in bad {
        let m = Transform::translate(Vec3::splat(value));
        geometries.extend(shapes(&m).into_iter().map(|(_, shape)| Geometry::from(shape)));
        let m = Transform::scale(Vec3::splat(value));
        geometries.extend(shapes(&m).into_iter().map(|(_, shape)| Geometry::from(shape)));
    }
    let world = world(geometries);
    let down = Ray::new(Vec3::new(0.25, 0.25, 1e-3), -Vec3::Z, 0.0);
    assert!(nearest(&world, &down).is_some());
    for o in [Vec3::NAN, Vec3::INFINITY, Vec3::splat(3e38), Vec3::ZERO] {
        for d in [Vec3::NAN, Vec3::INFINITY, Vec3::splat(3e38), Vec3::splat(1e-42), Vec3::ZERO, Vec3::X] {
            let hit = nearest(&world, &Ray::new(o, d, 0.0));
            assert!(hit.is_none_or(|hit| hit.t >= 0.0));
        }
    }
}

#[test]
fn a_million_duplicates() {
    let n = 1_000_000;
    let indices = vec![[0, 1, 2]; n];
    let world = world([mesh(vec![Vec3::ZERO, Vec3::X, Vec3::Y], indices, &Transform::IDENTITY).into()]);
    let mut stats = RayStats::default();
    let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), -Vec3::Z, 0.0);
    assert!(world.intersect(&ray, f32::INFINITY, &KEEP_ALL, &mut stats).is_some());
    assert!(world.occluded(&ray, f32::INFINITY, &KEEP_ALL, &mut stats));
}

#[test]
fn sizes_of_every_order_of_magnitude() {
    let rng = &mut Rng::new(9, 0);
    let geometry = soup(rng, 3000, |rng| 10f32.powf(between(rng, -30.0, 0.0)));
    compare(&[geometry], rays(rng, 300)).expect("equal");
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| world([soup(&mut Rng::new(5, 0), 200_000, |_| 0.01)]))
    };
    let [one, many] = [1, 7].map(build);
    let [mut first, mut second] = [RayStats::default(); 2];
    for ray in rays(&mut Rng::new(6, 0), 2000) {
        let a = one.intersect(&ray, f32::INFINITY, &KEEP_ALL, &mut first);
        assert_eq!(a, many.intersect(&ray, f32::INFINITY, &KEEP_ALL, &mut second));
    }
    assert_eq!(first, second, "the same boxes and triangles were tested");
}

#[test]
fn the_bvh_saves_tests() {
    let world = world([ball(300, 0.1, &Transform::IDENTITY).into()]);
    let mut stats = RayStats::default();
    for ray in rays(&mut Rng::new(6, 0), 1000) {
        world.intersect(&ray, f32::INFINITY, &KEEP_ALL, &mut stats);
    }
    assert_eq!(stats.rays, 1000);
    assert!(stats.extents > 1000 && stats.extents < 200_000, "{stats:?}");
    assert!(stats.primitives > 100 && stats.primitives < 50_000, "{stats:?}");
}

#[test]
fn rejected_candidates_are_passed_through() {
    let layers: Vec<Geometry> = (0..10)
        .map(|i| {
            let m = Transform::translate(Vec3::Z * i as f32);
            Shape::from(Disk::new(&m, false, 0.0, 1.0, 0.0, 360.0)).into()
        })
        .collect();
    let world = world(layers);
    let ray = Ray::new(Vec3::new(0.1, 0.1, 20.0), -Vec3::Z, 0.0);
    let below_four = Accepts::Some(&|hit| hit.geometry.0 < 4);
    let hit = world.intersect(&ray, f32::INFINITY, &below_four, &mut RayStats::default());
    assert_eq!(hit.map(|hit| hit.geometry), Some(GeometryId(3)));
    assert!(!world.occluded(&ray, 16.5, &below_four, &mut RayStats::default()));
}
