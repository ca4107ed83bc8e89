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

/// The field of view, in degrees.
const FOV: f64 = 40.0;
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

/// How something is looked at: right, up and forwards, as unit vectors.
pub(crate) type Axes = [DVec3; 3];

/// Adds camera, ground and light for shapes between two corners of a box; y is up.
pub(crate) fn furnish(desc: &mut SceneDesc, low: DVec3, high: DVec3) {
    if desc.shapes.iter().any(|(_, shape)| shape.material.is_none()) {
        let clay = desc.materials.push(diffuse(CLAY));
        for (_, shape) in desc.shapes.iter_mut() {
            shape.material.get_or_insert(clay);
        }
    }
    let axes = add_camera(desc, low, high);
    desc.film.resolution = [640, 480];
    desc.integrator = IntegratorDesc::Path(PathDesc::default()).into();
    desc.sampler.kind.set_samples_per_pixel(64);
    add_ground(desc, low, high);
    add_light(desc, &axes);
}

fn center_and_radius(low: DVec3, high: DVec3) -> (DVec3, f64) {
    ((low + high) / 2.0, ((high - low).length() / 2.0).max(1e-6))
}

/// Adds a camera that sees all of a box, from the front, a little from the side and from above.
pub(crate) fn add_camera(desc: &mut SceneDesc, low: DVec3, high: DVec3) -> Axes {
    let (center, radius) = center_and_radius(low, high);
    let direction = -DVec3::new(0.4, 0.35, 1.0).normalize();
    let right = direction.cross(DVec3::Y).normalize();
    let up = right.cross(direction);
    let eye = center - 1.1 * radius / libm::sin((FOV / 2.0).to_radians()) * direction;
    // Camera space is left-handed, with x to the right.
    let world_from_camera =
        DMat4::from_cols(right.extend(0.0), up.extend(0.0), direction.extend(0.0), eye.extend(1.0));
    desc.camera = CameraDesc {
        kind: CameraKind::Perspective {
            fov: FOV as f32,
            screen: ScreenDesc::default(),
            lens: LensDesc::default(),
        },
        camera_from_world: TransformDesc::fixed(world_from_camera.inverse()),
        ..CameraDesc::default()
    }
    .into();
    [right, up, direction]
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
