//! Lights and area lights.

use description::schema::{Settings, Value};
use description::{
    AreaLightDesc, InfiniteRadiance, LightDesc, LightKind, LightType, Stated, UvImageDesc, WrapMode,
};

use super::Builder;
use super::reader::Reader;
use crate::read::statement::{LightStatement, Statement};

impl Builder<'_> {
    pub(super) fn light(&mut self, light: LightStatement) -> Option<Stated<LightDesc>> {
        let (read, origin) = self.read(light.statement, read_light);
        let medium = light.medium.as_ref().and_then(|name| self.named_medium(name));
        let desc = LightDesc { world_from_light: light.world_from_light, medium, ..read? };
        Some(Stated::new(desc, origin))
    }

    /// Builds an area light; one that cannot be read is replaced by one without emission.
    pub(super) fn area_light(&mut self, statement: Statement) -> Stated<AreaLightDesc> {
        let (read, origin) = self.read(statement, area_light);
        Stated::new(read.unwrap_or(AreaLightDesc::new(0.0.into())), origin)
    }
}

/// Checks that a group of lights has a name.
fn check_group(reader: &mut Reader, group: Option<&str>) {
    if group == Some("") {
        reader.refuse("lightgroup", "a group of lights has a name");
    }
}

/// Takes back a power or an illuminance that is none: the format writes -1 for it.
fn without_none(reader: &mut Reader, lights: &mut impl Settings) {
    lights.visit(&mut |field, slot| {
        if let ("power" | "illuminance", Value::Number(total)) = (field.name, slot.get())
            && total <= 0.0
        {
            if total != -1.0 {
                reader.ignored(field.name, format!("`{}` has no effect unless it is above zero", field.name));
            }
            slot.set(&Value::Automatic);
        }
    });
}

fn read_light(reader: &mut Reader) -> Option<LightDesc> {
    let Some(kind) = LightType::named(&reader.kind.value).and_then(LightKind::new) else {
        reader.unknown_type("light", "light", LightType::NAMES);
        return None;
    };
    let mut light = LightDesc::from(kind);
    reader.settings(&mut light);
    without_none(reader, &mut light);
    check_group(reader, light.group.as_deref());
    match &mut light.kind {
        LightKind::Goniometric { image, .. } => *image = reader.image("filename", None),
        LightKind::Projection { image, .. } => {
            *image = Some(reader.needed("filename", |reader, name| reader.image(name, None))?);
        }
        LightKind::Infinite { radiance, .. } => {
            if let Some(image) = reader.image("filename", None) {
                if reader.has("L") {
                    reader.refuse(
                        "L",
                        "an infinite light takes its colour from `L` or from `filename`, not from both",
                    );
                }
                *radiance = InfiniteRadiance::Image(image);
            }
        }
        LightKind::Point { .. } | LightKind::Spot { .. } | LightKind::Distant { .. } => (),
    }
    Some(light)
}

fn area_light(reader: &mut Reader) -> Option<AreaLightDesc> {
    if reader.kind.value != "diffuse" {
        reader.unknown_type("area-light", "area light", &["diffuse"]);
        return None;
    }
    let image = reader.uv_image(&UvImageDesc::EMISSION, None, WrapMode::Clamp);
    if image.is_some() && reader.has("L") {
        reader.refuse("L", "an area light takes its colour from `L` or from `filename`, not from both");
    }
    let mut light = AreaLightDesc { image, ..AreaLightDesc::default() };
    reader.settings(&mut light);
    without_none(reader, &mut light);
    check_group(reader, light.group.as_deref());
    Some(light)
}
