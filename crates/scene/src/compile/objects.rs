//! Objects and their instances, which may be nested.
//!
//! An object is a group of the world. Its static shapes are in render space; a moving shape is an
//! instance within the group, and so is a nested object. Motions of nested instances are
//! interpolated separately and then combined.

use super::Compiler;
use super::curves::are_strands;
use description::{Arena, Handle, InstanceDesc, ObjectDesc, Stated, TransformDesc};
use geometry::{GroupId, Instance, InstancePath};
use math::{AnimatedTransform, Transform};
use std::collections::HashMap;
use std::sync::Arc;

/// The group of an object.
#[derive(Clone, Copy)]
struct Placeable {
    group: GroupId,
    /// The number of levels of nested instances.
    levels: usize,
}

#[derive(Default)]
struct Objects {
    built: HashMap<usize, Placeable>,
    /// The objects being compiled, each nested in the one before.
    open: Vec<usize>,
}

impl Compiler<'_> {
    /// Compiles all instances and their objects.
    pub(super) fn instances(&mut self, instances: &Arena<InstanceDesc>) {
        let mut objects = Objects::default();
        for (_, desc) in instances.iter() {
            let span = desc.origin.span;
            if let Some((instance, _)) = self.instance(desc, &mut objects) {
                self.add_instance(GroupId::TOP, instance, span);
            }
            self.names.add_instance(desc, self.entries.len(), self.instances.len());
        }
    }

    /// An instance, and its number of levels of nested instances, itself included.
    fn instance(
        &mut self,
        instance: &Stated<InstanceDesc>,
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
        let Some(Placeable { group, levels }) =
            built.filter(|object| objects.open.len() + object.levels < InstancePath::MAX_DEPTH)
        else {
            let most = InstancePath::MAX_DEPTH;
            self.error("nested-too-deep", format!("instances are nested more than {most} levels deep"), span);
            return None;
        };
        let Some(render_from_instance) = self.instance_motion(&instance.world_from_object) else {
            self.singular("instance", &instance.origin);
            return None;
        };
        Some((Instance { group, render_from_instance }, levels + 1))
    }

    /// The motion of an instance whose shapes are already in render space. The transforms of start
    /// and end are converted to render space before interpolation: the interpolation of a rotation
    /// depends on the origin, and the format interpolates about this one.
    fn instance_motion(&self, t: &TransformDesc) -> Option<AnimatedTransform> {
        let world_from_render = self.render_from_world.inverse();
        let moved = |world_from_object| self.render_from_world * world_from_object * world_from_render;
        AnimatedTransform::new(moved(t.start), moved(t.end), t.times)
    }

    /// The group of an object. Nested objects are compiled first.
    fn object(&mut self, handle: Handle<ObjectDesc>, objects: &mut Objects) -> Placeable {
        if let Some(built) = objects.built.get(&handle.index()) {
            return *built;
        }
        let described = Arc::clone(&self.objects);
        let object = &described[handle];
        let mut inner = Vec::new();
        objects.open.push(handle.index());
        for (_, instance) in object.instances.iter() {
            let span = instance.origin.span;
            inner.extend(self.instance(instance, objects).map(|(instance, levels)| (instance, levels, span)));
        }
        objects.open.pop();
        let shapes: Vec<_> = object.shapes.iter().map(|(_, shape)| shape).collect();
        let (moving, resting): (Vec<_>, Vec<_>) =
            shapes.chunk_by(|a, b| are_strands(a, b)).partition(|run| run[0].world_from_object.is_animated());
        for run in moving {
            let span = run[0].origin.span;
            inner.extend(self.moving(run).map(|instance| (instance, 1, span)));
        }
        let group = self.add_group();
        for run in resting {
            match Transform::from_f64(self.render_from_world * run[0].world_from_object.start) {
                Some(transform) => self.resting(run, group, &transform),
                None => self.singular("shape", &run[0].origin),
            }
        }
        let levels = inner.iter().map(|(_, levels, _)| *levels).max().unwrap_or(0);
        for (instance, _, span) in inner {
            self.add_instance(group, instance, span);
        }
        let built = Placeable { group, levels };
        objects.built.insert(handle.index(), built);
        built
    }
}
