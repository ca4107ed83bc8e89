//! Facts about a whole scene, recorded while it is compiled.

use description::Span;

/// What holds of a scene, for algorithms and back ends that treat some things differently and say
/// where.
///
/// It covers what is drawn: not objects without instances, nor materials that nothing is made of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct SceneTraits {
    /// Shapes without bounds, by kind of shape.
    pub unbounded_shapes: Vec<Occurrence>,
    /// Shapes that cannot be cut into patches, by kind of shape.
    pub shapes_without_patches: Vec<Occurrence>,
    /// Materials that are not diffuse, by kind of material: those of surfaces, and those that they
    /// mix. They are judged as described, also where another material stands in for them.
    pub materials_not_diffuse: Vec<Occurrence>,
    /// Whether a light is infinitely far away.
    pub is_lit_from_infinity: bool,
}

/// Things of the same kind of which a fact holds.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Occurrence {
    /// The format's name of the kind, such as `plane`.
    pub kind: &'static str,
    /// The first of them in the text.
    pub first: Span,
    /// How many there are, each counted once however many instances show it.
    pub count: usize,
}

impl Occurrence {
    /// Adds another one to those found so far.
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
