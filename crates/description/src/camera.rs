//! Cameras. A camera looks along +z of its own space, with +y up and +x to the right.

use std::sync::Arc;

use crate::{Handle, ImageDesc, MediumDesc, TransformDesc};

/// A camera.
#[derive(Clone, Debug)]
pub struct CameraDesc {
    /// Which one.
    pub kind: CameraKind,
    /// From world to camera space.
    pub camera_from_world: TransformDesc,
    /// Time at which the shutter opens.
    pub shutter_open: f32,
    /// Time at which it closes.
    pub shutter_close: f32,
    /// The medium around the camera.
    pub medium: Option<Handle<MediumDesc>>,
}

/// The cameras of the format.
#[derive(Clone, Debug)]
pub enum CameraKind {
    /// All rays through one point.
    Perspective {
        /// Angle in degrees over the shorter side of the image (over `[−1, 1]` of the screen).
        fov: f32,
        /// The screen.
        screen: ScreenDesc,
        /// A thin lens.
        lens: LensDesc,
    },
    /// Parallel rays.
    Orthographic {
        /// The screen, in camera-space units.
        screen: ScreenDesc,
        /// A thin lens.
        lens: LensDesc,
    },
    /// All directions at once.
    Spherical {
        /// How directions fill the image.
        mapping: SphericalMapping,
    },
    /// Rays refracted through lens elements.
    Realistic(RealisticCameraDesc),
}

/// The part of the screen that the image shows.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ScreenDesc {
    /// Width over height; that of the film if absent.
    pub frame_aspect_ratio: Option<f32>,
    /// `[x0, x1, y0, y1]`; if absent, `[−1, 1]` over the shorter side and more over the other.
    pub window: Option<[f32; 4]>,
}

/// A thin lens.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensDesc {
    /// Radius; 0 is a pinhole.
    pub radius: f32,
    /// Distance to what is sharp.
    pub focal_distance: f32,
}

impl Default for LensDesc {
    fn default() -> Self {
        Self { radius: 0.0, focal_distance: 1e6 }
    }
}

/// How a spherical camera's directions fill its image.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum SphericalMapping {
    /// The equal-area octahedral mapping.
    #[default]
    EqualArea,
    /// Latitude and longitude.
    EquiRectangular,
}

/// A camera with a lens system.
#[derive(Clone, Debug)]
pub struct RealisticCameraDesc {
    /// The elements, from the scene to the film.
    pub lenses: Arc<[LensElement]>,
    /// Diameter of the aperture stop in millimetres.
    pub aperture_diameter: f32,
    /// Distance in metres to what is sharp.
    pub focus_distance: f32,
    /// Shape of the aperture stop.
    pub aperture: ApertureDesc,
}

/// One interface of a lens system; lengths in millimetres.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LensElement {
    /// Radius of curvature; 0 for the aperture stop.
    pub curvature_radius: f32,
    /// Distance to the next interface.
    pub thickness: f32,
    /// Index of refraction behind it; 0 or 1 for air.
    pub eta: f32,
    /// Diameter.
    pub aperture_diameter: f32,
}

/// Shape of an aperture stop.
#[derive(Clone, Debug, Default)]
pub enum ApertureDesc {
    /// A disk.
    #[default]
    Circular,
    /// A disk that darkens outwards.
    Gaussian,
    /// A square.
    Square,
    /// A pentagon.
    Pentagon,
    /// A star.
    Star,
    /// What an image shows.
    Image(Handle<ImageDesc>),
}

impl Default for CameraDesc {
    fn default() -> Self {
        Self {
            kind: CameraKind::Perspective {
                fov: 90.0,
                screen: ScreenDesc::default(),
                lens: LensDesc::default(),
            },
            camera_from_world: TransformDesc::default(),
            shutter_open: 0.0,
            shutter_close: 1.0,
            medium: None,
        }
    }
}
