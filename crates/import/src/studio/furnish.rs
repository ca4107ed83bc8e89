//! The studio in which a bare mesh is shown: a camera that sees all of it, a ground that receives
//! its shadow, and light of a neutral grey.
//!
//! The light is an environment of constant radiance with a large soft key light in it. The key
//! light is so bright that the lit ground looks exactly like the environment behind it: for a
//! diffuse ground of reflectance ρ under an environment of radiance L, the key light's irradiance
//! is E = π L (1/ρ − 1), as ρ (π L + E) / π = L. Neither the ground's edge nor a horizon is then
//! visible, and the shadow lies in an even grey.

use std::f32::consts::PI;
use std::sync::Arc;

use description::{
    CameraDesc, CameraKind, ImageDesc, InfiniteRadiance, IntegratorDesc, LensDesc, LightKind, MaterialDesc,
    MaterialKind, PathDesc, SceneDesc, ScreenDesc, ShapeDesc, ShapeKind, TransformDesc,
};
use image::Image;
use math::{DMat4, DVec3, Vec2, Vec3, equal_area_square_to_sphere};

use super::outline::{Axes, Outline};

/// The field of view over the shorter side, in degrees.
const FOV: f64 = 40.0;
/// How much of the frame is filled.
const FILLED: f64 = 0.8;
/// Radiance of the environment, and so of the ground.
const BACKGROUND: f32 = 0.45;
/// Reflectance of the ground.
const GROUND: f32 = 0.36;
/// Reflectance of meshes that have no material.
const CLAY: f32 = 0.65;
/// Cosines of the angles from the middle of the key light to where it begins to fade and to its
/// edge: 12 and 18 degrees.
const KEY_EDGE: [f32; 2] = [0.978, 0.951];
/// Side of the environment's image in pixels.
const RESOLUTION: u32 = 128;
/// Radius of the ground, in radii of the mesh: beyond all shadows.
const GROUND_RADIUS: f64 = 6.0;

/// Adds camera, ground and light for shapes; y is up.
pub(crate) fn furnish(desc: &mut SceneDesc) {
    if desc.shapes.iter().any(|(_, shape)| shape.material.is_none()) {
        let clay = desc.materials.push(diffuse(CLAY));
        for (_, shape) in desc.shapes.iter_mut() {
            shape.material.get_or_insert(clay);
        }
    }
    desc.film.resolution = [640, 480];
    let (axes, [low, high]) = add_camera(desc, [-DVec3::ONE, DVec3::ONE]);
    desc.integrator = IntegratorDesc::Path(PathDesc::default()).into();
    desc.sampler.kind.set_samples_per_pixel(64);
    add_ground(desc, low, high);
    add_light(desc, &axes);
}

fn center_and_radius(low: DVec3, high: DVec3) -> (DVec3, f64) {
    ((low + high) / 2.0, ((high - low).length() / 2.0).max(1e-6))
}

/// Adds a camera that sees all surfaces, from the front, a little from the side and from above, so
/// that they fill [`FILLED`] of the frame from side to side or from top to bottom. Gives its axes,
/// and the box around all points. `bounds` are those of surfaces without points.
pub(crate) fn add_camera(desc: &mut SceneDesc, bounds: [DVec3; 2]) -> (Axes, [DVec3; 2]) {
    let forwards = -DVec3::new(0.4, 0.45, 1.0).normalize();
    let right = forwards.cross(DVec3::Y).normalize();
    let axes = [right, right.cross(forwards), forwards];
    let sides = desc.film.resolution.map(|side| f64::from(side.max(1)));
    let unit = FILLED * libm::tan((FOV / 2.0).to_radians()) / sides[0].min(sides[1]);
    let mut outline = Outline::of(desc, axes, sides.map(|side| unit * side));
    if outline.is_empty() || desc.shapes.iter().any(|(_, shape)| !has_points(&shape.kind)) {
        outline.add_box(bounds, &[DMat4::IDENTITY]);
    }
    let bounds = outline.bounds;
    let (eye, slopes) = outline.eye();
    // Camera space is left-handed, with x to the right.
    let [x, y, z] = axes.map(|axis| axis.extend(0.0));
    let world_from_camera = DMat4::from_cols(x, y, z, eye.extend(1.0));
    desc.camera = CameraDesc {
        kind: CameraKind::Perspective {
            fov: FOV as f32,
            screen: ScreenDesc::default(),
            lens: LensDesc::default(),
        },
        camera_from_world: TransformDesc::fixed(world_from_camera.inverse()),
        shows: Some(slopes.map(|slope| (slope / FILLED) as f32)),
        ..CameraDesc::default()
    }
    .into();
    (axes, bounds)
}

/// Chooses the field of view of a scene's camera anew, after the size of its film has changed, if
/// the scene came without a camera and the field of view is still that of its import.
pub fn refit_camera(desc: &mut SceneDesc, resolution_before: [i32; 2]) {
    let (resolution, camera) = (desc.film.resolution, &mut desc.camera.value);
    if let (Some(shows), CameraKind::Perspective { fov, .. }) = (camera.shows, &mut camera.kind)
        && resolution != resolution_before
        && (*fov - field_of_view(shows, resolution_before)).abs() < 1e-3
    {
        *fov = field_of_view(shows, resolution);
    }
}

/// The field of view over the shorter side, in degrees, so that a frame is as wide and as high.
fn field_of_view(shows: [f32; 2], resolution: [i32; 2]) -> f32 {
    let sides = resolution.map(|side| f64::from(side.max(1)));
    let shorter = sides[0].min(sides[1]);
    let slope = |axis: usize| f64::from(shows[axis]) * shorter / sides[axis];
    (2.0 * libm::atan(slope(0).max(slope(1))).to_degrees()) as f32
}

/// Whether a shape is known by its points.
fn has_points(shape: &ShapeKind) -> bool {
    matches!(shape, ShapeKind::Triangles(_) | ShapeKind::PlyMesh { .. })
}

/// Adds the environment, whose key light is behind the viewer, above and to the left.
pub(crate) fn add_light(desc: &mut SceneDesc, [right, up, direction]: &Axes) {
    let key = (0.3 * -*direction + 0.75 * *up - 0.75 * *right).normalize();
    let image = Arc::new(environment(key.as_vec3().into()));
    let radiance = InfiniteRadiance::Image(desc.images.push(ImageDesc { name: "studio".into(), image }));
    desc.lights.push(LightKind::Infinite { radiance, illuminance: None, portal: None }.into());
}

fn diffuse(reflectance: f32) -> MaterialDesc {
    MaterialKind::Diffuse { reflectance: reflectance.into() }.into()
}

/// A disk under the mesh, lower by a little so that flat undersides do not lie in it.
pub(crate) fn add_ground(desc: &mut SceneDesc, low: DVec3, high: DVec3) {
    let (center, radius) = center_and_radius(low, high);
    let under = DVec3::new(center.x, low.y, center.z);
    let place = DMat4::from_translation(under - 1e-3 * radius * DVec3::Y);
    let z_up = DMat4::from_rotation_x(-std::f64::consts::FRAC_PI_2);
    let disk = ShapeKind::Disk {
        height: 0.0,
        radius: (GROUND_RADIUS * radius) as f32,
        inner_radius: 0.0,
        phi_max: 360.0,
    };
    let material = Some(desc.materials.push(diffuse(GROUND)));
    let world_from_object = TransformDesc::fixed(place * z_up);
    desc.shapes.push(ShapeDesc { world_from_object, material, ..ShapeDesc::from(disk) });
}

/// The environment with the key light in a direction, in the equal-area octahedral mapping.
fn environment(key: Vec3) -> Image {
    let texel = |x: u32, y: u32| {
        let center = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / RESOLUTION as f32;
        let direction = equal_area_square_to_sphere(center);
        let [inner, outer] = KEY_EDGE;
        let t = ((direction.dot(key) - outer) / (inner - outer)).clamp(0.0, 1.0);
        (direction, t * t * (3.0 - 2.0 * t))
    };
    let solid_angle = 4.0 * PI / (RESOLUTION * RESOLUTION) as f32;
    let texels = (0..RESOLUTION).flat_map(|y| (0..RESOLUTION).map(move |x| texel(x, y)));
    let irradiance: f32 = texels.map(|(direction, weight)| weight * direction.y.max(0.0) * solid_angle).sum();
    let radiance = PI * BACKGROUND * (1.0 / GROUND - 1.0) / irradiance;
    Image::from_fn(RESOLUTION, RESOLUTION, ["R", "G", "B"], |x, y| [BACKGROUND + radiance * texel(x, y).1; 3])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_lit_ground_looks_like_the_background() {
        let image = environment(Vec3::new(-0.5, 0.7, 0.5).normalize());
        let mut irradiance = 0.0;
        for (x, y) in (0..RESOLUTION).flat_map(|y| (0..RESOLUTION).map(move |x| (x, y))) {
            let [r, g, b] = image.rgb(x, y);
            assert!(r == g && g == b, "grey");
            let center = Vec2::new(x as f32 + 0.5, y as f32 + 0.5) / RESOLUTION as f32;
            irradiance += r * equal_area_square_to_sphere(center).y.max(0.0);
        }
        let ground = GROUND * irradiance * 4.0 / (RESOLUTION * RESOLUTION) as f32;
        assert!((ground - BACKGROUND).abs() < 0.002, "{ground}");
    }
}
