//! Positions of instances and of the shapes in them, at rest and in motion.

use crate::common::{scene, sphere, triangles};
use alhazen_scene::{RayStats, Scene};
use description::{InstanceDesc, ObjectDesc, SceneDesc, ShapeDesc, TransformDesc};
use math::{DMat4, DVec3, Ray, Vec3};
use std::f64::consts::{FRAC_1_SQRT_2, FRAC_PI_2};

/// A scene of one instance. The camera is at `eye`.
fn placed(shape: ShapeDesc, world_from_object: TransformDesc, eye: DVec3) -> Scene {
    let mut desc = SceneDesc::default();
    desc.camera.camera_from_world = TransformDesc::fixed(DMat4::from_translation(-eye));
    let mut object = ObjectDesc::default();
    object.shapes.push(shape);
    let object = desc.objects.push(object);
    desc.instances.push(InstanceDesc { object, world_from_object });
    scene(&desc)
}

/// Whether a ray along −z at a time hits something above the point (x, y) of render space.
fn there(scene: &Scene, x: f32, y: f32, time: f32) -> bool {
    let ray = Ray::new(Vec3::new(x, y, 50.0), -Vec3::Z, time);
    scene.intersect(&ray, f32::INFINITY, &mut RayStats::default()).is_some()
}

fn moving(start: DMat4, end: DMat4) -> TransformDesc {
    TransformDesc { start, end, times: [0.0, 1.0] }
}

fn ball(world_from_object: TransformDesc) -> ShapeDesc {
    ShapeDesc { world_from_object, ..sphere(0.1).into() }
}

#[test]
fn moving_shapes_move_in_instances() {
    let shape = ball(moving(DMat4::IDENTITY, DMat4::from_translation(DVec3::X * 2.0)));
    let scene = placed(shape, TransformDesc::translation(0.0, 3.0, 0.0), DVec3::ZERO);
    for (time, x) in [(0.0, 0.0), (0.5, 1.0), (1.0, 2.0)] {
        assert!(there(&scene, x, 3.0, time), "at {time}");
        assert!(!there(&scene, x + 0.5, 3.0, time), "elsewhere at {time}");
    }
}

#[test]
fn instances_rotate_about_the_origin_of_render_space() {
    // A quarter turn about z, at its middle. Interpolation is about the camera: the translations of
    // the keys, (0, 0) and (−4, 4) for the second eye, are averaged.
    let shape = ball(TransformDesc::translation(1.0, 0.0, 0.0));
    let turn = moving(DMat4::IDENTITY, DMat4::from_rotation_z(FRAC_PI_2));
    let c = FRAC_1_SQRT_2 as f32;
    for (eye, x, y) in [(0.0_f32, c, c), (4.0, -2.0 - 3.0 * c, 2.0 - 3.0 * c)] {
        let scene = placed(shape.clone(), turn, DVec3::X * f64::from(eye));
        assert!(there(&scene, 1.0 - eye, 0.0, 0.0));
        assert!(there(&scene, -eye, 1.0, 1.0));
        assert!(there(&scene, x, y, 0.5), "from {eye}");
    }
}

#[test]
fn the_distance_of_the_camera_does_not_move_scaled_instances() {
    // The plane y = 0 of an object, seen from (0, 3, −4) down to the origin.
    let square = || {
        let corners = [[-5.0, 0.0, -5.0], [-5.0, 0.0, 5.0], [5.0, 0.0, 5.0], [5.0, 0.0, -5.0]];
        ShapeDesc::from(triangles(&corners, &[[0, 1, 2], [0, 2, 3]]))
    };
    let eye = DVec3::new(0.0, 3.0, -4.0);
    let ray = Ray::new(Vec3::ZERO, Vec3::new(0.02, -0.6, 0.8), 0.0);
    let check = |scene: Scene, what: &str| {
        let (_, t) = scene.intersect(&ray, f32::INFINITY, &mut RayStats::default()).expect(what);
        assert!((t - 5.0).abs() < 1e-3, "{what}: {t}");
    };
    for scale in [1.0, 1e4, 3e7, 1e9, 1e12] {
        let at = TransformDesc::fixed(DMat4::from_scale(DVec3::splat(scale)));
        check(placed(square(), at, eye), &format!("scaled by {scale:e}"));
    }
    // An object that is described far away, and brought back by its instance.
    let far = DVec3::new(1e6, 3e5, -2e6) + DVec3::splat(0.1);
    let shape =
        ShapeDesc { world_from_object: TransformDesc::fixed(DMat4::from_translation(far)), ..square() };
    let back = TransformDesc::fixed(DMat4::from_translation(-far));
    check(placed(shape, back, eye), "from far away");
}

#[test]
fn nested_instances_compose_their_transforms() {
    // A ball at x = 1 of its object, which is at y = 2 of another, which moves along x; the camera
    // is not at the origin.
    let mut desc = SceneDesc::default();
    desc.camera.camera_from_world = TransformDesc::fixed(DMat4::from_translation(DVec3::new(-3.0, 1.0, 0.0)));
    let mut inner = ObjectDesc::default();
    inner.shapes.push(ball(TransformDesc::translation(1.0, 0.0, 0.0)));
    let inner = desc.objects.push(inner);
    let mut outer = ObjectDesc::default();
    outer.shapes.push(ball(TransformDesc::translation(0.0, 0.0, 0.0)));
    let turn = moving(DMat4::IDENTITY, DMat4::from_translation(DVec3::Y));
    outer
        .instances
        .push(InstanceDesc { object: inner, world_from_object: TransformDesc::translation(0.0, 2.0, 0.0) });
    outer.instances.push(InstanceDesc { object: inner, world_from_object: turn });
    let outer = desc.objects.push(outer);
    let along = moving(DMat4::IDENTITY, DMat4::from_translation(DVec3::X * 4.0));
    desc.instances.push(InstanceDesc { object: outer, world_from_object: along });
    let scene = scene(&desc);
    for time in [0.0, 0.25, 0.5, 1.0] {
        let there = |x: f32, y: f32| there(&scene, x + 4.0 * time - 3.0, y + 1.0, time);
        assert!(there(0.0, 0.0), "the outer ball at {time}");
        assert!(there(1.0, 2.0), "the inner ball at {time}");
        assert!(there(1.0, time), "the inner ball that moves by itself at {time}");
        assert!(!there(0.0, 2.0) && !there(1.0, 2.5), "elsewhere at {time}");
    }
}

#[test]
fn the_name_of_an_instance_applies_to_everything_in_it() {
    // From left to right: a shape, one that moves, two instances of `tree`, and between them one of
    // `leaf`, which `tree` contains as well.
    let mut desc = SceneDesc::default();
    let at = |x| TransformDesc::translation(x, 0.0, 0.0);
    let mut leaf = ObjectDesc { name: "leaf".into(), ..ObjectDesc::default() };
    leaf.shapes.push(ball(at(0.0)));
    let leaf = desc.objects.push(leaf);
    let mut tree = ObjectDesc { name: "tree".into(), ..ObjectDesc::default() };
    tree.shapes.push(ball(at(0.0)));
    let end = DMat4::from_translation(DVec3::X * 0.31);
    tree.shapes.push(ball(moving(at(0.3).start, end)));
    tree.instances.push(InstanceDesc { object: leaf, world_from_object: at(0.6) });
    let tree = desc.objects.push(tree);
    desc.shapes.push(ball(at(0.0)));
    let start = DMat4::from_translation(DVec3::X);
    desc.shapes.push(ball(moving(start, DMat4::from_translation(DVec3::X * 1.01))));
    for (object, x) in [(tree, 2.0), (leaf, 3.0), (tree, 4.0)] {
        desc.instances.push(InstanceDesc { object, world_from_object: at(x) });
    }
    let scene = scene(&desc);
    let name = |x: f32| {
        let ray = Ray::new(Vec3::new(x, 0.0, 50.0), -Vec3::Z, 0.0);
        scene.hit(&ray, f32::INFINITY, &mut RayStats::default()).map(|hit| scene.names().object(&hit))
    };
    for (x, expected) in [
        (0.0, ["shape-0", "shape-0"]),
        (1.0, ["shape-1", "shape-1"]),
        (2.0, ["tree/0", "tree"]),
        (2.3, ["tree/0", "tree"]),
        (2.6, ["tree/0", "tree"]),
        (3.0, ["leaf/0", "leaf"]),
        (4.0, ["tree/1", "tree"]),
        (4.6, ["tree/1", "tree"]),
    ] {
        assert_eq!(name(x).unwrap(), expected, "at {x}");
    }
    let names: Vec<String> = scene.names().objects().collect();
    assert_eq!(names, ["shape-0", "shape-1", "tree/0", "leaf/0", "tree/1"]);
    assert_eq!(scene.names().assets().collect::<Vec<_>>(), ["shape-0", "shape-1", "tree", "leaf"]);
    assert_eq!(scene.names().materials().collect::<Vec<_>>(), ["default"]);
}
