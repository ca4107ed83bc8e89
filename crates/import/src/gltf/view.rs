//! What a scene needs besides surfaces and lights: a camera, light if the file has none, exposure,
//! and an algorithm.

use std::f64::consts::PI;

use description::{IntegratorDesc, LightKind, PathDesc, SceneDesc};
use math::DVec3;

use super::camera::Camera;
use super::json::{Fault, Result};
use super::log::Log;
use super::scene::Drawn;
use super::selection::Selection;
use crate::mesh::studio;

/// The radiance of a white surface in the lights of a scene that needs no other exposure.
const GOOD: [f64; 2] = [0.05, 4.0];
/// The radiance to which others are exposed.
const EXPOSED: f64 = 0.8;
/// Most scattering events of a path, without and with transparent surfaces.
const DEPTHS: [u32; 2] = [8, 16];

/// The camera that is looked through, and its place: the chosen one, else the first of the scene.
pub(super) fn camera<'c>(
    drawn: &Drawn,
    cameras: &'c [Option<Camera>],
    selection: &Selection,
) -> Result<Option<(&'c Camera, description::TransformDesc)>> {
    let nodes = &drawn.poses[0].nodes.nodes;
    let mut placed = drawn.nodes.iter().filter_map(|&node| Some((nodes[node].camera?, node)));
    let first = match &selection.camera {
        Some(choice) => {
            let name = |index| drawn.document.item("cameras", index)?.string("name").ok().flatten();
            let names: Vec<_> = (0..cameras.len()).map(|index| name(index).unwrap_or_default()).collect();
            let chosen = choice.index("camera", &names)?;
            let found = placed.find(|&(camera, _)| camera == chosen);
            let message = || format!("the camera `{}` is at no node of the scene", choice.0);
            Some(found.ok_or_else(|| Fault::new("unknown-choice", format!("/cameras/{chosen}"), message()))?)
        }
        None => placed.next(),
    };
    Ok(first.and_then(|(camera, node)| Some((cameras[camera].as_ref()?, drawn.motion(node)))))
}

/// Completes a scene whose surfaces are in a box.
pub(super) fn complete(
    desc: &mut SceneDesc,
    camera: Option<(&Camera, description::TransformDesc)>,
    [low, high]: [DVec3; 2],
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
    let is_lit = !desc.lights.is_empty()
        || (camera.is_some() && !desc.area_lights.is_empty())
        || desc.area_lights.iter().any(|(_, light)| light.scale > 1.0);
    let axes = match camera {
        Some((camera, motion)) => {
            desc.camera = camera.desc([motion.start, motion.end]).into();
            desc.film.resolution = camera.resolution();
            let node = motion.start;
            let axis = |v: math::DVec3| v.normalize_or(DVec3::Y);
            [axis(node.x_axis.truncate()), axis(node.y_axis.truncate()), -axis(node.z_axis.truncate())]
        }
        None => studio::add_camera(desc, low, high),
    };
    if is_lit {
        expose(desc, (low + high) / 2.0, (high - low).length() / 2.0, log);
    } else {
        studio::add_light(desc, &axes);
        if camera.is_none() {
            studio::add_ground(desc, low, high);
        }
        log.warn("no-light", "", "the file has no light; drawn in the light of a studio");
    }
    let is_transparent = desc.materials.iter().any(|(_, material)| match &material.kind {
        description::MaterialKind::OpenPbr(surface) => {
            let weight = description::OpenPbrDesc::NUMBERS
                .iter()
                .position(|number| number.name == "transmission_weight");
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
fn expose(desc: &mut SceneDesc, center: DVec3, radius: f64, log: &mut Log) {
    let mut illuminance = 0.0;
    for (_, light) in desc.lights.iter() {
        let distance = (light.world_from_light.start.w_axis.truncate() - center).length();
        let distance = distance.max(radius / 4.0).max(1e-6);
        illuminance += match light.kind {
            LightKind::Distant { .. } => f64::from(light.scale),
            _ => f64::from(light.scale) / (distance * distance),
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
