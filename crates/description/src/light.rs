//! Lights. The default colour of a light is the white of its colour space.

use math::{Point3, Vec3};

use crate::schema::{Domain, Field, Settings, Visitor, above, at_least, from as from_to, members, settings};
use crate::{ColorSpaceDesc, Handle, ImageDesc, MediumDesc, SpectrumDesc, TransformDesc, UvImageDesc};

settings! {
    /// A light that is not a surface.
    #[derive(Clone, Debug)]
    pub struct LightDesc {
        /// The member of the set.
        kind: LightKind = LightKind::default() => ..;
        /// From the light's space to the world.
        world_from_light: TransformDesc = TransformDesc::default();
        /// Factor on the brightness.
        scale: f32 = 1.0 => ["scale": at_least(0.0)];
        /// The medium around it.
        medium: Option<Handle<MediumDesc>> = None;
        /// Its group, whose light may have a layer of its own in the picture.
        group: Option<String> = None => ["lightgroup"];
    }
}

impl From<LightKind> for LightDesc {
    fn from(kind: LightKind) -> Self {
        Self { kind, ..Self::default() }
    }
}

members! {
    /// The lights of the format. `power` (in watts) replaces the brightness that the colour would
    /// give.
    #[derive(Clone, Debug)]
    pub enum LightKind: LightType = Point {
        /// From a point in all directions.
        Point = "point" {
            /// Radiant intensity.
            intensity: SpectrumDesc = WHITE => ["I"];
            /// Total power for white or a spectrum. −1 is none.
            power: Option<f32> = None => ["power": POWER];
            /// Its position in light space.
            from: Point3 = Vec3::ZERO => ["from"];
        },
        /// From a point into a cone.
        Spot = "spot" {
            /// Radiant intensity on the axis.
            intensity: SpectrumDesc = WHITE => ["I"];
            /// Total power for white or a spectrum. −1 is none.
            power: Option<f32> = None => ["power": POWER];
            /// The tip of the cone in light space.
            from: Point3 = Vec3::ZERO => ["from"];
            /// A point on its axis.
            to: Point3 = Vec3::Z => ["to"];
            /// Angle between axis and edge.
            cone_angle: f32 = 30.0 => ["coneangle": above(0.0).at_most(180.0).unit("degrees")];
            /// Angle from the edge inwards over which the light falls off.
            cone_delta_angle: f32 = 5.0 => ["conedeltaangle": from_to(0.0, 180.0).unit("degrees")];
        },
        /// From infinitely far away in one direction.
        Distant = "distant" {
            /// Radiance.
            radiance: SpectrumDesc = WHITE => ["L"];
            /// Illuminance of a surface that faces the light, for white or a spectrum; replaces the
            /// brightness of `L`. −1 is none.
            illuminance: Option<f32> = None => ["illuminance": ILLUMINANCE];
            /// Light travels from here …
            from: Point3 = Vec3::ZERO => ["from"];
            /// … towards here.
            to: Point3 = Vec3::Z => ["to"];
        },
        /// From a point, with a distribution given by an image in the equal-area octahedral
        /// projection.
        Goniometric = "goniometric" {
            /// Radiant intensity, multiplied by the image.
            intensity: SpectrumDesc = WHITE => ["I"];
            /// Total power for white or a spectrum. −1 is none.
            power: Option<f32> = None => ["power": POWER];
            /// The image; a constant 1 if absent.
            image: Option<Handle<ImageDesc>> = None;
        },
        /// From a point, projecting an image along +z.
        Projection = "projection" {
            /// Total power. −1 is none.
            power: Option<f32> = None => ["power": POWER];
            /// Angle over the shorter side of the image.
            fov: f32 = 90.0 => ["fov": above(0.0).unit("degrees")];
            /// The image, without which it is dark.
            image: Option<Handle<ImageDesc>> = None;
        },
        /// From infinity in all directions.
        Infinite = "infinite" {
            /// The radiance.
            radiance: InfiniteRadiance = InfiniteRadiance::default() => ..;
            /// Illuminance of a surface that faces +z, for white or a spectrum; replaces the
            /// brightness. −1 is none.
            illuminance: Option<f32> = None => ["illuminance": ILLUMINANCE];
            /// The corners of a rectangle in world space (portal) through which all light passes.
            portal: Option<[Point3; 4]> = None => ["portal"];
        },
    }
}

/// The default colour.
const WHITE: SpectrumDesc = SpectrumDesc::Illuminant(ColorSpaceDesc::Srgb);
const POWER: Domain = Domain::ANY.unit("W");
const ILLUMINANCE: Domain = Domain::ANY.unit("lux");

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

impl Default for InfiniteRadiance {
    fn default() -> Self {
        Self::Constant(WHITE)
    }
}

impl Settings for InfiniteRadiance {
    fn visit(&mut self, visitor: Visitor) {
        const RADIANCE: &Field = &Field::new("L", "Radiance, unless an image gives it.");
        let mut radiance = match self {
            Self::Constant(radiance) => Some(radiance.clone()),
            Self::Image(_) => None,
        };
        visitor(RADIANCE, &mut radiance);
        if let Some(radiance) = radiance {
            *self = Self::Constant(radiance);
        }
    }
}

settings! {
    /// The emission of surfaces; shapes refer to it.
    #[derive(Clone, Debug)]
    pub struct AreaLightDesc {
        /// Radiance.
        radiance: SpectrumDesc = WHITE => ["L"];
        /// An image over (u, v) instead of one colour.
        image: Option<UvImageDesc> = None;
        /// Factor on the brightness.
        scale: f32 = 1.0 => ["scale": at_least(0.0)];
        /// Power of each shape for white or a spectrum; replaces the brightness of `L`. −1 is none.
        power: Option<f32> = None => ["power": POWER];
        /// Whether both sides emit.
        two_sided: bool = false => ["twosided"];
        /// Its group, whose light may have a layer of its own in the picture.
        group: Option<String> = None => ["lightgroup"];
    }
}

impl AreaLightDesc {
    /// Constant radiance on one side.
    pub fn new(radiance: SpectrumDesc) -> Self {
        Self { radiance, ..Self::default() }
    }
}
