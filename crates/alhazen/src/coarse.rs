//! Instances so much larger than their distance from the camera that floats misplace them.

use description::Diagnostic;
use geometry::InstanceId;
use math::{DMat4, MACHINE_EPSILON, Ray, Vec2};
use scene::camera::CameraSample;
use scene::{RayStats, Scene, View};

/// The largest error of a hit, relative to its distance, that is not worth a warning.
const TOLERANCE: f64 = 0.01;

/// A warning about an instance that rays from the camera hit with a large error: within it, their
/// origins are floats of its object's space, whose spacing is that of its coordinates there.
pub(crate) fn warning(scene: &Scene, view: &View, resolution: [i32; 2]) -> Option<Diagnostic> {
    const SIDE: u32 = 16;
    if scene.instances().is_empty() {
        return None;
    }
    let position = |i: u32, axis: usize| (i as f32 + 0.5) / SIDE as f32 * resolution[axis] as f32;
    let (id, error) = (0..SIDE * SIDE).find_map(|i| {
        let film = Vec2::new(position(i % SIDE, 0), position(i / SIDE, 1));
        let sample = CameraSample { film, lens: Vec2::splat(0.5), time: 0.5, filter_weight: 1.0 };
        let ray = view.camera.generate_ray(&sample)?.ray;
        let hit = scene.hit(&ray, f32::INFINITY, &mut RayStats::default())?;
        let (id, error) = error_within(scene, hit.instance.ids(), &ray)?;
        // A surface that is passed because the origin is rounded to its other side.
        let behind = Ray { o: ray.at(-8.0 * error as f32), ..ray };
        let passed = scene.hit(&behind, 16.0 * error as f32, &mut RayStats::default());
        let is_passed = passed.is_some_and(|passed| passed.instance == hit.instance);
        let error = error / if is_passed { error } else { hit.t.into() };
        (error > TOLERANCE).then_some((id, error))
    })?;
    let message = format!(
        "the instance is so large, or so far from the origin of its object, that floats place its surface \
         with an error of {:.0} % of the distance from the camera",
        (100.0 * error).min(100.0)
    );
    let help = "write its shapes without an object, or nearer to the object's origin".to_owned();
    let warning = Diagnostic::warning("coarse-instance", message, scene.instances()[id.0 as usize].span);
    Some(Diagnostic { help: Some(help), ..warning })
}

/// The largest error, in render space, of the origin of a ray in the spaces of nested instances,
/// and the instance of that.
fn error_within(scene: &Scene, path: &[InstanceId], ray: &Ray) -> Option<(InstanceId, f64)> {
    let mut outward = DMat4::IDENTITY;
    let errors = path.iter().map(|&id| {
        outward *= scene.world().render_from_instance(id).at(ray.time).in_doubles();
        let inside = outward.inverse().transform_point3(ray.o.as_dvec3()).abs().max_element();
        let axes = [outward.x_axis, outward.y_axis, outward.z_axis].map(|axis| axis.truncate().length());
        (id, inside * f64::from(MACHINE_EPSILON) * axes.into_iter().fold(0.0, f64::max))
    });
    errors.max_by(|a, b| a.1.total_cmp(&b.1))
}
