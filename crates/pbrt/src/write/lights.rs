//! Lights that are not surfaces, and the emission of surfaces.

use std::collections::BTreeSet;

use description::{
    AreaLightDesc, Handle, ImageDesc, InfiniteRadiance, LightDesc, LightKind, SceneDesc, TransformDesc,
    UvImageDesc, WrapMode,
};
use image::ColorEncoding;
use math::DMat4;

use crate::write::files::Files;
use crate::write::names::Names;
use crate::write::settings::parameters;
use crate::write::statement::{Statement, quoted};
use crate::write::text::Text;
use crate::write::textures::uv_lookup;

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
        let LightDesc { kind, world_from_light, scale: _, medium, group } = &light.value;
        let mut statement = Statement::new("LightSource", kind.name()).target("light");
        parameters(&mut statement, &light.value, names);
        note_group(group.as_ref(), extensions);
        write(&mut statement, kind, desc, files, extensions);
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
        LightKind::Goniometric { image: picture, .. } | LightKind::Projection { image: picture, .. } => {
            if let Some(picture) = picture {
                to.text("filename", &image(desc, *picture, files));
            }
        }
        LightKind::Infinite { radiance: InfiniteRadiance::Image(sky), .. } => {
            let picture = &desc.images[*sky].image;
            if picture.width() != picture.height() {
                extensions.insert("latitude-longitude images".into());
            }
            to.text("filename", &image(desc, *sky, files));
        }
        LightKind::Infinite { .. }
        | LightKind::Point { .. }
        | LightKind::Spot { .. }
        | LightKind::Distant { .. } => (),
    }
}

/// The emission of the surfaces that follow.
pub(crate) fn area_light(
    desc: &SceneDesc,
    light: &AreaLightDesc,
    names: &Names,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) -> Statement {
    let mut statement = Statement::new("AreaLightSource", "diffuse").target("light");
    let mut light = light.clone();
    if let Some(picture) = light.image {
        light.radiance = AreaLightDesc::default().radiance;
        let name = image(desc, picture.image, files);
        statement.text("filename", &name);
        uv_lookup(&mut statement, &picture, &UvImageDesc::EMISSION, WrapMode::Clamp, extensions);
    }
    parameters(&mut statement, &light, names);
    if light.image.is_some() {
        statement.space = None;
    }
    note_group(light.group.as_ref(), extensions);
    statement
}

fn note_group(group: Option<&String>, extensions: &mut BTreeSet<String>) {
    extensions.extend(group.map(|_| "groups of lights".into()));
}
