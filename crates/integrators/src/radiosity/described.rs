//! From what a scene's author said to settings, and to warnings of what radiosity shows otherwise.

use description::{
    Diagnostic, FormFactorsDesc, Handle, MaterialDesc, MaterialKind, RadiosityDesc, SceneDesc, ShapeDesc,
    ShapeKind, Stated,
};

use super::{FormFactors, RadiositySettings};

/// The greatest depth: every patch keeps light apart by how often it was scattered.
const MOST_DEPTH: i32 = 100;

/// The most patches, about as many as fit into the memory of a large machine.
const MOST_PATCHES: i32 = 1_000_000;

/// The settings, or everything that is wrong with them: the parameter and what is wrong.
pub(crate) fn settings(desc: &RadiosityDesc) -> Result<RadiositySettings, Vec<(&'static str, String)>> {
    let mut errors = Vec::new();
    let mut count = |name: &'static str, value: i32, [least, most]: [i32; 2]| {
        if value < least || value > most {
            let range = match most {
                i32::MAX => format!("{least} or more"),
                _ => format!("from {least} to {most}"),
            };
            errors.push((name, format!("`{name}` is {range}, not {value}")));
        }
        value.clamp(least, most) as u32
    };
    let resolution = count("hemicuberesolution", desc.hemicube_resolution, [2, 1024]);
    let settings = RadiositySettings {
        max_depth: count("maxdepth", desc.max_depth, [0, MOST_DEPTH]),
        form_factors: match desc.form_factors {
            FormFactorsDesc::Analytic => FormFactors::Analytic,
            FormFactorsDesc::Hemicube => FormFactors::Hemicube { resolution },
        },
        patch_size: desc.patch_size,
        subdivision: count("subdivision", desc.subdivision, [0, 10]),
        gradient: desc.gradient,
        max_patches: count("maxpatches", desc.max_patches, [1, MOST_PATCHES]),
        tolerance: desc.tolerance,
        steps: count("steps", desc.steps, [1, i32::MAX]),
        gather: count("gather", desc.gather, [0, i32::MAX]),
        mesh_out: desc.mesh_out.as_ref().map(Into::into),
    };
    let mut positive = |name: &'static str, value: f32, most: f32| {
        // Written so that NaN is wrong, too.
        if !(value > 0.0 && value < most) {
            let range = if most == 1.0 { "between 0 and 1" } else { "a number above 0" };
            errors.push((name, format!("`{name}` is {range}, not {value}")));
        }
    };
    positive("patchsize", desc.patch_size.unwrap_or(1.0), f32::INFINITY);
    positive("gradient", desc.gradient, f32::INFINITY);
    positive("tolerance", desc.tolerance, 1.0);
    if let Some(file) = desc.mesh_out.as_ref().filter(|file| !file.to_ascii_lowercase().ends_with(".ply")) {
        errors.push(("mesh-out", format!("the name of `mesh-out` ends in .ply, not as `{file}`")));
    }
    if errors.is_empty() { Ok(settings) } else { Err(errors) }
}

/// Tells of each material that is not diffuse, and of each shape that cannot be cut into patches.
pub(crate) fn warnings(desc: &SceneDesc) -> Vec<Diagnostic> {
    let objects = desc.objects.iter().flat_map(|(_, object)| object.shapes.iter());
    let shapes: Vec<&Stated<ShapeDesc>> = desc.shapes.iter().chain(objects).map(|(_, shape)| shape).collect();
    let mut used = vec![false; desc.materials.iter().count()];
    for material in shapes.iter().filter_map(|shape| shape.material) {
        mark(desc, material, &mut used);
    }
    let materials = desc.materials.iter().zip(&used).filter(|((_, material), used)| {
        let is_diffuse = matches!(
            material.kind,
            MaterialKind::Diffuse { .. }
                | MaterialKind::DiffuseTransmission { .. }
                | MaterialKind::Mix { .. }
                | MaterialKind::Interface
        );
        **used && !is_diffuse
    });
    let of_material = materials.map(|((_, material), _)| {
        let message = "this material is not diffuse; radiosity draws it by its albedo";
        Diagnostic::warning("not-diffuse", message, material.origin.span)
    });
    let of_shape = shapes.iter().filter_map(|shape| {
        let what = match shape.kind {
            ShapeKind::Plane => "a plane without end",
            ShapeKind::Implicit { .. } => "a surface given by a formula",
            ShapeKind::Solid { .. } => "a solid",
            ShapeKind::Curve(_) => "a curve",
            _ => return None,
        };
        let message =
            format!("{what} cannot be cut into patches; radiosity lights it, but it passes no light on");
        Some(Diagnostic::warning("no-patches", message, shape.origin.span))
    });
    of_material.chain(of_shape).collect()
}

/// Marks a material, and those that it mixes.
fn mark(desc: &SceneDesc, material: Handle<MaterialDesc>, used: &mut [bool]) {
    let is_new = !std::mem::replace(&mut used[material.index()], true);
    if let MaterialKind::Mix { materials, .. } = &desc.materials[material].kind
        && is_new
    {
        materials.iter().for_each(|&part| mark(desc, part, used));
    }
}
