//! Worlds for ray queries, of which drivers make trees of their own.
//!
//! A group has its triangles, and boxes of its shapes, and each path of instances that leads to
//! some is an instance of the top group, as in [`paths`](super::paths). Instead of the references
//! of trees, groups have the indices of their first triangle and of their first shape, which is the
//! largest word of the top group where no group has any.

use std::ops::Range;

use geometry::{GeometryId, GroupId, World};
use math::{Bounds3, DMat4, gamma};

use super::item::{self, Item};
use super::{Bvh, Group, Top, largest_coordinate, node, paths};

/// The most instances, triangles of a group, or boxes, which all devices with ray queries take.
pub const MOST: usize = (1 << 24) - 1;

/// What stands for the item of an instance, which has 24 bits, outside of all.
const OUTSIDE: u32 = (1 << 24) - 1;

/// What is built on a device.
#[derive(Clone, Debug, Default)]
pub struct Plan {
    /// The boxes of shapes, group by group.
    pub boxes: Vec<[f32; 6]>,
    /// What is in each group.
    pub bodies: Vec<Body>,
    /// Where groups are seen, the top group as it is.
    pub places: Vec<Place>,
}

/// What is in a group.
#[derive(Clone, Debug, Default)]
pub struct Body {
    pub triangles: Range<usize>,
    /// Whether none of its triangles is marked.
    pub is_opaque: bool,
    pub boxes: Range<usize>,
}

/// A group seen through instances.
#[derive(Clone, Debug)]
pub struct Place {
    pub group: usize,
    /// The rows of the matrix that takes points out of the instance.
    pub rows: [f32; 12],
    /// The item of the instance, or [`OUTSIDE`].
    pub item: u32,
}

impl Bvh {
    /// The buffers of a world for ray queries. None where these do not trace it, because instances
    /// move or there is too much of it, or where nothing does.
    pub fn for_ray_queries(world: &World, is_marked: &dyn Fn(GeometryId) -> bool) -> Option<Self> {
        let (mut bvh, mut plan) = (Self::default(), Plan::default());
        let mut groups = vec![Group::EMPTY; world.groups()];
        plan.bodies = vec![Body::default(); world.groups()];
        for group in (0..world.groups() as u32).rev().map(GroupId) {
            let index = group.0 as usize;
            (groups[index], plan.bodies[index]) =
                bvh.add_body(world, group, &groups, is_marked, &mut plan.boxes)?;
        }
        let identity = Place { group: 0, rows: rows(&DMat4::IDENTITY), item: OUTSIDE };
        let placed = bvh.instances.iter().filter_map(|(path, item)| {
            let steps = path.ids().iter().map(|&id| world.render_from_instance(id).start().in_doubles());
            let group = world.group_of_instance(*path.ids().last()?).0 as usize;
            Some(Place { group, rows: rows(&steps.product()), item: *item })
        });
        plan.places = std::iter::once(identity).chain(placed).collect();
        let most = plan.bodies.iter().map(|body| body.triangles.len().max(body.boxes.len())).max();
        let items = bvh.items.len() / item::QUADRUPLES;
        if bvh.has_motion || most > Some(MOST) || items.max(2 * plan.places.len()) > MOST {
            return None;
        }
        let Group { roots: [first_triangle, first_shape], unbounded, size, .. } = groups[0];
        let first_shape = if plan.boxes.is_empty() { u32::MAX } else { first_shape };
        bvh.top = Top { roots: [first_triangle, first_shape], unbounded, size };
        bvh.plan = Some(plan);
        Some(bvh)
    }

    /// Adds a group, given those that its instances may place.
    fn add_body(
        &mut self,
        world: &World,
        group: GroupId,
        groups: &[Group],
        is_marked: &dyn Fn(GeometryId) -> bool,
        boxes: &mut Vec<[f32; 6]>,
    ) -> Option<(Group, Body)> {
        let (_, triangles) = world.triangle_tree(group);
        let first_triangle = self.triangles.len() / 3;
        let around = triangles.iter().map(|triangle| Bounds3::around(triangle.corners));
        let mut bounds = around.fold(Bounds3::EMPTY, Bounds3::union);
        let is_opaque = !triangles.iter().any(|triangle| is_marked(triangle.geometry));
        self.add_triangles(triangles, is_marked);
        let (_, mut all, unbounded) = world.item_tree(group);
        let instances = all.iter().filter_map(super::instance).collect();
        all.extend(world.sphere_tree(group).1);
        let items = paths::items(world, group, &all, groups).ok()?;
        bounds = items.iter().fold(bounds, |bounds, (inside, _)| bounds.union(*inside));
        let is_shape = |(_, item): &(Bounds3, Item)| matches!(item, Item::Shape(..));
        let (shapes, placed): (Vec<_>, Vec<_>) = items.into_iter().partition(is_shape);
        let (first_box, first) = (boxes.len(), self.items.len() / item::QUADRUPLES);
        boxes.extend(shapes.iter().map(|(inside, _)| {
            // Hits are rounded, and so are rays in the hardware.
            let inside = inside.expand(largest_coordinate(inside) * gamma(16));
            let ([a, b, c], [d, e, f]) = (inside.min.to_array(), inside.max.to_array());
            [a, b, c, d, e, f]
        }));
        let mut items: Vec<Item> = shapes.into_iter().chain(placed).map(|(_, item)| item).collect();
        let open = unbounded.iter().filter(|item| super::instance(item).is_none()).map(Item::from);
        let (first_open, bounded) = (first + items.len(), items.len());
        items.extend(open);
        let unbounded = node::leaf(node::ITEMS, first_open, items.len() - bounded)?;
        if group != GroupId::TOP && items.len() > bounded {
            return None;
        }
        self.add_items(world, items, groups, is_marked).ok()?;
        let roots = [first_triangle as u32, first as u32];
        let size = largest_coordinate(&bounds);
        let placed = Group { roots, unbounded, size, bounds, instances, stack: 0 };
        let triangles = first_triangle..self.triangles.len() / 3;
        Some((placed, Body { triangles, is_opaque, boxes: first_box..boxes.len() }))
    }
}

/// The rows of an affine matrix.
fn rows(matrix: &DMat4) -> [f32; 12] {
    let rows = [0, 1, 2].map(|row| matrix.row(row).as_vec4().to_array());
    std::array::from_fn(|i| rows[i / 4][i % 4])
}
