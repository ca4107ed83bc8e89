//! Positions of moving shapes and instances.

use crate::common::*;
use alhazen_scene::RayStats;
use description::{InstanceDesc, ObjectDesc, SceneDesc, ShapeDesc, TransformDesc};
use math::{DMat4, DVec3, Ray, Vec3};

/// A scene with one change, whose return value is ignored.
fn with<T>(change: impl FnOnce(&mut SceneDesc) -> T) -> SceneDesc {
    let mut desc = SceneDesc::default();
    change(&mut desc);
    desc
}

fn moving() -> TransformDesc {
    let at = |x| DMat4::from_translation(DVec3::new(x, 0.0, 5.0));
    TransformDesc { start: at(-2.0), end: at(2.0), times: [0.0, 1.0] }
}

fn distance_along(desc: &SceneDesc, o: Vec3, d: Vec3, time: f32) -> Option<f32> {
    let scene = scene(desc);
    scene.intersect(&Ray::new(o, d, time), f32::INFINITY, &mut RayStats::default()).map(|(_, t)| t)
}

#[test]
fn moving_shapes_are_interpolated() {
    let desc = with(|desc| {
        desc.shapes.push(ShapeDesc { world_from_object: moving(), ..sphere(0.5).into() });
    });
    for time in [-1.0f32, 0.0, 0.25, 0.5, 0.9, 1.0, 3.0] {
        let x = -2.0 + 4.0 * time.clamp(0.0, 1.0);
        let t = distance_along(&desc, Vec3::new(x, 0.0, 0.0), Vec3::Z, time).expect("the ball");
        assert!((t - 4.5).abs() < 1e-4, "at {time}: {t}");
        assert!(distance_along(&desc, Vec3::new(x + 0.6, 0.0, 0.0), Vec3::Z, time).is_none());
        let left = distance_along(&desc, Vec3::new(-10.0, 0.0, 5.0), Vec3::X, time).expect("the ball");
        assert!((left - (x + 9.5)).abs() < 1e-4);
    }
}

#[test]
fn moving_instances_are_interpolated() {
    // A sphere off the object's origin; a rotated and scaled instance, a moving one, and a camera
    // that is not at the origin.
    let desc = with(|desc| {
        let mut object = ObjectDesc::default();
        let in_object = TransformDesc::translation(1.0, 0.0, 0.0);
        object.shapes.push(ShapeDesc { world_from_object: in_object, ..sphere(0.5).into() });
        let object = desc.objects.push(object);
        let turned = DMat4::from_translation(DVec3::new(0.0, 0.0, 10.0))
            * DMat4::from_rotation_z(std::f64::consts::FRAC_PI_2)
            * DMat4::from_scale(DVec3::splat(2.0));
        desc.instances.push(InstanceDesc { object, world_from_object: TransformDesc::fixed(turned) });
        desc.instances.push(InstanceDesc { object, world_from_object: moving() });
        desc.camera.camera_from_world = TransformDesc::translation(0.0, 0.0, 7.0);
    });
    // The camera is at z = −7 in world space, the origin of render space.
    let camera = Vec3::new(0.0, 0.0, -7.0);
    let from = |x: f32, y: f32, time| distance_along(&desc, Vec3::new(x, y, 0.0) - camera, Vec3::Z, time);
    assert!((from(0.0, 2.0, 0.3).expect("the turned ball") - 9.0).abs() < 1e-4);
    assert!(from(2.0, 2.0, 0.3).is_none());
    for time in [0.0, 0.5, 0.75, 1.0] {
        let x = -2.0 + 4.0 * time + 1.0;
        assert!((from(x, 0.0, time).expect("the moving ball") - 4.5).abs() < 1e-4, "at {time}");
        assert!(from(x - 0.6, 0.0, time).is_none());
    }
}
