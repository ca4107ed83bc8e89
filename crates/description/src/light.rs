//! Lights. The default colour of a light is the white of its colour space.

use math::Point3;

use crate::names::names;
use crate::{Handle, ImageDesc, MediumDesc, SpectrumDesc, TransformDesc, UvImageDesc};

/// A light that is not a surface.
#[derive(Clone, Debug)]
pub struct LightDesc {
    /// Which one.
    pub kind: LightKind,
    /// From the light's space to the world.
    pub world_from_light: TransformDesc,
    /// Factor on its emission.
    pub scale: f32,
    /// The medium around it.
    pub medium: Option<Handle<MediumDesc>>,
    /// Its group, whose light may have a layer of its own in the picture.
    pub group: Option<String>,
}

impl From<LightKind> for LightDesc {
    fn from(kind: LightKind) -> Self {
        Self { kind, world_from_light: TransformDesc::default(), scale: 1.0, medium: None, group: None }
    }
}

/// The lights of the format. `power` (in watts) replaces the brightness that the colour would give.
#[derive(Clone, Debug)]
pub enum LightKind {
    /// From a point in all directions.
    Point {
        /// Radiant intensity.
        intensity: SpectrumDesc,
        /// Total power.
        power: Option<f32>,
        /// Its position in light space.
        from: Point3,
    },
    /// From a point into a cone.
    Spot {
        /// Radiant intensity on the axis.
        intensity: SpectrumDesc,
        /// Total power.
        power: Option<f32>,
        /// The tip of the cone in light space.
        from: Point3,
        /// A point on its axis.
        to: Point3,
        /// Angle in degrees between axis and edge.
        cone_angle: f32,
        /// Angle in degrees, from the edge inwards, over which the light falls off.
        cone_delta_angle: f32,
    },
    /// From infinitely far away in one direction.
    Distant {
        /// Radiance.
        radiance: SpectrumDesc,
        /// Illuminance in lux on a perpendicular surface; replaces the brightness of `radiance`.
        illuminance: Option<f32>,
        /// Light travels from here …
        from: Point3,
        /// … towards here.
        to: Point3,
    },
    /// From a point, with a distribution given by an image in the equal-area octahedral projection.
    Goniometric {
        /// Radiant intensity, multiplied by the image.
        intensity: SpectrumDesc,
        /// Total power.
        power: Option<f32>,
        /// The image; a constant 1 if absent.
        image: Option<Handle<ImageDesc>>,
    },
    /// From a point, projecting an image along +z.
    Projection {
        /// The image.
        image: Handle<ImageDesc>,
        /// Total power.
        power: Option<f32>,
        /// Angle in degrees over the shorter side.
        fov: f32,
    },
    /// From all directions.
    Infinite {
        /// The radiance.
        radiance: InfiniteRadiance,
        /// Illuminance in lux on an upward surface; replaces the brightness.
        illuminance: Option<f32>,
        /// The corners of a rectangle in world space (portal) through which all light passes.
        portal: Option<[Point3; 4]>,
    },
}

names! {
    /// The names of lights.
    LightType of LightKind {
        Point = "point",
        Spot = "spot",
        Distant = "distant",
        Goniometric = "goniometric",
        Projection = "projection",
        Infinite = "infinite",
    }
}

impl LightKind {
    /// Whether it is infinitely far away.
    pub fn is_distant(&self) -> bool {
        match self {
            Self::Distant { .. } | Self::Infinite { .. } => true,
            Self::Point { .. } | Self::Spot { .. } | Self::Goniometric { .. } | Self::Projection { .. } => {
                false
            }
        }
    }
}

/// The radiance of an infinite light.
#[derive(Clone, Debug, PartialEq)]
pub enum InfiniteRadiance {
    /// The same in all directions.
    Constant(SpectrumDesc),
    /// An image in the equal-area octahedral projection.
    Image(Handle<ImageDesc>),
}

/// The emission of surfaces; shapes refer to it.
#[derive(Clone, Debug)]
pub struct AreaLightDesc {
    /// Radiance.
    pub radiance: SpectrumDesc,
    /// An image instead of one colour.
    pub image: Option<UvImageDesc>,
    /// Factor on its emission.
    pub scale: f32,
    /// Total power in watts; replaces the brightness of `radiance`.
    pub power: Option<f32>,
    /// Whether both sides emit.
    pub two_sided: bool,
    /// Its group, whose light may have a layer of its own in the picture.
    pub group: Option<String>,
}

impl AreaLightDesc {
    /// Constant radiance on one side.
    pub fn new(radiance: SpectrumDesc) -> Self {
        Self { radiance, image: None, scale: 1.0, power: None, two_sided: false, group: None }
    }
}
