//! Constructive solid geometry: unions, intersections and differences of bodies.
//!
//! A ray is inside of each body on some spans. Along the sorted ends of all spans, the bodies that
//! the ray is inside of are counted: at least one in a union, all in an intersection, the first and
//! no other in a difference ([Roth 1982]). Combinations are bodies again. The surface at an end is
//! that of the body whose span ends there, with its orientation reversed where that body is
//! subtracted. Ends at equal t count as one, so that nothing is left between faces that coincide
//! exactly.
//!
//! A hit's parameters are the number of the face and 0; a [`SurfacePoint`]'s are those of the body.
//! Points cannot be sampled uniformly on such a surface, so that its area counts as 0.

mod part;

use super::extent::{Crossing, Span};
use super::implicit::Formula;
use super::sample::{ShapeHit, ShapeSample};
use crate::surface::SurfacePoint;
use math::{Bounds3, Point3, Ray, Transform, Vec2};
use part::{Part, Profile};

/// A Boolean operation on bodies.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Operation {
    /// Points in any of them.
    Union,
    /// Points in all of them.
    Intersection,
    /// Points in the first of them and in no other.
    Difference,
}

/// A body with a closed boundary.
#[derive(Clone, Debug)]
pub struct Solid {
    parts: Vec<Part>,
    tree: Tree,
}

#[derive(Clone, Debug)]
enum Tree {
    Part(u32),
    Combination(Operation, Vec<Tree>),
}

impl Solid {
    fn single(part: Part) -> Self {
        Self { parts: vec![part], tree: Tree::Part(0) }
    }

    /// The ball around the object's origin between two heights along z.
    pub fn sphere(render_from_object: &Transform, radius: f32, z: [f32; 2]) -> Self {
        let radius = f64::from(radius.abs());
        let z = ascending(z).map(|z| z.clamp(-radius, radius));
        Self::revolved(render_from_object, [radius * radius, 0.0, -1.0], 0.0, z)
    }

    /// The cylinder around the object's z axis between two heights, with its ends.
    pub fn cylinder(render_from_object: &Transform, radius: f32, z: [f32; 2]) -> Self {
        let radius = f64::from(radius);
        Self::revolved(render_from_object, [radius * radius, 0.0, 0.0], 0.0, ascending(z))
    }

    /// The cone on the object's xy plane with its point at `height` above it, with its base.
    pub fn cone(render_from_object: &Transform, radius: f32, height: f32) -> Self {
        let height = f64::from(height.abs());
        let slope = f64::from(radius) / height;
        Self::revolved(render_from_object, [0.0, 0.0, slope * slope], height, [0.0, height])
    }

    /// The paraboloid that opens along the object's z axis, between two heights, with `radius` at
    /// the larger one, which must be above 0.
    pub fn paraboloid(render_from_object: &Transform, radius: f32, z: [f32; 2]) -> Self {
        let z = ascending(z).map(|z| z.max(0.0));
        let radius = f64::from(radius);
        Self::revolved(render_from_object, [0.0, radius * radius / z[1], 0.0], 0.0, z)
    }

    /// The body within the surface that the line between two points of different z sweeps around
    /// the object's z axis.
    pub fn hyperboloid(render_from_object: &Transform, ends: [Point3; 2]) -> Self {
        let [from, to] = ends.map(|p| p.as_dvec3());
        let (q, e) = (from.truncate(), (to - from).truncate());
        let squared = e.length_squared();
        // The point of the line nearest to the axis.
        let v = if squared == 0.0 { 0.0 } else { -q.dot(e) / squared };
        let rise = to.z - from.z;
        let rho = [(q + e * v).length_squared(), 0.0, squared / (rise * rise)];
        Self::revolved(render_from_object, rho, from.z + rise * v, ascending(ends.map(|p| p.z)))
    }

    fn revolved(render_from_object: &Transform, rho: [f64; 3], origin: f64, z: [f64; 2]) -> Self {
        Self::single(Part::revolved(render_from_object, Some(Profile { rho, origin }), z))
    }

    /// The half space below the object's xy plane, which is unbounded.
    pub fn below_plane(render_from_object: &Transform) -> Self {
        Self::single(Part::revolved(render_from_object, None, [f64::NEG_INFINITY, 0.0]))
    }

    /// The body where a formula is negative within `bounds`, which close it.
    pub fn implicit(render_from_object: &Transform, formula: Formula, bounds: &Bounds3) -> Self {
        Self::single(Part::formula(render_from_object, formula, bounds))
    }

    /// Combines several solids; `None` of none.
    pub fn combine(operation: Operation, operands: impl IntoIterator<Item = Self>) -> Option<Self> {
        let mut operands = operands.into_iter();
        let Self { mut parts, tree } = operands.next()?;
        let mut trees = vec![tree];
        for mut operand in operands {
            if operation == Operation::Difference {
                operand.turn_round();
            }
            operand.tree.renumber(parts.len() as u32);
            parts.append(&mut operand.parts);
            trees.push(operand.tree);
        }
        let tree = if trees.len() == 1 { trees.remove(0) } else { Tree::Combination(operation, trees) };
        Some(Self { parts, tree })
    }

    /// Reverses its orientation.
    pub fn turn_round(&mut self) {
        for part in &mut self.parts {
            part.quadric.turn_round();
        }
    }

    pub(super) fn bounds(&self) -> Option<Bounds3> {
        self.tree.bounds(&self.parts)
    }

    pub(super) fn intersect(&self, ray: &Ray, [after, t_max]: [f32; 2]) -> Option<ShapeHit> {
        // The ends of the range are no faces.
        let range = [0.0, t_max.into()].map(|t| Crossing { t, face: u32::MAX });
        let crossings = self.tree.spans(&self.parts, ray, range).into_iter().flatten();
        let is_ahead = |crossing: &Crossing| crossing.face != u32::MAX && crossing.t as f32 > after;
        let first = crossings.into_iter().find(is_ahead)?;
        let t = first.t as f32;
        (t < t_max).then(|| ShapeHit { t, uv: Vec2::new(first.face as f32, 0.0) })
    }

    pub(super) fn surface(&self, ray: &Ray, hit: &ShapeHit) -> SurfacePoint {
        let face = hit.uv.x as u32;
        self.parts[(face / Part::FACES) as usize].surface(ray, hit.t, face % Part::FACES)
    }

    pub(super) fn area(&self) -> f32 {
        0.0
    }

    pub(super) fn sample(&self, _: Vec2) -> Option<ShapeSample> {
        None
    }
}

fn ascending(z: [f32; 2]) -> [f64; 2] {
    [f64::from(z[0].min(z[1])), f64::from(z[0].max(z[1]))]
}

impl Tree {
    fn renumber(&mut self, by: u32) {
        match self {
            Self::Part(index) => *index += by,
            Self::Combination(_, operands) => operands.iter_mut().for_each(|operand| operand.renumber(by)),
        }
    }

    fn bounds(&self, parts: &[Part]) -> Option<Bounds3> {
        match self {
            Self::Part(index) => parts[*index as usize].bounds(),
            Self::Combination(Operation::Union, operands) => operands
                .iter()
                .try_fold(Bounds3::EMPTY, |all, operand| Some(all.union(operand.bounds(parts)?))),
            Self::Combination(Operation::Difference, operands) => operands.first()?.bounds(parts),
            // Each of the boxes contains the intersection.
            Self::Combination(Operation::Intersection, operands) => {
                let boxes = operands.iter().filter_map(|operand| operand.bounds(parts));
                boxes.min_by(|a, b| a.diagonal().length().total_cmp(&b.diagonal().length()))
            }
        }
    }

    /// The spans of a ray that are inside, in order.
    fn spans(&self, parts: &[Part], ray: &Ray, range: Span) -> Vec<Span> {
        let mut spans = Vec::new();
        match self {
            Self::Part(index) => {
                parts[*index as usize].spans(ray, range, index * Part::FACES, &mut spans);
            }
            Self::Combination(operation, operands) => {
                let mut ends = Vec::new();
                for (i, operand) in operands.iter().enumerate() {
                    let inside = operand.spans(parts, ray, range);
                    let decides = match operation {
                        Operation::Union => false,
                        Operation::Intersection => true,
                        Operation::Difference => i == 0,
                    };
                    if inside.is_empty() && decides {
                        return spans;
                    }
                    ends.extend(inside.iter().flat_map(|&[enter, leave]| [(enter, 1, i), (leave, -1, i)]));
                }
                combine(*operation, operands.len() as i32, &mut ends, &mut spans);
            }
        }
        spans
    }
}

/// Spans of a combination from the ends of its operands' spans, each with the change of the count
/// and the index of the operand.
fn combine(operation: Operation, operands: i32, ends: &mut [(Crossing, i32, usize)], spans: &mut Vec<Span>) {
    ends.sort_by(|(a, ..), (b, ..)| a.t.total_cmp(&b.t));
    let (mut in_first, mut in_others) = (0, 0);
    let mut entered: Option<Crossing> = None;
    for same in ends.chunk_by(|(a, ..), (b, ..)| a.t == b.t) {
        let mut crossing = same[0].0;
        for &(end, change, whose) in same {
            if whose == 0 {
                in_first += change;
            } else {
                in_others += change;
            }
            crossing = end;
        }
        let is_inside = match operation {
            Operation::Union => in_first + in_others > 0,
            Operation::Intersection => in_first + in_others == operands,
            Operation::Difference => in_first > 0 && in_others == 0,
        };
        match entered {
            None if is_inside => entered = Some(crossing),
            Some(enter) if !is_inside => {
                spans.push([enter, crossing]);
                entered = None;
            }
            _ => (),
        }
    }
}
