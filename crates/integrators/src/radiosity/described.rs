//! Warnings of what radiosity draws otherwise than described.

use description::{Diagnostic, Handle, MaterialDesc, MaterialKind, SceneDesc, ShapeDesc, Stated};

/// Tells of each material that is not diffuse, and of each shape that cannot be cut into patches.
pub(crate) fn warnings(desc: &SceneDesc) -> Vec<Diagnostic> {
    let objects = desc.objects.iter().flat_map(|(_, object)| object.shapes.iter());
    let shapes: Vec<&Stated<ShapeDesc>> = desc.shapes.iter().chain(objects).map(|(_, shape)| shape).collect();
    let mut used = vec![false; desc.materials.iter().count()];
    for material in shapes.iter().filter_map(|shape| shape.material) {
        mark(desc, material, &mut used);
    }
    let materials = desc
        .materials
        .iter()
        .zip(&used)
        .filter(|((_, material), used)| **used && !material.kind.is_diffuse());
    let of_material = materials.map(|((_, material), _)| {
        let message = "this material is not diffuse; radiosity draws it by its albedo";
        Diagnostic::warning("not-diffuse", message, material.origin.span)
    });
    let of_shape = shapes.iter().filter(|shape| !shape.kind.traits().has_patches).map(|shape| {
        let name = shape.kind.name();
        let message = format!(
            "shape `{name}` cannot be cut into patches; radiosity lights it, but it passes no light on"
        );
        Diagnostic::warning("no-patches", message, shape.origin.span)
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
