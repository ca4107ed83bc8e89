//! Lights that are not surfaces, and the emission of surfaces.

use std::collections::BTreeSet;

use description::{
    AreaLightDesc, Handle, ImageDesc, InfiniteRadiance, LightDesc, LightKind, SceneDesc, TransformDesc,
    WrapMode,
};
use image::ColorEncoding;
use math::{DMat4, Vec3};

use crate::files::Files;
use crate::names::Names;
use crate::statement::{Statement, quoted};
use crate::text::Text;
use crate::textures::uv_lookup;

/// The file of an image whose codes are those of sRGB.
fn image(desc: &SceneDesc, image: Handle<ImageDesc>, files: &mut Files) -> String {
    files.image(&desc.images[image].image, ColorEncoding::Srgb)
}

/// All lights.
pub(crate) fn lights(
    desc: &SceneDesc,
    names: &Names,
    files: &mut Files,
    text: &mut Text,
    extensions: &mut BTreeSet<String>,
) {
    for (_, light) in desc.lights.iter() {
        let LightDesc { kind, world_from_light, scale, medium, group } = &light.value;
        let mut statement = Statement::new("LightSource", kind.name()).target("light");
        write(&mut statement, kind, desc, files, extensions);
        statement.float("scale", *scale, 1.0);
        write_group(&mut statement, group.as_deref(), extensions);
        // The medium of the camera is in force.
        let is_elsewhere = *medium != desc.camera.medium;
        let TransformDesc { start, end, times: _ } = world_from_light;
        let is_placed = [start, end] != [&DMat4::IDENTITY; 2];
        text.block(is_placed || is_elsewhere, |text| {
            text.transform(world_from_light);
            if is_elsewhere {
                text.line(&format!("MediumInterface \"\" {}", quoted(names.space(*medium))));
            }
            text.statement(statement);
        });
    }
}

fn write(
    to: &mut Statement,
    kind: &LightKind,
    desc: &SceneDesc,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) {
    match kind {
        LightKind::Point { intensity, power, from } => {
            to.white_or("I", intensity);
            to.optional_float("power", *power);
            to.triple("point3", "from", *from, Vec3::ZERO);
        }
        LightKind::Spot { intensity, power, from, to: target, cone_angle, cone_delta_angle } => {
            to.white_or("I", intensity);
            to.optional_float("power", *power);
            to.triple("point3", "from", *from, Vec3::ZERO);
            to.triple("point3", "to", *target, Vec3::Z);
            to.float("coneangle", *cone_angle, 30.0);
            to.float("conedeltaangle", *cone_delta_angle, 5.0);
        }
        LightKind::Distant { radiance, illuminance, from, to: target } => {
            to.white_or("L", radiance);
            to.optional_float("illuminance", *illuminance);
            to.triple("point3", "from", *from, Vec3::ZERO);
            to.triple("point3", "to", *target, Vec3::Z);
        }
        LightKind::Goniometric { intensity, power, image: table } => {
            to.white_or("I", intensity);
            to.optional_float("power", *power);
            if let Some(table) = table {
                to.text("filename", &image(desc, *table, files));
            }
        }
        LightKind::Projection { image: slide, power, fov } => {
            to.text("filename", &image(desc, *slide, files));
            to.optional_float("power", *power);
            to.float("fov", *fov, 90.0);
        }
        LightKind::Infinite { radiance, illuminance, portal } => {
            match radiance {
                InfiniteRadiance::Constant(color) => to.white_or("L", color),
                InfiniteRadiance::Image(sky) => {
                    let picture = &desc.images[*sky].image;
                    if picture.width() != picture.height() {
                        extensions.insert("latitude-longitude images".into());
                    }
                    to.text("filename", &image(desc, *sky, files));
                }
            }
            to.optional_float("illuminance", *illuminance);
            if let Some(portal) = portal {
                to.triples("point3", "portal", portal);
            }
        }
    }
}

/// The emission of the surfaces that follow.
pub(crate) fn area_light(
    desc: &SceneDesc,
    light: &AreaLightDesc,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) -> Statement {
    let AreaLightDesc { radiance, image: picture, scale, power, two_sided, group } = light;
    let mut statement = Statement::new("AreaLightSource", "diffuse").target("light");
    match picture {
        Some(picture) => {
            let name = image(desc, picture.image, files);
            statement.text("filename", &name);
            uv_lookup(&mut statement, picture, ["wrap", "filter", "columns"], WrapMode::Clamp, extensions);
        }
        None => statement.white_or("L", radiance),
    }
    statement.float("scale", *scale, 1.0);
    statement.optional_float("power", *power);
    statement.flag("twosided", *two_sided, false);
    write_group(&mut statement, group.as_deref(), extensions);
    statement
}

fn write_group(to: &mut Statement, group: Option<&str>, extensions: &mut BTreeSet<String>) {
    if let Some(group) = group {
        extensions.insert("groups of lights".into());
        to.text("lightgroup", group);
    }
}
