//! Single-sided surfaces, whose backs rays with the camera at an end pass through.

use crate::common::{disk, hit, patch, ray, scene, sphere, triangles, view};
use alhazen_scene::{Interfaces, RayStats, Scene};
use description::{
    InstanceDesc, MeshDesc, MeshKey, ObjectDesc, SceneDesc, ShapeDesc, ShapeKind, TransformDesc,
};
use geometry::{HitColumns, RayBuffer, RayColumns};
use math::{CameraEnd, DMat4, DVec3, Ray, Vec3};

/// A triangle around the origin, whose corners run counter-clockwise as seen from +z.
fn triangle() -> ShapeKind {
    triangles(&[[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.5, 0.0]], &[[0, 1, 2]])
}

fn mesh(change: impl FnOnce(&mut MeshDesc)) -> ShapeKind {
    let ShapeKind::Triangles(mut mesh) = triangle() else { unreachable!("a mesh") };
    change(&mut mesh);
    ShapeKind::Triangles(mesh)
}

fn single_sided(kind: ShapeKind) -> ShapeDesc {
    ShapeDesc { single_sided: true, ..kind.into() }
}

fn of(shape: ShapeDesc) -> Scene {
    let mut desc = SceneDesc::default();
    desc.shapes.push(shape);
    scene(&desc)
}

fn instance(shape: ShapeDesc, world_from_object: TransformDesc) -> Scene {
    let mut desc = SceneDesc::default();
    let mut object = ObjectDesc::default();
    object.shapes.push(shape);
    let object = desc.objects.push(object);
    desc.instances.push(InstanceDesc { object, world_from_object });
    scene(&desc)
}

/// Whether a ray along ±z past the origin hits something, which the scene says in two ways.
fn is_hit(scene: &Scene, z: f32, camera: CameraEnd) -> bool {
    let ray = Ray { camera, ..ray(Vec3::new(0.1, 0.1, -3.0 * z), Vec3::Z * z) };
    let is_hit = hit(scene, &ray).is_some();
    let stats = &mut RayStats::default();
    assert_eq!(scene.occluded(&ray, f32::INFINITY, Interfaces::Pass, stats), is_hit, "{ray:?}");
    is_hit
}

/// Asserts that the front of what is at the origin is seen from the side of z.
fn assert_front(name: &str, scene: &Scene, z: f32) {
    for (camera, from_front, from_back) in [
        (CameraEnd::Neither, true, true),
        (CameraEnd::Origin, true, false),
        // The camera is where the ray goes.
        (CameraEnd::Target, false, true),
    ] {
        let found = [is_hit(scene, -z, camera), is_hit(scene, z, camera)];
        assert_eq!(found, [from_front, from_back], "{name}: {camera:?}");
    }
}

#[test]
fn the_camera_sees_the_front_of_single_sided_surfaces_alone() {
    let scaled = |x, y, z| TransformDesc::fixed(DMat4::from_scale(DVec3::new(x, y, z)));
    let turn = TransformDesc {
        start: DMat4::IDENTITY,
        end: DMat4::from_rotation_z(1.0) * DMat4::from_scale(DVec3::new(-1.0, -1.0, 1.0)),
        times: [0.0, 1.0],
    };
    let placed = |world_from_object| ShapeDesc { world_from_object, ..single_sided(triangle()) };
    let reversed = ShapeDesc { reverse_orientation: true, ..single_sided(triangle()) };
    // Interpolated normals change neither the order of corners nor the front.
    let inward = || mesh(|mesh| mesh.normals = vec![-Vec3::Z; 3].into());
    let moving = mesh(|mesh| {
        let positions = mesh.positions.iter().map(|p| *p * 1.1).collect();
        mesh.later = vec![MeshKey { positions, normals: Default::default() }];
    });
    let square = patch([[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [-1.0, 1.0, 0.0], [1.0, 1.0, 0.0]]);
    for (name, scene, z) in [
        ("a triangle", of(single_sided(triangle())), 1.0),
        ("with opposite normals", of(single_sided(inward())), 1.0),
        ("reversed", of(reversed.clone()), -1.0),
        ("mirrored in its plane", of(placed(scaled(-1.0, 1.0, 1.0))), 1.0),
        ("mirrored to the other side", of(placed(scaled(1.0, 1.0, -2.0))), -1.0),
        ("that moves", of(placed(turn)), 1.0),
        ("that changes its form", of(single_sided(moving)), 1.0),
        ("in a mirrored instance", instance(single_sided(triangle()), scaled(1.0, -1.0, 1.0)), 1.0),
        ("in an instance upside down", instance(single_sided(inward()), scaled(1.0, 1.0, -1.0)), -1.0),
        ("reversed in an instance", instance(reversed, scaled(-1.0, 1.0, 1.0)), -1.0),
        ("in a moving instance", instance(single_sided(triangle()), turn), 1.0),
        ("a disk", of(single_sided(disk(0.0, 1.0))), 1.0),
        ("a patch", of(single_sided(square)), 1.0),
    ] {
        assert_front(name, &scene, z);
    }
    for kind in [triangle(), inward()] {
        let both = of(kind.into());
        for camera in [CameraEnd::Neither, CameraEnd::Origin, CameraEnd::Target] {
            assert!(is_hit(&both, 1.0, camera) && is_hit(&both, -1.0, camera));
        }
    }
}

#[test]
fn camera_rays_meet_what_is_beyond_a_back() {
    let ball = of(single_sided(sphere(1.0)));
    for (camera, from_inside, from_outside) in
        [(CameraEnd::Neither, Some(1.0), Some(2.0)), (CameraEnd::Origin, None, Some(2.0))]
    {
        let t = |o| {
            let ray = Ray { camera, ..ray(o, Vec3::Z) };
            ball.intersect(&ray, f32::INFINITY, &mut RayStats::default()).map(|(_, t)| t)
        };
        assert_eq!([t(Vec3::ZERO), t(Vec3::Z * -3.0)], [from_inside, from_outside]);
    }
    // A shadow ray passes the front, which the camera sees from behind, and meets the other side.
    let ray = Ray { camera: CameraEnd::Target, ..ray(Vec3::Z * -3.0, Vec3::Z) };
    let t = ball.intersect(&ray, f32::INFINITY, &mut RayStats::default()).map(|(_, t)| t);
    assert_eq!(t, Some(4.0));
}

#[test]
fn batches_of_camera_rays_find_the_same_hits() {
    // A bumpy ball of many triangles around the camera, and one beside it.
    let mut desc = SceneDesc::default();
    let (mut positions, mut indices) = (Vec::new(), Vec::new());
    for i in 0..=24 {
        for j in 0..48 {
            let (theta, phi) = (i as f32 * 0.1309, j as f32 * 0.1309);
            let r = 1.0 + 0.1 * (5.0 * theta).sin() * (3.0 * phi).cos();
            let (sin, cos) = theta.sin_cos();
            positions.push([r * sin * phi.cos(), r * sin * phi.sin(), r * cos]);
            let at = |i: u32, j: u32| i * 48 + j % 48;
            if i < 24 {
                indices.push([at(i, j), at(i + 1, j), at(i + 1, j + 1)]);
                indices.push([at(i, j), at(i + 1, j + 1), at(i, j + 1)]);
            }
        }
    }
    desc.shapes.push(single_sided(triangles(&positions, &indices)));
    let beside = TransformDesc::translation(1.5, 0.0, 3.0);
    let other = ShapeDesc { world_from_object: beside, ..single_sided(triangles(&positions, &indices)) };
    desc.shapes.push(other);
    let scene = scene(&desc);
    let rays: Vec<Ray> = (0..1024)
        .map(|i| {
            let (x, y) = ((i % 32) as f32 / 16.0 - 1.0, (i / 32) as f32 / 16.0 - 1.0);
            ray(Vec3::new(0.01, 0.02, 0.03), Vec3::new(x, y, 1.0))
        })
        .collect();
    let buffer: RayBuffer = rays.iter().map(|ray| (*ray, f32::INFINITY)).collect();
    let mut counts = Vec::new();
    for camera in [CameraEnd::Neither, CameraEnd::Origin] {
        let (mut hits, stats) = (HitColumns::default(), &mut RayStats::default());
        scene.hit_batch(RayColumns { camera, ..buffer.columns() }, &mut hits, stats);
        let single = |ray: &Ray| scene.hit(&Ray { camera, ..*ray }, f32::INFINITY, &mut RayStats::default());
        let found: Vec<_> = (0..rays.len()).map(|i| hits.get(i)).collect();
        assert_eq!(found, rays.iter().map(single).collect::<Vec<_>>());
        counts.push(found.iter().flatten().count());
    }
    assert!(counts[0] == 1024 && (50..500).contains(&counts[1]), "{counts:?}");
}

#[test]
fn a_view_out_of_a_back_has_no_surface() {
    let mut desc = SceneDesc::default();
    desc.shapes.push(single_sided(sphere(1.0)));
    assert!(!scene(&desc).has_surface_in(&view(&desc), [64, 64]));
    desc.shapes.push(ShapeDesc { reverse_orientation: true, ..single_sided(sphere(2.0)) });
    assert!(scene(&desc).has_surface_in(&view(&desc), [64, 64]));
}
