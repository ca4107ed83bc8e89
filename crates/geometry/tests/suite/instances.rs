//! Instances equal their transformed members, static or moving; and meshes follow the shading
//! conventions.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;

fn placed(geometries: impl IntoIterator<Item = Geometry>, motion: AnimatedTransform) -> World {
    let mut builder = World::builder();
    let group = builder.add_group();
    for geometry in geometries {
        builder.add_geometry(group, geometry);
    }
    builder.add_instance(GroupId::TOP, Instance { group, render_from_instance: motion });
    builder.build()
}

fn everything(m: &Transform) -> Vec<Geometry> {
    let mut all: Vec<Geometry> = shapes(m).into_iter().map(|(_, shape)| shape.into()).collect();
    all.push(ball(20, 0.2, m).into());
    all
}

#[test]
fn an_instance_equals_the_transformed_group() {
    let rng = &mut Rng::new(1, 0);
    let m = Transform::translate(Vec3::new(3.0, -2.0, 1.0))
        .after(&Transform::rotate(1.0, Vec3::new(1.0, 2.0, 3.0)))
        .after(&Transform::scale(Vec3::new(0.5, 1.5, 0.8)));
    let outside = world(everything(&m));
    let inside = placed(everything(&Transform::IDENTITY), m.into());
    assert!((inside.bounds().diagonal() - outside.bounds().diagonal()).abs().max_element() < 2.0);
    let mut hits = 0;
    for _ in 0..5000 {
        let target = m.point(point_in(rng, 1.0));
        let o = target + direction(rng) * 5.0;
        let ray = Ray::new(o, target - o, 0.3);
        let (a, b) = (nearest(&outside, &ray), nearest(&inside, &ray));
        assert_eq!(a.is_some(), b.is_some(), "{ray:?}");
        let (Some(a), Some(b)) = (a, b) else { continue };
        if a.geometry != b.geometry || a.primitive != b.primitive {
            continue;
        }
        hits += 1;
        assert!((a.t - b.t).abs() < 1e-5);
        assert_eq!((a.instance, b.instance.ids()), (InstancePath::TOP, &[InstanceId(0)][..]));
        let (a, b) = (outside.surface(&ray, &a), inside.surface(&ray, &b));
        assert!(a.p.p.distance(b.p.p) < 1e-4 && a.n.distance(b.n) < 1e-3 && a.wo.distance(b.wo) < 1e-5);
        assert!(a.uv.distance(b.uv) < 1e-3);
        assert!(
            a.dpdu.distance(b.dpdu) < 1e-2 * a.dpdu.length()
                && a.dpdv.distance(b.dpdv) < 1e-2 * a.dpdv.length()
        );
        assert!(a.dndu.distance(b.dndu) < 1e-2 * (1.0 + a.dndu.length()));
        let off = (a.p.p - b.p.p).dot(a.n).abs();
        assert!(off <= (a.p.error + b.p.error).dot(a.n.abs()) + 1e-6, "both are on one surface: {off}");
    }
    assert!(hits > 1000);
}

#[test]
fn moving_instances_are_hit_at_their_position_in_time() {
    let end = DMat4::from_translation(DVec3::new(10.0, 0.0, 0.0));
    let motion = AnimatedTransform::new(DMat4::IDENTITY, end, [0.0, 1.0]).expect("invertible");
    let ball = Shape::from(Sphere::whole(&Transform::IDENTITY, false, 1.0));
    let world = placed([ball.into()], motion);
    for time in [0.0, 0.25, 0.5, 1.0] {
        let down = |x| nearest(&world, &Ray::new(Vec3::new(x, 0.0, 5.0), -Vec3::Z, time));
        assert!(down(10.0 * time + 1.5).is_none() && down(10.0 * time - 1.5).is_none());
        let ray = Ray::new(Vec3::new(10.0 * time, 0.0, 5.0), -Vec3::Z, time);
        let hit = nearest(&world, &ray).expect("hit");
        assert!((hit.t - 4.0).abs() < 1e-5);
        let surface = world.surface(&ray, &hit);
        assert!(
            surface.n.distance(Vec3::Z) < 1e-3
                && surface.p.p.distance(Vec3::new(10.0 * time, 0.0, 1.0)) < 1e-3
        );
    }
    assert!(
        world.bounds().contains(Vec3::new(-1.0, 0.0, 0.0))
            && world.bounds().contains(Vec3::new(11.0, 0.0, 0.0))
    );
}

#[test]
fn an_instanced_plane_is_infinite() {
    let m = Transform::translate(Vec3::Z * -2.0);
    let world = placed([Shape::from(Plane::new(&Transform::IDENTITY, false)).into()], m.into());
    let hit = nearest(&world, &Ray::new(Vec3::new(1e6, -1e6, 1.0), -Vec3::Z, 0.0)).expect("hit");
    assert_eq!(hit.t, 3.0);
    assert!(nearest(&world, &Ray::new(Vec3::ZERO, Vec3::X, 0.0)).is_none(), "along the plane");
}

/// Rays spawned from flat surfaces in a distant instance do not hit them again.
#[test]
fn spawned_rays_do_not_hit_an_instanced_surface() {
    let rng = &mut Rng::new(3, 0);
    for i in 0..200 {
        let size = 10f32.powf(between(rng, -3.0, 4.0));
        let m = Transform::translate(direction(rng) * size * 10f32.powf(between(rng, -2.0, 3.0)))
            .after(&Transform::rotate(between(rng, 0.0, 6.0), direction(rng)))
            .after(&Transform::scale(Vec3::new(1.0, 0.7, -1.3) * size));
        let flat = ["disk", "ring", "rectangle", "triangle"][i % 4];
        let mut all = shapes(&Transform::IDENTITY).into_iter();
        let (_, shape) = all.find(|(name, _)| *name == flat).expect("a flat shape");
        let triangle =
            mesh(vec![Vec3::ZERO, Vec3::X, Vec3::new(0.3, 1.0, 0.5)], vec![[0, 1, 2]], &Transform::IDENTITY);
        for geometry in [Geometry::from(shape), triangle.into()] {
            let shape = geometry.shape(0).expect("a shape").into_owned();
            let world = placed([geometry], m.into());
            for _ in 0..100 {
                let target = m.point(shape.sample(uniform_2d(rng)).expect("a sample").p.p);
                let o = target + direction(rng) * size;
                let ray = Ray::new(o, target - o, 0.0);
                let Some(hit) = nearest(&world, &ray) else { continue };
                let surface = world.surface(&ray, &hit);
                let next = surface.spawn_ray(direction(rng));
                assert_eq!(nearest(&world, &next), None, "{next:?} from {surface:?}");
            }
        }
    }
}

#[test]
fn shading_normals_determine_orientation() {
    let corners: Vec<Vec3> = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let ns = Vec3::new(0.3, 0.2, -1.0).normalize();
    let attributes = MeshAttributes { normals: Some(vec![ns; 3].into()), ..MeshAttributes::default() };
    for (reverse, expected) in [(false, ns), (true, -ns)] {
        let mesh = TriangleMesh::new(
            corners.clone().into(),
            vec![[0, 1, 2]].into(),
            attributes.clone(),
            &Transform::IDENTITY,
            reverse,
        );
        let world = world([mesh.expect("a mesh").into()]);
        let ray = Ray::new(Vec3::new(0.2, 0.3, 1.0), -Vec3::Z, 0.0);
        let surface = world.surface(&ray, &nearest(&world, &ray).expect("hit"));
        assert!(surface.shading.n.distance(expected) < 1e-6);
        assert!(surface.n.distance(Vec3::Z * expected.z.signum()) < 1e-6, "n is flipped to its side");
        assert!(
            surface.shading.dpdu.dot(expected).abs() < 1e-6
                && surface.shading.dpdv.dot(expected).abs() < 1e-6
        );
        assert!(surface.dpdu.distance(Vec3::X) < 1e-6, "u runs from corner 0 to corner 1");
        assert_eq!(surface.uv, Vec2::new(0.5, 0.3));
    }
}

#[test]
fn invalid_arrays_are_refused() {
    let corners: Vec<Vec3> = vec![Vec3::ZERO, Vec3::X, Vec3::Y];
    let make = |index: u32, uvs: usize| {
        let attributes =
            MeshAttributes { uvs: Some(vec![Vec2::ZERO; uvs].into()), ..MeshAttributes::default() };
        TriangleMesh::new(
            corners.clone().into(),
            vec![[0, 1, index]].into(),
            attributes,
            &Transform::IDENTITY,
            false,
        )
    };
    assert!(make(2, 3).is_ok());
    assert_eq!(make(3, 3).unwrap_err(), MeshError::Index { triangle: 0, vertex: 3 });
    assert_eq!(make(2, 4).unwrap_err().to_string(), "4 texture coordinates for 3 vertices");
}

#[test]
fn shading_normals_are_weighted_by_their_lengths() {
    let corners = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::new(1.0, 1.0, 0.0)];
    let normals = [Vec3::Z, Vec3::new(3.0, 0.0, 4.0), Vec3::new(0.0, -1.0, 2.0), Vec3::Z];
    let m = Transform::scale(Vec3::new(0.5, 2.0, 1.0));
    let ray = Ray::new(Vec3::new(0.125, 0.5, 1.0), -Vec3::Z, 0.0);
    let mesh = |m: &Transform| -> Geometry {
        let attributes = MeshAttributes { normals: Some(normals[..3].into()), tangents: None, uvs: None };
        TriangleMesh::new(corners[..3].into(), [[0, 1, 2]].into(), attributes, m, false).unwrap().into()
    };
    let patch = |m: &Transform| -> Geometry {
        Shape::from(BilinearPatch::new(corners, Some(normals), None, m, false)).into()
    };
    // At a quarter of both edges; the transform is applied to the sum.
    let object = [normals[0] * 0.5 + (normals[1] + normals[2]) * 0.25, Vec3::new(9.0, -3.0, 28.0) / 16.0];
    for (make, n) in [(&mesh as &dyn Fn(&Transform) -> Geometry, object[0]), (&patch, object[1])] {
        let expected = m.normal(n).normalize();
        for there in [world([make(&m)]), placed([make(&Transform::IDENTITY)], m.into())] {
            let hit = nearest(&there, &ray).unwrap();
            let found = there.surface(&ray, &hit).shading.n;
            assert!(found.distance(expected) < 1e-5, "{found} {expected}");
        }
    }
}

/// A world with a sphere in nested instances, and one with the transformed sphere.
fn nested(rng: &mut Rng, levels: usize) -> (World, World) {
    let mut builder = World::builder();
    let mut group = builder.add_group();
    builder.add_geometry(group, ball(10, 0.2, &Transform::IDENTITY));
    let mut all = Transform::IDENTITY;
    for level in 1..=levels {
        let m = Transform::translate(point_in(rng, 0.4))
            .after(&Transform::rotate(between(rng, 0.0, 6.0), direction(rng)))
            .after(&Transform::scale(Vec3::new(
                between(rng, 0.8, 1.2),
                1.0,
                if level % 3 == 0 { -1.0 } else { 1.1 },
            )));
        all = m.after(&all);
        let outer = if level == levels { GroupId::TOP } else { builder.add_group() };
        builder.add_instance(outer, Instance { group, render_from_instance: m.into() });
        group = outer;
    }
    (builder.build(), placed([ball(10, 0.2, &Transform::IDENTITY).into()], all.into()))
}

#[test]
fn nested_instances_compose_their_transforms() {
    let rng = &mut Rng::new(8, 0);
    for levels in 1..=InstancePath::MAX_DEPTH {
        let (nested, once) = nested(rng, levels);
        let mut hits = 0;
        for _ in 0..1000 {
            let o = direction(rng) * 9.0;
            let ray = Ray::new(o, point_in(rng, 1.0) - o, 0.0);
            let (Some(a), Some(b)) = (nearest(&nested, &ray), nearest(&once, &ray)) else { continue };
            hits += 1;
            assert_eq!(a.instance.ids().len(), levels);
            assert_eq!(a.instance.ids()[0].0 as usize, levels - 1, "the outermost first");
            assert!((a.t - b.t).abs() < 1e-4, "{a:?} and {b:?}");
            let (p, q) = (nested.surface(&ray, &a), once.surface(&ray, &b));
            assert!(p.p.p.distance(q.p.p) < 1e-4, "{p:?} and {q:?}");
            if a.primitive == b.primitive {
                assert!(p.n.dot(q.n) > 0.9999 && p.dpdu.distance(q.dpdu) < 1e-3, "{p:?} and {q:?}");
            }
            // Rays spawned outwards do not hit the same triangle again.
            let away = nearest(&nested, &p.spawn_ray(face_forward(direction(rng), p.n)));
            assert!(away.is_none_or(|hit| hit.primitive != a.primitive), "{p:?}");
        }
        assert!(hits > 300, "{levels} levels: {hits}");
    }
}

#[test]
fn a_group_is_shared_by_many_nested_instances() {
    // A ball at x = 0, 1; those at y = 0, 3; and those again, with the first pair alone, at z = 0.
    let mut builder = World::builder();
    let at = |group, p: Vec3| Instance { group, render_from_instance: Transform::translate(p).into() };
    let one = builder.add_group();
    let pair = builder.add_group();
    let four = builder.add_group();
    builder.add_instance(four, at(pair, Vec3::ZERO));
    builder.add_instance(four, at(pair, Vec3::Y * 3.0));
    builder.add_instance(GroupId::TOP, at(four, Vec3::ZERO));
    builder.add_instance(GroupId::TOP, at(pair, Vec3::Y * 6.0));
    builder.add_instance(pair, at(one, Vec3::ZERO));
    builder.add_instance(pair, at(one, Vec3::X));
    builder.add_geometry(one, Shape::from(Sphere::whole(&Transform::IDENTITY, false, 0.3)));
    let world = builder.build();
    let mut paths = Vec::new();
    for y in [0.0, 3.0, 6.0] {
        for x in [0.0, 1.0] {
            let hit = nearest(&world, &Ray::new(Vec3::new(x, y, 5.0), -Vec3::Z, 0.0)).expect("a ball");
            assert!((hit.t - 4.7).abs() < 1e-6);
            paths.push(hit.instance);
        }
        assert!(nearest(&world, &Ray::new(Vec3::new(0.5, y, 5.0), -Vec3::Z, 0.0)).is_none());
    }
    assert_eq!(paths[1].ids(), [InstanceId(2), InstanceId(0), InstanceId(5)]);
    assert_eq!(paths[4].ids(), [InstanceId(3), InstanceId(4)]);
    paths.sort();
    paths.dedup();
    assert_eq!(paths.len(), 6);
}

#[test]
#[should_panic(expected = "too deep")]
fn too_deeply_nested_instances_are_refused() {
    nested(&mut Rng::new(9, 0), InstancePath::MAX_DEPTH + 1);
}
