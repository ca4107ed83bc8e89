//! Cameras. A camera of the file looks along −z of its node, with y up.

use description::{CameraDesc, CameraKind, LensDesc, ScreenDesc, TransformDesc};
use math::DMat4;

use super::json::{Fault, Place, Result};
use super::scene::Drawn;
use crate::selection::Selection;
use crate::studio::{View, camera_from_world, resolution};

/// What a camera sees.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Camera {
    Perspective {
        /// Vertical field of view in radians.
        yfov: f64,
        /// Width over height; that of the picture if absent.
        aspect: Option<f64>,
    },
    Orthographic {
        /// Half of the width and of the height.
        extent: [f64; 2],
    },
}

impl Camera {
    /// Reads a camera.
    pub fn parse(place: &Place) -> Result<Self> {
        let number = |place: &Place, key: &str| {
            let number = place.number(key)?.ok_or_else(|| place.invalid(format!("`{key}` is missing")))?;
            match number > 0.0 {
                true => Ok(number),
                false => Err(place.invalid_member(key, format!("this must be above 0, not {number}"))),
            }
        };
        match place.string("type")? {
            Some("perspective") => {
                let lens = place.required("perspective")?;
                let (yfov, aspect) = (number(&lens, "yfov")?, lens.get("aspectRatio"));
                // π itself may be rounded up, and is drawn as the widest view there is.
                if yfov > std::f64::consts::PI + 1e-6 {
                    return Err(lens.invalid_member("yfov", "a field of view is below π"));
                }
                let aspect = aspect.map(|_| number(&lens, "aspectRatio")).transpose()?;
                Ok(Self::Perspective { yfov, aspect })
            }
            Some("orthographic") => {
                let lens = place.required("orthographic")?;
                Ok(Self::Orthographic { extent: [number(&lens, "xmag")?, number(&lens, "ymag")?] })
            }
            _ => Err(place.invalid_member("type", "this must be `perspective` or `orthographic`")),
        }
    }

    /// Width over height of its picture.
    fn aspect(&self) -> f64 {
        match *self {
            Self::Perspective { aspect, .. } => aspect.unwrap_or(16.0 / 9.0),
            Self::Orthographic { extent: [x, y] } => x / y,
        }
    }

    /// The camera at a node that may move.
    fn view(&self, motion: &TransformDesc) -> View {
        let camera = self.desc([motion.start, motion.end]);
        View { camera, resolution: resolution(self.aspect()), world_from_camera: motion.start }
    }

    /// The camera of a scene, at a node that may move.
    fn desc(&self, world_from_node: [DMat4; 2]) -> CameraDesc {
        let aspect = self.aspect();
        let kind = match *self {
            Self::Perspective { yfov, .. } => {
                let vertical = libm::tan(yfov.min(std::f64::consts::PI - 1e-3) / 2.0);
                // The field of view is that over the shorter side.
                let fov = 2.0 * libm::atan(vertical * aspect.min(1.0));
                CameraKind::Perspective {
                    fov: (fov.to_degrees() as f32).clamp(1e-3, 179.99),
                    screen: ScreenDesc::default(),
                    lens: LensDesc::default(),
                }
            }
            Self::Orthographic { extent: [x, y] } => {
                let [x, y] = [x as f32, y as f32];
                let screen = ScreenDesc { window: Some([-x, x, -y, y]), ..ScreenDesc::default() };
                CameraKind::Orthographic { screen, lens: LensDesc::default() }
            }
        };
        let [start, end] = world_from_node.map(camera_from_world);
        let camera_from_world = TransformDesc { start, end, ..TransformDesc::default() };
        CameraDesc { kind, camera_from_world, ..CameraDesc::default() }
    }
}

/// The camera that is looked through, and its place: the chosen one, else the first of the scene.
pub(super) fn chosen(
    drawn: &Drawn,
    cameras: &[Option<Camera>],
    selection: &Selection,
) -> Result<Option<View>> {
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
    Ok(first.and_then(|(camera, node)| Some(cameras[camera].as_ref()?.view(&drawn.motion(node)))))
}
