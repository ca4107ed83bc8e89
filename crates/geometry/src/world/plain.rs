//! The trees of a world as plain data, for engines that traverse them elsewhere.

use super::World;
use super::geometry::GeometryId;
use super::group::Item;
use super::instance::{GroupId, InstanceId};
use crate::bvh::Bvh;
use math::{Bounds3, Vec3};
use std::ops::Range;

/// A tree of boxes. Node 0 is the root; there is none over nothing.
#[derive(Clone, Debug, Default)]
pub struct PlainTree {
    /// The children of each node.
    pub nodes: Vec<Vec<PlainChild>>,
}

/// A child of a node: its box, and what is in it.
#[derive(Clone, Debug)]
pub struct PlainChild {
    /// The box.
    pub bounds: Bounds3,
    /// A node.
    pub node: Option<usize>,
    /// Where it is a leaf, the indices of its primitives.
    pub primitives: Range<usize>,
}

/// A triangle of a mesh.
#[derive(Clone, Copy, Debug)]
pub struct PlainTriangle {
    /// The mesh.
    pub geometry: GeometryId,
    /// The triangle within the mesh.
    pub primitive: u32,
    /// The corners, in the space of the group.
    pub corners: [Vec3; 3],
}

/// A primitive that is tested alone, or an instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum PlainItem {
    /// A primitive of a geometry other than a mesh.
    Shape(GeometryId, u32),
    /// An instance.
    Instance(InstanceId),
}

impl From<&Item> for PlainItem {
    fn from(item: &Item) -> Self {
        match *item {
            Item::Shape(geometry, primitive) => Self::Shape(geometry, primitive),
            Item::Instance(id) => Self::Instance(id),
        }
    }
}

impl World {
    /// The number of groups.
    pub fn groups(&self) -> usize {
        self.tables.groups.len()
    }

    /// The tree over the triangles of a group's meshes, and the triangles in the order of leaves.
    pub fn triangle_tree(&self, group: GroupId) -> (PlainTree, Vec<PlainTriangle>) {
        let triangles = &self.tables.groups[group.0 as usize].triangles;
        let mut list = Vec::new();
        // Blocks are filled unevenly.
        let mut firsts = vec![0];
        for block in &triangles.blocks {
            for (lane, number) in block.numbers().enumerate() {
                let (geometry, primitive) = triangles.numbering.id(number);
                list.push(PlainTriangle { geometry, primitive, corners: block.triangle(lane) });
            }
            firsts.push(list.len());
        }
        (plain(&triangles.tree, |blocks| firsts[blocks.start]..firsts[blocks.end]), list)
    }

    /// The tree over the shapes and instances in a group, these in the order of leaves, and those
    /// without bounds.
    pub fn item_tree(&self, group: GroupId) -> (PlainTree, Vec<PlainItem>, Vec<PlainItem>) {
        let group = &self.tables.groups[group.0 as usize];
        let list = |items: &[Item]| items.iter().map(PlainItem::from).collect();
        (plain(&group.item_tree, |items| items), list(&group.items), list(&group.unbounded))
    }

    /// The tree over the spheres of a group's sets, and the spheres in the order of leaves.
    pub fn sphere_tree(&self, group: GroupId) -> (PlainTree, Vec<PlainItem>) {
        let spheres = &self.tables.groups[group.0 as usize].spheres;
        let mut list = Vec::new();
        // Blocks are filled unevenly.
        let mut firsts = vec![0];
        for block in &spheres.blocks {
            let ids = (0..block.len()).map(|lane| block.id(lane));
            list.extend(ids.map(|(geometry, sphere)| PlainItem::Shape(GeometryId(geometry), sphere)));
            firsts.push(list.len());
        }
        (plain(&spheres.tree, |blocks| firsts[blocks.start]..firsts[blocks.end]), list)
    }

    /// The group that an instance places.
    pub fn group_of_instance(&self, id: InstanceId) -> GroupId {
        GroupId(self.tables.instances[id.0 as usize].group)
    }
}

fn plain(tree: &Bvh, primitives: impl Fn(Range<usize>) -> Range<usize>) -> PlainTree {
    let child = |(bounds, child): (Bounds3, crate::bvh::Child)| match child.is_leaf() {
        true => PlainChild { bounds, node: None, primitives: primitives(child.blocks()) },
        false => PlainChild { bounds, node: Some(child.index()), primitives: 0..0 },
    };
    PlainTree { nodes: tree.nodes().iter().map(|node| node.boxes().map(child).collect()).collect() }
}
