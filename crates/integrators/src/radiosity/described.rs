//! Warnings of what radiosity draws otherwise than described.

use description::Diagnostic;
use scene::{Occurrence, Scene};

/// Tells of the materials that are not diffuse, and of the shapes that cannot be cut into patches.
pub(crate) fn warnings(scene: &Scene) -> Vec<Diagnostic> {
    let traits = scene.traits();
    let of_material = |&Occurrence { first, count, .. }: &Occurrence| {
        let message = "this material is not diffuse; radiosity draws it by its albedo";
        Diagnostic { count, ..Diagnostic::warning("not-diffuse", message, first) }
    };
    let of_shape = |&Occurrence { kind, first, count }: &Occurrence| {
        let message = format!(
            "shape `{kind}` cannot be cut into patches; radiosity lights it, but it passes no light on"
        );
        Diagnostic { count, ..Diagnostic::warning("no-patches", message, first) }
    };
    let of_materials = traits.materials_not_diffuse.iter().map(of_material);
    of_materials.chain(traits.shapes_without_patches.iter().map(of_shape)).collect()
}
