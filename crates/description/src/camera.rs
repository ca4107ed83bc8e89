//! Cameras. A camera looks along +z of its own space, with +y up and +x to the right.

use std::sync::Arc;

use crate::schema::{above, at_least, between, choices, settings};
use crate::{Handle, ImageDesc, MediumDesc, TransformDesc};

settings! {
    /// A camera.
    #[derive(Clone, Debug)]
    pub struct CameraDesc {
        /// Which one.
        kind: CameraKind = CameraKind::default() => ..;
        /// From world to camera space.
        camera_from_world: TransformDesc = TransformDesc::default();
        /// Time at which the shutter opens.
        shutter_open: f32 = 0.0 => ["shutteropen"];
        /// Time at which the shutter closes.
        shutter_close: f32 = 1.0 => ["shutterclose"];
        /// The medium around the camera.
        medium: Option<Handle<MediumDesc>> = None;
        /// Half of the width and height, at distance 1, that the image has at least. A camera that
        /// an importer placed has them, so that its field of view can follow the size of the film.
        shows: Option<[f32; 2]> = None;
    }
}

settings! {
    /// The cameras of the format.
    #[derive(Clone, Debug)]
    pub enum CameraKind = Perspective {
        /// All rays through one point.
        Perspective = "perspective" {
            /// The screen.
            screen: ScreenDesc = ScreenDesc::default() => ..;
            /// A thin lens.
            lens: LensDesc = LensDesc::default() => ..;
            /// Field of view over the shorter side of the image (over [−1, 1] of the screen).
            fov: f32 = 90.0 => ["fov": between(0.0, 180.0).unit("degrees")];
        },
        /// Parallel rays.
        Orthographic = "orthographic" {
            /// The screen, in camera-space units.
            screen: ScreenDesc = ScreenDesc::default() => ..;
            /// A thin lens.
            lens: LensDesc = LensDesc::default() => ..;
        },
        /// All directions at once.
        Spherical = "spherical" {
            /// The mapping from the image to directions.
            mapping: SphericalMapping = SphericalMapping::EqualArea => ["mapping"];
        },
        /// Rays refracted through lens elements.
        Realistic(RealisticCameraDesc) = "realistic",
    }
}

settings! {
    /// The part of the screen that the image shows.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct ScreenDesc {
        /// Width of the image over its height. If absent, that of the film.
        frame_aspect_ratio: Option<f32> = None => ["frameaspectratio": above(0.0)];
        /// The part of the screen, x0, x1, y0, y1. If absent, [−1, 1] over the shorter side and
        /// more over the other.
        window: Option<[f32; 4]> = None => ["screenwindow"];
    }
}

settings! {
    /// A thin lens.
    #[derive(Clone, Copy, Debug, PartialEq)]
    pub struct LensDesc {
        /// Radius of the lens. 0 is a pinhole.
        radius: f32 = 0.0 => ["lensradius": at_least(0.0).unit("scene units")];
        /// Distance to the plane of focus.
        focal_distance: f32 = 1e6 => ["focaldistance": above(0.0).unit("scene units")];
    }
}

choices! {
    /// The mapping from the image of a spherical camera to directions.
    pub enum SphericalMapping {
        /// The equal-area octahedral mapping.
        #[default]
        EqualArea = "equalarea",
        /// Latitude and longitude.
        EquiRectangular = "equirectangular",
    }
}

settings! {
    /// A camera with a lens system.
    #[derive(Clone, Debug)]
    pub struct RealisticCameraDesc {
        /// The elements, from the scene to the film.
        lenses: Arc<[LensElement]> = Arc::from([]);
        /// Diameter of the aperture stop.
        aperture_diameter: f32 = 1.0 => ["aperturediameter": above(0.0).unit("mm")];
        /// Distance to the plane of focus.
        focus_distance: f32 = 10.0 => ["focusdistance": above(0.0).unit("m")];
        /// Shape of the aperture stop.
        aperture: ApertureDesc = ApertureDesc::Circular;
    }
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
