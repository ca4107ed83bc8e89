//! Cameras. They look along −z of their prim, with y up. Apertures and focal lengths are in tenths
//! of the unit of the scene.

use description::{CameraDesc, CameraKind, LensDesc, ScreenDesc, TransformDesc};
use math::DMat4;

use super::stage::Prim;
use crate::log::Result;
use crate::studio::{View, camera_from_world, resolution};

/// The view of a camera that may move.
pub(super) fn view(prim: &Prim, world_from_camera: [DMat4; 2]) -> Result<View> {
    let above_zero = |name: &str, otherwise: f64| match prim.number(name)?.unwrap_or(otherwise) {
        value if value > 0.0 => Ok(value),
        value => Err(prim.fault(name, format!("this must be above 0, not {value}"))),
    };
    let width = above_zero("horizontalAperture", 20.955)?;
    let height = above_zero("verticalAperture", 15.2908)?;
    let offsets = ["horizontalApertureOffset", "verticalApertureOffset"];
    let [x, y] = [prim.number(offsets[0])?.unwrap_or(0.0), prim.number(offsets[1])?.unwrap_or(0.0)];
    let projection = prim.word("projection")?;
    let kind = match projection.as_deref() {
        None | Some("perspective") => {
            let focal_length = above_zero("focalLength", 50.0)?;
            let shorter = width.min(height);
            let fov = 2.0 * libm::atan(shorter / (2.0 * focal_length));
            let screen = match [x, y] {
                [0.0, 0.0] => ScreenDesc::default(),
                _ => window([x, y], [width, height], shorter / 2.0),
            };
            let stop = prim.positive("fStop", 0.0)?;
            let distance = prim.positive("focusDistance", 0.0)?;
            let lens = match stop > 0.0 && distance > 0.0 {
                true => LensDesc {
                    radius: (focal_length / 10.0 / (2.0 * stop)) as f32,
                    focal_distance: distance as f32,
                },
                false => LensDesc::default(),
            };
            CameraKind::Perspective { fov: (fov.to_degrees() as f32).clamp(1e-3, 179.99), screen, lens }
        }
        Some("orthographic") => {
            let screen = window([x, y], [width, height], 10.0);
            CameraKind::Orthographic { screen, lens: LensDesc::default() }
        }
        Some(other) => return Err(prim.fault("projection", format!("`{other}` is not a projection"))),
    };
    let [start, end] = world_from_camera.map(camera_from_world);
    let camera_from_world = TransformDesc { start, end, ..TransformDesc::default() };
    let camera = CameraDesc { kind, camera_from_world, ..CameraDesc::default() };
    Ok(View { camera, resolution: resolution(width / height), world_from_camera: world_from_camera[0] })
}

/// The part of the plane of the picture that is seen, in a unit.
fn window([x, y]: [f64; 2], [width, height]: [f64; 2], unit: f64) -> ScreenDesc {
    let edges = [x - width / 2.0, x + width / 2.0, y - height / 2.0, y + height / 2.0];
    ScreenDesc { window: Some(edges.map(|v| (v / unit) as f32)), ..ScreenDesc::default() }
}
