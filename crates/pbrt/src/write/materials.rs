//! Materials.

use std::collections::BTreeSet;

use description::{
    CoatedConductorDesc, ConductorDesc, MaterialDesc, MaterialKind, SceneDesc, UvImageDesc, UvImageNames,
    WrapMode,
};
use image::ColorEncoding;
use scattering::SubsurfaceMethod;

use crate::write::files::Files;
use crate::write::names::Names;
use crate::write::settings::{note_extension, parameters};
use crate::write::statement::Statement;
use crate::write::text::Text;
use crate::write::textures::uv_lookup;

/// All materials, each with a name.
pub(crate) fn materials(
    desc: &SceneDesc,
    names: &Names,
    files: &mut Files,
    text: &mut Text,
    extensions: &mut BTreeSet<String>,
) {
    for (handle, material) in desc.materials.iter() {
        let MaterialDesc { name: _, kind, normal_map, displacement } = &material.value;
        let mut statement =
            Statement::named("MakeNamedMaterial", names.material(handle), kind.name()).target("material");
        write(&mut statement, kind, names, files, extensions);
        if !matches!(kind, MaterialKind::Mix { .. } | MaterialKind::Interface) {
            if let Some(map) = normal_map {
                write_normal_map(&mut statement, &UvImageDesc::NORMALS, map, desc, files, extensions);
            } else {
                statement.optional_float_parameter("displacement", displacement.as_ref(), names);
            }
            if let MaterialKind::OpenPbr(surface) = kind
                && let Some(map) = &surface.geometry_coat_normal
            {
                write_normal_map(&mut statement, &UvImageDesc::COAT_NORMALS, map, desc, files, extensions);
            }
        }
        text.statement(statement);
    }
}

fn write_normal_map(
    to: &mut Statement,
    names: &UvImageNames,
    map: &UvImageDesc,
    desc: &SceneDesc,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) {
    to.text(names.file, &files.image(&desc.images[map.image].image, ColorEncoding::Linear));
    uv_lookup(to, map, names, WrapMode::Repeat, extensions);
}

fn write(
    to: &mut Statement,
    kind: &MaterialKind,
    names: &Names,
    files: &mut Files,
    extensions: &mut BTreeSet<String>,
) {
    note_extension("material", kind, extensions);
    parameters(to, kind, names);
    match kind {
        MaterialKind::CoatedConductor(CoatedConductorDesc {
            conductor: ConductorDesc { roughness: metal, .. },
            roughness: coat,
            ..
        }) if metal.remap != coat.remap && !metal.is_smooth() && !coat.is_smooth() => {
            to.fail("`remaproughness` differs between its interfaces");
        }
        MaterialKind::Subsurface { method: SubsurfaceMethod::RandomWalk, .. } => {
            extensions.insert("material subsurface method".into());
        }
        MaterialKind::Measured { table } => {
            if table.data().wavelengths.is_none() {
                extensions.insert("material measured in red, green and blue".into());
            }
            to.text("filename", &files.measured(table));
        }
        MaterialKind::OpenPbr(surface) => {
            to.white_or("emission_color", &surface.emission_color);
        }
        MaterialKind::Mix { materials, .. } => {
            to.texts("materials", materials.iter().map(|&material| names.material(material)));
        }
        MaterialKind::Diffuse { .. }
        | MaterialKind::CoatedDiffuse(_)
        | MaterialKind::CoatedConductor(_)
        | MaterialKind::Conductor(_)
        | MaterialKind::Dielectric { .. }
        | MaterialKind::ThinDielectric { .. }
        | MaterialKind::DiffuseTransmission { .. }
        | MaterialKind::Hair { .. }
        | MaterialKind::Subsurface { .. }
        | MaterialKind::Interface => (),
    }
}
