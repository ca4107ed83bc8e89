//! Warnings of materials and shapes that radiosity does not support.

use description::Diagnostic;
use scene::{Occurrence, Scene};

/// Warnings of materials that are not diffuse, and of shapes that cannot be subdivided into
/// patches.
pub(crate) fn warnings(scene: &Scene) -> Vec<Diagnostic> {
    let traits = scene.traits();
    let of_material = |&Occurrence { first, count, .. }: &Occurrence| {
        let message = "this material is not diffuse; radiosity draws it by its albedo";
        Diagnostic { count, ..Diagnostic::warning("not-diffuse", message, first) }
    };
    let of_shape = |&Occurrence { kind, first, count }: &Occurrence| {
        let message = format!(
            "shape `{kind}` cannot be cut into patches; in radiosity it receives light, but does not reflect it to others"
        );
        Diagnostic { count, ..Diagnostic::warning("no-patches", message, first) }
    };
    let of_materials = traits.materials_not_diffuse.iter().map(of_material);
    of_materials.chain(traits.shapes_without_patches.iter().map(of_shape)).collect()
}
