//! Objects and their instances, which may be nested.
//!
//! An object is a group of the world. Its static shapes are in the space of the object; a moving
//! shape is an instance within the group, and so is a nested object. Motions of nested instances
//! are interpolated separately and then combined.
//!
//! The space of an object is world space, translated so that the origin is that of its first shape:
//! then the coordinates within are no larger than the object, and the camera's and the instance's
//! translation are summed in doubles, where one may all but cancel the other. An object with an
//! instance that moves is in render space, as the interpolation of a rotation depends on the
//! origin, and the format interpolates about this one.

use super::Compiler;
use super::curves::are_strands;
use description::{Arena, Handle, InstanceDesc, ObjectDesc, Stated, TransformDesc};
use geometry::{GroupId, Instance, InstancePath};
use math::{AnimatedTransform, DMat4, Transform};
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// The group of an object.
#[derive(Clone, Copy)]
struct Placeable {
    group: GroupId,
    /// From the space of the group.
    world_from_object: DMat4,
    /// The number of levels of nested instances.
    levels: usize,
}

#[derive(Default)]
struct Objects {
    built: HashMap<usize, Placeable>,
    /// The objects being compiled, each nested in the one before.
    open: Vec<usize>,
    /// Objects that have an instance that moves.
    moving: HashSet<usize>,
}

impl Compiler<'_> {
    /// Compiles all instances and their objects.
    pub(super) fn instances(&mut self, instances: &Arena<InstanceDesc>) {
        let nested = self.objects.iter().flat_map(|(_, object)| object.instances.iter());
        let moving = instances.iter().chain(nested).filter(|(_, desc)| desc.world_from_object.is_animated());
        let moving = moving.map(|(_, desc)| desc.object.index()).collect();
        let mut objects = Objects { moving, ..Default::default() };
        let render_from_world = self.render_from_world;
        for (_, desc) in instances.iter() {
            let span = desc.origin.span;
            if let Some((instance, _)) = self.instance(desc, &render_from_world, &mut objects) {
                self.add_instance(GroupId::TOP, instance, span);
            }
            self.names.add_instance(desc, self.entries.len(), self.instances.len());
        }
    }

    /// An instance in a space, and its number of levels of nested instances, itself included.
    fn instance(
        &mut self,
        instance: &Stated<InstanceDesc>,
        space_from_world: &DMat4,
        objects: &mut Objects,
    ) -> Option<(Instance, usize)> {
        let span = instance.origin.span;
        if objects.open.contains(&instance.object.index()) {
            let message = format!("the object `{}` contains itself", self.objects[instance.object].name);
            self.error("endless-instances", message, span);
            return None;
        }
        let built =
            (objects.open.len() < InstancePath::MAX_DEPTH).then(|| self.object(instance.object, objects));
        let Some(Placeable { group, world_from_object, levels }) =
            built.filter(|object| objects.open.len() + object.levels < InstancePath::MAX_DEPTH)
        else {
            let most = InstancePath::MAX_DEPTH;
            self.error("nested-too-deep", format!("instances are nested more than {most} levels deep"), span);
            return None;
        };
        let TransformDesc { start, end, times } = instance.world_from_object;
        let [start, end] = [start, end].map(|moved| *space_from_world * moved * world_from_object);
        let Some(render_from_instance) = AnimatedTransform::new(start, end, times) else {
            self.singular("instance", &instance.origin);
            return None;
        };
        Some((Instance { group, render_from_instance }, levels + 1))
    }

    /// The group of an object. Nested objects are compiled first.
    fn object(&mut self, handle: Handle<ObjectDesc>, objects: &mut Objects) -> Placeable {
        if let Some(built) = objects.built.get(&handle.index()) {
            return *built;
        }
        let described = Arc::clone(&self.objects);
        let object = &described[handle];
        let shapes: Vec<_> = object.shapes.iter().map(|(_, shape)| shape).collect();
        let object_from_world = if objects.moving.contains(&handle.index()) {
            self.render_from_world
        } else {
            let first = shapes.first().map(|shape| shape.world_from_object.start.w_axis.truncate());
            DMat4::from_translation(-first.unwrap_or_default())
        };
        let mut inner = Vec::new();
        objects.open.push(handle.index());
        for (_, instance) in object.instances.iter() {
            let span = instance.origin.span;
            let nested = self.instance(instance, &object_from_world, objects);
            inner.extend(nested.map(|(instance, levels)| (instance, levels, span)));
        }
        objects.open.pop();
        let (moving, resting): (Vec<_>, Vec<_>) =
            shapes.chunk_by(|a, b| are_strands(a, b)).partition(|run| run[0].world_from_object.is_animated());
        for run in moving {
            let span = run[0].origin.span;
            inner.extend(self.moving(run, &object_from_world).map(|instance| (instance, 1, span)));
        }
        let group = self.add_group();
        for run in resting {
            match Transform::from_f64(object_from_world * run[0].world_from_object.start) {
                Some(transform) => self.resting(run, group, &transform),
                None => self.singular("shape", &run[0].origin),
            }
        }
        let levels = inner.iter().map(|(_, levels, _)| *levels).max().unwrap_or(0);
        for (instance, _, span) in inner {
            self.add_instance(group, instance, span);
        }
        let built = Placeable { group, world_from_object: object_from_world.inverse(), levels };
        objects.built.insert(handle.index(), built);
        built
    }
}
