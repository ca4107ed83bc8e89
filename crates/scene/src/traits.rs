//! Facts about a whole scene, recorded while it is compiled.

use description::Span;

/// Facts about a scene, for algorithms and back ends that do not support everything and report
/// where.
///
/// They cover what is rendered: not objects without instances, nor unused materials.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneTraits {
    /// Shapes without bounds, by kind of shape.
    pub unbounded_shapes: Vec<Occurrence>,
    /// Shapes that cannot be subdivided into patches, by kind of shape.
    pub shapes_without_patches: Vec<Occurrence>,
    /// Materials that are not diffuse, by kind of material: those of surfaces, and those that are
    /// parts of a mix. They are judged as described, even if they are replaced by another material.
    pub materials_not_diffuse: Vec<Occurrence>,
    /// Whether any light is infinitely far away.
    pub is_lit_from_infinity: bool,
    /// Whether anything moves while the shutter is open, the camera aside.
    pub is_moving: bool,
}

/// Shapes or materials of the same kind that a fact applies to.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// The format's name of the kind, such as `plane`.
    pub kind: &'static str,
    /// The first of them in the scene file.
    pub first: Span,
    /// Their number; instancing does not count.
    pub count: usize,
}

impl Occurrence {
    /// Counts one more of a kind.
    pub(crate) fn add(found: &mut Vec<Self>, kind: &'static str, span: Span) {
        match found.iter_mut().find(|same| same.kind == kind) {
            Some(same) => {
                same.count += 1;
                same.first = same.first.min(span);
            }
            None => found.push(Self { kind, first: span, count: 1 }),
        }
    }
}
