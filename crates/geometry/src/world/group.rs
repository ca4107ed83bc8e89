//! A group of primitives and its acceleration structures: trees over blocks of triangles and of
//! spheres, a tree over single items (other shapes, and instances of groups), and a list of
//! unbounded items.

use super::geometry::{Geometry, GeometryId};
use super::instance::{InstanceId, PreparedInstance};
use super::spheres::Spheres;
use super::triangles::Triangles;
use crate::bvh::{BuildQuality, Bvh, Extent, Primitives, Reference};
use math::{Bounds3, gamma};
use std::collections::BTreeSet;

/// A primitive that is tested alone, or an instance.
#[derive(Clone, Copy, Debug)]
pub(super) enum Item {
    Shape(GeometryId, u32),
    Instance(InstanceId),
}

#[derive(Clone, Debug)]
pub(super) struct Group {
    pub triangles: Triangles,
    pub spheres: Spheres,
    pub item_tree: Bvh,
    /// In the order of the leaves of `item_tree`.
    pub items: Vec<Item>,
    pub unbounded: Vec<Item>,
}

impl Group {
    pub fn build(
        members: &[GeometryId],
        geometries: &[Geometry],
        instances: &[(InstanceId, &PreparedInstance, &Group)],
        quality: BuildQuality,
    ) -> Self {
        let mut bounded = Vec::new();
        let mut unbounded = Vec::new();
        let mut add_bounded = |item, bounds: Bounds3| {
            if is_finite(&bounds) {
                bounded.push((item, bounds));
            }
        };
        for &id in members {
            match &geometries[id.0 as usize] {
                Geometry::Mesh(_) | Geometry::Spheres(_) => {}
                Geometry::Shapes(shapes) => {
                    for (i, shape) in shapes.iter().enumerate() {
                        let item = Item::Shape(id, i as u32);
                        match shape.bounds() {
                            Some(bounds) => add_bounded(item, bounds),
                            None => unbounded.push(item),
                        }
                    }
                }
                Geometry::Curves(curves) => {
                    for i in 0..curves.len() as u32 {
                        add_bounded(Item::Shape(id, i), curves.bounds(i));
                    }
                }
            }
        }
        for &(id, instance, group) in instances {
            if !group.bounds().is_empty() {
                add_bounded(Item::Instance(id), instance_bounds(instance, &group.bounds()));
            }
            if group.is_unbounded() {
                unbounded.push(Item::Instance(id));
            }
        }
        let triangles = Triangles::build(members, geometries, quality);
        let (item_tree, items) = Bvh::build(&BoundedItems(bounded), quality);
        let spheres = Spheres::build(members, geometries, quality);
        Self { triangles, spheres, item_tree, items, unbounded }
    }

    /// Refits the trees of triangles and spheres after these have moved.
    pub fn refit_meshes_and_spheres(&mut self, geometries: &[Geometry]) {
        self.spheres.refit(geometries);
        self.triangles.refit(geometries);
    }

    /// Refits the tree of items. `inner_groups` are the groups from group 1 on.
    pub fn refit_items(
        &mut self,
        geometries: &[Geometry],
        instances: &[PreparedInstance],
        inner_groups: &[Group],
    ) {
        self.item_tree.refit(&mut self.items, |&mut item| {
            let bounds = match item {
                Item::Shape(id, primitive) => match &geometries[id.0 as usize] {
                    Geometry::Shapes(shapes) => shapes[primitive as usize].bounds(),
                    Geometry::Curves(curves) => Some(curves.bounds(primitive)),
                    Geometry::Mesh(_) | Geometry::Spheres(_) => None,
                },
                Item::Instance(id) => {
                    let instance = &instances[id.0 as usize];
                    let bounds = inner_groups[instance.group as usize - 1].bounds();
                    (!bounds.is_empty()).then(|| instance_bounds(instance, &bounds))
                }
            };
            bounds.filter(is_finite).unwrap_or(Bounds3::EMPTY)
        });
    }

    /// Whether any primitive or instance is unbounded.
    pub fn is_unbounded(&self) -> bool {
        !self.unbounded.is_empty()
    }

    /// Whether nothing else can be hit in it.
    #[inline(always)]
    pub fn has_only_triangles(&self) -> bool {
        self.unbounded.is_empty() & self.spheres.blocks.is_empty() & self.items.is_empty()
    }

    /// Whether it has anything but triangles and sets of spheres.
    pub fn has_items(&self) -> bool {
        !self.unbounded.is_empty() || !self.items.is_empty()
    }

    /// Whether other groups are placed in it.
    pub fn has_instances(&self) -> bool {
        self.items.iter().any(|item| matches!(item, Item::Instance(_)))
    }

    /// The instances in it that can be hit, in the order of ids.
    pub fn instances(&self) -> BTreeSet<InstanceId> {
        let items = self.items.iter().chain(&self.unbounded);
        let instance = |item: &Item| match item {
            Item::Instance(id) => Some(*id),
            Item::Shape(..) => None,
        };
        items.filter_map(instance).collect()
    }

    /// Bytes of memory of the acceleration structures.
    pub fn bytes(&self) -> usize {
        let items = size_of_val(&*self.items) + size_of_val(&*self.unbounded);
        self.triangles.bytes() + self.spheres.bytes() + self.item_tree.bytes() + items
    }

    /// A box around everything bounded.
    pub fn bounds(&self) -> Bounds3 {
        self.triangles.tree.bounds().union(self.spheres.tree.bounds()).union(self.item_tree.bounds())
    }
}

fn is_finite(bounds: &Bounds3) -> bool {
    bounds.min.is_finite() && bounds.max.is_finite()
}

/// A box around an instance over the shutter time, with a margin for rounding.
fn instance_bounds(instance: &PreparedInstance, bounds: &Bounds3) -> Bounds3 {
    let moved = instance.motion.motion_bounds(bounds);
    moved.expand(moved.min.abs().max(moved.max.abs()).max_element() * gamma(8))
}

/// Items with their boxes; each is a block of its own.
struct BoundedItems(Vec<(Item, Bounds3)>);

impl Primitives for BoundedItems {
    type Block = Item;
    const COST: f32 = 4.0;

    fn width(&self) -> usize {
        1
    }

    fn geometries(&self) -> Vec<(u32, usize)> {
        vec![(0, self.0.len())]
    }

    fn extent(&self, _: u32, item: u32) -> Option<Extent> {
        Some(Extent::from(&self.0[item as usize].1))
    }

    fn block(&self, items: &[Reference]) -> (Item, usize, Extent) {
        let (item, bounds) = &self.0[items[0].primitive() as usize];
        (*item, 1, bounds.into())
    }
}
