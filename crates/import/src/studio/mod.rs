//! The studio of a scene, which adds to surfaces and lights: a camera, light if the file has none,
//! exposure, and an algorithm.

mod furnish;
mod outline;

use std::f64::consts::PI;

use description::{CameraDesc, InfiniteRadiance, IntegratorDesc, LightKind, PathDesc, SceneDesc};
use math::{DMat4, DVec3};

use crate::log::Log;

pub(crate) use furnish::furnish;
pub use furnish::refit_camera;

/// The radiance of a white surface in the lights of a scene that needs no other exposure.
const GOOD: [f64; 2] = [0.05, 4.0];
/// The radiance to which others are exposed.
const EXPOSED: f64 = 0.8;
/// Most scattering events of a path, without and with transparent surfaces.
const DEPTHS: [u32; 2] = [8, 16];

/// A camera at its place.
pub(crate) struct View {
    pub camera: CameraDesc,
    /// The size of its picture.
    pub resolution: [i32; 2],
    /// From a space in which it looks along −z, with y up.
    pub world_from_camera: DMat4,
}

/// A light with a surface, which is among the shapes of a scene.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Lamp {
    pub place: DVec3,
    /// About how bright it is from afar, in candela.
    pub intensity: f64,
}

/// The size of a picture of an aspect ratio: as large as 1280 × 720 pixels hold.
pub(crate) fn resolution(aspect: f64) -> [i32; 2] {
    const LARGEST: [f64; 2] = [1280.0, 720.0];
    let [width, height] = LARGEST;
    let (width, height) = (width.min(height * aspect), height.min(width / aspect));
    [width, height].map(|side| (side.round() as i32).max(1))
}

/// From the world to the space of a camera that looks along −z of a node, whose scale does not
/// matter.
pub(crate) fn camera_from_world(world_from_node: DMat4) -> DMat4 {
    let back = world_from_node.z_axis.truncate().normalize_or(DVec3::Z);
    let right = world_from_node.y_axis.truncate().cross(back).normalize_or(DVec3::X);
    let up = back.cross(right);
    let eye = world_from_node.w_axis.truncate();
    let columns = [right, up, -back].map(|axis| axis.extend(0.0));
    DMat4::from_cols(columns[0], columns[1], columns[2], eye.extend(1.0)).inverse()
}

/// Completes a scene whose surfaces are in a box.
pub(crate) fn complete(
    desc: &mut SceneDesc,
    view: Option<View>,
    [low, high]: [DVec3; 2],
    lamps: &[Lamp],
    log: &mut Log,
) {
    let (low, high) = if low.cmple(high).all() && (low + high).is_finite() {
        (low, high)
    } else {
        (-DVec3::ONE, DVec3::ONE)
    };
    if desc.shapes.is_empty() && desc.instances.is_empty() {
        log.warn("empty-scene", "", "the scene has no surfaces");
    }
    // Emission of an object alone is more often that of its lamps than the light of a scene.
    let is_lit = !(desc.lights.is_empty() && lamps.is_empty())
        || (view.is_some() && !desc.area_lights.is_empty())
        || desc.area_lights.iter().any(|(_, light)| light.scale > 1.0);
    let has_camera = view.is_some();
    let axes = match view {
        Some(View { camera, resolution, world_from_camera: node }) => {
            desc.camera = camera.into();
            desc.film.resolution = resolution;
            let axis = |v: math::DVec3| v.normalize_or(DVec3::Y);
            [axis(node.x_axis.truncate()), axis(node.y_axis.truncate()), -axis(node.z_axis.truncate())]
        }
        None => furnish::add_camera(desc, [low, high]).0,
    };
    if is_lit {
        expose(desc, (low + high) / 2.0, (high - low).length() / 2.0, lamps, log);
    } else {
        furnish::add_light(desc, &axes);
        if !has_camera {
            furnish::add_ground(desc, low, high);
        }
        log.warn("no-light", "", "the file has no light; drawn in the light of a studio");
    }
    let is_transparent = desc.materials.iter().any(|(_, material)| match &material.kind {
        description::MaterialKind::OpenPbr(surface) => {
            let weight = description::OpenPbrDesc::number("transmission_weight");
            weight.is_some_and(|index| surface.numbers[index].value() != Some(&0.0))
        }
        _ => false,
    });
    let path = PathDesc { max_depth: DEPTHS[usize::from(is_transparent)], ..PathDesc::default() };
    desc.integrator = match desc.media.is_empty() {
        true => IntegratorDesc::Path(path),
        false => IntegratorDesc::VolPath(path),
    }
    .into();
    desc.sampler.kind.set_samples_per_pixel(64);
}

/// Chooses a sensitivity where lights are so bright or so dark that nothing could be seen.
fn expose(desc: &mut SceneDesc, center: DVec3, radius: f64, lamps: &[Lamp], log: &mut Log) {
    let received = |lamp: Lamp| {
        let distance = (lamp.place - center).length().max(radius / 4.0).max(1e-6);
        lamp.intensity / (distance * distance)
    };
    let mut illuminance: f64 = lamps.iter().copied().map(received).sum();
    for (_, light) in desc.lights.iter() {
        let scale = f64::from(light.scale);
        illuminance += match &light.kind {
            LightKind::Distant { .. } => scale,
            LightKind::Infinite { radiance: InfiniteRadiance::Constant(_), .. } => PI * scale,
            LightKind::Infinite { radiance: InfiniteRadiance::Image(image), .. } => {
                let image = &desc.images[*image].image;
                let count = f64::from(image.width()) * f64::from(image.height());
                let sum: f64 = image.values().map(f64::from).sum();
                PI * scale * sum / (count * image.channel_count() as f64)
            }
            _ => received(Lamp { place: light.world_from_light.start.w_axis.truncate(), intensity: scale }),
        };
    }
    let radiance = illuminance / PI;
    if radiance > 0.0 && radiance.is_finite() && !(GOOD[0]..=GOOD[1]).contains(&radiance) {
        let iso = (100.0 * EXPOSED / radiance).clamp(1e-6, 1e9) as f32;
        desc.film.sensor.iso = iso;
        let message =
            format!("lights give about {illuminance:.3} lx; exposed by a sensitivity of ISO {iso:.3}");
        log.warn("exposure", "", message);
    }
}
