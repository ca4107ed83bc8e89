//! Instances of the top group that may be placed elsewhere.

use geometry::{InstanceId, World};
use math::{AnimatedTransform, Bounds3, DMat4, Transform};

use super::{Bvh, Words, item, paths};

/// An item that is a path of instances.
#[derive(Clone, Debug)]
pub struct Placed {
    /// The index of the item.
    pub item: u32,
    /// The outermost instance.
    pub instance: InstanceId,
    /// Whether an instance of the path moves by itself.
    pub is_moving: bool,
    /// What is in the group at the end of the path, and the matrix that takes it into the group
    /// that the outermost instance places.
    inside: Bounds3,
    inner: DMat4,
}

impl Placed {
    /// The rows of the item, where the outermost instance has this transform.
    pub fn rows(&self, outermost: &Transform) -> [Words; 3] {
        item::rows(outermost.matrix().as_dmat4() * self.inner)
    }

    /// Its box.
    pub fn bounds(&self, outermost: &AnimatedTransform) -> Bounds3 {
        paths::outside(outermost, &self.inside)
    }
}

impl Bvh {
    /// All paths of instances, ordered by the outermost one.
    pub(crate) fn placed(&self, world: &World) -> Vec<Placed> {
        let mut all: Vec<Placed> = self
            .instances
            .iter()
            .filter_map(|(path, item)| {
                let (&instance, inner) = path.ids().split_first()?;
                let last = world.group_of_instance(*path.ids().last()?);
                let transforms = || inner.iter().map(|&id| world.render_from_instance(id));
                let is_moving = world.render_from_instance(instance).is_moving();
                let bounds = self.groups[last.0 as usize].bounds;
                Some(Placed {
                    item: *item,
                    instance,
                    is_moving: is_moving || transforms().any(AnimatedTransform::is_moving),
                    inside: transforms().rev().fold(bounds, |inside, step| paths::outside(step, &inside)),
                    inner: transforms().map(|step| step.start().matrix().as_dmat4()).product(),
                })
            })
            .collect();
        all.sort_by_key(|placed| placed.instance);
        all
    }
}
