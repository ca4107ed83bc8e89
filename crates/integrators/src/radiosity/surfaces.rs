//! The surfaces that rays hit, except interfaces between media.

use geometry::{Hit, RayStats, SurfacePoint};
use math::Ray;
use scene::Scene;

/// The side of a surface that a ray has hit: the outer (0) or the inner (1).
pub(crate) fn seen_side(surface: &SurfacePoint) -> usize {
    usize::from(surface.wo.dot(surface.n) < 0.0)
}

/// The first hit of a ray that is not an interface between media.
pub(crate) fn first_solid(scene: &Scene, mut ray: Ray, stats: &mut RayStats) -> Option<(Hit, SurfacePoint)> {
    loop {
        let hit = scene.hit(&ray, f32::INFINITY, stats)?;
        let surface = scene.world().surface(&ray, &hit);
        if !scene.is_interface(&hit, &ray) {
            return Some((hit, surface));
        }
        ray = surface.spawn_ray(ray.d);
    }
}
