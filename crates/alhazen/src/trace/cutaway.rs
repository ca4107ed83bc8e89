//! A view of the scene from a side, without what is in front of a plane.

use image::Image;
use math::{DMat4, Ray, Vec3};
use scene::Scene;

use super::frame::Frame;
use crate::picture::data_uri;

/// The brightness of what lies behind nothing.
const EMPTY: f32 = 1.0;

/// What lies behind the plane of a frame, shaded by the slope of surfaces, as a picture in a data
/// URI. It is `size` pixels large.
pub(super) fn cutaway(scene: &Scene, frame: &Frame, size: [u32; 2]) -> String {
    let render_from_world: DMat4 = scene.world_from_render().inverse();
    let into: Vec3 = render_from_world.transform_vector3(frame.into.as_dvec3()).as_vec3().into();
    let brightness = |x: u32, y: u32| {
        let [u, v] = [(x as f32 + 0.5) / size[0] as f32, (y as f32 + 0.5) / size[1] as f32];
        let p = frame.point(u, v);
        let o = render_from_world.transform_point3(p.as_dvec3()).as_vec3().into();
        let hit = scene.intersect(&Ray::new(o, into, 0.0), f32::INFINITY, &mut Default::default());
        let Some((surface, t)) = hit else { return EMPTY };
        // Steep and distant surfaces are darker.
        let facing = surface.surface.shading.n.dot(into.normalize_or_zero()).abs();
        let near = 1.0 / (1.0 + t * into.length() / (frame.width + frame.height));
        (0.1 + 0.7 * facing) * (0.4 + 0.6 * near)
    };
    let picture = Image::from_fn(size[0], size[1], ["R", "G", "B"], |x, y| [brightness(x, y); 3]);
    data_uri(&picture)
}
