//! Surface points of the hits of batches are those of single hits.

use crate::common::*;
use alhazen_geometry::*;
use math::*;
use sampling::Rng;
use std::sync::Arc;

/// A mesh with any shading normals and texture coordinates.
fn with_attributes(rng: &mut Rng, plain: &TriangleMesh, tangents: bool) -> Geometry {
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for triangle in 0..plain.len() {
        positions.extend(plain.corners(triangle));
        indices.push([0, 1, 2].map(|corner| 3 * triangle as u32 + corner));
    }
    let n = positions.len();
    let mut vectors = |_| -> Arc<[Vec3]> { (0..n).map(|_| direction(rng)).collect() };
    let (normals, tangents) = (Some(vectors(0)), tangents.then(|| vectors(1)));
    let uvs = Some((0..n).map(|_| uniform_2d(rng)).collect());
    let attributes = MeshAttributes { normals, tangents, uvs };
    let m = Transform::scale(Vec3::new(-1.0, 1.0, 1.0));
    TriangleMesh::new(positions.into(), indices.into(), attributes, &m, true).expect("a mesh").into()
}

fn patches(rng: &mut Rng) -> Geometry {
    let patch = |i: u32| {
        let mut p = [Vec3::ZERO, Vec3::X, Vec3::Y, Vec3::X + Vec3::Y];
        p[3].z += if i.is_multiple_of(2) { 0.1 } else { 0.0 };
        BilinearPatch::new(p, None, None, &Transform::translate(point_in(rng, 2.0)), i.is_multiple_of(3))
    };
    let patches: Vec<Shape> = (0..9).map(patch).map(Shape::from).collect();
    Geometry::Shapes(patches.into())
}

/// Compares the points of hits, and returns their number.
fn compare(world: &World, rng: &mut Rng) -> usize {
    let rays: RayBuffer =
        (0..5003).map(|_| (Ray::new(point_in(rng, 3.0), direction(rng), 0.0), f32::INFINITY)).collect();
    let rays = rays.columns();
    let mut hits = HitColumns::default();
    world.intersect_batch(rays, &Accepts::All, &mut hits, &mut RayStats::default());
    let places: Vec<u32> =
        (0..rays.len() as u32).rev().filter(|&place| hits.get(place as usize).is_some()).collect();
    let mut points = PointColumns::default();
    world.points(rays, &hits, &places, &mut points);
    let mut with_shading = PointColumns::default();
    world.points_with_shading(rays, &hits, &places, &mut with_shading);
    for (i, &place) in places.iter().enumerate() {
        let hit = hits.get(place as usize).expect("a hit");
        let point = points.get::<f32>(i);
        let surface = world.surface(&rays.ray(place as usize), &hit);
        let near = |a: Vec3, b: Vec3, what: &str| {
            assert!((a - b).length() <= 1e-4 * (1.0 + b.length()), "{what} {a:?} and {b:?} of {hit:?}");
        };
        let error = point.p.error + surface.p.error;
        assert!((point.p.p - surface.p.p).abs().cmple(error).all(), "{hit:?}");
        near(point.n, surface.n, "normals");
        near(point.ns, surface.shading.n, "shading normals");
        near(point.dpdu.normalize(), surface.dpdu.normalize(), "tangents");
        // Tangents almost along the shading normal leave little to compare.
        let frame = |ns: Vec3, ss: Vec3| Frame::from_z_and_x(ns, ss).x;
        let Shading { n: ns, dpdu: ss, .. } = surface.shading;
        if point.ns.cross(point.ss).length() > 0.1 * point.ss.length() {
            let [in_lanes, single] = [frame(point.ns, point.ss), frame(ns, ss)];
            assert!((in_lanes - single).length() < 2e-3, "{in_lanes} and {single} of {hit:?}");
        }
        assert!((point.uv - surface.uv).length() < 1e-5, "{hit:?}");
        assert_eq!(with_shading.shading::<f32>(i), surface.shading);
        assert_eq!(with_shading.get::<f32>(i).ss, surface.shading.dpdu);
    }
    places.len()
}

#[test]
fn few_facets() {
    let rng = &mut Rng::new(1, 0);
    let mut geometries = vec![cube(&Transform::IDENTITY).into(), patches(rng)];
    geometries.push(with_attributes(rng, &cube(&Transform::translate(Vec3::X)), false));
    let found = compare(&world(geometries), rng);
    assert!(found > 500, "{found}");
}

#[test]
fn meshes_of_trees_and_what_is_computed_one_by_one() {
    let rng = &mut Rng::new(2, 0);
    let mut builder = World::builder();
    let group = builder.add_group();
    let at = |x: f32| Transform::translate(Vec3::X * x);
    builder.add_geometry(GroupId::TOP, ball(20, 0.1, &at(1.0)));
    builder.add_geometry(GroupId::TOP, with_attributes(rng, &ball(20, 0.1, &at(1.5)), false));
    builder.add_geometry(GroupId::TOP, patches(rng));
    builder.add_geometry(GroupId::TOP, with_attributes(rng, &ball(20, 0.1, &at(0.2)), true));
    builder.add_geometry(GroupId::TOP, Shape::from(Sphere::whole(&at(-2.0), false, 0.5)));
    builder.add_geometry(group, ball(9, 0.1, &at(-1.0)));
    builder.add_instance(GroupId::TOP, Instance { group, render_from_instance: at(0.5).into() });
    let found = compare(&builder.build(), rng);
    assert!(found > 600, "{found}");
}

#[test]
fn spheres_of_sets() {
    let rng = &mut Rng::new(3, 0);
    let mut builder = World::builder();
    let turn = DMat4::from_axis_angle(direction(rng).as_dvec3().normalize(), 1.2);
    for (size, reverse) in [(0.2, false), (0.1, true)] {
        let centers = (0..200).map(|_| point_in(rng, 2.0)).collect();
        let radii = (0..200).map(|_| size * (0.5 + rng.uniform_f32())).collect();
        let transform = Transform::from_f64(turn).expect("an inverse");
        builder
            .add_geometry(GroupId::TOP, SphereSet::new(centers, radii, &transform, reverse).expect("a set"));
    }
    let far = SphereSet::new([Vec3::X * 2.5].into(), [1e-6].into(), &Transform::IDENTITY, false);
    builder.add_geometry(GroupId::TOP, far.expect("a set"));
    let world = builder.build();
    let mut rays: RayBuffer =
        (0..5003).map(|_| (Ray::new(point_in(rng, 3.0), direction(rng), 0.0), f32::INFINITY)).collect();
    rays.push(&Ray::new(Vec3::new(2.5, 0.0, 30.0), -Vec3::Z, 0.0), f32::INFINITY);
    let rays = rays.columns();
    let mut hits = HitColumns::default();
    world.intersect_batch(rays, &Accepts::All, &mut hits, &mut RayStats::default());
    let is_hit = |place: &u32| hits.get(*place as usize).is_some();
    let places: Vec<u32> = (0..rays.len() as u32).rev().filter(is_hit).collect();
    let mut points = PointColumns::default();
    world.points(rays, &hits, &places, &mut points);
    assert!(places.len() > 1000);
    for (i, &place) in places.iter().enumerate() {
        let hit = hits.get(place as usize).expect("a hit");
        let point = points.get::<f32>(i);
        let surface = world.surface(&rays.ray(place as usize), &hit);
        let near = |a: Vec3, b: Vec3, what: &str| {
            assert!((a - b).length() <= 1e-3 * (1e-2 + b.length()), "{what} {a:?} and {b:?} of {hit:?}");
        };
        near(point.n, surface.n, "normals");
        near(point.ns, surface.shading.n, "shading normals");
        near(point.dpdu, surface.dpdu, "tangents");
        near(point.dpdv, surface.dpdv, "other tangents");
        // Along the surface the projection may move a point.
        let off = (point.p.p - surface.p.p).dot(surface.n).abs();
        assert!(off <= surface.n.abs().dot(point.p.error + surface.p.error), "{off} {hit:?}");
        near(point.p.p, surface.p.p, "points");
        let across = (point.uv - surface.uv).abs();
        assert!(across.y < 1e-3 && (across.x < 1e-3 || across.x > 0.999), "{across:?} {hit:?}");
    }
}
