//! Moving geometry equals static geometry at each time.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

/// A bumpy sphere with three keyframes.
fn poses() -> Vec<TriangleMesh> {
    [
        Transform::IDENTITY,
        Transform::translate(Vec3::new(0.6, 0.2, -0.1)).after(&Transform::scale(Vec3::new(1.0, 0.7, 1.2))),
        Transform::rotate(0.5, Vec3::Z).after(&Transform::translate(Vec3::new(0.2, 0.9, 0.0))),
    ]
    .map(|m| ball(12, 0.2, &m))
    .into()
}

/// The vertices at a time between 0.2 and 0.8.
fn pose_at(poses: &[TriangleMesh], time: f32) -> TriangleMesh {
    let x = ((time - 0.2) / 0.6 * 2.0).clamp(0.0, 2.0);
    let (a, b) = if x < 1.0 { (0, 1) } else { (1, 2) };
    let f = x - a as f32;
    let positions: Vec<Vec3> = (0..poses[0].len())
        .flat_map(|i| {
            let (p, q) = (poses[a].corners(i), poses[b].corners(i));
            [0, 1, 2].map(|corner| p[corner].lerp(q[corner], f))
        })
        .collect();
    let indices = (0..poses[0].len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    mesh(positions, indices, &Transform::IDENTITY)
}

fn moving_ball() -> Geometry {
    Geometry::Shapes(MovingMesh::new(poses(), [0.2, 0.8]).triangles().map(Shape::from).collect())
}

/// Asserts that two worlds have the same hits at a time.
fn agree(what: &str, moving: &World, still: &World, time: f32, rng: &mut Rng) {
    let mut hits = 0;
    for _ in 0..400 {
        let o = direction(rng) * 6.0;
        let ray = Ray::new(o, point_in(rng, 1.2) - o, time);
        match (nearest(moving, &ray), nearest(still, &ray)) {
            (Some(a), Some(b)) => {
                hits += 1;
                assert!((a.t - b.t).abs() < 1e-3, "{what} at {time}: {a:?} and {b:?}");
                let (p, q) = (moving.surface(&ray, &a), still.surface(&ray, &b));
                if a.primitive == b.primitive {
                    assert!(p.p.p.distance(q.p.p) < 1e-4 && p.n.dot(q.n) > 0.999, "{what} at {time}");
                }
                let away = p.spawn_ray(p.n);
                assert_eq!(away.time, time);
            }
            (a, b) => assert_eq!((a, b), (None, None), "{what} at {time}: {ray:?}"),
        }
    }
    assert!(hits > 20, "{what} at {time}: {hits} hits");
}

#[test]
fn moving_vertices_equal_a_static_mesh_at_each_time() {
    let rng = &mut Rng::new(1, 0);
    let (poses, moving) = (poses(), world([moving_ball()]));
    for frame in 0..40 {
        let time = frame as f32 / 39.0;
        agree("ball", &moving, &world([pose_at(&poses, time).into()]), time, rng);
    }
}

#[test]
fn moving_meshes_are_watertight() {
    let rng = &mut Rng::new(2, 0);
    let (poses, moving) = (poses(), world([moving_ball()]));
    for _ in 0..20_000 {
        let time = rng.uniform_f32();
        let pose = pose_at(&poses, time);
        let corners = pose.corners((rng.uniform_f32() * pose.len() as f32) as usize);
        let target =
            corners[0].lerp(corners[1], if rng.uniform_f32() < 0.5 { 0.0 } else { rng.uniform_f32() });
        // From the inside through a vertex or an edge.
        let center = pose.bounds().centroid();
        let ray = Ray::new(center, target - center, time);
        assert!(nearest(&moving, &ray).is_some(), "{ray:?}");
    }
}

#[test]
fn normals_move_with_their_vertices() {
    let positions = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let key = |n: Vec3| {
        let attributes = MeshAttributes { normals: Some(vec![n; 3].into()), ..MeshAttributes::default() };
        let positions = positions.clone().into();
        TriangleMesh::new(positions, [[0, 1, 2]].into(), attributes, &Transform::IDENTITY, false)
            .expect("a mesh")
    };
    let mesh = MovingMesh::new(vec![key(Vec3::Z), key(Vec3::new(1.0, 0.0, 1.0))], [0.0, 1.0]);
    let world = world([Geometry::Shapes(mesh.triangles().map(Shape::from).collect())]);
    for (time, x) in [(-1.0, 0.0), (0.0, 0.0), (0.5, 0.5), (1.0, 1.0), (7.0, 1.0)] {
        let ray = Ray::new(Vec3::new(0.2, 0.2, 1.0), -Vec3::Z, time);
        let surface = world.surface(&ray, &nearest(&world, &ray).expect("a hit"));
        assert!(surface.shading.n.distance(Vec3::new(x, 0.0, 1.0).normalize()) < 1e-6, "at {time}");
    }
}

/// A transform that rotates, translates and scales over the shutter interval.
fn moving_transform(rng: &mut Rng) -> AnimatedTransform {
    let mut key = || {
        let m = Transform::translate(point_in(rng, 0.8))
            .after(&Transform::rotate(between(rng, 0.0, 2.5), direction(rng)))
            .after(&Transform::scale(Vec3::new(1.0, between(rng, 0.6, 1.3), 1.1)));
        m.matrix().as_dmat4()
    };
    AnimatedTransform::new(key(), key(), [0.1, 0.7]).expect("keys with inverses")
}

#[test]
fn moving_instances_equal_static_ones_at_each_time() {
    let rng = &mut Rng::new(3, 0);
    for levels in 1..=3 {
        let motions: Vec<AnimatedTransform> = (0..levels).map(|_| moving_transform(rng)).collect();
        // The vertices of the sphere move too.
        let build = |geometry: Geometry, place: &dyn Fn(&AnimatedTransform) -> AnimatedTransform| {
            let mut builder = World::builder();
            let mut group = builder.add_group();
            builder.add_geometry(group, geometry);
            for (level, motion) in motions.iter().enumerate() {
                let outer = if level + 1 == levels { GroupId::TOP } else { builder.add_group() };
                builder.add_instance(outer, Instance { group, render_from_instance: place(motion) });
                group = outer;
            }
            builder.build()
        };
        let (poses, moving) = (poses(), build(moving_ball(), &AnimatedTransform::clone));
        for frame in 0..25 {
            let time = frame as f32 / 24.0;
            let still = build(pose_at(&poses, time).into(), &|motion| motion.at(time).into());
            agree(&format!("{levels} levels"), &moving, &still, time, rng);
        }
    }
}
