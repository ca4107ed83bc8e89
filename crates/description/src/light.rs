//! Lights. A light whose colour the author left out shines with its colour space's white.

use math::Point3;

use crate::names::names;
use crate::{Handle, ImageDesc, MediumDesc, SpectrumDesc, TransformDesc};

/// A light that is not a surface.
#[derive(Clone, Debug)]
pub struct LightDesc {
    /// Which one.
    pub kind: LightKind,
    /// From the light's space to the world.
    pub world_from_light: TransformDesc,
    /// Factor on what it emits.
    pub scale: f32,
    /// The medium it stands in.
    pub medium: Option<Handle<MediumDesc>>,
}

impl From<LightKind> for LightDesc {
    fn from(kind: LightKind) -> Self {
        Self { kind, world_from_light: TransformDesc::default(), scale: 1.0, medium: None }
    }
}

/// The lights of the format. `power` (in watts) replaces the brightness that the colour would give.
#[derive(Clone, Debug)]
pub enum LightKind {
    /// From a point to all sides.
    Point {
        /// Radiant intensity.
        intensity: SpectrumDesc,
        /// Total power.
        power: Option<f32>,
        /// Its place in light space.
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
        /// Illuminance in lux on a surface that faces it; replaces the brightness of `radiance`.
        illuminance: Option<f32>,
        /// Light travels from here …
        from: Point3,
        /// … towards here.
        to: Point3,
    },
    /// From a point, as an image in equal-area octahedral form says.
    Goniometric {
        /// Radiant intensity that the image scales.
        intensity: SpectrumDesc,
        /// Total power.
        power: Option<f32>,
        /// The image; a constant 1 if absent.
        image: Option<Handle<ImageDesc>>,
    },
    /// From a point, an image thrown along +z.
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
        /// What shines.
        radiance: InfiniteRadiance,
        /// Illuminance in lux on an upward surface; replaces the brightness.
        illuminance: Option<f32>,
        /// The corners of a rectangle in world space through which alone it shines.
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
    /// Whether its light comes from infinitely far away.
    pub fn is_distant(&self) -> bool {
        match self {
            Self::Distant { .. } | Self::Infinite { .. } => true,
            Self::Point { .. } | Self::Spot { .. } | Self::Goniometric { .. } | Self::Projection { .. } => {
                false
            }
        }
    }
}

/// What an infinite light shines with.
#[derive(Clone, Debug, PartialEq)]
pub enum InfiniteRadiance {
    /// The same from everywhere.
    Constant(SpectrumDesc),
    /// An image in equal-area octahedral form.
    Image(Handle<ImageDesc>),
}

/// A surface that shines; the shapes it is on refer to it.
#[derive(Clone, Debug)]
pub struct AreaLightDesc {
    /// Radiance.
    pub radiance: SpectrumDesc,
    /// An image over (u, v) instead of one colour.
    pub image: Option<Handle<ImageDesc>>,
    /// Factor on what it emits.
    pub scale: f32,
    /// Total power in watts; replaces the brightness of `radiance`.
    pub power: Option<f32>,
    /// Shine to both sides.
    pub two_sided: bool,
}

impl AreaLightDesc {
    /// One colour, one side.
    pub fn new(radiance: SpectrumDesc) -> Self {
        Self { radiance, image: None, scale: 1.0, power: None, two_sided: false }
    }
}
