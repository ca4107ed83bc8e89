//! Views of one scene by several cameras, in the render space that the scene has fixed.

use crate::common::*;
use alhazen_scene::camera::CameraSample;
use alhazen_scene::{Scene, View};
use description::{CameraKind, LensDesc, SceneDesc, ScreenDesc, ShapeKind, TransformDesc};
use math::{Vec2, Vec3};

/// A ball at the world's origin, seen from the distance `z` in a picture of 100 × 100 pixels.
fn from_distance(z: f64) -> SceneDesc {
    let mut desc = SceneDesc::default();
    desc.shapes.push(ShapeKind::Sphere { radius: 1.0, z_min: -1.0, z_max: 1.0, phi_max: 360.0 }.into());
    desc.film.resolution = [100, 100];
    desc.camera.kind =
        CameraKind::Perspective { fov: 60.0, screen: ScreenDesc::default(), lens: LensDesc::default() };
    desc.camera.camera_from_world = TransformDesc::translation(0.3, -0.2, z);
    desc
}

/// The distance and the world position of the surface seen at a film position.
fn seen(scene: &Scene, view: &View, film: Vec2) -> (f32, Vec3) {
    let sample = CameraSample { film, lens: Vec2::ZERO, time: 0.0, filter_weight: 1.0 };
    let ray = view.camera.generate_ray(&sample).expect("a ray").ray;
    let (surface, t) = scene.intersect(&ray, f32::INFINITY, &mut Default::default()).expect("the ball");
    (t, scene.world_from_render().transform_point3(surface.p().as_dvec3()).as_vec3().into())
}

#[test]
fn a_second_camera_views_the_same_scene() {
    let (near, far) = (from_distance(4.0), from_distance(900.0));
    let scene_of_far = scene(&far);
    let visitor = View::compile(&near, scene_of_far.world_from_render()).expect("a view").view;
    assert_eq!(visitor.camera.transform().world_from_render(), scene_of_far.world_from_render());
    for film in [[50.0, 50.0], [61.0, 40.0], [45.5, 58.2]].map(Vec2::from) {
        let (own, own_p) = seen(&scene(&near), &view(&near), film);
        let (other, other_p) = seen(&scene_of_far, &visitor, film);
        // Single precision is 6e-5 at a distance of 900.
        assert!((own - other).abs() < 1e-3 && (own_p - other_p).length() < 1e-3, "{own} {other}");
    }
}

#[test]
fn coarser_pixels_view_the_same_scene() {
    let desc = from_distance(4.0);
    let (scene, view) = (scene(&desc), view(&desc));
    let film = Vec2::new(60.0, 45.0);
    let ((fine, _), (coarse, _)) = (seen(&scene, &view, film), seen(&scene, &view.coarser(4), film / 4.0));
    assert!((fine - coarse).abs() < 1e-5, "{fine} {coarse}");
}

#[test]
fn surfaces_in_view_are_found() {
    let in_view = |desc: &SceneDesc| scene(desc).has_surface_in(&view(desc), desc.film.resolution);
    assert!(in_view(&from_distance(4.0)));
    assert!(!in_view(&from_distance(-4.0)), "the ball is behind the camera");
}
