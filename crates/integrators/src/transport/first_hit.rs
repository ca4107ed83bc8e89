//! The first hit of a camera ray, for the AOVs of the film.

use film::{FirstHit, id_of_name};
use geometry::Hit;
use math::{Differentials, RayDifferential, Vec2, Vec3, face_forward};
use scene::camera::Projection;
use spectrum::{SampledSpectrum, SampledWavelengths};

use super::Tracer;

/// Maximum number of interfaces that a ray passes before it counts as a miss.
const MAX_INTERFACES: u32 = 64;

/// Directions that the albedo is averaged over.
const ALBEDO_SAMPLES: u32 = 16;

/// The first surface that a camera ray hits, except interfaces. The albedo is that at `lambda`.
/// Slopes come from the neighbours of the camera ray, without which they are 0.
pub(crate) fn first_hit(
    tracer: &mut Tracer,
    ray: &RayDifferential,
    neighbours: Option<&Differentials>,
    lambda: &SampledWavelengths,
) -> Option<FirstHit> {
    let mut ray = *ray;
    let mut lambda = *lambda;
    for _ in 0..MAX_INTERFACES {
        let hit = tracer.hit(&ray.ray)?;
        let mut surface = tracer.scene.interaction(&hit, tracer.scene.world().surface(&ray.ray, &hit));
        let Some(bsdf) = tracer.bsdf(&mut surface, &ray, &mut lambda) else {
            ray = surface.spawn_ray(ray.ray.d).into();
            continue;
        };
        let (p, time) = (surface.p(), ray.ray.time);
        let wo = -ray.ray.d.normalize();
        let samples = (0..ALBEDO_SAMPLES).map(|i| {
            let u = (i as f32 + 0.5) / ALBEDO_SAMPLES as f32;
            let v = (i.reverse_bits() >> 8) as f32 / (1 << 24) as f32;
            ((u + v).fract(), Vec2::new(u, v))
        });
        let albedo: SampledSpectrum = bsdf.rho(wo, samples);
        let world_from_render = tracer.scene.world_from_render();
        let camera_from_render = tracer.view.camera.transform().render_from_camera(time).inverse();
        let in_camera = camera_from_render.point(p);
        let depth = match tracer.view.camera.projection() {
            Projection::Spherical(_) => in_camera.length(),
            _ => in_camera.z,
        };
        // Towards the camera, as compositing software expects.
        let [normal, geometric] = [surface.surface.shading.n, surface.surface.n].map(|n| face_forward(n, wo));
        let in_world = |v: Vec3| world_from_render.transform_vector3(v.as_dvec3()).as_vec3();
        let steps = neighbours.map_or([Vec3::splat(0.0); 2], |neighbours| {
            tracer.view.pixel_on_plane(Some((neighbours, true)), p, surface.surface.n, time)
        });
        let names = tracer.scene.names();
        let [object, asset] = names.object(&hit).map(|name| id_of_name(&name));
        return Some(FirstHit {
            depth: [depth],
            position: world_from_render.transform_point3(p.as_dvec3()).as_vec3().to_array(),
            normal: in_world(normal).normalize_or_zero().to_array(),
            geometric_normal: in_world(geometric).normalize_or_zero().to_array(),
            camera_position: in_camera.to_array(),
            camera_normal: camera_from_render.normal(normal).normalize_or_zero().to_array(),
            camera_geometric_normal: camera_from_render.normal(geometric).normalize_or_zero().to_array(),
            slope: steps.map(|step| in_world(step).z),
            camera_slope: steps.map(|step| camera_from_render.vector(step).z),
            albedo,
            uv: surface.surface.uv.to_array(),
            motion: motion(tracer, &hit, p).to_array(),
            ids: [object, id_of_name(names.material(surface.material)), asset],
        });
    }
    None
}

/// The displacement of a surface point on the film while the shutter is open, in pixels; 0 if it
/// leaves the view. Surfaces without parameters count as static.
fn motion(tracer: &Tracer, hit: &Hit, p: Vec3) -> Vec2 {
    let camera = &tracer.view.camera;
    let seen = |time: f32| {
        let surface =
            tracer.scene.world().surface_at(hit.geometry, hit.primitive, hit.instance, hit.uv, time);
        let p = surface.map_or(p, |surface| surface.p.p);
        camera.sample_wi(p, time, Vec2::splat(0.5)).map(|seen| seen.film)
    };
    let [open, close] = camera.shutter();
    match (seen(open), seen(close)) {
        (Some(first), Some(last)) => last - first,
        _ => Vec2::ZERO,
    }
}
