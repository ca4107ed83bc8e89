//! The BVH saves tests and does not change results: brute force finds the same hits.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

fn spheres(centers: Vec<Vec3>, m: &Transform) -> Geometry {
    let radii = vec![0.15; centers.len()].into();
    SphereSet::new(centers.into(), radii, m, false).expect("a set").into()
}

/// Shapes of all kinds: direct, in instances, in nested and in moving instances.
fn builder(rng: &mut Rng) -> WorldBuilder {
    let mut builder = World::builder();
    let [inner, outer] = [builder.add_group(), builder.add_group()];
    for group in [GroupId::TOP, inner, outer] {
        let m = Transform::translate(point_in(rng, 2.0))
            .after(&Transform::scale(Vec3::splat(between(rng, 0.2, 0.7))));
        builder.add_geometry(group, ball(9, 0.3, &m));
        for (_, shape) in shapes(&m) {
            builder.add_geometry(group, shape);
        }
        let centers: Vec<Vec3> = (0..30).map(|_| point_in(rng, 1.5)).collect();
        builder.add_geometry(group, spheres(centers, &m));
        let keys = vec![ball(5, 0.1, &m), ball(5, 0.4, &Transform::translate(Vec3::Z).after(&m))];
        let moving = MovingMesh::new(keys, [0.0, 1.0]).triangles().map(Shape::from).collect();
        builder.add_geometry(group, Geometry::Shapes(moving));
    }
    builder.add_geometry(outer, Shape::from(Plane::new(&Transform::translate(Vec3::Z * -4.0), false)));
    for (group, placed) in [(outer, inner), (outer, inner), (GroupId::TOP, outer), (GroupId::TOP, inner)] {
        let mut key = || {
            let m = Transform::translate(point_in(rng, 1.0))
                .after(&Transform::rotate(between(rng, 0.0, 3.0), direction(rng)));
            m.matrix().as_dmat4()
        };
        let render_from_instance = AnimatedTransform::new(key(), key(), [0.0, 1.0]).expect("no singular key");
        builder.add_instance(group, Instance { group: placed, render_from_instance });
    }
    builder
}

#[test]
fn brute_force_finds_the_same_hits() {
    let rng = &mut Rng::new(1, 0);
    for _ in 0..8 {
        let builder = builder(rng);
        let (with, without) = (builder.clone().build(), builder.extents(false).build());
        let [mut fewer, mut all] = [RayStats::default(); 2];
        // A filter rejects some candidates.
        let filter = Accepts::Some(&|hit| !hit.primitive.is_multiple_of(7));
        for _ in 0..300 {
            let ray = Ray::new(point_in(rng, 3.0), direction(rng), rng.uniform_f32());
            let t_max = if rng.uniform_f32() < 0.3 { between(rng, 0.0, 3.0) } else { f32::INFINITY };
            let hit = with.intersect(&ray, t_max, &filter, &mut fewer);
            assert_eq!(without.intersect(&ray, t_max, &filter, &mut all), hit, "{ray:?} up to {t_max}");
        }
        assert_eq!((all.extents, all.rays), (0, 300));
        assert!(fewer.extents > 0 && fewer.primitives * 10 < all.primitives, "{fewer:?} and {all:?}");
        let one = RayStats { rays: 1, primitives: all.primitives / 300, extents: 0 };
        assert_eq!(one.primitives * 300, all.primitives, "each ray was tested against all primitives");
        for _ in 0..300 {
            let ray = Ray::new(point_in(rng, 3.0), direction(rng), rng.uniform_f32());
            let t_max = between(rng, 0.0, 3.0);
            let occluded = with.occluded(&ray, t_max, &filter, &mut fewer);
            assert_eq!(without.occluded(&ray, t_max, &filter, &mut all), occluded, "{ray:?} up to {t_max}");
        }
    }
}
