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

    /// The tree over the instances in a group, and these in the order of leaves; `None` where other
    /// things are in the tree.
    pub fn instance_tree(&self, group: GroupId) -> Option<(PlainTree, Vec<InstanceId>)> {
        let group = &self.tables.groups[group.0 as usize];
        let instance = |item: &Item| match item {
            Item::Instance(id) => Some(*id),
            Item::Shape(..) => None,
        };
        let instances = group.items.iter().map(instance).collect::<Option<_>>()?;
        Some((plain(&group.item_tree, |items| items), instances))
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
