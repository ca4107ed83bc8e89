//! Lights and area lights.

use description::{
    AreaLightDesc, InfiniteRadiance, LightDesc, LightKind, LightType, SpectrumDesc, Stated, WrapMode,
};
use math::Vec3;

use super::Builder;
use super::reader::Reader;
use crate::pbrt::statement::{LightStatement, Statement};

impl Builder<'_> {
    pub(super) fn light(&mut self, light: LightStatement) -> Option<Stated<LightDesc>> {
        let (read, origin) = self.read(light.statement, |reader| {
            let kind = kind(reader)?;
            Some((kind, scale(reader), group(reader)))
        });
        let medium = light.medium.as_ref().and_then(|name| self.named_medium(name));
        let (kind, scale, group) = read?;
        let world_from_light = light.world_from_light;
        Some(Stated::new(LightDesc { kind, world_from_light, scale, medium, group }, origin))
    }

    /// Builds an area light; one that cannot be read is replaced by one without emission.
    pub(super) fn area_light(&mut self, statement: Statement) -> Stated<AreaLightDesc> {
        let (read, origin) = self.read(statement, area_light);
        Stated::new(read.unwrap_or(AreaLightDesc::new(0.0.into())), origin)
    }
}

/// The colour of a light: white if it is not given.
fn color(reader: &mut Reader, name: &'static str) -> SpectrumDesc {
    let color = reader.spectrum(name);
    reader.note("white", "");
    color.unwrap_or(SpectrumDesc::Illuminant(reader.color_space))
}

/// A factor of the light's brightness.
fn scale(reader: &mut Reader) -> f32 {
    let scale = reader.float("scale", 1.0);
    if scale < 0.0 {
        reader.refuse("scale", "`scale` cannot be negative");
    }
    scale
}

/// The group of lights that it belongs to.
fn group(reader: &mut Reader) -> Option<String> {
    let name = reader.string("lightgroup")?.value;
    if name.is_empty() {
        reader.refuse("lightgroup", "a group of lights has a name");
    }
    Some(name)
}

/// A power or an illuminance; the format writes -1 for none.
fn total(reader: &mut Reader, name: &'static str) -> Option<f32> {
    let total = reader.optional_float(name)?;
    if total <= 0.0 && total != -1.0 {
        reader.ignored(name, format!("`{name}` has no effect unless it is above zero"));
    }
    (total > 0.0).then_some(total)
}

/// The angles of a spot light's cone and of its soft edge, in degrees.
fn cone(reader: &mut Reader) -> [f32; 2] {
    let [angle, delta] = [reader.float("coneangle", 30.0), reader.float("conedeltaangle", 5.0)];
    if !(angle > 0.0 && angle <= 180.0) {
        reader.refuse("coneangle", "`coneangle` must be above 0 and at most 180 degrees");
    }
    if !(0.0..=180.0).contains(&delta) {
        reader.refuse("conedeltaangle", "`conedeltaangle` must lie between 0 and 180 degrees");
    }
    [angle, delta]
}

fn kind(reader: &mut Reader) -> Option<LightKind> {
    let Some(light) = LightType::named(&reader.kind.value) else {
        reader.unknown_type("light", "light", LightType::NAMES);
        return None;
    };
    Some(match light {
        LightType::Point => LightKind::Point {
            intensity: color(reader, "I"),
            power: total(reader, "power"),
            from: reader.point3("from", Vec3::ZERO),
        },
        LightType::Spot => {
            let [cone_angle, cone_delta_angle] = cone(reader);
            LightKind::Spot {
                intensity: color(reader, "I"),
                power: total(reader, "power"),
                from: reader.point3("from", Vec3::ZERO),
                to: reader.point3("to", Vec3::Z),
                cone_angle,
                cone_delta_angle,
            }
        }
        LightType::Distant => LightKind::Distant {
            radiance: color(reader, "L"),
            illuminance: total(reader, "illuminance"),
            from: reader.point3("from", Vec3::ZERO),
            to: reader.point3("to", Vec3::Z),
        },
        LightType::Goniometric => LightKind::Goniometric {
            intensity: color(reader, "I"),
            power: total(reader, "power"),
            image: reader.image("filename", None),
        },
        LightType::Projection => {
            let (power, fov) = (total(reader, "power"), reader.positive("fov", 90.0));
            let Some(image) = reader.image("filename", None) else {
                reader.missing("filename");
                return None;
            };
            LightKind::Projection { image, power, fov }
        }
        LightType::Infinite => infinite(reader),
    })
}

fn infinite(reader: &mut Reader) -> LightKind {
    let color = reader.spectrum("L");
    let illuminance = total(reader, "illuminance");
    let portal = reader.points3("portal").and_then(|corners| {
        let four = <[Vec3; 4]>::try_from(&*corners).ok();
        if four.is_none() {
            reader.refuse("portal", format!("`portal` takes four points, not {}", corners.len()));
        }
        four
    });
    let radiance = match (reader.image("filename", None), color) {
        (Some(image), color) => {
            if color.is_some() {
                reader.refuse(
                    "L",
                    "an infinite light takes its colour from `L` or from `filename`, not from both",
                );
            }
            InfiniteRadiance::Image(image)
        }
        (None, Some(color)) => InfiniteRadiance::Constant(color),
        (None, None) => InfiniteRadiance::Constant(SpectrumDesc::Illuminant(reader.color_space)),
    };
    LightKind::Infinite { radiance, illuminance, portal }
}

fn area_light(reader: &mut Reader) -> Option<AreaLightDesc> {
    if reader.kind.value != "diffuse" {
        reader.unknown_type("area-light", "area light", &["diffuse"]);
        return None;
    }
    let names = ["filename", "wrap", "filter", "columns"];
    let image = reader.uv_image(names, None, WrapMode::Clamp);
    if image.is_some() && reader.has("L") {
        reader.refuse("L", "an area light takes its colour from `L` or from `filename`, not from both");
    }
    Some(AreaLightDesc {
        radiance: color(reader, "L"),
        image,
        scale: scale(reader),
        power: total(reader, "power"),
        two_sided: reader.boolean("twosided", false),
        group: group(reader),
    })
}
