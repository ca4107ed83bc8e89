//! Shapes without bounds, and how far light from infinity reaches.
//!
//! Light subpaths from infinity start on a disk outside the bounding sphere of all bounded shapes.
//! A plane is lit by them where they leave the sphere, and nowhere else. Algorithms that sample
//! lights from surfaces are not affected; those that trace light subpaths miss what lies beyond.

use description::Diagnostic;
use scene::{Occurrence, Scene};

/// Warns of the unbounded shapes that are lit from infinity, for the algorithm `name`, which traces
/// light subpaths.
pub(crate) fn warnings(scene: &Scene, name: &str) -> Vec<Diagnostic> {
    let traits = scene.traits();
    let warning = |&Occurrence { kind, first, count }: &Occurrence| {
        let what = if kind == "plane" { "a plane" } else { "a solid" };
        let message = format!(
            "light from infinity does not reach {what} without end beyond the scene's bounds; {name} draws it too dark there"
        );
        Diagnostic { count, ..Diagnostic::warning("beyond-bounds", message, first) }
    };
    let shapes = traits.unbounded_shapes.iter().filter(|_| traits.is_lit_from_infinity);
    shapes.map(warning).collect()
}
