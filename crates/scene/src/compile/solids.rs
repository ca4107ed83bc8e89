//! Constructive solid geometry: combinations of solids.

use super::Compiler;
use description::{Diagnostic, ShapeDesc, ShapeKind, SolidOperation, Span, Stated};
use geometry::{Operation, Solid};
use math::{Bounds3, DMat4, Transform};
use std::sync::Arc;

/// The maximum number of parts of a solid, nested solids included.
const MAX_PARTS: usize = 1024;
/// The maximum nesting depth of solids.
const MAX_DEPTH: usize = 32;

/// A solid under construction.
pub(super) struct Assembly {
    /// The span of the outermost solid.
    whole: Span,
    parts: usize,
    depth: usize,
}

impl Assembly {
    pub fn new(whole: Span) -> Self {
        Self { whole, parts: 0, depth: 0 }
    }
}

impl Compiler<'_> {
    /// The solid that a shape bounds. `None` after an error, such as for a shape that is not
    /// closed.
    pub(super) fn solid(
        &mut self,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
        assembly: &mut Assembly,
    ) -> Option<Solid> {
        let span = shape.origin.span;
        assembly.parts += 1;
        if assembly.parts > MAX_PARTS {
            if assembly.parts == MAX_PARTS + 1 {
                let message = format!("a solid has at most {MAX_PARTS} parts");
                self.error("too-large", message, assembly.whole);
            }
            return None;
        }
        let what = match &shape.kind {
            ShapeKind::Sphere { radius, z_min, z_max, phi_max } if *phi_max >= 360.0 => {
                return Some(Solid::sphere(transform, *radius, [*z_min, *z_max]));
            }
            ShapeKind::Cylinder { radius, z_min, z_max, phi_max } if *phi_max >= 360.0 => {
                return Some(Solid::cylinder(transform, *radius, [*z_min, *z_max]));
            }
            ShapeKind::Cone { radius, height, phi_max } if *phi_max >= 360.0 => {
                return Some(Solid::cone(transform, *radius, *height));
            }
            ShapeKind::Paraboloid { radius, z_min, z_max, phi_max } if *phi_max >= 360.0 => {
                return Some(Solid::paraboloid(transform, *radius, [*z_min, *z_max]));
            }
            ShapeKind::Hyperboloid { ends, phi_max } if *phi_max >= 360.0 => {
                return Some(Solid::hyperboloid(transform, *ends));
            }
            ShapeKind::Plane => return Some(Solid::below_plane(transform)),
            ShapeKind::Implicit { formula, bounds: [min, max] } => {
                let bounds = Bounds3 { min: *min, max: *max };
                return self.formula(formula, &bounds).map(|f| Solid::implicit(transform, f, &bounds));
            }
            ShapeKind::Solid { .. } => return self.combination(shape, transform, assembly),
            ShapeKind::Sphere { .. }
            | ShapeKind::Cylinder { .. }
            | ShapeKind::Cone { .. }
            | ShapeKind::Paraboloid { .. }
            | ShapeKind::Hyperboloid { .. } => "a shape whose `phimax` is below 360",
            ShapeKind::Spheres(_) => "a set of spheres",
            ShapeKind::Disk { .. } => "a disk",
            ShapeKind::Triangles(_) | ShapeKind::PlyMesh { .. } | ShapeKind::LoopSubdivision { .. } => {
                "a mesh"
            }
            ShapeKind::Patches(_) => "a patch",
            ShapeKind::Curve(_) => "a curve",
        };
        let message = format!("{what} cannot be part of a solid");
        let diagnostic = Diagnostic::error("not-closed", message, span);
        let help = "parts of a solid are full quadrics, planes, implicit surfaces and solids";
        self.diagnostics.push(diagnostic.with_label(assembly.whole, "the solid").with_help(help));
        None
    }

    fn combination(
        &mut self,
        shape: &Stated<ShapeDesc>,
        transform: &Transform,
        assembly: &mut Assembly,
    ) -> Option<Solid> {
        let ShapeKind::Solid { operation, operands } = &shape.kind else { return None };
        assembly.depth += 1;
        if assembly.depth > MAX_DEPTH {
            let message = format!("solids can be nested at most {MAX_DEPTH} levels deep");
            self.error("too-large", message, assembly.whole);
            return None;
        }
        let objects = Arc::clone(&self.objects);
        let mut bodies = Vec::new();
        for operand in operands {
            let object = &objects[operand.value];
            if let Some((_, instance)) = object.instances.iter().next() {
                let message = "instances of objects cannot be part of a solid";
                self.error("not-closed", message, instance.origin.span);
                return None;
            }
            let mut shapes = Vec::new();
            for (_, part) in object.shapes.iter() {
                shapes.push(self.part(part, transform, assembly)?);
            }
            match Solid::combine(Operation::Union, shapes) {
                Some(body) => bodies.push(body),
                None => {
                    let message = format!("the object `{}` has no shapes", object.name);
                    self.error("not-closed", message, operand.span);
                    return None;
                }
            }
        }
        assembly.depth -= 1;
        let operation = match operation {
            SolidOperation::Union => Operation::Union,
            SolidOperation::Intersection => Operation::Intersection,
            SolidOperation::Difference => Operation::Difference,
        };
        Solid::combine(operation, bodies)
    }

    /// Compiles a shape of an object to a part of the solid.
    fn part(
        &mut self,
        shape: &Stated<ShapeDesc>,
        whole: &Transform,
        assembly: &mut Assembly,
    ) -> Option<Solid> {
        if shape.world_from_object.is_animated() {
            let message = "parts of a solid do not move in it; drawn where they start";
            self.warn("not-drawn", message, shape.origin.span);
        }
        if shape.area_light.is_some() {
            let message = "parts of a solid do not emit; drawn without light";
            self.warn("not-drawn", message, shape.origin.span);
        }
        if shape.alpha.is_some() {
            let message = "parts of a solid have no `alpha`; drawn without it";
            self.warn("not-drawn", message, shape.origin.parameter("alpha"));
        }
        let placed: DMat4 = whole.matrix().as_dmat4() * shape.world_from_object.start;
        match Transform::from_f64(placed) {
            Some(transform) => self.solid(shape, &transform, assembly),
            None => {
                self.singular("shape", &shape.origin);
                None
            }
        }
    }
}
