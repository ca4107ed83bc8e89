//! Instances within instances, as one level: each path of instances that leads to shapes is an
//! instance of the top group.

use geometry::{GroupId, InstancePath, PlainItem, World};
use math::{AnimatedTransform, Bounds3, gamma};

use super::item::Item;
use super::{BvhError, Group};

/// The most items of a tree that is built anew, which takes long.
const MOST: usize = 1 << 20;

/// The items of a group with their boxes: its shapes, and of the top group all paths to shapes.
pub fn items(
    world: &World,
    group: GroupId,
    items: &[PlainItem],
    groups: &[Group],
) -> Result<Vec<(Bounds3, Item)>, BvhError> {
    let mut boxed = Vec::new();
    for item in items {
        match *item {
            PlainItem::Shape(geometry, primitive) => {
                let bounds = world.geometry(geometry).bounds(primitive).unwrap_or(Bounds3::EMPTY);
                boxed.push((bounds, Item::Shape(geometry, primitive)));
            }
            PlainItem::Instance(id) if group == GroupId::TOP => {
                add(world, InstancePath::TOP.into(id), groups, &mut boxed)?;
            }
            PlainItem::Instance(_) => {}
        }
    }
    Ok(boxed)
}

/// A box outside of an instance, at all times, around one inside.
pub fn outside(transform: &AnimatedTransform, inside: &Bounds3) -> Bounds3 {
    let moved = transform.motion_bounds(inside);
    moved.expand(moved.min.abs().max(moved.max.abs()).max_element() * gamma(8))
}

/// Adds a path and those that go on from it.
fn add(
    world: &World,
    path: InstancePath,
    groups: &[Group],
    boxed: &mut Vec<(Bounds3, Item)>,
) -> Result<(), BvhError> {
    let Some(&last) = path.ids().last() else { return Ok(()) };
    let group = &groups[world.group_of_instance(last).0 as usize];
    if !group.bounds.is_empty() {
        if boxed.len() >= MOST {
            return Err(BvhError::Nested(last));
        }
        let bounds = path
            .ids()
            .iter()
            .rev()
            .fold(group.bounds, |bounds, &id| outside(world.render_from_instance(id), &bounds));
        boxed.push((bounds, Item::Instance(path)));
    }
    group.instances.iter().try_for_each(|&id| add(world, path.into(id), groups, boxed))
}
