//! The motions of a camera.

use alhazen::description::{CameraDesc, TransformDesc};
use alhazen::math::{DMat4, DVec3};
use alhazen_view::Flight;

/// A camera at (0, 2, −10) that looks at the origin, as `LookAt` makes it, or mirrored.
fn flight(mirrors: bool) -> Flight {
    let (position, up) = (DVec3::new(0.0, 2.0, -10.0), DVec3::Y);
    let forward = -position.normalize();
    let right = up.cross(forward).normalize();
    let up = forward.cross(right);
    let right = if mirrors { -right } else { right };
    let columns = [right, up, forward].map(|axis| axis.extend(0.0));
    let world_from_camera = DMat4::from_cols(columns[0], columns[1], columns[2], position.extend(1.0));
    let camera_from_world = TransformDesc::fixed(world_from_camera.inverse());
    Flight::new(CameraDesc { camera_from_world, ..CameraDesc::default() }, DVec3::ZERO)
}

/// A point of the world in camera space.
fn seen(flight: &Flight, p: DVec3) -> DVec3 {
    flight.camera().camera_from_world.start.transform_point3(p)
}

#[test]
fn an_orbit_keeps_the_distance_and_the_focus_in_the_middle() {
    for mirrors in [false, true] {
        let mut flight = flight(mirrors);
        let distance = flight.distance();
        for (angle, tilt) in [(0.3, 0.1), (-2.0, 0.5), (4.0, -0.9), (0.0, 5.0), (0.1, -9.0)] {
            flight.orbit(angle, tilt);
            assert!((flight.distance() - distance).abs() < 1e-9);
            let focus = seen(&flight, DVec3::ZERO);
            assert!((focus - DVec3::Z * distance).length() < 1e-9, "{focus}");
            // The horizon stays level, and the camera upright.
            let up = flight.camera().camera_from_world.start.transform_vector3(DVec3::Y);
            assert!(up.x.abs() < 1e-9 && up.y > 0.0, "{up}");
        }
    }
}

#[test]
fn motions_are_to_the_sides_that_they_say() {
    for mirrors in [false, true] {
        let home = flight(mirrors);
        let mut moved = home.clone();
        moved.orbit(0.2, 0.0);
        assert!(seen(&home, moved.position()).x > 0.0);
        moved.go_home();
        moved.orbit(0.0, 0.2);
        assert!(moved.position().y > home.position().y);
        moved.go_home();
        moved.look(0.2, 0.1);
        assert!(moved.position().distance(home.position()) < 1e-9);
        let turned = home.camera().camera_from_world.start.transform_vector3(moved.forward());
        assert!(turned.x > 0.0 && turned.y > 0.0, "{turned}");
        assert!((moved.distance() - home.distance()).abs() < 1e-9);
        moved.go_home();
        moved.fly([1.0, 2.0, 3.0]);
        let step = seen(&home, moved.position());
        assert!((step - DVec3::new(1.0, 2.0, 3.0)).length() < 1e-9, "{step}");
    }
}

#[test]
fn a_walk_keeps_its_height() {
    let mut flight = flight(false);
    flight.look(0.4, -0.6);
    for _ in 0..10 {
        flight.walk(0.5, 1.0);
        flight.look(0.1, 0.05);
    }
    assert!((flight.position().y - 2.0).abs() < 1e-9);
    assert!(flight.position().distance(DVec3::new(0.0, 2.0, -10.0)) > 5.0);
}

#[test]
fn a_camera_looks_where_it_is_told_to() {
    for mirrors in [false, true] {
        let mut flight = flight(mirrors);
        for target in [[5.0, 1.0, -3.0], [-20.0, 30.0, -40.0], [0.0, -7.0, 0.0]] {
            let target = DVec3::from(target);
            flight.look_at(target);
            let at = seen(&flight, target);
            assert!(at.truncate().length() < 1e-6 && at.z > 0.0, "{at}");
            assert_eq!(flight.focus(), target);
        }
        flight.approach(0.5);
        assert!((flight.position() - DVec3::new(0.0, -2.5, -5.0)).length() < 1e-9);
    }
}

#[test]
fn up_is_the_axis_of_the_scene() {
    // A camera of a scene with z up, on its way a little to the side.
    let world_from_camera = DMat4::from_rotation_x(-1.4) * DMat4::from_rotation_z(0.05);
    let camera_from_world = TransformDesc::fixed(world_from_camera.inverse());
    let camera = CameraDesc { camera_from_world, ..CameraDesc::default() };
    let mut flight = Flight::new(camera, DVec3::new(0.0, 5.0, 0.0));
    let height = flight.position().z;
    flight.walk(3.0, 4.0);
    assert!((flight.position().z - height).abs() < 1e-9);
}
