//! Lights of the extension `KHR_lights_punctual`.
//!
//! Luminous intensities in candela and illuminances in lux become the photometric scales of the
//! scene's lights, in which 1 unit of radiance is 1 cd/m².

use description::{LightDesc, LightKind, SpectrumDesc, TransformDesc};
use math::Vec3;

use super::document::Document;
use super::json::{Place, Result};

/// A light in the space of its node, in which it shines along −z.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Light {
    pub color: [f32; 3],
    /// In candela, or in lux for a directional light.
    pub intensity: f32,
    pub kind: Kind,
    /// Whether its light ends at a distance, which is not drawn.
    pub has_range: bool,
    /// Empty for a light without a name.
    pub name: String,
    pub pointer: String,
}

/// Where a light shines.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Kind {
    Directional,
    Point,
    Spot {
        /// Angles from the axis where light begins to fall off, and where it ends.
        inner: f32,
        outer: f32,
    },
}

/// The lights of a text.
pub(super) fn places<'a>(document: &Document<'a>) -> Result<Vec<Place<'a>>> {
    match document.root().extension("KHR_lights_punctual")? {
        Some(extension) => extension.array("lights"),
        None => Ok(Vec::new()),
    }
}

impl Light {
    /// Reads a light.
    pub fn parse(place: &Place) -> Result<Self> {
        const POSITIVE: [f64; 2] = [0.0, f64::INFINITY];
        let kind = match place.string("type")? {
            Some("directional") => Kind::Directional,
            Some("point") => Kind::Point,
            Some("spot") => {
                let spot = place.object("spot")?.ok_or_else(|| place.invalid("`spot` is missing"))?;
                let half = std::f64::consts::FRAC_PI_2;
                let outer = spot.number_in("outerConeAngle", half / 2.0, [0.0, half])?;
                let inner = spot.number_in("innerConeAngle", 0.0, [0.0, half])?;
                if outer == 0.0 {
                    return Err(spot.invalid_member("outerConeAngle", "the angle of a cone is above 0"));
                }
                // Equal angles are a sharp edge.
                if inner > outer * (1.0 + 1e-6) {
                    let message = "the inner angle of a cone is at most the outer one";
                    return Err(spot.invalid_member("innerConeAngle", message));
                }
                Kind::Spot { inner: inner.min(outer), outer }
            }
            Some(kind) => {
                return Err(place.invalid_member("type", format!("`{kind}` is not a kind of light")));
            }
            None => return Err(place.invalid("`type` is missing")),
        };
        let range = place.number("range")?;
        if range.is_some_and(|range| range <= 0.0) {
            return Err(place.invalid_member("range", "a range is above 0"));
        }
        Ok(Self {
            color: place.color("color", [1.0; 3], f64::INFINITY)?,
            intensity: place.number_in("intensity", 1.0, POSITIVE)?,
            kind,
            has_range: range.is_some() && kind != Kind::Directional,
            name: place.string("name")?.unwrap_or("").to_owned(),
            pointer: place.pointer.clone(),
        })
    }

    /// The light of a scene; `None` if it is dark.
    pub fn desc(&self, world_from_light: TransformDesc) -> Option<LightDesc> {
        let most = self.color.into_iter().fold(0.0, f32::max);
        let scale = self.intensity * most;
        if scale <= 0.0 {
            return None;
        }
        let [r, g, b] = self.color.map(|v| v / most);
        let color = SpectrumDesc::rgb(r, g, b);
        let (from, to) = (Vec3::ZERO, -Vec3::Z);
        let kind = match self.kind {
            Kind::Directional => LightKind::Distant { radiance: color, illuminance: None, from, to },
            Kind::Point => LightKind::Point { intensity: color, power: None, from },
            Kind::Spot { inner, outer } => LightKind::Spot {
                intensity: color,
                power: None,
                from,
                to,
                cone_angle: outer.to_degrees(),
                cone_delta_angle: (outer - inner).to_degrees(),
            },
        };
        let group = (!self.name.is_empty()).then(|| self.name.clone());
        Some(LightDesc { world_from_light, scale, group, ..LightDesc::from(kind) })
    }
}
