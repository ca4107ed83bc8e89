//! Shapes without bounds, and how far light from infinity reaches.
//!
//! Light subpaths from infinity start on a disk outside the bounding sphere of all bounded shapes.
//! A plane is lit by them where they leave the sphere, and nowhere else. Algorithms that sample
//! lights from surfaces are not affected; those that trace light subpaths miss what lies beyond.

use description::{
    Diagnostic, Handle, InstanceDesc, ObjectDesc, SceneDesc, ShapeDesc, ShapeKind, SolidOperation, Stated,
};

/// Warns of each unbounded shape that is lit from infinity, for the algorithm `name`, which traces
/// light subpaths.
pub(crate) fn warnings(desc: &SceneDesc, name: &str) -> Vec<Diagnostic> {
    if !desc.lights.iter().any(|(_, light)| light.kind.is_distant()) {
        return Vec::new();
    }
    let mut drawn = vec![false; desc.objects.iter().len()];
    desc.instances.iter().for_each(|(_, instance)| mark(desc, instance, &mut drawn));
    let objects = desc.objects.iter().zip(drawn).filter(|&(_, drawn)| drawn);
    let in_objects = objects.flat_map(|((_, object), _)| object.shapes.iter());
    let endless = endless_objects(desc);
    let shapes = desc.shapes.iter().chain(in_objects).filter(|(_, shape)| is_endless(shape, &endless));
    let warning = |(_, shape): (_, &Stated<ShapeDesc>)| {
        let what = if matches!(shape.kind, ShapeKind::Plane) { "a plane" } else { "a solid" };
        let message = format!(
            "light from infinity does not reach {what} without end beyond the scene's bounds; {name} draws it too dark there"
        );
        Diagnostic::warning("beyond-bounds", message, shape.origin.span)
    };
    shapes.map(warning).collect()
}

/// Marks what an instance draws.
fn mark(desc: &SceneDesc, instance: &InstanceDesc, drawn: &mut [bool]) {
    if !std::mem::replace(&mut drawn[instance.object.index()], true) {
        let object: &ObjectDesc = &desc.objects[instance.object];
        object.instances.iter().for_each(|(_, instance)| mark(desc, instance, drawn));
    }
}

/// Which objects have a shape without end. Solids are made of objects that come before them.
fn endless_objects(desc: &SceneDesc) -> Vec<bool> {
    let mut endless = Vec::new();
    for (_, object) in desc.objects.iter() {
        let any = object.shapes.iter().any(|(_, shape)| is_endless(shape, &endless));
        endless.push(any);
    }
    endless
}

fn is_endless(shape: &ShapeDesc, endless: &[bool]) -> bool {
    match &shape.kind {
        ShapeKind::Solid { operation, operands } => {
            let is_endless = |object: Handle<ObjectDesc>| endless.get(object.index()) == Some(&true);
            let mut operands = operands.iter().map(|operand| is_endless(operand.value));
            match operation {
                SolidOperation::Union => operands.any(|is_endless| is_endless),
                SolidOperation::Intersection => operands.all(|is_endless| is_endless),
                SolidOperation::Difference => operands.next() == Some(true),
            }
        }
        kind => kind.traits().is_unbounded,
    }
}
