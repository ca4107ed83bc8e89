//! Cameras. A camera of the file looks along −z of its node, with y up.

use description::{CameraDesc, CameraKind, LensDesc, ScreenDesc, TransformDesc};
use math::{DMat4, DVec3};

use super::json::{Place, Result};

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

/// The size of the picture of a camera, at most.
const LARGEST: [f64; 2] = [1280.0, 720.0];

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
                if yfov >= std::f64::consts::PI {
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
            Self::Perspective { aspect, .. } => aspect.unwrap_or(LARGEST[0] / LARGEST[1]),
            Self::Orthographic { extent: [x, y] } => x / y,
        }
    }

    /// The size of its picture: its aspect ratio, as large as 1280 × 720 pixels hold.
    pub fn resolution(&self) -> [i32; 2] {
        let [width, height] = LARGEST;
        let aspect = self.aspect();
        let (width, height) = (width.min(height * aspect), height.min(width / aspect));
        [width, height].map(|side| (side.round() as i32).max(1))
    }

    /// The camera of a scene, at a node that may move.
    pub fn desc(&self, world_from_node: [DMat4; 2]) -> CameraDesc {
        let aspect = self.aspect();
        let kind = match *self {
            Self::Perspective { yfov, .. } => {
                let vertical = (yfov / 2.0).tan();
                // The field of view is that over the shorter side.
                let fov = 2.0 * (vertical * aspect.min(1.0)).atan();
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

/// From the world to the space of a camera at a node, whose scale does not matter.
fn camera_from_world(world_from_node: DMat4) -> DMat4 {
    let back = world_from_node.z_axis.truncate().normalize_or(DVec3::Z);
    let right = world_from_node.y_axis.truncate().cross(back).normalize_or(DVec3::X);
    let up = back.cross(right);
    let eye = world_from_node.w_axis.truncate();
    let columns = [right, up, -back].map(|axis| axis.extend(0.0));
    DMat4::from_cols(columns[0], columns[1], columns[2], eye.extend(1.0)).inverse()
}
