//! A set of spheres is hit, shaded and sampled like single spheres.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use proptest::prelude::*;
use sampling::Rng;

fn set(centers: Vec<Vec3>, radii: Vec<f32>, m: &Transform) -> SphereSet {
    SphereSet::new(centers.into(), radii.into(), m, false).expect("a set")
}

fn random_set(rng: &mut Rng, n: usize, sizes: [f32; 2], m: &Transform) -> SphereSet {
    let centers = (0..n).map(|_| point_in(rng, 1.0)).collect();
    let radii = (0..n).map(|_| 10f32.powf(between(rng, sizes[0], sizes[1]))).collect();
    set(centers, radii, m)
}

fn similarity(rng: &mut Rng, mirror: bool) -> Transform {
    let scale = 10f64.powf(between(rng, -3.0, 3.0).into());
    let side = if mirror { -scale } else { scale };
    let place = DMat4::from_translation(point_in(rng, 2.0).as_dvec3() * scale);
    let turn = DMat4::from_axis_angle(direction(rng).as_dvec3().normalize(), between(rng, 0.0, 6.0).into());
    let size = DMat4::from_scale(DVec3::new(scale, scale, side));
    Transform::from_f64(place * turn * size).expect("an inverse")
}

/// The nearest hit by testing all spheres.
fn brute_force(set: &SphereSet, ray: &Ray, t_max: f32) -> Option<(f32, usize)> {
    let hits = (0..set.len()).filter_map(|i| {
        let shape = Shape::from(set.sphere(i));
        Some((shape.intersect(ray, t_max)?.t, i))
    });
    hits.min_by(|a, b| a.0.total_cmp(&b.0))
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 100, failure_persistence: None, rng_seed: proptest::test_runner::RngSeed::Fixed(1), ..ProptestConfig::default() })]

    #[test]
    fn a_set_equals_its_spheres(seed in 0u64..1 << 40, n in 0usize..200, mirror: bool) {
        let rng = &mut Rng::new(seed, 0);
        let m = similarity(rng, mirror);
        let set = random_set(rng, n, [-6.0, -0.3], &m);
        let world = world([set.clone().into()]);
        for _ in 0..200 {
            let (a, b) = (m.point(point_in(rng, 2.0)), m.point(point_in(rng, 1.0)));
            let ray = Ray::new(a, (b - a) * 10f32.powf(between(rng, -5.0, 5.0)), 0.0);
            let t_max = if rng.uniform_f32() < 0.5 { f32::INFINITY } else { between(rng, 0.0, 1.0) / ray.d.length() * (b - a).length() };
            let expected = brute_force(&set, &ray, t_max);
            let stats = &mut RayStats::default();
            let found = world.intersect(&ray, t_max, &KEEP_ALL, stats);
            // The roots of a rotated sphere differ in the last bits of double precision.
            let close = |a: f32, b: f32| (a - b).abs() <= a.abs() * 2.0 * f32::EPSILON;
            match (found, expected) {
                (Some(hit), Some((t, i))) => {
                    prop_assert!(close(hit.t, t), "{:?} and {t}", hit);
                    prop_assert!(hit.primitive == i as u32 || close(hit.t, t));
                }
                (None, None) => {}
                other => prop_assert!(false, "{other:?} for {ray:?}"),
            }
            prop_assert_eq!(world.occluded(&ray, t_max, &KEEP_ALL, stats), expected.is_some());
        }
    }

    #[test]
    fn surfaces_are_those_of_the_object(seed in 0u64..1 << 40, mirror: bool, reverse: bool) {
        let rng = &mut Rng::new(seed, 0);
        let m = similarity(rng, mirror);
        let (center, radius) = (point_in(rng, 0.2), between(rng, 0.5, 1.0));
        let set = SphereSet::new([center].into(), [radius].into(), &m, reverse).expect("a set");
        let placed = m.after(&Transform::translate(center));
        let sphere = Shape::from(Sphere::whole(&placed, reverse, radius));
        let world = world([set.clone().into()]);
        for _ in 0..20 {
            let o = m.point(direction(rng) * 3.0);
            let ray = Ray::new(o, m.point(point_in(rng, 0.5)) - o, 0.25);
            let (Some(hit), Some(shape_hit)) = (nearest(&world, &ray), sphere.intersect(&ray, f32::INFINITY)) else { continue };
            let (a, b) = (world.surface(&ray, &hit), sphere.surface(&ray, &shape_hit));
            let size = m.vector(Vec3::X).length();
            prop_assert!(a.p.p.distance(b.p.p) < 1e-4 * size);
            prop_assert!(a.n.distance(b.n) < 1e-4 && a.wo == b.wo && a.time == 0.25);
            prop_assert!(a.uv.distance(b.uv) < 1e-3 || b.uv.x < 1e-3 || b.uv.x > 1.0 - 1e-3, "{:?} and {:?}", a.uv, b.uv);
            prop_assert!(a.dpdu.distance(b.dpdu) < 1e-2 * size && a.dpdv.distance(b.dpdv) < 1e-2 * size);
            prop_assert!((Geometry::from(set.clone()).shape(0).expect("a sphere").area() / sphere.area() - 1.0).abs() < 1e-4);
        }
    }
}

/// A closed world of spheres that touch, overlap, and are far from the origin of object space.
fn crowds(rng: &mut Rng) -> Vec<SphereSet> {
    (0..12)
        .map(|i| {
            let scale = [1f32, 1e-4, 1e5, 30.0][i % 4];
            let away = direction(rng) * [0.0, 3.0, 1e3][i % 3] * scale;
            let centers = (0..60).map(|_| away + point_in(rng, scale)).collect();
            let radii = (0..60).map(|_| between(rng, 0.1, 0.6) * scale).collect();
            set(centers, radii, &Transform::IDENTITY)
        })
        .collect()
}

#[test]
fn spawned_rays_stay_on_their_side() {
    let rng = &mut Rng::new(3, 0);
    for set in crowds(rng) {
        for i in 0..set.len() {
            let world =
                world([self::set(vec![set.center(i)], vec![set.radius(i)], &Transform::IDENTITY).into()]);
            for _ in 0..60 {
                let o = set.center(i) + direction(rng) * set.radius(i) * between(rng, 0.0, 4.0);
                let ray = Ray::new(o, direction(rng), 0.0);
                let Some(hit) = nearest(&world, &ray) else { continue };
                let surface = world.surface(&ray, &hit);
                let d = direction(rng);
                let away = nearest(&world, &surface.spawn_ray(d));
                assert_eq!(away.is_some(), d.dot(surface.n) < 0.0, "{d} from {surface:?}");
            }
        }
    }
}

#[test]
fn rays_inside_do_not_leak() {
    let rng = &mut Rng::new(4, 0);
    for set in crowds(rng) {
        let world = world([set.clone().into()]);
        for _ in 0..5000 {
            let i = (rng.uniform_f32() * set.len() as f32) as usize;
            let o = set.center(i) + direction(rng) * set.radius(i) * between(rng, 0.0, 0.999);
            assert!(nearest(&world, &Ray::new(o, direction(rng), 0.0)).is_some(), "sphere {i} from {o}");
        }
    }
}

#[test]
fn hits_in_closed_form() {
    let centers = vec![Vec3::ZERO, Vec3::X * 3.0, Vec3::X * 6.0];
    let world = world([set(centers, vec![1.0], &Transform::IDENTITY).into()]);
    let hit = |o: Vec3, d: Vec3| nearest(&world, &Ray::new(o, d, 0.0)).map(|hit| (hit.t, hit.primitive));
    assert_eq!(hit(-Vec3::X * 3.0, Vec3::X), Some((2.0, 0)));
    assert_eq!(hit(Vec3::X * 9.0, -Vec3::X * 2.0), Some((1.0, 2)));
    assert_eq!(hit(Vec3::ZERO, Vec3::X), Some((1.0, 0)), "from within");
    assert_eq!(hit(Vec3::X * 3.0 + Vec3::Y, Vec3::Z), None, "a tangent that starts at its point of contact");
    assert_eq!(hit(Vec3::new(3.0, 1.0, -2.0), Vec3::Z), Some((2.0, 1)), "a tangent");
    assert_eq!(hit(Vec3::new(3.0, 1.0 + 1e-6, -2.0), Vec3::Z), None);
    assert_eq!(hit(Vec3::X * 1.5, Vec3::Y), None, "between");
}

#[test]
fn all_magnitudes_and_non_finite_spheres() {
    let rng = &mut Rng::new(5, 0);
    let set = random_set(rng, 3000, [-30.0, 0.0], &Transform::IDENTITY);
    let world = world([set.clone().into()]);
    for k in 0..3000 {
        let d = set.center(k) + direction(rng) * set.radius(k) * 0.5;
        let o = point_in(rng, 3.0);
        let ray = Ray::new(o, d - o, 0.0);
        let found = nearest(&world, &ray).map(|hit| hit.t);
        assert_eq!(found, brute_force(&set, &ray, f32::INFINITY).map(|hit| hit.0));
    }
    for o in [Vec3::NAN, Vec3::INFINITY, Vec3::splat(3e38), Vec3::ZERO] {
        for d in [Vec3::NAN, Vec3::INFINITY, Vec3::splat(3e38), Vec3::splat(1e-42), Vec3::ZERO, Vec3::X] {
            assert!(nearest(&world, &Ray::new(o, d, 0.0)).is_none_or(|hit| hit.t >= 0.0));
        }
    }
    let huge = self::set(vec![Vec3::splat(3e38), Vec3::ZERO], vec![3e38, 1.0], &Transform::IDENTITY);
    let world = crate::common::world([huge.into()]);
    assert!(
        nearest(&world, &Ray::new(Vec3::Z * 2.0, -Vec3::Z, 0.0)).is_some(),
        "infinite boxes are left out"
    );
}

#[test]
fn invalid_arrays_are_refused() {
    let new = |centers: &[Vec3], radii: &[f32], m: &Transform| {
        SphereSet::new(centers.into(), radii.into(), m, false).map(|set| set.len())
    };
    let m = &Transform::IDENTITY;
    let two = [Vec3::ZERO, Vec3::X];
    assert_eq!(new(&two, &[1.0], m), Ok(2));
    assert_eq!(new(&[], &[], m), Ok(0));
    assert_eq!(new(&two, &[], m), Err(SphereSetError::RadiusCount { radii: 0, centers: 2 }));
    assert_eq!(new(&two, &[1.0; 3], m), Err(SphereSetError::RadiusCount { radii: 3, centers: 2 }));
    for radius in [0.0, -1.0, f32::INFINITY] {
        assert_eq!(new(&two, &[1.0, radius], m), Err(SphereSetError::Radius { index: 1, radius }));
    }
    assert_eq!(new(&[Vec3::ZERO, Vec3::NAN], &[1.0], m), Err(SphereSetError::Center { index: 1 }));
    let stretch = Transform::scale(Vec3::new(1.0, 1.0, 2.0));
    assert_eq!(new(&two, &[1.0], &stretch), Err(SphereSetError::NotSimilar));
    assert_eq!(new(&two, &[1.0], &Transform::scale(Vec3::splat(-2.0))), Ok(2));
}

#[test]
fn sets_can_be_instanced_and_mixed_with_other_shapes() {
    let mut builder = World::builder();
    let group = builder.add_group();
    let ball = builder.add_geometry(group, set(vec![Vec3::ZERO], vec![1.0], &Transform::IDENTITY));
    let stretch = Transform::translate(Vec3::X * 5.0).after(&Transform::scale(Vec3::new(1.0, 2.0, 1.0)));
    builder.add_instance(GroupId::TOP, Instance { group, render_from_instance: stretch.into() });
    let other = builder.add_geometry(GroupId::TOP, set(vec![Vec3::ZERO], vec![1.0], &Transform::IDENTITY));
    let cube = builder.add_geometry(GroupId::TOP, cube(&Transform::translate(-Vec3::X * 5.0)));
    let world = builder.build();
    let down = |x: f32| {
        let hit = nearest(&world, &Ray::new(Vec3::new(x, 9.0, 0.0), -Vec3::Y, 0.0)).expect("a hit");
        (hit.t, hit.geometry)
    };
    assert_eq!([down(5.0), down(0.0), down(-4.9)], [(7.0, ball), (8.0, other), (8.0, cube)]);
    assert!(world.bytes() > 3 * 12 && world.bounds().max.y >= 2.0);
}

#[test]
fn refitted_sets_are_hit_at_their_new_positions() {
    let rng = &mut Rng::new(8, 0);
    let old = random_set(rng, 5000, [-3.0, -1.0], &Transform::IDENTITY);
    let mut world = world([old.into()]);
    let new = random_set(rng, 5000, [-3.0, -1.0], &Transform::IDENTITY);
    world.refit([(GeometryId(0), new.clone().into())]).expect("the same primitives");
    let rebuilt = crate::common::world([new.into()]);
    let mut hits = 0;
    for _ in 0..5000 {
        let ray = Ray::new(point_in(rng, 2.0), direction(rng), 0.0);
        let hit = nearest(&world, &ray);
        hits += hit.is_some() as u32;
        assert_eq!(hit, nearest(&rebuilt, &ray));
    }
    assert!(hits > 1000, "{hits}");
    let fewer = random_set(rng, 4999, [-3.0, -1.0], &Transform::IDENTITY);
    let refused = world.refit([(GeometryId(0), fewer.into())]);
    assert_eq!(refused, Err(RefitError::Different(GeometryId(0))));
}

#[test]
fn the_tree_does_not_depend_on_the_number_of_threads() {
    let build = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().expect("threads");
        pool.install(|| {
            world([random_set(&mut Rng::new(5, 0), 100_000, [-3.0, -2.0], &Transform::IDENTITY).into()])
        })
    };
    let [one, many] = [1, 7].map(build);
    let [mut first, mut second] = [RayStats::default(); 2];
    let rng = &mut Rng::new(6, 0);
    for _ in 0..2000 {
        let ray = Ray::new(point_in(rng, 2.0), direction(rng), 0.0);
        let a = one.intersect(&ray, f32::INFINITY, &KEEP_ALL, &mut first);
        assert_eq!(a, many.intersect(&ray, f32::INFINITY, &KEEP_ALL, &mut second));
    }
    assert_eq!(first, second, "the same boxes and spheres were tested");
}

#[test]
fn instruction_sets_agree() {
    let rng = &mut Rng::new(7, 0);
    let mut world = world([random_set(rng, 20_000, [-3.0, -1.0], &Transform::IDENTITY).into()]);
    let rays: Vec<Ray> = (0..5000).map(|_| Ray::new(point_in(rng, 2.0), point_in(rng, 1.0), 0.0)).collect();
    let mut answers = InstructionSet::ALL.into_iter().filter(|set| set.is_available()).map(|set| {
        world.set_instruction_set(set);
        rays.iter().map(|ray| nearest(&world, ray)).collect::<Vec<_>>()
    });
    let first = answers.next().expect("a set");
    assert!(first.iter().flatten().count() > 1000);
    assert!(answers.all(|other| other == first));
}

#[test]
fn spheres_that_have_moved_are_hit_as_in_a_new_world_and_by_brute_force() {
    let rng = &mut Rng::new(77, 0);
    let mut all = random_set(rng, 3000, [-2.0, -1.2], &Transform::IDENTITY);
    let mut builder = World::builder();
    let id = builder.add_geometry(GroupId::TOP, all.clone());
    let mut world = builder.build();
    // A little at first, so that the tree is refitted; then everywhere, so that it is built anew.
    for (way, rebuilds) in [(0.01, false), (2.0, true)] {
        let centers = (0..all.len()).map(|i| all.center(i) + point_in(rng, way)).collect();
        all = all.moved(centers).expect("as many centres");
        let has_rebuilt = world.refit_or_rebuild([(id, all.clone().into())], BuildQuality::Balanced);
        assert_eq!(has_rebuilt, Ok(rebuilds), "{way}");
        let mut builder = World::builder();
        builder.add_geometry(GroupId::TOP, all.clone());
        let new = builder.build();
        let mut count = 0;
        for _ in 0..1500 {
            let ray = Ray::new(point_in(rng, 3.0), direction(rng), 0.0);
            let hit = |world: &World| {
                let hit = world.intersect(&ray, f32::INFINITY, &Accepts::All, &mut RayStats::default());
                hit.map(|hit| (hit.t, hit.primitive as usize))
            };
            assert_eq!(hit(&world), hit(&new));
            assert_eq!(hit(&world), brute_force(&all, &ray, f32::INFINITY));
            count += u32::from(hit(&world).is_some());
        }
        assert!(count > 50, "{count}");
    }
    assert!(all.moved([Vec3::ZERO].into()).is_none());
}
