//! Unbounded shapes that light paths from infinite lights do not reach.
//!
//! Light subpaths from infinity start on a disk outside the bounding sphere of all bounded shapes.
//! They hit a plane only behind the sphere. Algorithms that sample lights from surfaces are not
//! affected; those that trace light subpaths miss the light on other parts of unbounded shapes.

use description::Diagnostic;
use scene::{Occurrence, Scene};

/// Warnings of unbounded shapes that are lit from infinity, for the algorithm `name`, which traces
/// light subpaths.
pub(crate) fn warnings(scene: &Scene, name: &str) -> Vec<Diagnostic> {
    let traits = scene.traits();
    let warning = |&Occurrence { kind, first, count }: &Occurrence| {
        let what = if kind == "plane" { "an infinite plane" } else { "an unbounded solid" };
        let message = format!(
            "light from infinity does not reach {what} beyond the scene's bounds; {name} renders it too dark there"
        );
        Diagnostic { count, ..Diagnostic::warning("beyond-bounds", message, first) }
    };
    let shapes = traits.unbounded_shapes.iter().filter(|_| traits.is_lit_from_infinity);
    shapes.map(warning).collect()
}
